//! A tracer that follows a moving scene returns exactly what one built for each pose returns.

mod common;

use std::sync::Arc;

use ambray_core::{
    frame::PoseStats,
    shape::Shape,
    trace::{Hit, Ray, Trace},
};
use ambray_cpu::{AlphaTest, BuildOptions, Opaque, Packets, Tracer, Width};
use ambray_scene::{
    Instance, Mesh, Motion, Scene, ShapeInstance,
    animation::{Deformer, Rig, UpdatePolicy, Updates},
};
use common::{BruteForce, Random, random_rays, random_triangles, scene, soup};
use glam::{Affine3A, Mat3, Quat, Vec3};

const POLICIES: [UpdatePolicy; 4] =
    [UpdatePolicy::Auto, UpdatePolicy::Refit, UpdatePolicy::Rebuild, UpdatePolicy::Cache];

/// Every way of updating, for every tree.
fn all_options() -> Vec<BuildOptions> {
    let mut all = Vec::new();
    for policy in POLICIES {
        for width in Width::ALL {
            for packets in [Packets::Never, Packets::Always] {
                let updates = Updates { policy, poses: 3, ..Updates::default() };
                let (width, bake_budget) = (Some(width), 0);
                all.push(BuildOptions { width, packets, bake_budget, updates, ..BuildOptions::default() });
            }
        }
    }
    all
}

/// A scene that moves: of these motions, one a mesh, each with one instance.
fn moving(meshes: Vec<Mesh>, motions: &[Motion]) -> Scene {
    let mut scene = scene(meshes);
    scene.rig = Some(Arc::new(Rig::default()));
    for (instance, &motion) in scene.instances.iter_mut().zip(motions) {
        instance.motion = motion;
    }
    scene
}

fn positions(scene: &mut Scene, mesh: usize) -> &mut Vec<Vec3> {
    &mut Arc::make_mut(&mut scene.meshes[mesh]).positions
}

/// What a tracer answers about `rays`.
fn answers(tracer: &impl Trace, rays: &[Ray]) -> (Vec<Hit>, Vec<bool>) {
    let (mut hits, mut blocked) = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
    tracer.closest_hits(rays, &mut hits);
    tracer.any_hits(rays, &mut blocked);
    (hits, blocked)
}

/// Moves `scene` from pose to pose by `pose`, and compares tracers that follow it with a loop over all triangles and with a
/// tracer built there.
#[track_caller]
fn check<A: AlphaTest>(
    mut scene: Scene,
    alpha: &A,
    poses: usize,
    rays: impl Fn(&Scene, usize) -> Vec<Ray>,
    mut pose: impl FnMut(&mut Scene, usize),
) {
    let options = all_options();
    let mut tracers: Vec<_> = options.iter().map(|&options| Tracer::build(&scene, alpha, options)).collect();
    for at in 0..poses {
        pose(&mut scene, at);
        let rays = rays(&scene, at);
        let expected = answers(&BruteForce::new(&scene, alpha), &rays);
        for (tracer, options) in tracers.iter_mut().zip(&options) {
            tracer.update(&scene, alpha);
            let fresh = answers(&Tracer::build(&scene, alpha, *options), &rays);
            let followed = answers(tracer, &rays);
            for (i, ray) in rays.iter().enumerate() {
                let message = format!("pose {at}, {options:?}, ray {i}: {ray:?}");
                assert_eq!(followed.0[i], expected.0[i], "{message}");
                assert_eq!(followed.1[i], expected.1[i], "any, {message}");
                assert_eq!(fresh.0[i], expected.0[i], "fresh, {message}");
                // Equality of numbers does not tell zeros apart.
                let bits = |hit: &Hit| [hit.t, hit.u, hit.v].map(f32::to_bits);
                assert_eq!(bits(&followed.0[i]), bits(&fresh.0[i]), "{message}");
            }
        }
    }
}

/// Rays about all triangles of the scene as it stands, those in object space included.
fn rays_about(scene: &Scene, seed: u32) -> Vec<Ray> {
    let triangles: Vec<_> = scene
        .instances
        .iter()
        .flat_map(|instance| {
            let mesh = &scene.meshes[instance.mesh as usize];
            let place = |p: Vec3| instance.world_from_object.transform_point3(p);
            (0..mesh.triangles.len() as u32).map(move |t| mesh.corners(t).map(place))
        })
        .collect();
    random_rays(&mut Random(seed), &triangles, 160)
}

/// Random motion of single vertices, which scrambles the order that trees were built for.
#[test]
fn deforming_soups() {
    for size in [1, 5, 40, 900] {
        let mut random = Random(size);
        let triangles = random_triangles(&mut random, size as usize);
        let (first, second) = triangles.split_at(triangles.len() / 2);
        let scene = moving(vec![soup(first), soup(second)], &[Motion::Static, Motion::Deforming]);
        let rest = scene.meshes[1].positions.clone();
        let strengths = [0.0, 0.01, 0.3, 2.0, 0.3, 0.0];
        check(
            scene,
            &Opaque,
            strengths.len(),
            |scene, at| rays_about(scene, at as u32),
            |scene, at| {
                for (position, rest) in positions(scene, 1).iter_mut().zip(&rest) {
                    *position = *rest + random.cube() * strengths[at];
                }
            },
        );
    }
}

/// Triangles that lose their area, that go beyond the range of the tracer or become huge, and come back.
#[test]
fn triangles_that_come_and_go() {
    let mut random = Random(7);
    let triangles = random_triangles(&mut random, 200);
    let scene = moving(vec![soup(&triangles)], &[Motion::Deforming]);
    let rest = scene.meshes[0].positions.clone();
    let change = |at: usize, vertex: usize, p: Vec3| {
        let triangle = vertex / 3;
        match at {
            1 if triangle.is_multiple_of(2) => rest[vertex - vertex % 3],
            2 if !triangle.is_multiple_of(3) => Vec3::ZERO,
            3 => Vec3::ONE,
            4 if triangle.is_multiple_of(5) => p * 1e13,
            5 if vertex.is_multiple_of(7) => Vec3::splat(f32::NAN),
            6 if triangle.is_multiple_of(4) => p + Vec3::new(1e6, -1e5, 0.0),
            7 => p * 1e11,
            8 => p * 1e-20,
            9 if triangle == 0 => Vec3::splat(f32::INFINITY),
            _ => p,
        }
    };
    check(
        scene,
        &Opaque,
        11,
        |_, at| {
            let scale = [1.0, 1e11, 1e-20][match at {
                7 => 1,
                8 => 2,
                _ => 0,
            }];
            let rays = random_rays(&mut Random(8), &triangles, 160);
            rays.iter()
                .map(|ray| Ray { origin: ray.origin * scale, t_max: ray.t_max * scale, ..*ray })
                .collect()
        },
        |scene, at| {
            for (vertex, position) in positions(scene, 0).iter_mut().enumerate() {
                *position = change(at, vertex, rest[vertex]);
            }
        },
    );
}

/// Instances that move as a whole, also to where no ray finds them, among shared and unshared ones that stay.
#[test]
fn rigid_instances() {
    let mut random = Random(3);
    let triangles = random_triangles(&mut random, 120);
    let meshes = vec![soup(&triangles[..50]), soup(&triangles[50..100]), soup(&triangles[100..])];
    let mut scene = moving(meshes, &[Motion::Static, Motion::Rigid, Motion::Rigid]);
    for i in 0..12 {
        let motion = if i % 2 == 0 { Motion::Rigid } else { Motion::Static };
        let world_from_object = Affine3A::from_translation(random.cube());
        scene.instances.push(Instance { mesh: 1 + i % 2, world_from_object, motion });
    }
    let placements: Vec<Vec<Affine3A>> = (0..8)
        .map(|at| {
            let placement = |i: usize| {
                let turn = Mat3::from_quat(Quat::from_scaled_axis(random.cube() * 3.0));
                let scale = match (at + i) % 9 {
                    0 => Vec3::ZERO,
                    1 => Vec3::new(1.0, 0.0, 1.0),
                    2 => Vec3::new(-1.0, 1.0, 1.0),
                    3 => Vec3::splat(1e13),
                    4 => Vec3::splat(1e5),
                    5 => Vec3::new(0.1, 3.0, -0.5),
                    6 => Vec3::splat(f32::NAN),
                    _ => Vec3::ONE,
                };
                let turn = if (at + i) % 9 == 8 { Mat3::IDENTITY } else { turn };
                Affine3A::from_mat3_translation(turn * Mat3::from_diagonal(scale), random.cube())
            };
            (0..scene.instances.len()).map(placement).collect()
        })
        .collect();
    let order = [0, 1, 2, 3, 4, 5, 6, 7, 6, 5, 4, 3, 2, 1, 0];
    check(
        scene,
        &Opaque,
        order.len(),
        |_, at| random_rays(&mut Random(at as u32), &triangles, 96),
        |scene, at| {
            let moved = scene.instances.iter_mut().zip(&placements[order[at]]);
            for (instance, placement) in moved.filter(|(instance, _)| instance.motion == Motion::Rigid) {
                instance.world_from_object = *placement;
            }
        },
    );
}

/// Accepts a pattern of holes that depends on everything it is told.
struct Holes;

impl AlphaTest for Holes {
    fn is_opaque(&self, mesh: u32) -> bool {
        mesh == 0
    }
    fn accepts(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool {
        (u * 7.0).fract() > 0.3 && (v * 5.0).fract() > 0.2 && !(triangle ^ seed ^ instance).is_multiple_of(4)
    }
}

/// Several meshes that deform, with one and with several instances, with holes and without; instances move too, and pass
/// through the identity.
#[test]
fn deforming_instances_move() {
    let mut random = Random(5);
    let triangles = random_triangles(&mut random, 160);
    let meshes = triangles.chunks(40).map(soup).collect();
    let motions = [Motion::Deforming, Motion::Deforming, Motion::Static, Motion::Deforming];
    let mut scene = moving(meshes, &motions);
    // The third mesh deforms although its instance does not say so; the last one has another instance, which says nothing.
    let rig = Rig { deformers: vec![Deformer { mesh: 2, ..Deformer::default() }], ..Rig::default() };
    scene.rig = Some(Arc::new(rig));
    scene.instances[2].motion = Motion::Deforming;
    scene.instances.push(Instance {
        mesh: 3,
        world_from_object: Affine3A::from_translation(Vec3::X * 0.3),
        motion: Motion::Static,
    });
    let rest: Vec<_> = scene.meshes.iter().map(|mesh| mesh.positions.clone()).collect();
    check(
        scene,
        &Holes,
        6,
        |scene, at| rays_about(scene, at as u32),
        |scene, at| {
            for (mesh, rest) in rest.iter().enumerate() {
                for (position, rest) in positions(scene, mesh).iter_mut().zip(rest) {
                    *position = *rest + random.cube() * 0.1 * at as f32;
                }
            }
            for i in [0, 3, 4] {
                let moved = Affine3A::from_rotation_translation(
                    Quat::from_scaled_axis(random.cube()),
                    random.cube() * 0.3,
                );
                scene.instances[i].world_from_object = if at % 3 == 1 { Affine3A::IDENTITY } else { moved };
            }
        },
    );
}

/// Many meshes with vertices in world space, as skinned ones have: more than rays try one by one.
#[test]
fn many_meshes_in_world_space() {
    let mut random = Random(6);
    let triangles = random_triangles(&mut random, 100);
    let scene = moving(triangles.chunks(5).map(soup).collect(), &[Motion::Deforming; 20]);
    check(
        scene,
        &Holes,
        3,
        |scene, at| rays_about(scene, at as u32),
        |scene, _| {
            for mesh in 0..20 {
                positions(scene, mesh).iter_mut().for_each(|position| *position += random.cube() * 0.1);
            }
        },
    );
}

/// Placed shapes follow too, also where none of them can be hit at first.
#[test]
fn shapes_move() {
    let mut scene = moving(vec![soup(&[])], &[Motion::Static]);
    scene.shapes = vec![Shape::Sphere { radius: 0.5 }];
    let hidden = Affine3A::from_scale(Vec3::ZERO);
    let moving =
        ShapeInstance { world_from_object: hidden, motion: Motion::Rigid, ..ShapeInstance::default() };
    scene.shape_instances = vec![moving];
    let down = Ray { origin: Vec3::Y * 10.0, t_max: f32::INFINITY, direction: Vec3::NEG_Y, seed: 0 };
    let mut tracer = Tracer::build(&scene, Opaque, BuildOptions::default());
    assert_eq!((answers(&tracer, &[down]), tracer.stats().shapes), ((vec![Hit::MISS], vec![false]), 0));
    for height in [0.0, 2.0, -1.0] {
        scene.shape_instances[0].world_from_object = Affine3A::from_translation(Vec3::Y * height);
        tracer.update(&scene, Opaque);
        assert_eq!(answers(&tracer, &[down]).0[0].t, 9.5 - height);
        assert_eq!(answers(&tracer, &[down]).1, [true]);
    }
    scene.shape_instances[0].world_from_object = hidden;
    tracer.update(&scene, Opaque);
    assert_eq!(answers(&tracer, &[down]), (vec![Hit::MISS], vec![false]));
}

/// A sheet of 2 · `side`² triangles, each with vertices of its own.
fn sheet(side: u32) -> Mesh {
    let point = |x: u32, y: u32| Vec3::new(x as f32, 0.0, y as f32) / side as f32;
    let square = |i: u32| {
        let (x, y) = (i % side, i / side);
        let [a, b, c, d] = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(x, y)| point(x, y));
        [[a, b, c], [c, b, d]]
    };
    soup(&(0..side * side).flat_map(square).collect::<Vec<_>>())
}

/// A tracer of a sheet that deforms, and the scene.
fn sheet_scene(policy: UpdatePolicy, poses: u32) -> (Scene, Tracer) {
    let scene = moving(vec![sheet(40)], &[Motion::Deforming]);
    let updates = Updates { policy, poses, ..Updates::default() };
    let tracer = Tracer::build(&scene, Opaque, BuildOptions { updates, ..BuildOptions::default() });
    (scene, tracer)
}

/// Puts the triangles of the sheet into another order for each pose: the tree of one is poor in the others. At pose 0 all
/// are at rest.
fn scramble(scene: &mut Scene, pose: u32) {
    let mut places: Vec<[Vec3; 3]> = {
        let sheet = sheet(40);
        (0..sheet.triangles.len() as u32).map(|t| sheet.corners(t)).collect()
    };
    let mut random = Random(pose);
    if pose != 0 {
        for i in (1..places.len()).rev() {
            places.swap(i, random.below(i as u32 + 1) as usize);
        }
    }
    *positions(scene, 0) = places.concat();
}

fn counts(stats: &PoseStats) -> (u32, u32, u32) {
    (stats.refitted, stats.rebuilt, stats.kept)
}

#[test]
fn refitting_to_the_same_pose_changes_nothing() {
    for policy in [UpdatePolicy::Auto, UpdatePolicy::Refit, UpdatePolicy::Cache] {
        let (mut scene, mut tracer) = sheet_scene(policy, 4);
        for _ in 0..3 {
            let stats = tracer.update(&scene, Opaque);
            assert_eq!((counts(&stats), stats.decay), ((1, 0, 1), 1.0), "{policy:?}");
        }
        // Size does not matter.
        for position in positions(&mut scene, 0) {
            *position *= 4.0;
        }
        assert_eq!(tracer.update(&scene, Opaque).decay, 1.0, "{policy:?}");
    }
}

#[test]
fn poor_trees_are_rebuilt() {
    let (mut scene, mut tracer) = sheet_scene(UpdatePolicy::Auto, 4);
    scramble(&mut scene, 1);
    let stats = tracer.update(&scene, Opaque);
    assert_eq!((counts(&stats), stats.decay), ((0, 1, 1), 1.0));
    let stats = tracer.update(&scene, Opaque);
    assert_eq!((counts(&stats), stats.decay), ((1, 0, 1), 1.0), "measured from the new tree");

    let (mut scene, mut tracer) = sheet_scene(UpdatePolicy::Refit, 4);
    scramble(&mut scene, 1);
    let stats = tracer.update(&scene, Opaque);
    assert_eq!(counts(&stats), (1, 0, 1));
    assert!(stats.decay > 5.0, "{stats:?}");
    scramble(&mut scene, 0);
    assert_eq!(tracer.update(&scene, Opaque).decay, 1.0);

    let (scene, mut tracer) = sheet_scene(UpdatePolicy::Rebuild, 4);
    for _ in 0..2 {
        let stats = tracer.update(&scene, Opaque);
        assert_eq!((counts(&stats), stats.decay), ((0, 1, 1), 1.0));
    }
}

/// A mesh that was nothing when its tree was built, which has then no order at all.
#[test]
fn trees_of_nothing_are_rebuilt() {
    for at in [Vec3::ZERO, Vec3::ONE, Vec3::splat(f32::NAN)] {
        let (mut scene, _) = sheet_scene(UpdatePolicy::Auto, 1);
        let rest = scene.meshes[0].positions.clone();
        positions(&mut scene, 0).fill(at);
        let mut tracer = Tracer::build(&scene, Opaque, BuildOptions::default());
        assert_eq!(tracer.update(&scene, Opaque).decay, 1.0);
        *positions(&mut scene, 0) = rest;
        assert_eq!(counts(&tracer.update(&scene, Opaque)), (0, 1, 1), "{at}");
    }
}

#[test]
fn the_cache_finds_trees_again_and_forgets_the_oldest() {
    let (mut scene, mut tracer) = sheet_scene(UpdatePolicy::Cache, 3);
    let mut visit = |pose: u32| {
        scramble(&mut scene, pose);
        let stats = tracer.update(&scene, Opaque);
        assert!(stats.rebuilt == 1 || stats.decay == 1.0, "{stats:?}");
        (stats.rebuilt, stats.kept)
    };
    assert_eq!(visit(0), (0, 1));
    assert_eq!(visit(1), (1, 2));
    assert_eq!(visit(2), (1, 3));
    for pose in [0, 1, 2, 2, 0] {
        assert_eq!(visit(pose), (0, 3), "pose {pose} is kept");
    }
    assert_eq!(visit(3), (1, 3), "replaces 1");
    for pose in [2, 0, 3] {
        assert_eq!(visit(pose), (0, 3), "pose {pose} is kept");
    }
    assert_eq!(visit(1), (1, 3), "1 was forgotten");
}

#[test]
fn a_cache_of_one_is_no_cache() {
    for poses in [0, 1] {
        let (mut scene, mut tracer) = sheet_scene(UpdatePolicy::Cache, poses);
        for pose in [1, 0, 1] {
            scramble(&mut scene, pose);
            assert_eq!(counts(&tracer.update(&scene, Opaque)), (0, 1, 1));
        }
    }
}

/// The same poses give the same trees, whatever the number of threads.
#[test]
fn updates_do_not_depend_on_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut random = Random(9);
            let mut scene = moving(vec![sheet(70), sheet(20)], &[Motion::Deforming; 2]);
            let mut tracer = Tracer::build(&scene, Opaque, BuildOptions::default());
            let mut decays = Vec::new();
            for at in 0..6 {
                for mesh in 0..2 {
                    for position in positions(&mut scene, mesh) {
                        *position += random.cube() * 0.002 * at as f32;
                    }
                }
                let stats = tracer.update(&scene, Opaque);
                decays.push((counts(&stats), stats.decay.to_bits()));
            }
            decays
        })
    };
    let expected = run(1);
    assert!(expected.iter().any(|((_, rebuilt, _), _)| *rebuilt > 0), "{expected:?}");
    assert!(expected.iter().any(|((refitted, ..), decay)| *refitted > 0 && *decay != 1.0_f32.to_bits()));
    assert_eq!(run(4), expected);
}

/// Without a rig nothing moves, whatever the instances say.
#[test]
fn scenes_without_a_rig_are_baked() {
    let mut still = moving(vec![sheet(4), sheet(3)], &[Motion::Rigid, Motion::Deforming]);
    let options = BuildOptions::default();
    assert_eq!(Tracer::build(&still, Opaque, options).stats().placed_instances, 2);
    still.rig = None;
    let tracer = Tracer::build(&still, Opaque, options);
    assert_eq!((tracer.stats().placed_instances, tracer.stats().triangles), (0, 50));
}

/// What moves is never baked, whatever the budget.
#[test]
fn what_moves_is_not_baked() {
    let mut scene = moving(vec![sheet(4)], &[Motion::Rigid]);
    for x in 1..10 {
        let motion = if x < 5 { Motion::Rigid } else { Motion::Static };
        let world_from_object = Affine3A::from_translation(Vec3::X * x as f32);
        scene.instances.push(Instance { mesh: 0, world_from_object, motion });
    }
    for (bake_budget, baked) in [(0, 0), (u64::MAX, 5)] {
        let tracer = Tracer::build(&scene, Opaque, BuildOptions { bake_budget, ..BuildOptions::default() });
        let stats = tracer.stats();
        assert_eq!((stats.baked_instances, stats.placed_instances), (baked, 10 - baked));
        assert_eq!(stats.triangles, 32 * (baked + 1));
    }
}
