//! Spheres around the origin.

use glam::Vec3;

use super::interval::Interval;

/// Where the line is within the sphere (Haines, Günther and Akenine-Möller 2019).
pub(super) fn crossing(o: Vec3, d: Vec3, radius: f32) -> Interval {
    let a = d.dot(d);
    let b = o.dot(d);
    // The point of the line next to the centre: its distance is what decides, and it is small where the sphere is hit.
    let closest = o - d * (b / a);
    let length = closest.dot(closest).sqrt();
    let inner = (radius - length) * (radius + length);
    if inner < 0.0 {
        return Interval::EMPTY;
    }
    let distance = o.dot(o).sqrt();
    let c = (distance - radius) * (distance + radius);
    let root = (a * inner).sqrt();
    let q = if b < 0.0 { root - b } else { -b - root };
    if q == 0.0 {
        return Interval::EMPTY;
    }
    Interval::between(c / q, q / a)
}

pub(super) fn normal(p: Vec3) -> Vec3 {
    let length = p.dot(p).sqrt();
    if length > 0.0 { p / length } else { Vec3::Y }
}

pub(super) fn project(p: Vec3, radius: f32) -> Vec3 {
    normal(p) * radius
}
