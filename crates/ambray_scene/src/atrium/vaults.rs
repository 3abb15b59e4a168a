//! Groin vaults over the bays of the arcades.

use glam::{Vec2, Vec3};

use super::palette::Palette;
use super::{COURT, PITCH, SPRINGING, Side};
use crate::modelling::builder::Builder;
use crate::modelling::pose::{Pose, sin_cos};
use crate::modelling::shapes::Shape;

/// Radius of the vaults; their edges vanish in walls and arches.
const RADIUS: f32 = 1.235;

/// Places a vault over each bay and each corner of the arcades.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let vault = builder.smooth("groin vault", &vault(), palette.plaster);
    let boss = builder.smooth("vault boss", &boss(), palette.stone);
    let middle = 0.5 * PITCH;
    let mut places = Vec::new();
    for side in Side::ALL {
        let bays = (0..side.bays()).map(|k| Pose::xyz(side.bay(k), SPRINGING, middle));
        places.extend(bays.map(|bay| side.pose().then(&bay)));
    }
    for (x, z) in [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        places.push(Pose::xyz(x * (COURT.x + middle), SPRINGING, z * (COURT.y + middle)));
    }
    for place in places {
        builder.place(vault, &place);
        builder.place(boss, &place);
    }
}

/// Two barrels that cross: four webs of a quarter each, seen from below.
fn vault() -> Shape {
    let mut shape = Shape::default();
    for turn in 0..4 {
        shape.append(web().posed(&Pose::xyz(0.0, 0.0, 0.0).turned(90.0 * turn as f32)));
    }
    shape
}

/// The part of the barrel along z where |x| < z.
fn web() -> Shape {
    // (u, v): v from the middle to the edge, u across from one groin to the other.
    Shape::sheet(6, 6, Vec2::splat(1.4), |u, v| {
        let edge = 86.0 * v;
        let (sin, cos) = sin_cos(edge * (2.0 * u - 1.0));
        let depth = sin_cos(edge).0 / sin_cos(86.0).0;
        Vec3::new(sin, cos, depth) * RADIUS
    })
}

/// The round stone where the groins meet.
fn boss() -> Shape {
    let profile = [(0.0, -0.05), (0.045, -0.042), (0.06, -0.02), (0.075, -0.03), (0.10, -0.02), (0.11, 0.02)];
    Shape::lathe(&profile.map(|(r, y)| Vec2::new(r, RADIUS + y)), 10)
}
