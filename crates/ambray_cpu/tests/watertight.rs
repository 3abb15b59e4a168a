//! Rays aimed at shared edges and corners of closed surfaces never slip through.

mod common;

use ambray_core::trace::{Hit, Ray, Trace};
use ambray_cpu::{BuildOptions, Opaque, Packets, Tracer};
use ambray_scene::Mesh;
use common::{Random, scene};
use glam::Vec3;

/// Traces all rays closest and any, in packets and alone, and demands a hit.
#[track_caller]
fn check(mesh: Mesh, rays: &[Ray]) {
    let scene = scene(vec![mesh]);
    for packets in [Packets::Never, Packets::Always] {
        let tracer = Tracer::build(&scene, Opaque, BuildOptions { packets, ..BuildOptions::fast_build() });
        let mut hits = vec![Hit::MISS; rays.len()];
        tracer.closest_hits(rays, &mut hits);
        let mut blocked = vec![false; rays.len()];
        tracer.any_hits(rays, &mut blocked);
        for (ray, (hit, blocked)) in rays.iter().zip(hits.iter().zip(blocked)) {
            assert!(hit.is_hit() && blocked, "{ray:?} slipped through");
        }
    }
}

/// Sphere of 2 · `n`² triangles with shared vertices, about `center`.
fn sphere(n: u32, center: Vec3, radius: f32) -> Mesh {
    let point = |i: u32, j: u32| {
        let theta = std::f32::consts::PI * i as f32 / n as f32;
        let phi = std::f32::consts::TAU * j as f32 / n as f32;
        center + radius * Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
    };
    let mut mesh = Mesh::default();
    for i in 0..=n {
        // Poles are single points, and the last meridian is the first.
        mesh.positions.extend((0..n).map(|j| if i == 0 || i == n { point(i, 0) } else { point(i, j) }));
    }
    for i in 0..n {
        for j in 0..n {
            let at = |i: u32, j: u32| i * n + j % n;
            let (a, b, c, d) = (at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.extend([[a, b, c], [c, b, d]]);
        }
    }
    mesh
}

#[test]
fn sphere_from_inside() {
    let mut random = Random(11);
    for (center, radius) in [(Vec3::ZERO, 1.0), (Vec3::new(1e5, -3e4, 7e4), 10.0), (Vec3::splat(0.1), 1e-3)] {
        let mesh = sphere(64, center, radius);
        let mut rays = Vec::new();
        for _ in 0..20_000 {
            let origin = center + random.cube() * radius * 0.5;
            let triangle = mesh.corners(random.below(mesh.triangles.len() as u32));
            let corner = random.below(3) as usize;
            let (a, b) = (triangle[corner], triangle[(corner + 1) % 3]);
            let along = if random.below(3) == 0 { 0.0 } else { random.unit() };
            let direction = (a + (b - a) * along - origin).normalize();
            rays.push(Ray { origin, t_max: f32::INFINITY, direction, seed: 0 });
        }
        check(mesh, &rays);
    }
}

#[test]
fn grid_of_a_million_triangles() {
    const N: u32 = 700;
    let mut random = Random(12);
    let height: Vec<f32> = (0..=N * N + 2 * N).map(|_| random.unit() * 0.3).collect();
    let mut mesh = Mesh::default();
    for z in 0..=N {
        mesh.positions
            .extend((0..=N).map(|x| Vec3::new(x as f32, height[(z * (N + 1) + x) as usize], z as f32)));
    }
    for z in 0..N {
        for x in 0..N {
            let a = z * (N + 1) + x;
            mesh.triangles.extend([[a, a + 1, a + N + 1], [a + N + 1, a + 1, a + N + 2]]);
        }
    }
    let mut rays = Vec::new();
    for i in 0..200_000_u32 {
        let p = mesh.positions[(N / 4 * (N + 1) + random.below(N * N / 2)) as usize];
        if p.x < 100.0 || p.x > 600.0 {
            continue;
        }
        let slant = Vec3::new(random.unit() - 0.5, 0.0, random.unit() - 0.5) * 5.0;
        let origin = match i % 3 {
            0 => p + Vec3::Y,                                    // straight down at corners
            1 => p + Vec3::Y + slant,                            // at corners
            _ => p + Vec3::new(random.unit(), 1.0, 0.0) + slant, // about an edge
        };
        let target = if i % 3 == 2 { origin - slant - Vec3::Y } else { p };
        let direction = (target - origin).normalize();
        rays.push(Ray { origin, t_max: f32::INFINITY, direction, seed: 0 });
    }
    check(mesh, &rays);
}
