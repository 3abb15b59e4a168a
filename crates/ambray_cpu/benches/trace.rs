//! Build time, and ambient rays per second of one thread, on a generated terrain with columns.

use std::hint::black_box;

use ambray_core::trace::{Hit, Ray, Trace};
use ambray_cpu::{BuildOptions, Isa, Opaque, Packets, Quality, Tracer};
use ambray_scene::{Instance, Mesh, Scene};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{Affine3A, Vec2, Vec3};

/// Squares along a side of the terrain.
const SIDE: u32 = 300;

/// Height of the bumpy ground.
fn height(p: Vec2) -> f32 {
    0.5 * (0.7 * p.x).sin() * (0.9 * p.y).cos() + 0.1 * (5.1 * p.x).sin() * (4.3 * p.y).sin()
}

fn terrain() -> Scene {
    let mut ground = Mesh::default();
    for z in 0..=SIDE {
        for x in 0..=SIDE {
            let p = Vec2::new(x as f32, z as f32) * 0.1;
            ground.positions.push(Vec3::new(p.x, height(p), p.y));
        }
    }
    for z in 0..SIDE {
        for x in 0..SIDE {
            let a = z * (SIDE + 1) + x;
            ground.triangles.extend([[a, a + 1, a + SIDE + 1], [a + SIDE + 1, a + 1, a + SIDE + 2]]);
        }
    }
    let mut columns = Mesh::default();
    for column in 0..100_u32 {
        let foot = Vec2::new((column % 10) as f32, (column / 10) as f32) * 3.0 + 1.5;
        let first = columns.positions.len() as u32;
        let (sides, rings) = (24, 30);
        for ring in 0..=rings {
            for side in 0..sides {
                let angle = std::f32::consts::TAU * side as f32 / sides as f32;
                let radius = 0.3 + 0.05 * (ring as f32).sin();
                let p = foot + Vec2::from_angle(angle) * radius;
                columns.positions.push(Vec3::new(p.x, height(foot) - 0.5 + ring as f32 * 0.1, p.y));
            }
        }
        for ring in 0..rings {
            for side in 0..sides {
                let at = |ring: u32, side: u32| first + ring * sides + side % sides;
                let (a, b) = (at(ring, side), at(ring, side + 1));
                let (c, d) = (at(ring + 1, side), at(ring + 1, side + 1));
                columns.triangles.extend([[a, b, c], [c, b, d]]);
            }
        }
    }
    let instances = (0..2)
        .map(|mesh| Instance { mesh, world_from_object: Affine3A::IDENTITY, ..Instance::default() })
        .collect();
    Scene { meshes: vec![ground.into(), columns.into()], instances, ..Scene::default() }
}

/// Rays from points above the ground, 16 neighbours in one direction each: the order of deinterleaved ambient rays.
fn ambient_rays() -> Vec<Ray> {
    let unit = |i: u32| ambray_core::sampling::unit_float(ambray_core::sampling::pcg(i));
    let mut rays = Vec::new();
    for packet in 0..4096 {
        let [x, z, u, v] = [0, 1, 2, 3].map(|k| unit(4 * packet + k));
        let direction = ambray_core::sampling::cosine_hemisphere(Vec2::new(u, v));
        let direction = Vec3::new(direction.x, direction.z, direction.y).normalize();
        for lane in 0..16_u32 {
            let step = Vec2::new((lane % 4) as f32, (lane / 4) as f32) * 0.02;
            let p = Vec2::new(x, z) * 28.0 + 1.0 + step;
            let origin = Vec3::new(p.x, height(p) + 0.02, p.y);
            rays.push(Ray { origin, t_max: 2.0, direction, seed: 0 });
        }
    }
    rays
}

fn build(criterion: &mut Criterion) {
    let scene = terrain();
    let mut group = criterion.benchmark_group("build");
    group.throughput(Throughput::Elements(scene.triangle_count())).sample_size(10);
    for quality in Quality::ALL {
        let options = BuildOptions { quality, ..BuildOptions::default() };
        group.bench_function(format!("{quality:?}"), |bencher| {
            bencher.iter(|| Tracer::build(black_box(&scene), Opaque, options));
        });
    }
}

fn trace(criterion: &mut Criterion) {
    let (scene, rays) = (terrain(), ambient_rays());
    let (mut hits, mut blocked) = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
    let mut group = criterion.benchmark_group("trace");
    group.throughput(Throughput::Elements(rays.len() as u64)).sample_size(20);
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for packets in [Packets::Never, Packets::Always] {
            let options = BuildOptions { isa: Some(isa), packets, ..BuildOptions::default() };
            let tracer = Tracer::build(&scene, Opaque, options);
            let name = if packets == Packets::Always { "packets" } else { "single" };
            group.bench_function(BenchmarkId::new(format!("closest/{name}"), isa.name()), |bencher| {
                bencher.iter(|| tracer.closest_hits(black_box(&rays), &mut hits));
            });
            group.bench_function(BenchmarkId::new(format!("any/{name}"), isa.name()), |bencher| {
                bencher.iter(|| tracer.any_hits(black_box(&rays), &mut blocked));
            });
        }
    }
}

criterion_group!(benches, build, trace);
criterion_main!(benches);
