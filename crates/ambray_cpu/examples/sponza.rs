//! Measures build time and ambient rays per second of one thread on Sponza, in the three views of the quality bars.
//!
//! `cargo run --release -p ambray_cpu --example sponza [-- SCENE]`; without an argument it looks for the shared scenes.
//! 960 × 540 pixels, 8 cosine-distributed rays a pixel of 4 × 4 interleaved classes, `t_max` 1, any hit and closest hit,
//! batches of 16 × 16 pixels ordered by (class, direction). Medians of rounds that take turns.

use std::path::PathBuf;
use std::time::Instant;

use ambray_core::camera::{Camera, Projection};
use ambray_core::offset::RayOffset;
use ambray_core::sampling::{PixelKey, SampleSets};
use ambray_core::settings::{Sampling, Sequence};
use ambray_core::trace::{Hit, Ray, Trace};
use ambray_cpu::{BuildOptions, Isa, Opaque, Quality, Tracer, Width};
use ambray_scene::{AlphaMode, Scene};
use glam::{Mat3, Vec3};

const SIZE: (u32, u32) = (960, 540);
const RAYS_PER_PIXEL: u32 = 8;
const ROUNDS: usize = 5;
const VIEWS: [(&str, Vec3, Vec3); 3] = [
    ("nave", Vec3::new(-9.0, 1.6, -0.3), Vec3::new(0.0, 2.2, -0.3)),
    ("curtain", Vec3::new(-2.6, 0.55, 3.3), Vec3::new(-3.6, 0.25, 1.7)),
    ("gallery", Vec3::new(-9.5, 5.0, 3.2), Vec3::new(2.0, 4.2, 2.4)),
];

fn main() {
    let path = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/scenes/Sponza/Sponza.gltf")),
        PathBuf::from,
    );
    let mut scene = ambray_scene::load(&path).expect("the scene loads").scene;
    let Scene { meshes, materials, instances, .. } = &mut scene;
    instances
        .retain(|i| materials[meshes[i.mesh as usize].material as usize].alpha_mode == AlphaMode::Opaque);
    println!("{} triangles", scene.triangle_count());

    let reference = Tracer::build(&scene, Opaque, BuildOptions::balanced());
    let batches = VIEWS.map(|(_, eye, target)| ambient_batches(&scene, &reference, eye, target));
    for quality in Quality::ALL {
        let tracer = Tracer::build(&scene, Opaque, BuildOptions { quality, ..BuildOptions::default() });
        let s = tracer.stats();
        println!(
            "{quality:?}: built in {:.2} s, {} triangles, {} nodes, {:.1} triangles a leaf, {:.1} MB, depth {}, SAH {:.1}",
            s.build_time.as_secs_f64(),
            s.triangles,
            s.nodes,
            s.triangles as f64 / s.leaf_blocks as f64,
            s.bytes as f64 / 1e6,
            s.depth,
            s.sah_cost,
        );
    }

    let mut contenders = Vec::new();
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for (quality, width, packets) in [
            (Quality::Balanced, Width::Eight, false),
            (Quality::Balanced, Width::Sixteen, false),
            (Quality::Balanced, Width::Eight, true),
            (Quality::Balanced, Width::Sixteen, true),
        ] {
            if isa == Isa::Portable && (width == Width::Sixteen || packets) {
                continue; // slow, and no faster than this
            }
            let (width, isa) = (Some(width), Some(isa));
            contenders.push(BuildOptions { quality, width, isa, packets, ..BuildOptions::default() });
        }
    }
    let tracers: Vec<_> = contenders.iter().map(|&options| Tracer::build(&scene, Opaque, options)).collect();
    let mut times = vec![[[[0.0; ROUNDS]; 2]; VIEWS.len()]; contenders.len()];
    for round in 0..ROUNDS {
        for (tracer, times) in tracers.iter().zip(&mut times) {
            for (batches, times) in batches.iter().zip(times) {
                times[0][round] = timed(batches, |rays| {
                    tracer.any_hits(rays, &mut [false; 2048][..rays.len()]);
                });
                times[1][round] = timed(batches, |rays| {
                    tracer.closest_hits(rays, &mut [Hit::MISS; 2048][..rays.len()]);
                });
            }
        }
    }
    println!("Mrays/s, one thread, any hit | closest hit: {}", VIEWS.map(|v| v.0).join(" / "));
    for (options, times) in contenders.iter().zip(&mut times) {
        let name = format!(
            "{} {:?} {:?} {}",
            options.isa.map_or("", Isa::name),
            options.width.expect("given"),
            options.quality,
            if options.packets { "packets" } else { "single" }
        );
        let mut rates = [[0.0; VIEWS.len()]; 2];
        for (view, times) in times.iter_mut().enumerate() {
            for (query, times) in times.iter_mut().enumerate() {
                times.sort_by(f64::total_cmp);
                let rays: usize = batches[view].iter().map(Vec::len).sum();
                rates[query][view] = rays as f64 / times[ROUNDS / 2] / 1e6;
            }
        }
        let [any, closest] = rates.map(|r| r.map(|r| format!("{r:5.1}")).join(" / "));
        println!("{name:40} {any} | {closest}");
    }
}

fn timed(batches: &[Vec<Ray>], mut trace: impl FnMut(&[Ray])) -> f64 {
    let start = seconds();
    batches.iter().for_each(|rays| trace(rays));
    seconds() - start
}

/// Time this thread spent running where the system tells (Linux), so that other load hardly matters; else wall clock.
fn seconds() -> f64 {
    static START: std::sync::LazyLock<Instant> = std::sync::LazyLock::new(Instant::now);
    let own = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let own = own.and_then(|s| s.split(' ').next()?.parse::<f64>().ok());
    own.map_or_else(|| START.elapsed().as_secs_f64(), |nanoseconds| nanoseconds * 1e-9)
}

/// Ambient rays of a quarter of all tiles of the view.
fn ambient_batches(scene: &Scene, tracer: &impl Trace, eye: Vec3, target: Vec3) -> Vec<Vec<Ray>> {
    let projection = Projection::Perspective { vertical_fov: 50_f32.to_radians() };
    let camera = Camera::new(eye, (target - eye).normalize(), Vec3::Y, projection, SIZE.0, SIZE.1);
    let sets = SampleSets::new(Sampling::Interleaved, Sequence::Auto, RAYS_PER_PIXEL, 0, 0);
    let mut batches = Vec::new();
    for y0 in (0..SIZE.1).step_by(16) {
        // Every fourth tile stands for all.
        for x0 in (y0 % 64..SIZE.0).step_by(64) {
            let mut classes = vec![Vec::new(); 16];
            for (x, y) in
                (0..16).flat_map(|y| (0..16).map(move |x| (x0 + x, y0 + y))).filter(|p| p.1 < SIZE.1)
            {
                let ray = camera.primary_ray(x, y, 0);
                let mut hit = [Hit::MISS];
                tracer.closest_hits(&[ray], &mut hit);
                if hit[0].is_hit() {
                    let key = PixelKey::new(x, y, 0, 0);
                    classes[key.class as usize].push((key, surface(scene, &ray, &hit[0])));
                }
            }
            let mut rays = Vec::new();
            for pixels in &classes {
                for sample in 0..RAYS_PER_PIXEL {
                    for &(key, (position, normal)) in pixels {
                        let basis = basis(normal);
                        rays.push(Ray {
                            origin: RayOffset::UNIT.apply(position, normal, 0.0),
                            t_max: 1.0,
                            direction: (basis * sets.direction(key, sample).local).normalize(),
                            seed: key.ray_seed(sample),
                        });
                    }
                }
            }
            batches.push(rays);
        }
    }
    batches
}

/// Position and geometric normal towards the ray's origin.
fn surface(scene: &Scene, ray: &Ray, hit: &Hit) -> (Vec3, Vec3) {
    let instance = &scene.instances[hit.instance as usize];
    let [a, b, c] = scene.meshes[instance.mesh as usize]
        .corners(hit.triangle)
        .map(|p| instance.world_from_object.transform_point3(p));
    let normal = (b - a).cross(c - a).normalize();
    (a + (b - a) * hit.u + (c - a) * hit.v, if normal.dot(ray.direction) > 0.0 { -normal } else { normal })
}

/// Tangent, bitangent, normal; a function of the normal alone, so that rays of a class are parallel on a plane.
fn basis(normal: Vec3) -> Mat3 {
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    Mat3::from_cols(tangent, bitangent, normal)
}
