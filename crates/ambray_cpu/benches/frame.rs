//! What a frame takes besides tracing: each part, and what it could take at least.
//!
//! `cargo bench -p ambray_cpu --bench frame`. One thread unless said otherwise.

use std::{
    hint::black_box,
    sync::Arc,
    time::{Duration, Instant},
};

use ambray_core::{
    camera::Camera,
    control::Control,
    frame::StageTimes,
    settings::{Settings, Size},
    trace::{Hit, Ray, Trace, World},
    view::View,
};
use ambray_cpu::{BuildOptions, CpuBackend};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;

const SIZE: (u32, u32) = (480, 270);
const PIXELS: u64 = SIZE.0 as u64 * SIZE.1 as u64;
/// Pass 2 reads guides (32 bytes), two planes of four numbers (32) and the G-buffer (112), and writes a plane of four
/// numbers (16), two of three (24) and one of one (4).
const BYTES_OF_PASS_2: usize = (32 + 32 + 112) + (16 + 24 + 4);
/// Of a hit whose ray is one of eight: √(π/8).
const CONE: f32 = 0.626_657;

struct Atrium {
    backend: CpuBackend,
    view: View,
    settings: Settings,
}

impl Atrium {
    fn new() -> Self {
        let scene = ambray_scene::atrium::atrium();
        let seen = &scene.cameras[0];
        let camera = Camera::new(seen.position, seen.forward, seen.up, seen.projection, SIZE.0, SIZE.1);
        let radius = scene.radius.unwrap_or(1.0);
        let view = View { lights: scene.lights.clone(), ..View::new(camera, radius) };
        let settings = Settings { size: Size { width: SIZE.0, height: SIZE.1 }, ..Settings::default() };
        Self { backend: CpuBackend::new(Arc::new(scene), BuildOptions::default()), view, settings }
    }

    /// Renders `frames` frames; the sum of what `part` takes of each.
    fn time(&self, frames: u64, threads: usize, part: impl Fn(&StageTimes) -> Duration) -> Duration {
        let control = Control { threads, ..Control::default() };
        let frame = || {
            let frame = self.backend.render(&self.settings, &self.view, control).expect("nobody cancels");
            let time = part(&frame.stats.times);
            self.backend.recycle(frame);
            time
        };
        (0..frames).map(|_| frame()).sum()
    }
}

fn parts(c: &mut Criterion) {
    let atrium = Atrium::new();
    let mut group = c.benchmark_group("atrium, 480x270, 8 spp");
    group.sample_size(10).throughput(Throughput::Elements(PIXELS));
    group.bench_function("frame", |b| b.iter_custom(|n| atrium.time(n, 1, |t| t.total)));
    group.bench_function("frame, all threads", |b| b.iter_custom(|n| atrium.time(n, 0, |t| t.total)));
    group.bench_function("tracing", |b| b.iter_custom(|n| atrium.time(n, 1, |t| t.tracing)));
    group
        .bench_function("all but tracing", |b| b.iter_custom(|n| atrium.time(n, 1, |t| t.total - t.tracing)));
    group.bench_function("pass 2", |b| b.iter_custom(|n| atrium.time(n, 1, |t| t.filter)));
    // A copy moves each byte twice, so half of them are copied.
    let from = vec![1_u8; PIXELS as usize * BYTES_OF_PASS_2 / 2];
    let mut to = vec![0_u8; from.len()];
    group.bench_function("a copy of the bytes of pass 2", |b| {
        b.iter(|| black_box(&mut to).copy_from_slice(black_box(&from)));
    });
    group.bench_function("frame in fresh memory", |b| {
        let control = Control { threads: 1, ..Control::default() };
        b.iter_custom(|n| {
            let start = Instant::now();
            for _ in 0..n {
                let frame = atrium.backend.render(&atrium.settings, &atrium.view, control);
                drop(black_box(frame));
            }
            start.elapsed()
        });
    });
}

fn albedos(c: &mut Criterion) {
    let Atrium { backend, view, .. } = Atrium::new();
    let world = backend.world();
    let pixels = (0..SIZE.1).step_by(8).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    let rays: Vec<Ray> = pixels.map(|(x, y)| view.camera.primary_ray(x, y, 0)).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    world.closest_hits(&rays, &mut hits);
    let mut albedos = vec![Vec3::ZERO; rays.len()];
    let mut group = c.benchmark_group("albedos of hits");
    group.throughput(Throughput::Elements(rays.len() as u64));
    group.bench_function("as a batch", |b| {
        b.iter(|| world.albedos_at(&rays, &hits, CONE, black_box(&mut albedos)));
    });
    group.bench_function("one by one", |b| {
        b.iter(|| {
            for ((ray, hit), albedo) in rays.iter().zip(&hits).zip(black_box(&mut albedos)) {
                *albedo = world.diffuse_at(ray, hit, hit.t * CONE).albedo;
            }
        });
    });
}

criterion_group!(benches, parts, albedos);
criterion_main!(benches);
