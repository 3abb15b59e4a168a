//! Columns with entasis, attic base and leafed capital; the piers in the corners of the court.

use glam::{Vec2, Vec3};

use super::palette::Palette;
use super::{COURT, Side};
use crate::modelling::builder::Builder;
use crate::modelling::column::column;
use crate::modelling::pose::Pose;
use crate::modelling::shapes::{Profile, Shape};

/// Places the columns and corner piers of the ground floor.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let column = builder.smooth("column", &column(18, 1), palette.stone);
    for side in Side::ALL {
        for k in 1..side.bays() {
            builder.place(column, &side.pose().then(&Pose::xyz(side.column(k), 0.0, 0.0)));
        }
    }
    let pier = builder.smooth("corner pier", &pier(), palette.stone);
    for (x, z) in [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        builder.place(pier, &Pose::xyz(x * COURT.x, 0.0, z * COURT.y));
    }
}

/// A square pier of 0.46 m and 2.5 m high with the mouldings of the columns.
fn pier() -> Shape {
    let profile = Profile::from(0.05, -0.05)
        .to(0.05, 0.14)
        .to(0.035, 0.155)
        .to(0.035, 0.19)
        .curve(Vec2::new(0.006, 0.20), Vec2::new(0.0, 0.26), 4)
        .to(0.0, 2.16)
        .torus(0.0, 2.165, 0.018, 4)
        .to(0.0, 2.205)
        .to(0.0, 2.30)
        .curve(Vec2::new(0.005, 2.36), Vec2::new(0.035, 2.37), 4)
        .to(0.035, 2.42)
        .to(0.048, 2.43)
        .to(0.048, 2.5)
        .to(-0.2, 2.5);
    let mut shape = Shape::moulding(Vec2::splat(0.23), &profile.0);
    // A sunk panel's frame on each face, by a thin border that stands out.
    for turn in 0..4 {
        let pose = Pose::xyz(0.0, 0.0, 0.0).turned(90.0 * turn as f32);
        for (lo, hi) in [
            (Vec3::new(-0.17, 0.40, 0.2), Vec3::new(-0.13, 2.02, 0.245)),
            (Vec3::new(0.13, 0.40, 0.2), Vec3::new(0.17, 2.02, 0.245)),
            (Vec3::new(-0.17, 0.36, 0.2), Vec3::new(0.17, 0.40, 0.245)),
            (Vec3::new(-0.17, 2.02, 0.2), Vec3::new(0.17, 2.06, 0.245)),
        ] {
            shape.append(Shape::cuboid(lo, hi).posed(&pose));
        }
    }
    shape
}
