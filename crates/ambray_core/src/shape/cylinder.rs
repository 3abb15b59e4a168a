//! Cylinders and truncated cones, and the cone around the axis that tapered capsules share.

use glam::{Vec2, Vec3};

use super::cuboid::slab;
use super::interval::Interval;

/// The cone around the y axis whose signed distance is `cos` ρ + `sin` y − `offset`, with ρ the distance from the axis. Its
/// nappe is where `offset` − `sin` y ≥ 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    pub(super) cos: f32,
    pub(super) sin: f32,
    pub(super) offset: f32,
}

/// What a line has to do with both nappes of a [`Cone`]: a t² + 2 b t + c = (cos ρ)² − (offset − sin y)², and the roots.
pub(super) struct Roots {
    a: f32,
    b: f32,
    c: f32,
    /// Both roots in any order, the second infinite where `a` is 0; `None` if there are none.
    pub(super) t: Option<[f32; 2]>,
    /// By how much offset − sin y grows along the line.
    growth: f32,
}

impl Cone {
    pub(super) fn roots(&self, o: Vec3, d: Vec3) -> Roots {
        let (e, f) = (Vec2::new(o.x, o.z), Vec2::new(d.x, d.z));
        let radius = self.offset - self.sin * o.y;
        let growth = -(self.sin * d.y);
        let rho = self.cos * e.dot(e).sqrt();
        let c = (rho - radius) * (rho + radius);
        let b = self.cos * self.cos * e.dot(f) - radius * growth;
        let speed = self.cos * f.dot(f).sqrt();
        let a = (speed - growth) * (speed + growth);
        // b² − a c = cos² (|radius f − growth e|² − cos² (e × f)²), in factors.
        let v = f * radius - e * growth;
        let (v, x) = (v.dot(v).sqrt(), self.cos * (e.x * f.y - e.y * f.x).abs());
        let discriminant = (v - x) * (v + x);
        // A line steeper than the cone meets it, whatever the rounding.
        if discriminant < 0.0 && a > 0.0 {
            return Roots { a, b, c, t: None, growth };
        }
        let root = self.cos * discriminant.max(0.0).sqrt();
        let q = if b < 0.0 { root - b } else { -b - root };
        let t = if q == 0.0 { None } else { Some([c / q, if a == 0.0 { f32::INFINITY } else { q / a }]) };
        Roots { a, b, c, t, growth }
    }

    /// Unit normal at `p` of the nappe.
    pub(super) fn normal(&self, p: Vec3) -> Vec3 {
        let rho = (p.x * p.x + p.z * p.z).sqrt();
        if rho == 0.0 {
            return Vec3::new(0.0, if self.sin < 0.0 { -1.0 } else { 1.0 }, 0.0);
        }
        let radial = self.cos / rho;
        Vec3::new(p.x * radial, self.sin, p.z * radial)
    }

    /// Signed distance of a point at distance `rho` from the axis and height `y`.
    pub(super) fn distance(&self, rho: f32, y: f32) -> f32 {
        self.cos * rho + self.sin * y - self.offset
    }
}

impl Roots {
    /// Where the line is within the nappe, for lines that do not reach the other one.
    fn inside(&self) -> Interval {
        let Some([t0, t1]) = self.t else {
            return if self.a <= 0.0 && self.c <= 0.0 { Interval::ALL } else { Interval::EMPTY };
        };
        let both = Interval::between(t0, t1);
        if self.a > 0.0 {
            both
        } else if self.a == 0.0 {
            // Parallel to the cone: one end.
            if self.b > 0.0 {
                Interval { near: f32::NEG_INFINITY, far: t0 }
            } else {
                Interval { near: t0, far: f32::INFINITY }
            }
        } else if self.growth > 0.0 {
            // Out of the other nappe, then into this one.
            Interval { near: both.far, far: f32::INFINITY }
        } else {
            Interval { near: f32::NEG_INFINITY, far: both.near }
        }
    }
}

/// The cone through the rims.
fn side(height: f32, bottom: f32, top: f32) -> Cone {
    let taper = bottom - top;
    let slant = (height * height + taper * taper).sqrt();
    let cos = height / slant;
    Cone { cos, sin: taper / slant, offset: cos * (0.5 * (bottom + top)) }
}

/// Where the line is between the discs and within the cone.
pub(super) fn crossing(o: Vec3, d: Vec3, height: f32, bottom: f32, top: f32) -> Interval {
    let between = slab(o.y, d.y, 0.5 * height);
    between.intersection(side(height, bottom, top).roots(o, d).inside())
}

/// The face next to `p`: ±1 for the discs, 0 for the side.
fn face(p: Vec3, height: f32, side: &Cone) -> f32 {
    let rho = (p.x * p.x + p.z * p.z).sqrt();
    if p.y.abs() - 0.5 * height < side.distance(rho, p.y) {
        0.0
    } else if p.y < 0.0 {
        -1.0
    } else {
        1.0
    }
}

pub(super) fn normal(p: Vec3, height: f32, bottom: f32, top: f32) -> Vec3 {
    let side = side(height, bottom, top);
    let face = face(p, height, &side);
    if face == 0.0 { side.normal(p) } else { Vec3::new(0.0, face, 0.0) }
}

pub(super) fn project(p: Vec3, height: f32, bottom: f32, top: f32) -> Vec3 {
    let side = side(height, bottom, top);
    let half = 0.5 * height;
    let face = face(p, height, &side);
    if face != 0.0 {
        return Vec3::new(p.x, face * half, p.z);
    }
    let rho = (p.x * p.x + p.z * p.z).sqrt();
    let q = p - side.normal(p) * side.distance(rho, p.y);
    Vec3::new(q.x, q.y.max(-half).min(half), q.z)
}
