//! Every tree, width and instruction set returns exactly what a loop over all triangles returns.

mod common;

use ambray_core::trace::{Hit, Ray, Trace};
use ambray_cpu::{AlphaTest, BuildOptions, Isa, Opaque, Packets, Quality, Tracer, Width};
use ambray_scene::{Instance, Scene, animation::Updates};
use common::{BruteForce, Random, random_rays, random_triangles, scene, soup};
use glam::{Affine3A, Mat3, Quat, Vec3};

/// All combinations of options that this machine can run.
fn all_options() -> Vec<BuildOptions> {
    let mut all = Vec::new();
    for quality in Quality::ALL {
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            for width in Width::ALL {
                for packets in Packets::ALL {
                    let (isa, width, bake_budget) = (Some(isa), Some(width), 0);
                    let updates = Updates::default();
                    all.push(BuildOptions { quality, isa, width, packets, bake_budget, updates });
                }
            }
        }
    }
    all
}

/// Compares what is found with a loop over all triangles, also with ends to all rays: then a batch enters the tree by what
/// its rays may reach, which is less the fewer they are.
#[track_caller]
fn check<A: AlphaTest>(scene: &Scene, rays: &[Ray], alpha: &A) {
    check_batch(scene, rays, alpha);
    let Some([first, second, third]) = rays.first_chunk() else { return };
    let near = first.origin.distance(second.origin).min(second.origin.distance(third.origin));
    let ended: Vec<_> = rays.iter().map(|ray| Ray { t_max: ray.t_max.min(near), ..*ray }).collect();
    for count in [64, 65, 80, rays.len()] {
        check_batch(scene, &ended[..count.min(ended.len())], alpha);
    }
}

#[track_caller]
fn check_batch<A: AlphaTest>(scene: &Scene, rays: &[Ray], alpha: &A) {
    let reference = BruteForce::new(scene, alpha);
    let mut expected = vec![Hit::MISS; rays.len()];
    reference.closest_hits(rays, &mut expected);
    for options in all_options() {
        let tracer = Tracer::build(scene, alpha, options);
        let mut hits = vec![Hit::MISS; rays.len()];
        tracer.closest_hits(rays, &mut hits);
        let mut blocked = vec![false; rays.len()];
        tracer.any_hits(rays, &mut blocked);
        for i in 0..rays.len() {
            assert_eq!(hits[i], expected[i], "{options:?}, ray {i}: {:?}", rays[i]);
            assert_eq!(blocked[i], expected[i].is_hit(), "{options:?}, any, ray {i}: {:?}", rays[i]);
        }
    }
}

fn scaled(rays: &[Ray], scale: f32, offset: Vec3) -> Vec<Ray> {
    rays.iter().map(|r| Ray { origin: r.origin * scale + offset, t_max: r.t_max * scale, ..*r }).collect()
}

#[test]
fn soups() {
    let mut random = Random(1);
    for (size, scale, offset) in [
        (1, 1.0, 0.0),
        (2, 1.0, 0.0),
        (7, 1.0, 0.0),
        (17, 1.0, 0.0),
        (100, 1.0, 0.0),
        (1500, 1.0, 0.0),
        (300, 1e-3, 0.0),
        (300, 1.0, 1e5),
        (300, 1e-3, 1e5),
        (300, 1e6, 0.0),
        (300, 1e-12, 0.0),
        (300, 1e11, 0.0),
    ] {
        let offset = Vec3::new(offset, -offset, offset * 0.5);
        let triangles: Vec<_> = random_triangles(&mut random, size);
        let rays = scaled(&random_rays(&mut random, &triangles, 512), scale, offset);
        let moved: Vec<_> = triangles.iter().map(|t| t.map(|p| p * scale + offset)).collect();
        let (first, second) = moved.split_at(size / 3);
        check(&scene(vec![soup(first), soup(second)]), &rays, &Opaque);
    }
}

#[test]
fn instances() {
    let mut random = Random(2);
    let triangles = random_triangles(&mut random, 60);
    let rays = random_rays(&mut random, &triangles, 1024);
    let mut scene =
        scene(vec![soup(&triangles[..20]), soup(&triangles[20..]), soup(&triangles[..5]), soup(&[])]);
    for i in 0..40 {
        let rotation = Mat3::from_quat(Quat::from_scaled_axis(random.cube() * 3.0));
        let mirror = if i % 3 == 0 { Vec3::new(-1.0, 1.0, 1.0) } else { Vec3::ONE };
        let stretch = Mat3::from_diagonal(mirror * (Vec3::ONE * 0.1 + random.cube().abs()));
        let matrix = if i == 7 { Mat3::ZERO } else { rotation * stretch };
        scene.instances.push(Instance {
            mesh: if i == 11 { 3 } else { i % 2 },
            world_from_object: Affine3A::from_mat3_translation(matrix, random.cube()),
            ..Instance::default()
        });
    }
    check(&scene, &rays, &Opaque);
    // A single mesh, mirrored and stretched: baked.
    let mut scene = common::scene(vec![soup(&triangles)]);
    scene.instances[0].world_from_object =
        Affine3A::from_mat3_translation(Mat3::from_diagonal(Vec3::new(-2.0, 0.5, 1.0)), Vec3::X);
    check(&scene, &rays, &Opaque);
}

/// Accepts a pattern of holes that depends on everything it is told.
struct Holes;

impl AlphaTest for Holes {
    fn is_opaque(&self, mesh: u32) -> bool {
        mesh == 0
    }
    fn accepts(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool {
        assert_ne!(instance, 0, "opaque meshes are not asked about");
        (u * 7.0).fract() > 0.3 && (v * 5.0).fract() > 0.2 && !(triangle ^ seed ^ instance).is_multiple_of(4)
    }
}

#[test]
fn alpha() {
    let mut random = Random(3);
    let triangles = random_triangles(&mut random, 400);
    let rays = random_rays(&mut random, &triangles, 1024);
    let mut scene = scene(vec![soup(&triangles[..100]), soup(&triangles[100..200]), soup(&triangles[200..])]);
    check(&scene, &rays, &Holes);
    scene.instances.push(Instance {
        mesh: 2,
        world_from_object: Affine3A::from_scale(Vec3::splat(1.3)),
        ..Instance::default()
    });
    check(&scene, &rays, &Holes);
}

#[test]
fn empty_scenes_and_strange_rays() {
    let mut random = Random(4);
    let triangles = random_triangles(&mut random, 50);
    let mut rays = random_rays(&mut random, &triangles, 64);
    for (i, ray) in rays.iter_mut().enumerate() {
        match i % 7 {
            0 => ray.t_max = 0.0,
            1 => ray.t_max = f32::NAN,
            2 => ray.t_max = -1.0,
            3 => ray.direction = Vec3::ZERO,
            4 => ray.direction.y = f32::NAN,
            5 => ray.origin.x = f32::INFINITY,
            _ => {}
        }
    }
    check(&scene(vec![soup(&triangles)]), &rays, &Opaque);
    check(&Scene::default(), &rays, &Opaque);
    check(&scene(vec![soup(&[])]), &rays, &Opaque);
    let mut unplaced = scene(vec![soup(&triangles)]);
    unplaced.instances.clear();
    check(&unplaced, &rays, &Opaque);
    // Triangles that cannot be hit: points, lines, and beyond the range of the arithmetic.
    let far = Vec3::splat(2e12);
    let flat = [[Vec3::ONE; 3], [Vec3::ZERO, Vec3::X, Vec3::X * 2.0], [far, Vec3::X, Vec3::Y]];
    let scene = scene(vec![soup(&flat)]);
    check(&scene, &rays, &Opaque);
    assert_eq!(Tracer::build(&scene, Opaque, BuildOptions::default()).stats().dropped, 3);
}

#[test]
fn same_t_in_any_order_of_triangles() {
    let mut random = Random(5);
    let mut triangles = random_triangles(&mut random, 800);
    let rays = random_rays(&mut random, &triangles, 2048);
    let trace = |triangles: &[[Vec3; 3]]| {
        let mut hits = vec![Hit::MISS; rays.len()];
        Tracer::build(&scene(vec![soup(triangles)]), Opaque, BuildOptions::default())
            .closest_hits(&rays, &mut hits);
        hits.into_iter().map(|hit| hit.t).collect::<Vec<_>>()
    };
    let before = trace(&triangles);
    for i in (1..triangles.len()).rev() {
        triangles.swap(i, random.below(i as u32 + 1) as usize);
    }
    assert_eq!(before, trace(&triangles));
}

/// Baked instances are hit exactly as if each had a mesh of its own.
#[test]
fn baked_instances() {
    let mut random = Random(6);
    let triangles = random_triangles(&mut random, 40);
    let rays = random_rays(&mut random, &triangles, 1024);
    let mut shared = scene(vec![soup(&triangles[..15]), soup(&triangles[15..])]);
    for i in 0..30 {
        let rotation = Mat3::from_quat(Quat::from_scaled_axis(random.cube() * 3.0));
        let world_from_object = Affine3A::from_mat3_translation(rotation, random.cube());
        shared.instances.push(Instance { mesh: i % 2, world_from_object, ..Instance::default() });
    }
    let mut own = shared.clone();
    own.meshes = shared.instances.iter().map(|i| shared.meshes[i.mesh as usize].clone()).collect();
    for (mesh, instance) in (0..).zip(&mut own.instances) {
        instance.mesh = mesh;
    }
    let reference = BruteForce::new(&own, &Opaque);
    let mut expected = vec![Hit::MISS; rays.len()];
    reference.closest_hits(&rays, &mut expected);
    for (bake_budget, baked) in [(BuildOptions::BAKE_BUDGET, 32), (u64::MAX, 32), (0, 0)] {
        let options = BuildOptions { bake_budget, ..BuildOptions::default() };
        let tracer = Tracer::build(&shared, Opaque, options);
        assert_eq!(tracer.stats().baked_instances, baked);
        assert_eq!(tracer.stats().placed_instances, 32 - baked);
        let mut hits = vec![Hit::MISS; rays.len()];
        tracer.closest_hits(&rays, &mut hits);
        if baked > 0 {
            assert_eq!(hits, expected);
        }
    }
}

/// Baking stops at its budget, the dearest meshes stay shared.
#[test]
fn baking_keeps_to_its_budget() {
    let mut random = Random(7);
    let triangles = random_triangles(&mut random, 5000);
    let mut scene = scene(vec![soup(&triangles[..1]), soup(&triangles)]);
    let copies = BuildOptions::BAKE_BUDGET / 5000;
    for i in 0..copies as u32 {
        let world_from_object = Affine3A::from_translation(Vec3::X * i as f32);
        scene.instances.push(Instance { mesh: 1, world_from_object, ..Instance::default() });
    }
    scene.instances.push(scene.instances[0]);
    let tracer = Tracer::build(&scene, Opaque, BuildOptions::default());
    assert_eq!(tracer.stats().baked_instances, 2);
    assert_eq!(tracer.stats().placed_instances, copies as usize + 1);
}

/// A hundred thousand triangles in one place, and as many beside: the builder must not take the square of them.
#[test]
fn crowds_in_one_place_are_no_trap() {
    let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
    // Small ones in the crowd's box, each of which looks for a better place in all of it.
    let inside = |i: usize| triangle.map(|p| 1e-5 * p + Vec3::new(0.6, 0.6 + 1e-5 * i as f32, 0.0));
    let beside = |i: usize| triangle.map(|p| p + Vec3::new(2.0 + 0.001 * i as f32, 0.0, 0.0));
    let few = (0..20_000).map(inside).chain((0..1000).map(beside));
    let all: Vec<_> = std::iter::repeat_n(triangle, 100_000).chain(few).collect();
    let scene = scene(vec![soup(&all)]);
    for quality in Quality::ALL {
        let options = BuildOptions { quality, ..BuildOptions::default() };
        let tracer = Tracer::build(&scene, Opaque, options);
        assert!(tracer.stats().depth < 64, "{quality:?}: {} levels", tracer.stats().depth);
        let ray =
            |x: f32| Ray { origin: Vec3::new(x, 0.2, 1.0), t_max: 10.0, direction: Vec3::NEG_Z, seed: 0 };
        let mut hits = [Hit::MISS; 2];
        tracer.closest_hits(&[ray(0.2), ray(3.5)], &mut hits);
        assert_eq!((hits[0].triangle, hits[0].t), (0, 1.0));
        assert!(hits[1].is_hit() && hits[1].triangle >= 120_000);
    }
}
