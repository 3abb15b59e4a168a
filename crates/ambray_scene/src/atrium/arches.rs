//! Round arches: the fronts of the court, the arches across the arcades and those of the gallery.

use glam::{Vec2, Vec3};

use super::palette::Palette;
use super::{COURT, GALLERY, PITCH, SPRINGING, Side};
use crate::modelling::builder::Builder;
use crate::modelling::pose::{Pose, sin_cos};
use crate::modelling::shapes::{Corner, Profile, Shape};

/// Radius of the opening of the large arches.
const RADIUS: f32 = 1.15;
/// Half the thickness of the walls above the large arches.
const HALF_WALL: f32 = 0.2;

/// Builds the arches of the ground floor with the walls and the cornice above them.
pub(super) fn build(builder: &mut Builder, palette: &Palette) {
    let ring = builder.smooth("archivolt", &archivolt(), palette.stone);
    let keystone = builder.flat("keystone", &keystone(), palette.stone);
    let opening = Opening { half_width: 0.5 * PITCH, hole: 1.27, height: GALLERY - SPRINGING, steps: 20 };
    let wall = builder.flat("arch wall", &opening.wall(HALF_WALL), palette.plaster);
    let dentils = builder.flat("dentils", &dentils(), palette.stone);
    let cross = builder.smooth("cross arch", &cross_arch(), palette.stone);
    for side in Side::ALL {
        for k in 0..side.bays() {
            let pose = side.pose().then(&Pose::xyz(side.bay(k), SPRINGING, 0.0));
            for mesh in [ring, keystone, wall, dentils] {
                builder.place(mesh, &pose);
            }
        }
        for k in 0..=side.bays() {
            let pose = Pose::xyz(side.column(k), SPRINGING, 0.5 * PITCH).turned(90.0);
            builder.place(cross, &side.pose().then(&pose));
        }
    }
    builder.smooth_once("court cornice", &cornice(), palette.stone);
}

/// A wall with an arched hole, its middle above the origin; both fronts, without edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Opening {
    /// Half the width of the wall.
    pub(super) half_width: f32,
    /// Radius of the hole.
    pub(super) hole: f32,
    /// Height of the wall above the springing.
    pub(super) height: f32,
    /// Steps of the half circle.
    pub(super) steps: u32,
}

impl Opening {
    /// Both fronts, at z = ±`half_thickness`.
    pub(super) fn wall(&self, half_thickness: f32) -> Shape {
        let corner = libm::atan2f(self.height, self.half_width).to_degrees();
        let mut angles: Vec<f32> = (0..=self.steps).map(|k| 180.0 * k as f32 / self.steps as f32).collect();
        angles.extend([corner, 180.0 - corner]);
        angles.sort_by(f32::total_cmp);
        let mut shape = Shape::default();
        for pair in angles.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|degrees| (self.at_hole(degrees), self.at_edge(degrees)));
            for (z, [a, b]) in [(half_thickness, [a, b]), (-half_thickness, [b, a])] {
                let corner = |p: Vec2| Corner { position: p.extend(z), uv: Vec2::new(p.x, -p.y) };
                shape.quad([a.0, a.1, b.1, b.0].map(corner));
            }
        }
        shape
    }

    fn at_hole(&self, degrees: f32) -> Vec2 {
        let (sin, cos) = sin_cos(degrees);
        Vec2::new(cos, sin) * self.hole
    }

    /// Where the ray at `degrees` leaves the wall.
    fn at_edge(&self, degrees: f32) -> Vec2 {
        let (sin, cos) = sin_cos(degrees);
        let beside = if cos.abs() > 1e-6 { self.half_width / cos.abs() } else { f32::INFINITY };
        let above = if sin > 1e-6 { self.height / sin } else { f32::INFINITY };
        Vec2::new(cos, sin) * beside.min(above)
    }
}

/// Half a ring in the x-y plane: `profile` holds (radius, z) from back to front over the inside of the arch.
pub(super) fn arch(profile: &[Vec2], angles: &[f32]) -> Shape {
    let ring = |&degrees: &f32| {
        let (sin, cos) = sin_cos(degrees);
        profile.iter().map(|p| Vec3::new(p.x * cos, p.x * sin, p.y)).collect()
    };
    Shape::loft(&angles.iter().map(ring).collect::<Vec<Vec<_>>>())
}

/// The moulded ring of a large arch, 11 voussoirs with grooves between, 0.47 m thick.
fn archivolt() -> Shape {
    const VOUSSOIRS: u32 = 11;
    const GROOVE: f32 = 0.012;
    let full = Profile::from(1.34, 0.19)
        .to(1.34, 0.225)
        .to(RADIUS + 0.015, 0.235)
        .to(RADIUS, 0.220)
        .to(RADIUS, -0.210)
        .to(RADIUS + 0.075, -0.225)
        .to(RADIUS + 0.083, -0.245)
        .to(RADIUS + 0.160, -0.250)
        .curve(Vec2::new(RADIUS + 0.175, -0.290), Vec2::new(RADIUS + 0.215, -0.285), 2)
        .to(RADIUS + 0.225, -0.19)
        .0;
    let sunk: Vec<Vec2> = full
        .iter()
        .map(|p| {
            Vec2::new((p.x + GROOVE).min(1.36), p.y - p.y.signum() * GROOVE * f32::from(p.y.abs() > 0.19))
        })
        .collect();
    let ring = |profile: &[Vec2], degrees: f32| -> Vec<Vec3> {
        let (sin, cos) = sin_cos(degrees);
        profile.iter().map(|p| Vec3::new(p.x * cos, p.x * sin, p.y)).collect()
    };
    let (width, gap) = (180.0 / VOUSSOIRS as f32, 0.45);
    let mut rings = Vec::new();
    for k in 0..VOUSSOIRS {
        let start = width * k as f32;
        rings.push(ring(&sunk, start));
        rings.push(ring(&full, start + gap));
        rings.push(ring(&full, start + width - gap));
    }
    rings.push(ring(&sunk, 180.0));
    Shape::loft(&rings)
}

/// The keystone towards the court: a wedge 0.4 m high with a stepped front.
fn keystone() -> Shape {
    let wedge = |low: f32, high: f32, half: f32, front: f32| {
        let corner = |x: f32, y: f32, z: f32| Vec3::new(x * half * y / RADIUS, y, z);
        let (back, low_front) = (-0.15, front + 0.02);
        let mut shape = Shape::default();
        let [a, b, c, d] = [
            corner(1.0, low, low_front),
            corner(-1.0, low, low_front),
            corner(-1.0, high, front),
            corner(1.0, high, front),
        ];
        let [e, f, g, h] = [
            corner(1.0, low, back),
            corner(-1.0, low, back),
            corner(-1.0, high, back),
            corner(1.0, high, back),
        ];
        shape.panel([a, b, c, d]);
        shape.panel([e, a, d, h]);
        shape.panel([b, f, g, c]);
        shape.panel([d, c, g, h]);
        shape.panel([e, f, b, a]);
        shape
    };
    let mut shape = wedge(1.125, 1.475, 0.12, -0.33);
    shape.append(wedge(1.475, 1.515, 0.145, -0.36));
    shape
}

/// A plain arch across the arcade with a sunk band below, 0.34 m thick, from capital to wall.
fn cross_arch() -> Shape {
    let profile = Profile::from(1.30, 0.17)
        .to(RADIUS, 0.17)
        .to(RADIUS, 0.11)
        .to(RADIUS + 0.025, 0.095)
        .to(RADIUS + 0.025, -0.095)
        .to(RADIUS, -0.11)
        .to(RADIUS, -0.17)
        .to(1.30, -0.17);
    let angles: Vec<f32> = (0..=16).map(|k| 180.0 * k as f32 / 16.0).collect();
    arch(&profile.0, &angles)
}

/// The small blocks under the cornice, over one arch.
fn dentils() -> Shape {
    const COUNT: u32 = 16;
    let mut shape = Shape::default();
    for k in 0..COUNT {
        let x = ((k as f32 + 0.5) / COUNT as f32 - 0.5) * PITCH;
        let (lo, hi) = (GALLERY - SPRINGING - 0.225, GALLERY - SPRINGING - 0.145);
        shape.append(Shape::cuboid(Vec3::new(x - 0.04, lo, -0.275), Vec3::new(x + 0.04, hi, -0.19)));
    }
    shape
}

/// The cornice around the court, 0.3 m high, at the height of the gallery's floor.
fn cornice() -> Shape {
    let profile = Profile::from(0.19, -0.30)
        .to(0.225, -0.295)
        .to(0.225, -0.255)
        .to(0.205, -0.245)
        .to(0.205, -0.15)
        .to(0.285, -0.15)
        .to(0.285, -0.125)
        .curve(Vec2::new(0.36, -0.12), Vec2::new(0.37, -0.06), 4)
        .to(0.385, -0.055)
        .to(0.385, -0.015)
        .to(0.37, 0.0)
        .to(0.05, 0.002);
    let profile: Vec<Vec2> = profile.0.iter().map(|p| Vec2::new(p.x, p.y + GALLERY)).collect();
    Shape::inner_moulding(COURT, &profile)
}
