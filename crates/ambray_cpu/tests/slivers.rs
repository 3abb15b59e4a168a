//! Rays that leave long thin triangles by their offset never hit them again.

mod common;

use ambray_core::{
    offset::RayOffset,
    trace::{Hit, Ray, Trace},
};
use ambray_cpu::{BuildOptions, Opaque, Packets, Tracer};
use ambray_scene::Mesh;
use common::{Random, scene};
use glam::{Quat, Vec3};

#[test]
fn slivers_do_not_shadow_themselves() {
    let mut random = Random(11);
    for (length, width) in [(20.0, 0.03), (20.0, 0.5), (2.0, 1e-3), (300.0, 0.1)] {
        for _ in 0..50 {
            let turned = Quat::from_scaled_axis(3.0 * random.cube());
            let moved = 0.5 * length * random.cube();
            let corners = [Vec3::ZERO, Vec3::X * length, Vec3::new(0.1 * length, width, 0.0)]
                .map(|p| turned * (p - Vec3::X * 0.5 * length) + moved);
            check(&mut random, corners);
        }
    }
}

#[track_caller]
fn check(random: &mut Random, corners: [Vec3; 3]) {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).normalize();
    let reach = corners.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
    let mut rays = Vec::new();
    for _ in 0..256 {
        let (mut u, mut v) = (random.unit(), random.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let point = a + (b - a) * u + (c - a) * v;
        let direction = random.direction();
        // The normal itself is rounded: rays next to the horizon may point into the triangle.
        let side = if direction.dot(normal) < 0.0 { -normal } else { normal };
        if direction.dot(side) > 2e-3 {
            let origin = RayOffset::UNIT.apply(point, side, reach);
            rays.push(Ray { origin, t_max: f32::INFINITY, direction, seed: 0 });
        }
    }
    let mesh = Mesh { positions: corners.to_vec(), triangles: vec![[0, 1, 2]], ..Mesh::default() };
    for packets in [Packets::Never, Packets::Always] {
        let tracer = Tracer::build(
            &scene(vec![mesh.clone()]),
            Opaque,
            BuildOptions { packets, ..BuildOptions::fast_build() },
        );
        let mut hits = vec![Hit::MISS; rays.len()];
        tracer.closest_hits(&rays, &mut hits);
        for (ray, hit) in rays.iter().zip(&hits) {
            assert!(!hit.is_hit(), "{ray:?} hits {corners:?} again at {}", hit.t);
        }
    }
}
