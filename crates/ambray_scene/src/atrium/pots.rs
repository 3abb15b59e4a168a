//! Vases, amphorae, bowls and barrels: things turned on the wheel.

use glam::{Vec2, Vec3};

use super::palette::Palette;
use super::{COURT_FLOOR, GALLERY, Side};
use crate::modelling::builder::Builder;
use crate::modelling::pose::Pose;
use crate::modelling::shapes::{Profile, Shape};

/// Height of the earth in a large vase.
pub(super) const VASE_EARTH: f32 = 0.60;

/// Where large vases with plants stand: x, y, z and the turn of the plant in degrees.
pub(super) const PLANTED: [[f32; 4]; 8] = [
    [-6.15, COURT_FLOOR, 3.35, 10.0],
    [6.15, COURT_FLOOR, 3.35, 80.0],
    [-6.15, COURT_FLOOR, -3.35, 130.0],
    [6.15, COURT_FLOOR, -3.35, 200.0],
    [-2.1, COURT_FLOOR, 3.30, 250.0],
    [2.1, COURT_FLOOR, 3.30, 300.0],
    [1.30, 0.0, 6.38, 40.0],
    [-9.2, 0.0, 0.95, 170.0],
];

/// Places all pottery.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let vase = builder.smooth("vase", &vase(), palette.pottery);
    let earth = Shape::lathe(&[Vec2::new(0.0, VASE_EARTH + 0.02), Vec2::new(0.262, VASE_EARTH)], 20);
    let earth = builder.smooth("earth", &flipped(earth), palette.soil);
    for [x, y, z, turn] in PLANTED {
        let pose = Pose::xyz(x, y, z).turned(turn);
        builder.place(vase, &pose);
        builder.place(earth, &pose);
    }

    let amphora_shape = amphora();
    let amphora = builder.smooth("amphora", &amphora_shape, palette.pottery);
    let glazed = builder.smooth("glazed amphora", &amphora_shape, palette.glaze);
    let standing = [
        (-8.9, 6.35, 20.0, 1.0),
        (-9.15, 5.75, 100.0, 0.86),
        (8.95, -6.3, 60.0, 1.0),
        (4.75, 6.42, 200.0, 0.92),
    ];
    for (x, z, turn, size) in standing {
        builder.place(amphora, &Pose::xyz(x, 0.0, z).turned(turn).sized(size));
    }
    builder.place(glazed, &Pose::xyz(-8.45, 0.0, 6.5).turned(310.0).sized(0.8));
    builder.place(glazed, &Pose::xyz(4.28, 0.0, 6.5).turned(20.0).sized(0.72));
    // One lies on its side by the wall.
    builder.place(amphora, &Pose::xyz(7.9, 0.215, -6.25).turned(35.0).rolled(90.0));

    let urn = builder.smooth("urn", &urn(), palette.stone);
    for k in 1..Side::North.bays() {
        let place = Side::North.pose().then(&Pose::xyz(Side::North.column(k), GALLERY + 0.95, 0.0));
        builder.place(urn, &place);
    }
    let barrel_pose = [(-9.2, -2.3, 0.0), (-9.25, -3.0, 40.0)];
    let barrel = builder.smooth("barrel", &barrel().with_uv_turned(), palette.wood);
    let hoop = builder.smooth("barrel hoops", &hoops(), palette.bronze);
    for (x, z, turn) in barrel_pose {
        builder.place(barrel, &Pose::xyz(x, 0.0, z).turned(turn));
        builder.place(hoop, &Pose::xyz(x, 0.0, z).turned(turn));
    }
}

/// The same surface seen from its other side.
pub(super) fn flipped(mut shape: Shape) -> Shape {
    for corners in &mut shape.triangles {
        corners.swap(1, 2);
    }
    shape
}

/// A vase for plants, 0.68 m high and 0.64 m wide, open above.
fn vase() -> Shape {
    let profile = Profile::from(0.20, -0.01)
        .to(0.20, 0.05)
        .to(0.16, 0.08)
        .curve(Vec2::new(0.335, 0.20), Vec2::new(0.315, 0.44), 5)
        .curve(Vec2::new(0.305, 0.53), Vec2::new(0.285, 0.56), 2)
        .to(0.285, 0.59)
        .curve(Vec2::new(0.29, 0.63), Vec2::new(0.325, 0.635), 2)
        .to(0.335, 0.655)
        .to(0.325, 0.68)
        .to(0.29, 0.675)
        .to(0.262, 0.62)
        .to(0.25, 0.55);
    let mut shape = Shape::lathe(&profile.0, 18);
    shape.append(Shape::torus(0.316, 0.014, 18, 3).posed(&Pose::xyz(0.0, 0.40, 0.0)));
    shape
}

/// An amphora with two handles, 0.9 m high and 0.44 m wide.
fn amphora() -> Shape {
    let profile = Profile::from(0.0, -0.004)
        .to(0.11, -0.004)
        .to(0.115, 0.03)
        .to(0.085, 0.06)
        .curve(Vec2::new(0.19, 0.22), Vec2::new(0.215, 0.44), 4)
        .curve(Vec2::new(0.225, 0.62), Vec2::new(0.09, 0.68), 4)
        .curve(Vec2::new(0.062, 0.70), Vec2::new(0.064, 0.80), 3)
        .to(0.075, 0.86)
        .to(0.098, 0.875)
        .to(0.098, 0.90)
        .to(0.070, 0.90)
        .to(0.055, 0.84)
        .to(0.05, 0.66);
    let mut shape = Shape::lathe(&profile.0, 16);
    for side in [-1.0, 1.0] {
        let path = [(0.06, 0.83), (0.13, 0.85), (0.175, 0.80), (0.182, 0.72), (0.165, 0.60)];
        shape.append(Shape::tube(&path.map(|(x, y)| Vec3::new(side * x, y, 0.0)), 0.017, 4));
    }
    shape
}

/// A low stone urn with a lid for the pedestals of the terrace, 0.55 m high.
fn urn() -> Shape {
    let profile = Profile::from(0.11, -0.01)
        .to(0.11, 0.03)
        .to(0.05, 0.06)
        .to(0.045, 0.10)
        .curve(Vec2::new(0.16, 0.13), Vec2::new(0.165, 0.26), 4)
        .to(0.15, 0.31)
        .to(0.18, 0.33)
        .to(0.18, 0.355)
        .curve(Vec2::new(0.10, 0.40), Vec2::new(0.035, 0.44), 3)
        .to(0.03, 0.455)
        .torus(0.025, 0.46, 0.03, 4)
        .to(0.0, 0.53);
    Shape::lathe(&profile.0, 14)
}

/// A barrel, 0.85 m high.
fn barrel() -> Shape {
    let profile = Profile::from(0.24, -0.01)
        .curve(Vec2::new(0.36, 0.42), Vec2::new(0.24, 0.85), 8)
        .to(0.215, 0.85)
        .to(0.21, 0.81)
        .to(0.0, 0.81);
    Shape::lathe(&profile.0, 18)
}

/// The four hoops of a barrel.
fn hoops() -> Shape {
    let mut shape = Shape::default();
    for (y, lower, upper) in
        [(0.06, 0.257, 0.267), (0.26, 0.291, 0.298), (0.54, 0.299, 0.293), (0.74, 0.269, 0.259)]
    {
        let profile = Profile::from(lower - 0.02, y).to(lower + 0.006, y).to(upper + 0.006, y + 0.045);
        shape.append(Shape::lathe(&profile.to(upper - 0.02, y + 0.045).0, 18));
    }
    shape
}
