//! Boxes around the origin.

use glam::Vec3;

use super::interval::Interval;

/// Where the line is within the box: between all three pairs of planes.
pub(super) fn crossing(o: Vec3, d: Vec3, half: Vec3) -> Interval {
    slab(o.x, d.x, half.x).intersection(slab(o.y, d.y, half.y)).intersection(slab(o.z, d.z, half.z))
}

/// Where a coordinate that starts at `o` and moves by `d` is within ± `half`.
pub(super) fn slab(o: f32, d: f32, half: f32) -> Interval {
    if d == 0.0 {
        return if o.abs() <= half { Interval::ALL } else { Interval::EMPTY };
    }
    Interval::between((-half - o) / d, (half - o) / d)
}

/// The axis of the face next to `p`; of several the first.
fn axis(p: Vec3, half: Vec3) -> usize {
    let outside = p.abs() - half;
    if outside.x >= outside.y && outside.x >= outside.z {
        0
    } else if outside.y >= outside.z {
        1
    } else {
        2
    }
}

fn sign(x: f32) -> f32 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

pub(super) fn normal(p: Vec3, half: Vec3) -> Vec3 {
    match axis(p, half) {
        0 => Vec3::new(sign(p.x), 0.0, 0.0),
        1 => Vec3::new(0.0, sign(p.y), 0.0),
        _ => Vec3::new(0.0, 0.0, sign(p.z)),
    }
}

pub(super) fn project(p: Vec3, half: Vec3) -> Vec3 {
    let mut q = p.max(-half).min(half);
    match axis(p, half) {
        0 => q.x = sign(p.x) * half.x,
        1 => q.y = sign(p.y) * half.y,
        _ => q.z = sign(p.z) * half.z,
    }
    q
}
