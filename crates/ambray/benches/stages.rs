//! Time of the stages that the method owns: sampling, gather without a tracer's cost, filter; and a whole frame.

use ambray::{
    Control, Renderer,
    settings::{Settings, Size, Thin},
};
use ambray_core::{
    filter::{Filter, Guide},
    gather::{GatherParams, GatherScratch, Gathered, ShadedPoint, gather},
    offset::RayOffset,
    openness::Openness,
    sampling::{PixelKey, SampleSets},
    settings::{NearRadiance, RadianceSource, Sampling, Sequence},
    trace::{Diffuse, Hit, Motion, Ray, Trace, World},
};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{Vec3, Vec4};

/// A world whose rays cost nothing: every second one hits a grey surface half a unit away.
struct Free;

impl Trace for Free {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (i, (ray, hit)) in rays.iter().zip(hits).enumerate() {
            let instance = if i % 2 == 0 { 0 } else { Hit::NONE };
            *hit = Hit { t: if i % 2 == 0 { 0.5 * ray.t_max } else { f32::INFINITY }, instance, ..Hit::MISS };
        }
    }

    fn any_hits(&self, _rays: &[Ray], blocked: &mut [bool]) {
        blocked.fill(false);
    }
}

impl World for Free {
    fn motion(&self, _instance: u32) -> Motion {
        Motion::Static
    }

    fn diffuse_at(&self, ray: &Ray, hit: &Hit, _width: f32) -> Diffuse {
        let position = ray.origin + hit.t * ray.direction;
        Diffuse { position, geometric_normal: -ray.direction, reach: 0.0, albedo: Vec3::splat(0.5) }
    }
}

fn sampling(c: &mut Criterion) {
    c.bench_function("sample sets of a frame, 8 spp", |b| {
        b.iter(|| SampleSets::new(Sampling::Interleaved, Sequence::Auto, 8, 0, 0));
    });
}

fn gathering(c: &mut Criterion) {
    let samples = SampleSets::new(Sampling::Interleaved, Sequence::Auto, 8, 0, 0);
    let points: Vec<ShadedPoint> = (0..256)
        .map(|i| ShadedPoint {
            position: Vec3::new((i % 16) as f32, 0.0, (i / 16) as f32) * 0.01,
            geometric_normal: Vec3::Y,
            reach: 0.0,
            normal: Vec3::Y,
            instance: Hit::NONE,
            key: PixelKey { class: (i / 16) as u8, hash: i },
        })
        .collect();
    let mut group = c.benchmark_group("gather without tracing");
    group.throughput(Throughput::Elements(256 * 8));
    for thin in [Thin::Off, Thin::Paper, Thin::Sheet] {
        let params = GatherParams {
            openness: Openness::Power { radius: 1.0, exponent: 1.0 },
            radius: 1.0,
            near_radiance: NearRadiance::Averaged,
            near_limit: 1.0,
            source: RadianceSource::Ambient,
            thin,
            thin_edge: false,
            ambient: Vec3::ONE,
            lights: &[],
            offset: RayOffset::UNIT,
            samples: &samples,
            temporal: false,
        };
        let (mut scratch, mut out) = (GatherScratch::default(), vec![Gathered::default(); points.len()]);
        group.bench_function(format!("{thin:?}"), |b| {
            b.iter(|| gather(&Free, &params, &points, &mut scratch, &mut out))
        });
    }
}

fn filtering(c: &mut Criterion) {
    let (width, height) = (320, 180);
    let guide = |i: usize| Guide {
        position: Vec3::new((i % width) as f32, 0.0, (i / width) as f32),
        depth: 1.0,
        normal: Vec3::Y,
        footprint: 1.0,
    };
    let guides: Vec<Guide> = (0..width * height).map(guide).collect();
    let input = vec![Vec4::splat(0.5); width * height];
    let mut output = input.clone();
    let filter = Filter::from(&Settings::default());
    let mut group = c.benchmark_group("filter");
    group.throughput(Throughput::Elements((width * height) as u64));
    group.bench_function("centred, one plane", |b| {
        b.iter(|| {
            for (y, row) in output.chunks_mut(width).enumerate() {
                filter.filter_row(&guides, width, y, [&input], [row]);
            }
        });
    });
}

fn frame(c: &mut Criterion) {
    let mut renderer = Renderer::new(ambray::scene::atrium::atrium());
    let settings = Settings { size: Size { width: 320, height: 180 }, ..Settings::default() };
    let mut group = c.benchmark_group("atrium, 320x180, 8 spp");
    group.sample_size(20);
    for thin in [Thin::Off, Thin::Sheet] {
        let settings = Settings { thin, ..settings.clone() };
        group.bench_function(format!("thin {thin:?}"), |b| {
            b.iter(|| renderer.render(&settings, Control::default()))
        });
    }
}

criterion_group!(benches, sampling, gathering, filtering, frame);
criterion_main!(benches);
