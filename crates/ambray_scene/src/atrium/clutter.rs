//! Benches, crates, books, a table, a rug and a short flight of stairs.

use glam::{Vec2, Vec3};

use super::palette::Palette;
use super::{PITCH, Side, WALL};
use crate::modelling::builder::Builder;
use crate::modelling::noise::Dice;
use crate::modelling::pose::Pose;
use crate::modelling::shapes::{Profile, Shape};

/// Places all furniture.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let bench = builder.smooth("bench", &bench(), palette.stone);
    for (side, x) in [(Side::South, -2.8), (Side::South, 2.8), (Side::North, 1.4), (Side::West, -2.8)] {
        builder.place(bench, &side.pose().then(&Pose::xyz(x, 0.0, WALL - 0.30)));
    }

    let crate_mesh = builder.flat("crate", &wooden_crate(), palette.wood);
    for (x, y, z, turn) in [
        (5.55, 0.0, 6.40, 4.0),
        (5.58, 0.52, 6.44, -9.0),
        (6.18, 0.0, 6.36, 12.0),
        (9.2, 0.0, 3.1, 5.0),
        (9.15, 0.0, 2.45, -8.0),
        (9.2, 0.52, 2.85, 20.0),
    ] {
        builder.place(crate_mesh, &Pose::xyz(x, y, z).turned(turn));
    }
    books(builder, palette);
    table(builder, palette);

    let rug = Shape::cuboid(Vec3::new(-0.75, -0.01, -1.1), Vec3::new(0.75, 0.008, 1.1));
    let rug = builder.flat("rug", &rug, palette.striped);
    builder.place(rug, &Pose::xyz(8.3, 0.0, 0.0).turned(2.0));
    stairs(builder, palette);
}

/// A stone bench of 1.5 m on two shaped feet, 0.45 m high.
fn bench() -> Shape {
    let slab = Profile::from(-0.2, 0.37)
        .to(0.0, 0.37)
        .to(0.0, 0.385)
        .torus(0.0, 0.39, 0.025, 4)
        .to(0.0, 0.45)
        .to(-0.2, 0.45);
    let mut shape = Shape::moulding(Vec2::new(0.75, 0.2), &slab.0);
    for x in [-0.5, 0.5] {
        let foot = Profile::from(0.03, -0.02)
            .to(0.03, 0.05)
            .curve(Vec2::new(-0.02, 0.10), Vec2::new(-0.02, 0.22), 4)
            .curve(Vec2::new(-0.02, 0.32), Vec2::new(0.03, 0.375), 4);
        shape.append(Shape::moulding(Vec2::new(0.07, 0.14), &foot.0).posed(&Pose::xyz(x, 0.0, 0.0)));
    }
    shape
}

/// A crate of boards, 0.52 m on all sides, open above.
fn wooden_crate() -> Shape {
    const EDGE: f32 = 0.26;
    let mut shape = Shape::cuboid(Vec3::new(-0.24, 0.01, -0.24), Vec3::new(0.24, 0.03, 0.24));
    for turn in 0..4 {
        let pose = Pose::xyz(0.0, 0.0, 0.0).turned(90.0 * turn as f32);
        for k in 0..3 {
            let y = 0.012 + 0.172 * k as f32;
            let board = Shape::cuboid(
                Vec3::new(-EDGE + 0.018, y, EDGE - 0.036),
                Vec3::new(EDGE - 0.018, y + 0.158, EDGE - 0.018),
            );
            shape.append(board.posed(&pose));
        }
        for x in [-EDGE + 0.001, EDGE - 0.071] {
            let batten = Shape::cuboid(
                Vec3::new(x, 0.0, EDGE - 0.019),
                Vec3::new(x + 0.07, 0.52, EDGE - 0.001 * turn as f32),
            );
            shape.append(batten.posed(&pose));
        }
    }
    shape
}

/// A stack of books on the western bench of the south arcade, one leaning on it.
fn books(builder: &mut Builder, palette: &Palette) {
    let (cover, pages) = book();
    let covers = [palette.red, palette.glaze, palette.green, palette.dark_wood]
        .map(|material| builder.flat("book cover", &cover, material));
    let pages = builder.flat("book pages", &pages, palette.paper);
    let mut dice = Dice::new(311);
    let bench = [Pose::xyz(2.45, 0.45, 6.5), Pose::xyz(-3.2, 0.45, 6.5)];
    for (stack, count) in bench.iter().zip([4, 3]) {
        let mut height = 0.0;
        for k in 0..count {
            let thickness = dice.between(0.7, 1.3);
            let pose = Pose::xyz(dice.between(-0.015, 0.015), height, 0.0).turned(dice.between(-25.0, 25.0));
            let pose = stack.then(&pose.scaled(Vec3::new(1.0, thickness, 1.0)));
            builder.place(covers[k % covers.len()], &pose);
            builder.place(pages, &pose);
            height += 0.05 * thickness + 0.0005;
        }
    }
}

/// A closed book that lies flat, 0.22 × 0.30 m and 5 cm thick: its cover and its pages.
fn book() -> (Shape, Shape) {
    let mut cover = Shape::cuboid(Vec3::new(-0.11, 0.0, -0.15), Vec3::new(0.11, 0.005, 0.15));
    cover.append(Shape::cuboid(Vec3::new(-0.11, 0.045, -0.15), Vec3::new(0.11, 0.05, 0.15)));
    cover.append(Shape::cuboid(Vec3::new(-0.115, 0.0, -0.15), Vec3::new(-0.106, 0.05, 0.15)));
    (cover, Shape::cuboid(Vec3::new(-0.107, 0.004, -0.143), Vec3::new(0.102, 0.046, 0.143)))
}

/// A small table with a bowl of oranges in the east arcade.
fn table(builder: &mut Builder, palette: &Palette) {
    let place = Pose::xyz(9.05, 0.0, -2.1).turned(8.0);
    let mut shape = Shape::cuboid(Vec3::new(-0.40, 0.70, -0.55), Vec3::new(0.40, 0.74, 0.55));
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let leg = Shape::block(Vec3::new(0.06, 0.72, 0.06)).posed(&Pose::xyz(0.33 * x, -0.01, 0.48 * z));
        shape.append(leg);
    }
    shape.append(Shape::cuboid(Vec3::new(-0.33, 0.60, -0.48), Vec3::new(0.33, 0.705, 0.48)));
    let table = builder.flat("table", &shape, palette.wood);
    builder.place(table, &place);

    let bowl = Profile::from(0.0, 0.735)
        .to(0.07, 0.735)
        .to(0.07, 0.75)
        .curve(Vec2::new(0.17, 0.76), Vec2::new(0.19, 0.84), 5)
        .to(0.18, 0.842)
        .curve(Vec2::new(0.16, 0.775), Vec2::new(0.0, 0.765), 5);
    let bowl = builder.smooth("bowl", &Shape::lathe(&bowl.0, 24), palette.glaze);
    builder.place(bowl, &place);
    let fruit = builder.smooth("fruit", &Shape::sphere(0.042, 12), palette.orange);
    for (x, y, z) in [
        (0.06, 0.822, 0.03),
        (-0.05, 0.822, 0.05),
        (0.0, 0.822, -0.065),
        (0.0, 0.888, 0.005),
        (0.31, 0.782, 0.2),
    ] {
        builder.place(fruit, &place.then(&Pose::xyz(x, y, z)));
    }
}

/// Height of the landing above the floor.
pub(super) const LANDING: f32 = 0.825;

/// Five steps of stone that rise along the north wall to a landing, before its door.
fn stairs(builder: &mut Builder, palette: &Palette) {
    let mut shape = Shape::default();
    for k in 0..5 {
        let (x, top) = (-1.50 + 0.30 * k as f32, 0.165 * (k + 1) as f32);
        shape.append(Shape::cuboid(Vec3::new(x, -0.05, 0.0), Vec3::new(x + 0.30, top - 0.035, 1.0)));
        shape.append(Shape::cuboid(Vec3::new(x - 0.025, top - 0.035, -0.02), Vec3::new(x + 0.30, top, 1.0)));
    }
    shape.append(Shape::cuboid(Vec3::new(0.0, -0.05, 0.0), Vec3::new(1.5, 0.79, 1.0)));
    shape.append(Shape::cuboid(Vec3::new(0.0, 0.79, -0.02), Vec3::new(1.52, LANDING + 0.0001, 1.0)));
    let stairs = builder.flat("stairs", &shape, palette.stone);
    builder.place(stairs, &Side::North.pose().then(&Pose::xyz(2.0 * PITCH - 0.75, 0.0, WALL - 0.96)));
}
