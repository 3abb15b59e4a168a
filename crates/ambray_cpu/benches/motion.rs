//! What it takes to follow the cloth of the built-in scene `banner` between two poses, on one thread, and rays through its
//! trees. `examples/motion.rs` measures more, once.

use std::hint::black_box;
use std::sync::Arc;

use ambray_core::trace::{Hit, Ray, Trace};
use ambray_cpu::{BuildOptions, Opaque, Quality, Tracer};
use ambray_scene::Scene;
use ambray_scene::animation::{Clips, Moment, UpdatePolicy, Updates};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;

/// Seconds at which trees are built, and to which they are moved: where the cloth is far from the first pose.
const TIMES: [f64; 2] = [0.0, 1.5];

fn scene_at(time: f64) -> Scene {
    let mut scene = ambray_scene::moving::banner();
    let rig = Arc::clone(scene.rig.as_ref().expect("it moves"));
    let pose = rig.pose(Some(&Moment { clips: Clips::All, time, repeat: true }));
    scene.place(&pose);
    scene.deform(&pose);
    scene
}

fn options(policy: UpdatePolicy, quality: Quality) -> BuildOptions {
    BuildOptions { quality, updates: Updates { policy, ..Updates::default() }, ..BuildOptions::default() }
}

fn update(criterion: &mut Criterion) {
    let scenes = TIMES.map(scene_at);
    let cloth = scenes[0].rig.as_ref().map(|rig| rig.deformers[0].mesh as usize).expect("it moves");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("threads start");
    let mut group = criterion.benchmark_group("update");
    group.throughput(Throughput::Elements(scenes[0].meshes[cloth].triangles.len() as u64));
    let mut measure = |name: &str, policy: UpdatePolicy, quality: Quality| {
        let mut tracer = Tracer::build(&scenes[0], Opaque, options(policy, quality));
        let mut poses = scenes.iter().cycle();
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let scene = poses.next().expect("poses go round");
                pool.install(|| tracer.update(black_box(scene), Opaque))
            });
        });
    };
    measure("refit", UpdatePolicy::Refit, Quality::Balanced);
    measure("rebuild/FastBuild", UpdatePolicy::Rebuild, Quality::FastBuild);
    measure("rebuild/Balanced", UpdatePolicy::Rebuild, Quality::Balanced);
}

/// From the side where light comes in, 16 neighbours in one direction each.
fn rays() -> Vec<Ray> {
    let unit = |i: u32| ambray_core::sampling::unit_float(ambray_core::sampling::pcg(i)) * 2.0 - 1.0;
    let vector = |i: u32| Vec3::new(unit(i), unit(i + 1), unit(i + 2));
    let packet = |packet: u32| {
        let (start, direction) = (vector(6 * packet), vector(6 * packet + 3).normalize_or(Vec3::X));
        (0..16_u32).map(move |lane| {
            let step = Vec3::new((lane % 4) as f32, (lane / 4) as f32, 0.0) * 0.01;
            let origin = start + Vec3::Y * 1.5 + step;
            Ray { origin, t_max: 1.0, direction, seed: 0 }
        })
    };
    (0..4096).flat_map(packet).collect()
}

fn trace(criterion: &mut Criterion) {
    let (scenes, rays) = (TIMES.map(scene_at), rays());
    let mut hits = vec![Hit::MISS; rays.len()];
    let mut group = criterion.benchmark_group("trace_moved");
    group.throughput(Throughput::Elements(rays.len() as u64)).sample_size(20);
    for (name, policy) in [("refitted", UpdatePolicy::Refit), ("rebuilt", UpdatePolicy::Rebuild)] {
        let mut tracer = Tracer::build(&scenes[0], Opaque, options(policy, Quality::Balanced));
        tracer.update(&scenes[1], Opaque);
        group.bench_function(name, |bencher| {
            bencher.iter(|| tracer.closest_hits(black_box(&rays), &mut hits));
        });
    }
}

criterion_group!(benches, update, trace);
criterion_main!(benches);
