//! The walls behind the arcades with pilasters, skirting and doors.

use glam::{Vec2, Vec3};

use super::clutter::LANDING;
use super::palette::Palette;
use super::{CEILING, COURT, GALLERY, PITCH, SPRINGING, Side, WALL};
use crate::modelling::builder::Builder;
use crate::modelling::pose::Pose;
use crate::modelling::shapes::{Profile, Shape};

/// Thickness of the outer walls.
const THICKNESS: f32 = 0.4;

/// Builds the outer walls of both storeys, the pilasters and the doors.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let outer = COURT + WALL;
    let ground = wall_around(-0.4, GALLERY - 0.05, outer);
    builder.smooth_once("arcade walls", &ground, palette.terracotta);

    let skirting = Profile::from(0.035, -0.05).to(0.035, 0.11).to(0.02, 0.13).to(-0.01, 0.13);
    builder.smooth_once("skirting", &Shape::inner_moulding(outer, &skirting.0), palette.stone);
    let rail = Profile::from(-0.01, SPRINGING - 0.09)
        .to(0.025, SPRINGING - 0.085)
        .to(0.03, SPRINGING - 0.05)
        .curve(Vec2::new(0.035, SPRINGING - 0.02), Vec2::new(0.06, SPRINGING - 0.015), 3)
        .to(0.06, SPRINGING)
        .to(-0.01, SPRINGING);
    builder.smooth_once("wall moulding", &Shape::inner_moulding(outer, &rail.0), palette.stone);

    let pilaster = builder.smooth("pilaster", &pilaster(), palette.stone);
    for side in Side::ALL {
        for k in 0..=side.bays() {
            builder.place(pilaster, &side.pose().then(&Pose::xyz(side.column(k), 0.0, WALL)));
        }
    }

    upper_walls(builder, palette, outer);
    doors(builder, palette);
}

/// The four outer walls between two heights.
fn wall_around(from: f32, to: f32, outer: Vec2) -> Shape {
    let profile =
        [(0.0, from), (0.0, to), (-THICKNESS, to), (-THICKNESS, from)].map(|(x, y)| Vec2::new(x, y));
    Shape::inner_moulding(outer, &profile)
}

/// Half column of square plan under the arches across the arcade, 0.36 m wide, 8 cm before the wall.
fn pilaster() -> Shape {
    let profile = Profile::from(0.03, -0.05)
        .to(0.03, 0.16)
        .to(0.015, 0.175)
        .curve(Vec2::new(0.003, 0.19), Vec2::new(0.0, 0.24), 3)
        .to(0.0, SPRINGING - 0.30)
        .torus(0.0, SPRINGING - 0.295, 0.014, 4)
        .to(0.0, SPRINGING - 0.25)
        .to(0.0, SPRINGING - 0.16)
        .curve(Vec2::new(0.005, SPRINGING - 0.11), Vec2::new(0.04, SPRINGING - 0.10), 3)
        .to(0.04, SPRINGING - 0.05)
        .to(0.05, SPRINGING - 0.04)
        .to(0.05, SPRINGING + 0.004)
        .to(-0.1, SPRINGING + 0.004);
    Shape::moulding(Vec2::new(0.17, 0.08), &profile.0)
}

/// Walls behind the galleries, and the parapet of the terrace in the north.
fn upper_walls(builder: &mut Builder, palette: &Palette, outer: Vec2) {
    let (floor, top) = (GALLERY - 0.05, CEILING + 0.5);
    let mut ochre = Shape::default();
    ochre.append(Shape::cuboid(
        Vec3::new(-outer.x - THICKNESS, floor, outer.y),
        Vec3::new(outer.x + THICKNESS, top, outer.y + THICKNESS),
    ));
    for x in [-1.0, 1.0] {
        let span = |a: f32, b: f32| if a * x < b * x { (a * x, b * x) } else { (b * x, a * x) };
        let (lo, hi) = span(outer.x, outer.x + THICKNESS);
        ochre.append(Shape::cuboid(Vec3::new(lo, floor, -outer.y), Vec3::new(hi, top, outer.y)));
        // The gable in the north, and the wall between gallery and terrace.
        let (lo, hi) = span(COURT.x - 0.14, outer.x + THICKNESS);
        ochre.append(Shape::cuboid(Vec3::new(lo, floor, -outer.y - THICKNESS), Vec3::new(hi, top, -outer.y)));
        let (lo, hi) = span(COURT.x - 0.14, COURT.x + 0.14);
        ochre.append(Shape::cuboid(Vec3::new(lo, floor, -outer.y), Vec3::new(hi, top, -COURT.y + 0.15)));
    }
    builder.smooth_once("gallery walls", &ochre, palette.ochre);

    let parapet = Shape::cuboid(
        Vec3::new(-COURT.x + 0.1, floor, -outer.y - THICKNESS),
        Vec3::new(COURT.x - 0.1, GALLERY + 0.95, -outer.y),
    );
    builder.smooth_once("terrace parapet", &parapet, palette.plaster);
    let coping = Shape::cuboid(
        Vec3::new(-COURT.x + 0.1, GALLERY + 0.95, -outer.y - THICKNESS - 0.05),
        Vec3::new(COURT.x - 0.1, GALLERY + 1.03, -outer.y + 0.06),
    );
    builder.flat_once("terrace coping", &coping, palette.stone);
}

/// Panelled doors in stone frames: in the arcades below and in the galleries above.
fn doors(builder: &mut Builder, palette: &Palette) {
    let mut frame = Shape::default();
    for (lo, hi) in [
        (Vec3::new(-0.66, -0.05, -0.07), Vec3::new(-0.50, 2.12, 0.05)),
        (Vec3::new(0.50, -0.05, -0.07), Vec3::new(0.66, 2.12, 0.05)),
        (Vec3::new(-0.66, 2.12, -0.07), Vec3::new(0.66, 2.27, 0.05)),
        (Vec3::new(-0.72, 2.27, -0.13), Vec3::new(0.72, 2.33, 0.05)),
        (Vec3::new(-0.74, -0.05, -0.30), Vec3::new(0.74, 0.15, 0.05)),
    ] {
        frame.append(Shape::cuboid(lo, hi));
    }
    let mut leaf = Shape::cuboid(Vec3::new(-0.51, 0.1, -0.02), Vec3::new(0.51, 2.13, 0.05));
    for x in [-0.25, 0.25] {
        for (y0, y1) in [(0.24, 0.82), (0.90, 1.40), (1.48, 2.02)] {
            leaf.append(Shape::cuboid(Vec3::new(x - 0.19, y0, -0.045), Vec3::new(x + 0.19, y1, 0.0)));
        }
    }
    let frame = builder.flat("door frame", &frame, palette.stone);
    let leaf = builder.flat("door", &leaf.with_uv_turned(), palette.wood);
    let mut places = vec![
        Side::South.pose().then(&Pose::xyz(0.0, 0.0, WALL)),
        Side::West.pose().then(&Pose::xyz(0.0, 0.0, WALL)),
        Side::North.pose().then(&Pose::xyz(-PITCH, 0.0, WALL)),
        Side::East.pose().then(&Pose::xyz(0.0, 0.0, WALL)),
    ];
    // The door over the stairs is thicker, since the moulding of the wall ends at it.
    let raised = Pose::xyz(2.0 * PITCH, LANDING, WALL).scaled(Vec3::new(1.0, 1.0, 3.15));
    places.push(Side::North.pose().then(&raised));
    for side in Side::TALL {
        places.push(side.pose().then(&Pose::xyz(0.0, GALLERY, WALL)));
    }
    for place in places {
        builder.place(frame, &place);
        builder.place(leaf, &place);
    }
}
