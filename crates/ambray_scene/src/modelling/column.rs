//! A column with entasis, attic base and leafed capital.

use glam::{Vec2, Vec3};

use super::pose::Pose;
use super::shapes::{Profile, Shape};

/// A column 2.5 m high, 0.36 m thick at the foot, on a plinth of 0.5 m; `coarseness` divides the steps of its curves.
///
/// Scaled down it serves the gallery too.
pub(crate) fn column(segments: u32, coarseness: u32) -> Shape {
    let steps = |n: u32| (n / coarseness).max(2);
    let mut profile = Profile::from(0.245, 0.095)
        .torus(0.208, 0.10, 0.036, steps(5))
        .to(0.208, 0.182)
        .curve(Vec2::new(0.180, 0.192), Vec2::new(0.196, 0.222), steps(3))
        .torus(0.192, 0.226, 0.020, steps(4))
        .to(0.190, 0.276)
        .curve(Vec2::new(0.181, 0.280), Vec2::new(0.180, 0.300), 1);
    let rings = steps(5);
    for k in 1..=rings {
        let t = k as f32 / rings as f32;
        profile = profile.to(0.180 - 0.006 * t - 0.022 * t * t, 0.300 + 1.76 * t);
    }
    let profile = profile
        .torus(0.152, 2.064, 0.020, steps(4))
        .to(0.150, 2.108)
        .curve(Vec2::new(0.150, 2.26), Vec2::new(0.226, 2.352), steps(4))
        .to(0.232, 2.364);
    let mut shape = Shape::lathe(&profile.0, segments);

    let plinth = Profile::from(0.25, -0.05).to(0.25, 0.088).to(0.238, 0.10).to(0.12, 0.10);
    shape.append(Shape::moulding(Vec2::ZERO, &plinth.0));
    let abacus = Profile::from(0.16, 2.358)
        .to(0.236, 2.358)
        .to(0.236, 2.392)
        .to(0.244, 2.398)
        .curve(Vec2::new(0.248, 2.436), Vec2::new(0.272, 2.446), steps(3))
        .to(0.272, 2.5)
        .to(0.05, 2.5);
    shape.append(Shape::moulding(Vec2::ZERO, &abacus.0));
    for k in 0..8 {
        shape.append(capital_leaf(coarseness).posed(&Pose::xyz(0.0, 0.0, 0.0).turned(45.0 * k as f32)));
    }
    shape
}

/// A leaf that rises along the bell of the capital towards +z and curls over at its tip.
fn capital_leaf(coarseness: u32) -> Shape {
    Shape::sheet(2, 5 / coarseness, Vec2::new(0.1, 0.25), |u, v| {
        let (x, curl) = (2.0 * u - 1.0, ((v - 0.62) / 0.38).max(0.0));
        let width = 0.060 * (1.0 - 0.55 * v * v) * if v > 0.95 { 0.55 } else { 1.0 };
        let bell = 0.156 + 0.062 * v * v * v;
        let out = bell + 0.010 + 0.055 * curl * curl + 0.012 * (1.0 - x * x);
        let height = 2.112 + 0.245 * v - 0.085 * curl * curl;
        Vec3::new(x * width, height, out - 0.02 * x * x)
    })
}
