//! Measures what it takes to follow a moving mesh, and what refitted trees cost the rays.
//!
//! `cargo run --release -p ambray_cpu --example motion`. Times of updates are the shortest of some rounds, those of
//! rays medians; one thread unless it says otherwise.
//! Rays are ambient ones from what a camera sees, 16 neighbours in one direction each.

use std::sync::Arc;
use std::time::{Duration, Instant};

use ambray_core::trace::{Hit, Ray, Trace};
use ambray_cpu::{BuildOptions, Opaque, Quality, Tracer};
use ambray_scene::animation::{Clips, Moment, Rig, UpdatePolicy, Updates};
use ambray_scene::{Instance, Mesh, Motion, Scene, SceneCamera};
use glam::{Affine3A, Quat, Vec3};

const ROUNDS: usize = 7;

fn main() {
    speed_of_updates();
    let strengths = [0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0];
    println!(
        "\na sheet of 180 000 triangles that is twisted (strength in turns) or scrambled within a distance"
    );
    let sheet = sheet(300);
    let twisted = strengths.map(|turns| (format!("twist {turns}"), twist(&sheet.positions, turns)));
    let distances = [0.003, 0.01, 0.03, 0.1];
    let torn = distances.map(|far| (format!("torn {far}"), tear(&sheet.positions, far)));
    let mut scene = single(sheet, Motion::Deforming);
    let mut poses = twisted.into_iter().chain(torn);
    quality_of_refits(&mut scene, |scene| {
        let (name, positions) = poses.next()?;
        Arc::make_mut(&mut scene.meshes[0]).positions = positions;
        Some(name)
    });

    println!("\nthe banner");
    let mut scene = ambray_scene::moving::banner();
    let mut times = (0..8).map(|half| f64::from(half) * 0.5);
    quality_of_refits(&mut scene, |scene| {
        let time = times.next()?;
        move_to(scene, time);
        Some(format!("{time} s"))
    });

    println!("\nthe flock: top level");
    let mut scene = ambray_scene::moving::flock();
    let mut tracer = Tracer::build(&scene, Opaque, BuildOptions::default());
    for _ in 0..4 {
        let mut times = Vec::new();
        for i in 0..ROUNDS {
            move_to(&mut scene, i as f64 * 0.1);
            times.push(tracer.update(&scene, Opaque).top_level);
        }
        println!("{} instances: {:.2} ms", scene.instances.len(), ms(median(times)));
        // The same once more beside it.
        let more: Vec<_> = scene.instances.clone();
        scene.instances.extend(more.into_iter().map(|i| Instance {
            world_from_object: Affine3A::from_translation(Vec3::X * 20.0) * i.world_from_object,
            ..i
        }));
        tracer = Tracer::build(&scene, Opaque, BuildOptions::default());
    }
}

/// Triangles per second.
fn speed_of_updates() {
    println!("triangles per second of an update, in millions");
    for side in [100, 300, 700] {
        let mesh = sheet(side);
        let triangles = mesh.triangles.len();
        let mut scene = single(mesh, Motion::Deforming);
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
            let mut measure = |name: &str, policy, quality| {
                let mut tracer = Tracer::build(&scene, Opaque, options(policy, quality));
                let times = (0..ROUNDS).map(|round| {
                    for position in &mut Arc::make_mut(&mut scene.meshes[0]).positions {
                        position.y += 0.01 * (position.x + round as f32).sin();
                    }
                    pool.install(|| tracer.update(&scene, Opaque).bottom_level)
                });
                let time = times.min().expect("there are rounds");
                let speed = triangles as f64 / time.as_secs_f64() / 1e6;
                println!("{triangles} triangles, {threads} threads, {name}: {speed:.1} ({:.2} ms)", ms(time));
            };
            measure("refit", UpdatePolicy::Refit, Quality::Balanced);
            if threads == 1 {
                for quality in Quality::ALL {
                    measure(&format!("{quality:?}"), UpdatePolicy::Rebuild, quality);
                }
            }
        }
    }
}

/// Speed of rays through trees that are refitted from the first pose and through trees that are built at each.
fn quality_of_refits(scene: &mut Scene, mut next: impl FnMut(&mut Scene) -> Option<String>) {
    println!(
        "{:>12} {:>8} | ns a ray: {:>8} {:>10} {:>10} {:>10} | refitted over balanced",
        "pose", "decay", "refitted", "FastBuild", "Balanced", "BestTrace"
    );
    let mut name = next(scene);
    let mut refitted = Tracer::build(scene, Opaque, options(UpdatePolicy::Refit, Quality::Balanced));
    while let Some(pose) = name {
        let decay = refitted.update(scene, Opaque).decay;
        let fresh =
            Quality::ALL.map(|quality| Tracer::build(scene, Opaque, options(UpdatePolicy::Refit, quality)));
        let rays = ambient_rays(scene, &fresh[1]);
        let all: Vec<_> = std::iter::once(&refitted).chain(&fresh).collect();
        let mut times = vec![Vec::new(); all.len()];
        let mut hits = vec![Hit::MISS; rays.len()];
        for _ in 0..ROUNDS {
            for (tracer, times) in all.iter().zip(&mut times) {
                let start = Instant::now();
                for (rays, hits) in rays.chunks(1024).zip(hits.chunks_mut(1024)) {
                    tracer.closest_hits(rays, hits);
                }
                times.push(start.elapsed());
            }
        }
        let [r, fast, balanced, best] =
            [0, 1, 2, 3].map(|i| median(times[i].clone()).as_secs_f64() * 1e9 / rays.len().max(1) as f64);
        println!(
            "{pose:>12} {decay:8.3} | {r:18.1} {fast:10.1} {balanced:10.1} {best:10.1} | {:.3}",
            r / balanced
        );
        name = next(scene);
    }
}

fn options(policy: UpdatePolicy, quality: Quality) -> BuildOptions {
    BuildOptions { quality, updates: Updates { policy, ..Updates::default() }, ..BuildOptions::default() }
}

/// What the first camera sees, and 8 rays from each point there.
fn ambient_rays(scene: &Scene, tracer: &Tracer) -> Vec<Ray> {
    let SceneCamera { position, forward, up, .. } = scene.cameras[0];
    let right = forward.cross(up);
    let (width, height) = (320, 240);
    let primary: Vec<_> = (0..width * height)
        .map(|i| {
            let (x, y) = ((i % width) as f32 / width as f32, (i / width) as f32 / height as f32);
            let direction = (forward + right * (x - 0.5) * 0.8 + up * (0.5 - y) * 0.6).normalize();
            Ray { origin: position, t_max: f32::INFINITY, direction, seed: 0 }
        })
        .collect();
    let mut hits = vec![Hit::MISS; primary.len()];
    tracer.closest_hits(&primary, &mut hits);
    let seen: Vec<_> = primary.iter().zip(&hits).filter(|(_, hit)| hit.is_hit()).collect();
    let unit = |i: u32| ambray_core::sampling::unit_float(ambray_core::sampling::pcg(i)) * 2.0 - 1.0;
    let mut rays = Vec::new();
    for (packet, points) in seen.chunks(16).enumerate() {
        for direction in 0..8 {
            let seed = 24 * packet as u32 + 3 * direction;
            let direction = Vec3::from_array([0, 1, 2].map(|k| unit(seed + k))).normalize_or(Vec3::Y);
            rays.extend(points.iter().map(|(ray, hit)| {
                let origin = ray.origin + ray.direction * hit.t * 0.999;
                Ray { origin, t_max: scene.radius.unwrap_or(1.0), direction, seed: 0 }
            }));
        }
    }
    rays
}

fn move_to(scene: &mut Scene, time: f64) {
    let rig = Arc::clone(scene.rig.as_ref().expect("the scene moves"));
    let pose = rig.pose(Some(&Moment { clips: Clips::All, time, repeat: true }));
    scene.place(&pose);
    scene.deform(&pose);
}

fn single(mesh: Mesh, motion: Motion) -> Scene {
    let camera = SceneCamera {
        name: String::new(),
        position: Vec3::new(0.0, 1.5, 3.0),
        forward: Vec3::new(0.0, -0.45, -0.9).normalize(),
        up: Vec3::new(0.0, 0.9, -0.45).normalize(),
        projection: ambray_core::camera::Projection::Perspective { vertical_fov: 0.6 },
    };
    Scene {
        meshes: vec![mesh.into()],
        instances: vec![Instance { mesh: 0, world_from_object: Affine3A::IDENTITY, motion }],
        cameras: vec![camera],
        radius: Some(0.3),
        rig: Some(Arc::new(Rig::default())),
        ..Scene::default()
    }
}

/// A rough sheet of 2 · `side`² triangles, 2 units wide.
fn sheet(side: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for y in 0..=side {
        for x in 0..=side {
            let p = Vec3::new(x as f32, 0.0, y as f32) * 2.0 / side as f32 - Vec3::new(1.0, 0.0, 1.0);
            mesh.positions.push(p + Vec3::Y * 0.05 * (17.0 * p.x).sin() * (23.0 * p.z).cos());
        }
    }
    for y in 0..side {
        for x in 0..side {
            let a = y * (side + 1) + x;
            mesh.triangles.extend([[a, a + 1, a + side + 1], [a + side + 1, a + 1, a + side + 2]]);
        }
    }
    mesh
}

/// Wound up around x by so many turns from end to end.
fn twist(positions: &[Vec3], turns: f32) -> Vec<Vec3> {
    let turn = |p: Vec3| Quat::from_rotation_x(std::f32::consts::PI * turns * p.x) * p;
    positions.iter().map(|&p| turn(p)).collect()
}

/// Each vertex goes up to `far` away from the others.
fn tear(positions: &[Vec3], far: f32) -> Vec<Vec3> {
    let unit = |i: usize| ambray_core::sampling::unit_float(ambray_core::sampling::pcg(i as u32)) * 2.0 - 1.0;
    let offset = |i: usize| Vec3::from_array([0, 1, 2].map(|k| unit(3 * i + k))) * far;
    positions.iter().enumerate().map(|(i, &p)| p + offset(i)).collect()
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort();
    times[times.len() / 2]
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
