//! Batches of hits and readers of surfaces give the bits that single hits do.

use std::sync::Arc;

use ambray_core::{
    sampling::{pcg, unit_float},
    trace::{Hit, Ray},
};
use ambray_scene::{Scene, atrium::atrium, moving, surface::Surfaces};
use glam::Vec3;

const RAY: Ray = Ray { origin: Vec3::new(0.5, 9.0, 0.25), t_max: 100.0, direction: Vec3::NEG_Y, seed: 7 };
/// Of eight rays.
const CONE: f32 = 0.626_657;

/// Hits all over `scene`, every fourth on the triangle of the one before it, with misses among them.
fn hits(scene: &Scene, count: u32) -> Vec<Hit> {
    let random = |i: u32, dimension: u32| pcg(i ^ pcg(dimension));
    let instances = (scene.instances.len() + scene.shape_instances.len()) as u32;
    let hit = |i: u32| {
        let place = i - u32::from(i % 4 == 3);
        if i % 29 == 5 {
            return Hit::MISS;
        }
        let instance = random(place, 1) % instances;
        let mesh = scene.instances.get(instance as usize).map(|of| &scene.meshes[of.mesh as usize]);
        let triangle = mesh.map_or(0, |mesh| random(place, 2) % mesh.triangles.len() as u32);
        let u = unit_float(random(i, 3));
        let v = (1.0 - u) * unit_float(random(i, 4));
        Hit { t: 4.0 * unit_float(random(i, 5)).powi(3), u, v, instance, triangle }
    };
    (0..count).map(hit).collect()
}

#[track_caller]
fn check(scene: Scene) {
    let surfaces = Surfaces::new(Arc::new(scene));
    let hits = hits(surfaces.scene(), 5000);
    let rays = vec![RAY; hits.len()];
    let mut albedos = vec![Vec3::NAN; hits.len()];
    surfaces.albedos_at(&rays, &hits, CONE, &mut albedos);
    let by_point = albedos.clone();
    surfaces.prepare_albedos();
    albedos.fill(Vec3::NAN);
    surfaces.albedos_at(&rays, &hits, CONE, &mut albedos);
    assert_eq!(albedos, by_point);
    let mut reader = surfaces.reader();
    for (hit, albedo) in hits.iter().zip(albedos) {
        if !hit.is_hit() {
            assert_eq!(albedo, Vec3::ZERO);
            continue;
        }
        assert_eq!(albedo, surfaces.diffuse_at(&RAY, hit, hit.t * CONE).albedo, "{hit:?}");
        let width = 0.01 * hit.t;
        assert_eq!(reader.surface_at(&RAY, hit, width), surfaces.surface_at(&RAY, hit, width), "{hit:?}");
    }
}

#[test]
fn in_a_scene_of_textures_and_instances() {
    check(atrium());
}

#[test]
fn in_scenes_that_move() {
    check(moving::banner());
    check(moving::flock());
}
