//! Placed shapes, alone and among triangles: the tree against a loop over all of them.

mod common;

use ambray_core::shape::{Shape, SignedDistanceField};
use ambray_core::trace::{Hit, Ray, Trace};
use ambray_cpu::{AlphaTest, BuildOptions, Isa, Opaque, Packets, Tracer, Width};
use ambray_scene::{Scene, ShapeInstance};
use common::{Random, scene, soup};
use glam::{Affine3A, Quat, Vec3};

fn shapes() -> Vec<Shape> {
    let n = 8;
    let at = |i: u32| 2.0 * i as f32 / (n - 1) as f32 - 1.0;
    let distances = (0..n * n * n).map(|i| Vec3::new(at(i % n), at(i / n % n), at(i / n / n)).length() - 0.7);
    let field = SignedDistanceField::new([n; 3], Vec3::splat(2.0), distances.collect()).expect("a field");
    vec![
        Shape::Sphere { radius: 1.0 },
        Shape::Box { half_extents: Vec3::new(0.5, 1.0, 0.25) },
        Shape::Capsule { height: 1.0, radius_bottom: 0.5, radius_top: 0.2 },
        Shape::Cylinder { height: 1.0, radius_bottom: 0.2, radius_top: 0.7 },
        Shape::Field(field),
    ]
}

/// `count` placed shapes among triangles, some at the same place.
fn mixed(random: &mut Random, count: u32) -> Scene {
    let triangles: Vec<[Vec3; 3]> = (0..60)
        .map(|_| {
            let p = random.cube();
            [p, p + random.cube() * 0.5, p + random.cube() * 0.5]
        })
        .collect();
    let mut scene = scene(vec![soup(&triangles[..30]), soup(&triangles[30..])]);
    scene.shapes = shapes();
    for i in 0..count {
        let scale = 0.02 + 0.2 * random.cube().abs();
        let scale = if i % 3 == 0 { scale * Vec3::new(1.0, -1.0, 1.0) } else { scale };
        let rotation = Quat::from_scaled_axis(random.cube() * 3.0);
        let world_from_object = if i % 9 == 8 {
            scene.shape_instances[i as usize - 1].world_from_object
        } else {
            Affine3A::from_scale_rotation_translation(scale, rotation, random.cube())
        };
        let shape = if i % 9 == 8 { scene.shape_instances[i as usize - 1].shape } else { i % 5 };
        scene.shape_instances.push(ShapeInstance { shape, world_from_object, ..ShapeInstance::default() });
    }
    scene
}

fn rays(random: &mut Random, count: u32) -> Vec<Ray> {
    let ray = |i: u32| {
        let origin = random.cube() * if i.is_multiple_of(2) { 1.0 } else { 5.0 };
        let target = random.cube();
        let t_max = if i.is_multiple_of(3) { random.unit() * 3.0 } else { f32::INFINITY };
        let mut direction = (target - origin).normalize();
        if i.is_multiple_of(17) {
            direction = Vec3::X;
        }
        Ray { origin, t_max, direction, seed: random.bits() }
    };
    (0..count).map(ray).collect()
}

fn trace(scene: &Scene, alpha: impl AlphaTest, options: BuildOptions, rays: &[Ray]) -> (Vec<Hit>, Vec<bool>) {
    let tracer = Tracer::build(scene, alpha, options);
    let (mut hits, mut blocked) = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
    tracer.closest_hits(rays, &mut hits);
    tracer.any_hits(rays, &mut blocked);
    (hits, blocked)
}

/// Sees about half of all shapes.
#[derive(Clone, Copy)]
struct Sieve;

impl AlphaTest for Sieve {
    fn is_opaque(&self, _mesh: u32) -> bool {
        true
    }
    fn accepts(&self, instance: u32, _triangle: u32, _u: f32, _v: f32, seed: u32) -> bool {
        ambray_core::sampling::pcg(seed ^ instance) & 1 == 0
    }
}

#[test]
fn the_tree_finds_what_a_loop_finds() {
    let mut random = Random(1);
    for count in [1, 2, 9, 200] {
        let scene = mixed(&mut random, count);
        let rays = rays(&mut random, 1500);
        // The loop: scenes with one shape each, numbered as in the whole scene.
        let mut expected = {
            let triangles = Scene { shape_instances: Vec::new(), ..scene.clone() };
            trace(&triangles, Sieve, BuildOptions::default(), &rays).0
        };
        let first = scene.instances.len() as u32;
        for (index, instance) in (first..).zip(&scene.shape_instances) {
            let one = Scene {
                meshes: Vec::new(),
                instances: Vec::new(),
                shape_instances: vec![*instance],
                ..scene.clone()
            };
            let (hits, _) = trace(&one, Opaque, BuildOptions::default(), &rays);
            for ((hit, best), ray) in hits.iter().zip(&mut expected).zip(&rays) {
                if hit.is_hit() && Sieve.accepts(index, 0, 0.0, 0.0, ray.seed) && hit.t < best.t {
                    *best = Hit { instance: index, ..*hit };
                }
                check_against_formula(&scene, instance, ray, hit);
            }
        }
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            for (width, packets) in [(Width::Eight, Packets::Always), (Width::Sixteen, Packets::Never)] {
                let options =
                    BuildOptions { isa: Some(isa), width: Some(width), packets, ..BuildOptions::default() };
                let (hits, blocked) = trace(&scene, Sieve, options, &rays);
                for i in 0..rays.len() {
                    assert_eq!(hits[i], expected[i], "{count} shapes, {options:?}: {:?}", rays[i]);
                    assert_eq!(blocked[i], expected[i].is_hit(), "{count} shapes: {:?}", rays[i]);
                }
                // One by one.
                let (one, _) = trace(&scene, Sieve, options, &rays[7..8]);
                assert_eq!(one[0], expected[7]);
            }
        }
        let on_shapes = expected.iter().filter(|hit| hit.is_hit() && hit.instance >= first).count();
        assert!(count < 200 || on_shapes > 100, "{on_shapes} of {count} shapes");
    }
}

fn check_against_formula(scene: &Scene, instance: &ShapeInstance, ray: &Ray, hit: &Hit) {
    let object_from_world = instance.world_from_object.inverse();
    let origin = object_from_world.transform_point3(ray.origin);
    let direction = object_from_world.transform_vector3(ray.direction);
    let t = scene.shapes[instance.shape as usize].intersect(origin, direction, ray.t_max);
    match t {
        Some(t) => assert!((hit.t - t).abs() <= 1e-4 * t.max(1.0), "{hit:?} is not at {t}"),
        None => assert!(!hit.is_hit(), "{hit:?}"),
    }
}

#[test]
fn coincident_shapes_have_the_smaller_number() {
    let mut scene = scene(vec![soup(&[[
        Vec3::new(-1.0, -1.0, 1.0),
        Vec3::new(3.0, -1.0, 1.0),
        Vec3::new(-1.0, 3.0, 1.0),
    ]])]);
    scene.shapes = vec![Shape::Box { half_extents: Vec3::ONE }];
    scene.shape_instances = vec![ShapeInstance::default(); 40];
    let ray = |direction| Ray { origin: Vec3::ZERO - direction * 4.0, t_max: 9.0, direction, seed: 0 };
    let rays = [ray(Vec3::NEG_Z), ray(Vec3::Z)];
    let (hits, blocked) = trace(&scene, Opaque, BuildOptions::default(), &rays);
    // Triangles before shapes, shapes in order.
    assert_eq!((hits[0].instance, hits[0].t), (0, 3.0));
    assert_eq!(hits[1], Hit { t: 3.0, u: 0.0, v: 0.0, instance: 1, triangle: 0 });
    assert_eq!(blocked, [true, true]);
}

#[test]
fn odd_placements_and_rays() {
    let mut scene = Scene { shapes: shapes(), ..Scene::default() };
    for world_from_object in [
        Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0)),
        Affine3A::from_translation(Vec3::splat(f32::NAN)),
        Affine3A::from_translation(Vec3::splat(1e13)),
    ] {
        scene.shape_instances.push(ShapeInstance { world_from_object, ..ShapeInstance::default() });
    }
    let down = Ray { origin: Vec3::new(0.1, 5.0, 0.1), t_max: 1e3, direction: Vec3::NEG_Y, seed: 0 };
    let tracer = Tracer::build(&scene, Opaque, BuildOptions::default());
    assert_eq!(tracer.stats().shapes, 0);
    assert_eq!(trace(&scene, Opaque, BuildOptions::default(), &[down]).0, [Hit::MISS]);
    scene.shape_instances.push(ShapeInstance::default());
    let odd = [
        down,
        Ray { direction: Vec3::ZERO, ..down },
        Ray { origin: Vec3::splat(f32::NAN), ..down },
        Ray { t_max: f32::NAN, ..down },
        Ray { t_max: -1.0, ..down },
    ];
    let (hits, blocked) = trace(&scene, Opaque, BuildOptions::default(), &odd);
    assert_eq!((hits[0].instance, blocked[0]), (3, true));
    assert!(hits[1..].iter().all(|hit| *hit == Hit::MISS) && !blocked[1..].contains(&true));
}
