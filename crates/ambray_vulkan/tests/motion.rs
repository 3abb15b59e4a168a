//! Scenes that move on a device, against backends made for each of their poses.

mod common;
#[path = "common/moving.rs"]
mod moving;
#[path = "common/scenes.rs"]
mod scenes;

use std::sync::{Arc, atomic::AtomicBool};

use ambray_core::{
    control::Control,
    frame::PoseStats,
    settings::Settings,
    trace::{Hit, Ray},
};
use ambray_scene::{
    Scene,
    animation::{Pose, UpdatePolicy, Updates},
    surface::normal_matrix,
};
use ambray_vulkan::{
    AccelerationOptions, Context, TraceMode, VulkanBackend, VulkanError, VulkanOptions, layout,
    testing::Functions,
};
use common::{assert_valid, context};
use glam::{DAffine3, DVec3, Vec3, Vec3A};
use moving::{BALL, BANNER_INSTANCE, BOX, BOX_INSTANCE, Random, pose, posed, rest, scene};
use scenes::view;

const POLICIES: [UpdatePolicy; 4] =
    [UpdatePolicy::Auto, UpdatePolicy::Refit, UpdatePolicy::Rebuild, UpdatePolicy::Cache];

/// Ways to trace that the device has.
fn modes(context: &Context) -> Vec<TraceMode> {
    let modes = [(context.has_pipelines(), TraceMode::Pipeline), (context.has_queries(), TraceMode::Query)];
    modes.into_iter().filter(|(has, _)| *has).map(|(_, mode)| mode).collect()
}

fn open(context: &Arc<Context>, scene: &Arc<Scene>, trace: TraceMode, updates: Updates) -> VulkanBackend {
    // Where there are two ways to trace, one shares its scratch memory among all builds and the other builds one by one.
    let batch = if trace == TraceMode::Query { 1 } else { AccelerationOptions::default().batch };
    let acceleration = AccelerationOptions { updates, batch, ..AccelerationOptions::default() };
    let options = VulkanOptions { trace, acceleration, ..VulkanOptions::default() };
    VulkanBackend::new(context, scene, options, &Control::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn updates(policy: UpdatePolicy) -> Updates {
    Updates { policy, ..Updates::default() }
}

fn move_to(backend: &mut VulkanBackend, scene: &Scene, pose: &Pose) -> PoseStats {
    let [placed, _] = posed(scene, pose);
    backend.pose(&placed, pose, &Control::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// A backend made for the scene as it is at `pose`.
fn fresh(backend: &VulkanBackend, scene: &Scene, pose: &Pose) -> VulkanBackend {
    let [_, deformed] = posed(scene, pose);
    backend.with_scene(&deformed, &Control::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn rays(random: &mut Random, count: usize) -> Vec<Ray> {
    (0..count)
        .map(|i| {
            let origin = random.vector(4.0);
            let towards = random.vector(2.0) - origin;
            let direction = towards.try_normalize().unwrap_or(Vec3::X);
            Ray { origin, direction, t_max: f32::INFINITY, seed: i as u32 }
        })
        .collect()
}

fn hits(backend: &VulkanBackend, rays: &[Ray]) -> Vec<Hit> {
    backend.closest_hits(rays).unwrap_or_else(|error| panic!("{error}"))
}

/// The same hits, distances to rounding.
#[track_caller]
fn assert_same_hits(moved: &VulkanBackend, fresh: &VulkanBackend, rays: &[Ray], what: &str) -> Vec<Hit> {
    let (found, expected) = (hits(moved, rays), hits(fresh, rays));
    for (i, (a, b)) in found.iter().zip(&expected).enumerate() {
        assert_eq!((a.instance, a.triangle), (b.instance, b.triangle), "{what}: ray {i}: {a:?} {b:?}");
        assert!(!a.is_hit() || (a.t - b.t).abs() <= 1e-5 * b.t.max(1.0), "{what}: ray {i}: {a:?} {b:?}");
    }
    found
}

#[test]
fn hits_are_those_of_a_scene_made_for_the_pose() {
    let Some(context) = context() else { return };
    let scene = Arc::new(scene(24));
    for mode in modes(&context) {
        for policy in POLICIES {
            let mut random = Random(3);
            let mut backend = open(&context, &scene, mode, updates(policy));
            let mut hit = 0;
            for round in 0..6 {
                let scatter = if round % 3 == 2 { 1.0 } else { 0.02 };
                let pose = if round == 5 { rest(&scene) } else { pose(&scene, &mut random, scatter) };
                let stats = move_to(&mut backend, &scene, &pose);
                assert_eq!(stats.refitted + stats.rebuilt, 2, "{policy:?}: {stats:?}");
                if policy == UpdatePolicy::Rebuild {
                    assert_eq!((stats.rebuilt, stats.decay), (2, 1.0));
                }
                let what = format!("{mode:?} {policy:?} pose {round}");
                let rays = rays(&mut random, 4000);
                let found = assert_same_hits(&backend, &fresh(&backend, &scene, &pose), &rays, &what);
                hit += found.iter().filter(|hit| hit.is_hit()).count();
            }
            assert!(hit > 6000, "{hit}");
        }
    }
    assert_valid(&context);
}

/// Frames agree in all bits but for a pixel in a thousand, where they do within 1e-3: the trees differ, so a ray on an edge may
/// hit the other triangle.
#[test]
fn frames_are_those_of_a_scene_made_for_the_pose() {
    let Some(context) = context() else { return };
    let scene = Arc::new(scene(16));
    let settings = Settings { spp: 4, ..Settings::default() };
    let view = view(&settings, 96, 64);
    for mode in modes(&context) {
        let mut backend = open(&context, &scene, mode, updates(UpdatePolicy::Auto));
        let mut random = Random(8);
        for round in 0..3 {
            let pose = pose(&scene, &mut random, 0.02);
            move_to(&mut backend, &scene, &pose);
            let render = |backend: &VulkanBackend| {
                let frame = backend.render(&settings, &view, Control::default());
                frame.unwrap_or_else(|error| panic!("{error}"))
            };
            let (found, expected) = (render(&backend), render(&fresh(&backend, &scene, &pose)));
            let differs =
                |&i: &usize| found.beauty[i] != expected.beauty[i] || found.ambient[i] != expected.ambient[i];
            let pixels = found.beauty.len();
            let unequal = (0..pixels).filter(differs).count();
            println!("{mode:?} pose {round}: {unequal} of {pixels} pixels differ");
            assert!(unequal * 1000 <= pixels, "{mode:?} pose {round}: {unequal}");
        }
    }
    assert_valid(&context);
}

#[test]
fn instances_appear_and_vanish() {
    let Some(context) = context() else { return };
    let scene = Arc::new(scene(6));
    let rays = rays(&mut Random(5), 4000);
    for mode in modes(&context) {
        let mut backend = open(&context, &scene, mode, updates(UpdatePolicy::Auto));
        let ball = scene.instances.len() as u32;
        let nothing = DAffine3::from_scale(DVec3::ZERO);
        let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
        let far = DAffine3::from_translation(DVec3::splat(1e30));
        for (round, [r#box, banner, sphere]) in [
            [nothing, DAffine3::IDENTITY, flat],
            [DAffine3::IDENTITY, nothing, far],
            [far, flat, nothing],
            [DAffine3::from_translation(DVec3::Y); 3],
        ]
        .into_iter()
        .enumerate()
        {
            let mut pose = rest(&scene);
            pose.world[BOX] = r#box;
            pose.world[moving::BANNER] = banner;
            pose.world[BALL] = sphere;
            move_to(&mut backend, &scene, &pose);
            let what = format!("{mode:?} round {round}");
            let found = assert_same_hits(&backend, &fresh(&backend, &scene, &pose), &rays, &what);
            let is_seen = |instance: u32| found.iter().any(|hit| hit.is_hit() && hit.instance == instance);
            let shows = |world: DAffine3| world.matrix3.determinant() != 0.0 && world.translation.x < 1e20;
            assert_eq!(is_seen(BOX_INSTANCE), shows(r#box), "{what}");
            assert_eq!(is_seen(BANNER_INSTANCE), shows(banner), "{what}");
            assert_eq!(is_seen(ball), shows(sphere), "{what}");
        }
    }
    assert_valid(&context);
}

/// Culling goes by boxes, which are those of the vertices at the pose.
#[test]
fn what_grows_into_the_view_is_seen() {
    let Some(context) = context() else { return };
    let scene = Arc::new(scene(8));
    let settings = Settings { spp: 2, ..Settings::default() };
    let view = view(&settings, 48, 32);
    for mode in modes(&context) {
        let mut backend = open(&context, &scene, mode, updates(UpdatePolicy::Auto));
        // Everything behind the camera, then joints that take the tube alone in front of it.
        let mut pose = rest(&scene);
        pose.world.fill(DAffine3::from_translation(DVec3::Z * 40.0));
        let far = glam::Affine3A::from_translation(Vec3::Z * 40.0);
        for (round, joint) in [far, glam::Affine3A::IDENTITY, far].into_iter().enumerate() {
            pose.joints[0].fill(joint);
            move_to(&mut backend, &scene, &pose);
            let render = |backend: &VulkanBackend| {
                let frame = backend.render(&settings, &view, Control::default());
                frame.unwrap_or_else(|error| panic!("{error}"))
            };
            let (found, expected) = (render(&backend), render(&fresh(&backend, &scene, &pose)));
            let seen = |frame: &ambray_core::frame::Frame| {
                frame.gbuffer.iter().map(|p| p.instance).collect::<Vec<_>>()
            };
            assert_eq!(seen(&found), seen(&expected), "{mode:?} round {round}");
            let tube = scene.instances.len() as u32 - 1;
            assert_eq!(seen(&found).contains(&tube), round == 1, "{mode:?} round {round}");
        }
    }
    assert_valid(&context);
}

#[test]
fn decay_tells_when_a_tree_is_poor() {
    let Some(context) = context() else { return };
    let scene = Arc::new(scene(32));
    let mut backend = open(&context, &scene, TraceMode::Auto, updates(UpdatePolicy::Auto));
    let still = move_to(&mut backend, &scene, &rest(&scene));
    assert_eq!((still.refitted, still.rebuilt, still.kept, still.decay), (2, 0, 2, 1.0));
    // The whole moves, the vertices within it do not.
    let mut moved = rest(&scene);
    moved.joints[0].fill(glam::Affine3A::from_translation(Vec3::new(3.0, -2.0, 8.0)));
    let shifted = move_to(&mut backend, &scene, &moved);
    assert_eq!((shifted.refitted, shifted.rebuilt), (2, 0));
    assert!((shifted.decay - 1.0).abs() < 1e-3, "{}", shifted.decay);
    // Scrambled, both are poor; once rebuilt they are as good as new.
    let mut scrambled = rest(&scene);
    scrambled.weights.iter_mut().for_each(|weights| weights[2] = 1.0);
    let rebuilt = move_to(&mut backend, &scene, &scrambled);
    assert_eq!((rebuilt.refitted, rebuilt.rebuilt, rebuilt.decay), (0, 2, 1.0));
    let again = move_to(&mut backend, &scene, &scrambled);
    assert_eq!((again.refitted, again.rebuilt, again.decay), (2, 0, 1.0));
    // The tree of the scrambled pose is poor for the one at rest, too.
    let back = move_to(&mut backend, &scene, &rest(&scene));
    assert_eq!((back.refitted, back.rebuilt), (0, 2));

    let mut backend = open(&context, &scene, TraceMode::Auto, updates(UpdatePolicy::Refit));
    let poor = move_to(&mut backend, &scene, &scrambled);
    println!("decay of a scrambled mesh: {}", poor.decay);
    assert_eq!((poor.refitted, poor.rebuilt), (2, 0));
    assert!(poor.decay > 3.0 && poor.decay < f32::MAX, "{}", poor.decay);
    assert_valid(&context);
}

/// A mesh that was built with all of it in one place says nothing about other poses.
#[test]
fn what_opens_from_a_point_is_built_anew() {
    let Some(context) = context() else { return };
    let mut closed = rest(&scene(8));
    closed.joints[0].fill(glam::Affine3A::from_scale(Vec3::ZERO));
    let [_, shut] = posed(&scene(8), &closed);
    let mut backend = open(&context, &shut, TraceMode::Auto, updates(UpdatePolicy::Auto));
    let still = move_to(&mut backend, &shut, &closed);
    assert_eq!((still.rebuilt, still.decay), (0, 1.0));
    let open = rest(&shut);
    assert_eq!(move_to(&mut backend, &shut, &open).rebuilt, 1);
    let rays = rays(&mut Random(11), 4000);
    let found = assert_same_hits(&backend, &fresh(&backend, &shut, &open), &rays, "open");
    assert!(found.iter().any(|hit| hit.is_hit() && hit.instance == 4));
    assert_valid(&context);
}

#[test]
fn a_cache_is_bounded_and_used() {
    let Some(context) = context() else { return };
    let scene = Arc::new(scene(16));
    let updates = Updates { policy: UpdatePolicy::Cache, poses: 3, ..Updates::default() };
    let mut random = Random(1);
    let mut backend = open(&context, &scene, TraceMode::Auto, updates);
    let mut scattered = rest(&scene);
    scattered.weights.iter_mut().for_each(|weights| weights[2] = 1.0);
    let first = move_to(&mut backend, &scene, &scattered);
    assert_eq!((first.refitted, first.rebuilt, first.kept), (0, 2, 4));
    // Both poses have their structure now.
    for pose in [rest(&scene), scattered.clone(), rest(&scene)] {
        let stats = move_to(&mut backend, &scene, &pose);
        assert_eq!((stats.refitted, stats.rebuilt, stats.kept, stats.decay), (2, 0, 4, 1.0));
        let rays = rays(&mut random, 2000);
        assert_same_hits(&backend, &fresh(&backend, &scene, &pose), &rays, "cached");
    }
    let mut live = None;
    for round in 0..20 {
        let pose = pose(&scene, &mut random, if round % 2 == 0 { 4.0 } else { 0.0 });
        let stats = move_to(&mut backend, &scene, &pose);
        assert!(stats.kept <= 6, "{stats:?}");
        let rays = rays(&mut random, 1000);
        assert_same_hits(&backend, &fresh(&backend, &scene, &pose), &rays, "cached");
        if stats.kept == 6 {
            let now = context.live();
            assert_eq!(*live.get_or_insert(now), now, "nothing more is kept");
        }
    }
    assert!(live.is_some());
    assert_valid(&context);
}

#[test]
fn cancelled_poses_leave_a_sound_backend() {
    let Some(context) = context() else { return };
    let scene = Arc::new(scene(8));
    let mut backend = open(&context, &scene, TraceMode::Auto, updates(UpdatePolicy::Cache));
    let mut random = Random(2);
    let rays = rays(&mut random, 1000);
    let first = pose(&scene, &mut random, 0.0);
    move_to(&mut backend, &scene, &first);
    let before = hits(&backend, &rays);
    let cancel = AtomicBool::new(true);
    let control = Control { cancel: &cancel, ..Control::default() };
    let second = pose(&scene, &mut random, 1.0);
    let [placed, _] = posed(&scene, &second);
    assert!(matches!(backend.pose(&placed, &second, &control), Err(VulkanError::Cancelled(_))));
    assert_eq!(hits(&backend, &rays), before);
    move_to(&mut backend, &scene, &second);
    assert_same_hits(&backend, &fresh(&backend, &scene, &second), &rays, "afterwards");
    assert_valid(&context);
}

/// Scenes whose rig bends nothing, or that have none.
#[test]
fn scenes_without_deformers_move() {
    let Some(context) = context() else { return };
    let mut rigid = scene(2);
    rigid.instances.truncate(2);
    let mut rig = rigid.rig.as_deref().cloned().expect("it moves");
    rig.deformers.clear();
    rig.instances.truncate(2);
    rigid.rig = Some(Arc::new(rig));
    let rays = rays(&mut Random(4), 2000);
    let mut backend = open(&context, &Arc::new(rigid.clone()), TraceMode::Auto, Updates::default());
    let mut moved = rest(&rigid);
    moved.world[BOX] = DAffine3::from_translation(DVec3::new(0.5, 0.2, -0.4));
    let stats = move_to(&mut backend, &rigid, &moved);
    assert_eq!((stats.refitted, stats.rebuilt, stats.kept, stats.decay), (0, 0, 0, 1.0));
    assert_same_hits(&backend, &fresh(&backend, &rigid, &moved), &rays, "rigid");
    let still = Arc::new(Scene { rig: None, ..rigid });
    let mut backend = open(&context, &still, TraceMode::Auto, Updates::default());
    backend.pose(&still, &Pose::default(), &Control::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_valid(&context);
}

/// Points of surfaces, where they were when the last frame was rendered.
#[test]
fn surfaces_know_where_they_were() {
    let Some(context) = context() else { return };
    let scene = Arc::new(scene(6));
    let settings = Settings { spp: 1, ..Settings::default() };
    let view = view(&settings, 8, 8);
    let mut backend = open(&context, &scene, TraceMode::Auto, Updates::default());
    let mut random = Random(21);
    let poses: Vec<_> = (0..4).map(|_| pose(&scene, &mut random, 0.3)).collect();
    let at = |pose: &Pose| posed(&scene, pose)[1].clone();
    let [a, b, c, d] = [&poses[0], &poses[1], &poses[2], &poses[3]].map(at);
    let render = |backend: &VulkanBackend| {
        backend.render(&settings, &view, Control::default()).unwrap_or_else(|error| panic!("{error}"));
    };
    check_previous(&backend, &scene, "nothing was rendered");
    move_to(&mut backend, &scene, &poses[0]);
    check_previous(&backend, &a, "no pose was rendered");
    render(&backend);
    check_previous(&backend, &a, "nothing moved since");
    move_to(&mut backend, &scene, &poses[1]);
    check_previous(&backend, &a, "moved once");
    move_to(&mut backend, &scene, &poses[2]);
    check_previous(&backend, &a, "the pose between was not rendered");
    render(&backend);
    check_previous(&backend, &c, "rendered again");
    render(&backend);
    check_previous(&backend, &c, "and again");
    move_to(&mut backend, &scene, &poses[3]);
    check_previous(&backend, &c, "moved again");
    render(&backend);
    check_previous(&backend, &d, "the last");
    move_to(&mut backend, &scene, &poses[1]);
    move_to(&mut backend, &scene, &poses[1]);
    check_previous(&backend, &d, "moved twice to the same place");
    render(&backend);
    check_previous(&backend, &b, "the end");
    assert_valid(&context);
}

/// Fails unless the shaders find all points where they are in `then`.
#[track_caller]
fn check_previous(backend: &VulkanBackend, then: &Scene, what: &str) {
    let settings = Settings::default();
    let functions = Functions::new(backend, &settings).unwrap_or_else(|error| panic!("{error}"));
    let mut random = Random(77);
    let (mut calls, mut expected) = (Vec::new(), Vec::new());
    for instance in 0..(then.instances.len() + then.shape_instances.len()) as u32 {
        for _ in 0..200 {
            let mut call = [0; layout::ARGUMENTS as usize];
            call[0] = instance;
            let (u, v) = (random.between(0.0, 0.5), random.between(0.0, 0.5));
            let point = random.vector(1.0).normalize() * 0.5;
            call[2..7].copy_from_slice(&[u, v, point.x, point.y, point.z].map(f32::to_bits));
            expected.push(match then.shape_instance(instance) {
                Some(shape) => {
                    let normal = normal_matrix(shape.world_from_object.matrix3) * Vec3A::from(point);
                    (shape.world_from_object.transform_point3(point), Vec3::from(normal))
                }
                None => {
                    let placed = &then.instances[instance as usize];
                    let mesh = &then.meshes[placed.mesh as usize];
                    let triangle = random.between(0.0, mesh.triangles.len() as f32) as u32;
                    call[1] = triangle;
                    let corners = mesh.triangles[triangle as usize].map(|i| i as usize);
                    let mean = |list: &[Vec3]| {
                        list[corners[0]] * (1.0 - u - v) + list[corners[1]] * u + list[corners[2]] * v
                    };
                    let normal =
                        normal_matrix(placed.world_from_object.matrix3) * Vec3A::from(mean(&mesh.normals));
                    (placed.world_from_object.transform_point3(mean(&mesh.positions)), Vec3::from(normal))
                }
            });
            calls.push(call);
        }
    }
    let found = functions.call(layout::FUNCTION_PREVIOUS, &view(&settings, 8, 8), &calls);
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    for ((call, values), (position, normal)) in calls.iter().zip(&found).zip(expected) {
        let values = values.map(f32::from_bits);
        let vector = |i: usize| Vec3::new(values[i], values[i + 1], values[i + 2]);
        let what = format!("{what}: instance {}, triangle {}", call[0], call[1]);
        assert!(vector(0).abs_diff_eq(position, 2e-5), "{what}: {} for {position}", vector(0));
        assert!(vector(3).abs_diff_eq(normal.normalize(), 2e-4), "{what}: {} for {normal}", vector(3));
    }
}
