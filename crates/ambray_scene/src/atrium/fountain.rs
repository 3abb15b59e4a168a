//! The fountain in the middle of the court.

use glam::{Vec2, Vec3};

use super::COURT_FLOOR;
use super::palette::Palette;
use super::pots::flipped;
use crate::modelling::builder::Builder;
use crate::modelling::pose::{Pose, sin_cos};
use crate::modelling::shapes::{Profile, Shape};

/// Builds an octagonal basin of 2.9 m, a bowl on a shaft 1.35 m up, and the water in both.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let place = Pose::xyz(0.0, COURT_FLOOR, 0.0);
    let rim = Profile::from(1.50, -0.05)
        .to(1.50, 0.10)
        .to(1.46, 0.12)
        .to(1.34, 0.12)
        .to(1.34, 0.16)
        .to(1.30, 0.20)
        .to(1.30, 0.44)
        .to(1.34, 0.47)
        .to(1.36, 0.49)
        .to(1.36, 0.54)
        .to(1.34, 0.56)
        .to(1.16, 0.56)
        .to(1.14, 0.54)
        .to(1.14, 0.10)
        .to(0.0, 0.10);
    let basin = builder.flat("fountain basin", &octagon(&rim.0), palette.stone);
    builder.place(basin, &place);

    let shaft = Profile::from(0.34, 0.05)
        .to(0.34, 0.30)
        .torus(0.25, 0.30, 0.04, 4)
        .curve(Vec2::new(0.10, 0.42), Vec2::new(0.12, 0.66), 4)
        .torus(0.12, 0.66, 0.03, 4)
        .curve(Vec2::new(0.09, 0.80), Vec2::new(0.10, 1.02), 4)
        .to(0.14, 1.05)
        .curve(Vec2::new(0.50, 1.06), Vec2::new(0.60, 1.26), 6)
        .torus(0.60, 1.26, 0.028, 4)
        .to(0.56, 1.30)
        .curve(Vec2::new(0.40, 1.12), Vec2::new(0.08, 1.13), 4)
        .to(0.07, 1.30)
        .torus(0.07, 1.30, 0.02, 4)
        .curve(Vec2::new(0.05, 1.46), Vec2::new(0.11, 1.52), 3)
        .curve(Vec2::new(0.11, 1.62), Vec2::new(0.0, 1.66), 4);
    let bowl = builder.smooth("fountain bowl", &Shape::lathe(&shaft.0, 28), palette.stone);
    builder.place(bowl, &place);

    let mut water = octagon(&[Vec2::new(1.16, 0.43), Vec2::new(0.0, 0.43)]);
    water.append(flipped(Shape::lathe(&[Vec2::new(0.0, 1.255), Vec2::new(0.55, 1.255)], 32)));
    let water = builder.flat("fountain water", &water, palette.water);
    builder.place(water, &place);
}

/// An eight-sided thing about the y axis with a side towards +z: `profile` holds (distance of the sides, height).
fn octagon(profile: &[Vec2]) -> Shape {
    let reach = 1.0 / sin_cos(67.5).0;
    let ring = |k: u32| -> Vec<Vec3> {
        let (sin, cos) = sin_cos(22.5 + 45.0 * (k % 8) as f32);
        profile.iter().map(|p| Vec3::new(p.x * reach * cos, p.y, -p.x * reach * sin)).collect()
    };
    Shape::loft(&(0..=8).map(ring).collect::<Vec<_>>())
}
