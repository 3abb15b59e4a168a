//! Plants of alpha-masked leaf cards: in the vases, on the west front, and an orange tree.

use glam::{Vec2, Vec3};

use super::palette::Palette;
use super::pots::{PLANTED, VASE_EARTH};
use super::{COURT_FLOOR, Side};
use crate::modelling::builder::{Builder, MeshId};
use crate::modelling::noise::Dice;
use crate::modelling::pose::{Pose, sin_cos};
use crate::modelling::shapes::Shape;

/// Grows all plants.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let bush = builder.flat("bush leaves", &spray(32, 0.46, 0.25, 211), palette.leaf);
    let tuft = builder.flat("vine leaves", &spray(11, 0.16, 0.14, 223), palette.leaf);
    let mut dice = Dice::new(227);
    for [x, y, z, turn] in PLANTED {
        let pot = Pose::xyz(x, y + VASE_EARTH, z).turned(turn);
        for k in 0..3 {
            let pose = Pose::xyz(0.0, 0.02, 0.0).turned(120.0 * k as f32 + dice.between(-20.0, 20.0));
            let pose = pose.tilted(dice.between(10.0, 32.0)).sized(dice.between(0.85, 1.2));
            builder.place(bush, &pot.then(&pose));
        }
    }
    vine(builder, palette, tuft, &mut dice);
    tree(builder, palette, bush, &mut dice);
}

/// A spray of `count` leaves around the y axis, up to `height` above the origin, each `length` long.
fn spray(count: u32, height: f32, length: f32, seed: u32) -> Shape {
    let mut dice = Dice::new(seed);
    let mut shape = Shape::default();
    for k in 0..count {
        let up = height * (k as f32 + dice.unit()) / count as f32;
        let size = length * dice.between(0.7, 1.15);
        let pose = Pose::xyz(0.0, up, 0.0)
            .turned(137.5 * k as f32 + dice.between(-25.0, 25.0))
            .tilted(dice.between(15.0, 95.0) - 30.0 * up / height)
            .turned(dice.between(-30.0, 30.0));
        shape.append(leaf(size).posed(&Pose::xyz(0.0, 0.0, 0.0).then(&pose)));
    }
    shape
}

/// A leaf that grows from the origin upwards and bends towards +z: two quadrilaterals.
fn leaf(length: f32) -> Shape {
    Shape::sheet(1, 2, Vec2::ONE, |u, v| {
        Vec3::new((u - 0.5) * 0.62, v * (1.0 - 0.12 * v), 0.28 * v * v) * length
    })
}

/// A vine that climbs a column of the west front and runs along its arches.
fn vine(builder: &mut Builder, palette: &Palette, tuft: MeshId, dice: &mut Dice) {
    let front = Side::West.pose();
    let column = Side::West.column(2);
    // Up the column in a spiral, then over both archivolts.
    let mut path = Vec::new();
    for k in 0..=26 {
        let t = k as f32 / 26.0;
        let (sin, cos) = sin_cos(200.0 + 620.0 * t);
        let radius = 0.225 - 0.03 * t;
        path.push(Vec3::new(column + radius * cos, 2.16 * t, radius * sin));
    }
    let stem = builder.smooth("vine stem", &Shape::tube(&path, 0.013, 5), palette.bark);
    builder.place(stem, &front);
    let mut branches = Vec::new();
    for side in [-1.0f32, 1.0] {
        let branch = (0..=14).map(|k| {
            let t = k as f32 / 14.0;
            let (sin, cos) = sin_cos(10.0 + 62.0 * t);
            let radius = 1.47 + 0.05 * libm::sinf(7.0 * t);
            Vec3::new(column + side * (1.4 - radius * cos), 2.45 + radius * sin, -0.31)
        });
        let mut branch: Vec<Vec3> = branch.collect();
        branch.insert(0, Vec3::new(column + side * 0.1, 2.05, -0.21));
        let mesh = builder.smooth("vine branch", &Shape::tube(&branch, 0.010, 5), palette.bark);
        builder.place(mesh, &front);
        branches.push(branch);
    }
    let along_stem = path.iter().skip(3).map(|p| (*p, p.x - column, p.z));
    let along_branches = branches.iter().flatten().map(|p| (*p, 0.0, -1.0));
    for (point, x, z) in along_stem.chain(along_branches) {
        let outwards = libm::atan2f(x, z).to_degrees() + dice.between(-50.0, 50.0);
        let pose = Pose::at(point).turned(outwards).tilted(dice.between(30.0, 100.0));
        builder.place(tuft, &front.then(&pose.sized(dice.between(0.9, 1.5))));
    }
}

/// Sprays of leaves in the crown of the tree.
const BRANCHES: u32 = 26;

/// An orange tree in a box at the north-west of the court, 3 m high.
fn tree(builder: &mut Builder, palette: &Palette, bush: MeshId, dice: &mut Dice) {
    let foot = Pose::xyz(-4.3, COURT_FLOOR, -1.5);
    let mut planter = Shape::cuboid(Vec3::new(-0.42, 0.04, -0.42), Vec3::new(0.42, 0.62, 0.42));
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let post = Shape::block(Vec3::new(0.1, 0.72, 0.1));
        planter.append(post.posed(&Pose::xyz(0.42 * x, -0.01, 0.42 * z)));
    }
    let planter = builder.flat("planter", &planter, palette.wood);
    builder.place(planter, &foot);
    let earth = Shape::cuboid(Vec3::new(-0.38, 0.5, -0.38), Vec3::new(0.38, 0.635, 0.38));
    let earth = builder.flat("planter earth", &earth, palette.soil);
    builder.place(earth, &foot);

    let trunk = [(0.0, 0.55, 0.0), (0.03, 1.0, 0.02), (-0.02, 1.5, 0.03), (0.0, 1.9, 0.0)];
    let mut wood = Shape::tube(&trunk.map(|(x, y, z)| Vec3::new(x, y, z)), 0.055, 9);
    let crown = Vec3::new(0.0, 2.45, 0.0);
    let mut tips = Vec::new();
    for k in 0..BRANCHES {
        // Even over the sphere, by the golden angle.
        let y = 1.0 - 2.0 * (k as f32 + 0.5) / BRANCHES as f32;
        let around = libm::sqrtf(1.0 - y * y);
        let (sin, cos) = sin_cos(137.508 * k as f32);
        let out = Vec3::new(around * cos, y, around * sin);
        let tip = crown + out * dice.between(0.42, 0.58);
        if k % 3 == 0 {
            let bend = crown + out * 0.2 - Vec3::Y * 0.2;
            wood.append(Shape::tube(&[Vec3::new(0.0, 1.75, 0.0), bend, tip], 0.018, 5));
        }
        tips.push((tip, out));
    }
    let wood = builder.smooth("tree wood", &wood, palette.bark);
    builder.place(wood, &foot);
    let fruit = builder.smooth("orange", &Shape::sphere(0.042, 10), palette.orange);
    for (k, (tip, out)) in tips.into_iter().enumerate() {
        let turn = libm::atan2f(out.x, out.z).to_degrees();
        let lean = libm::acosf(out.y.clamp(-1.0, 1.0)).to_degrees();
        let pose = Pose::at(tip - out * 0.28).turned(turn).tilted(lean).turned(dice.between(0.0, 360.0));
        builder.place(bush, &foot.then(&pose.sized(dice.between(0.85, 1.15))));
        if k % 2 == 0 {
            builder.place(fruit, &foot.then(&Pose::at(crown + (tip - crown) * 1.12 - Vec3::Y * 0.06)));
        }
    }
}
