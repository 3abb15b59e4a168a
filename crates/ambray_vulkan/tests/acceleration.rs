//! Acceleration structures of whole scenes on whatever device there is.

mod common;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ambray_core::camera::{Camera, Projection};
use ambray_core::control::Control;
use ambray_core::shape::Shape;
use ambray_scene::surface::Surfaces;
use ambray_scene::{Instance, Material, Mesh, Motion, Scene, ShapeInstance};
use ambray_vulkan::{
    Acceleration, AccelerationOptions, Context, Culling, GeometryKind, Grouping, Live, TopLevel, VulkanError,
};
use common::{assert_valid, context};
use glam::{Affine3A, Quat, Vec3};

/// Every triangle and shape that rays can hit, with how often it is to be found.
type Census = BTreeMap<[u32; 2], u32>;

fn is_hittable(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    corners.iter().all(|p| p.is_finite() && p.abs().max_element() <= 1e12)
        && (b - a).cross(c - a) != glam::DVec3::ZERO
}

fn expected(scene: &Scene) -> Census {
    let mut census = Census::new();
    for (i, instance) in (0_u32..).zip(&scene.instances) {
        let mesh = &scene.meshes[instance.mesh as usize];
        for triangle in 0..mesh.triangles.len() as u32 {
            let world = mesh.corners(triangle).map(|p| instance.world_from_object.transform_point3(p));
            if is_hittable(world) {
                census.insert([i, triangle], 1);
            }
        }
    }
    let shapes = 0..scene.shape_instances.len() as u32;
    census.extend(shapes.map(|i| ([scene.instances.len() as u32 + i, 0], 1)));
    census
}

fn found(acceleration: &Acceleration) -> Census {
    let refs = acceleration.refs();
    let mut starts: Vec<_> = acceleration.placements().iter().map(|p| p.first_ref as usize).collect();
    starts.push(refs.len());
    starts.sort_unstable();
    let mut census = Census::new();
    for placement in acceleration.placements() {
        let start = placement.first_ref as usize;
        let end = *starts.iter().find(|&&s| s > start).expect("the end is behind all");
        for &[instance, triangle] in &refs[start..end] {
            assert!((instance == u32::MAX) != (placement.instance == u32::MAX));
            *census.entry([instance.min(placement.instance), triangle]).or_default() += 1;
        }
    }
    census
}

fn build(context: &Arc<Context>, scene: &Scene, options: AccelerationOptions) -> Acceleration {
    let surfaces = Surfaces::new(Arc::new(scene.clone()));
    let opaque: Vec<_> = (0..scene.meshes.len() as u32).map(|m| surfaces.is_opaque(m)).collect();
    let acceleration = Acceleration::build(context, scene, &opaque, &options, &Control::default()).unwrap();
    for placement in acceleration.placements() {
        let start = placement.first_ref as usize;
        let [of_ref, triangle] = acceleration.refs()[start];
        let instance = of_ref.min(placement.instance);
        let kind = match scene.instances.get(instance as usize) {
            None => GeometryKind::Shape,
            Some(i) if opaque[i.mesh as usize] => GeometryKind::Opaque,
            Some(_) => GeometryKind::Masked,
        };
        assert_eq!(placement.kind, kind, "instance {instance}, triangle {triangle}");
    }
    acceleration
}

/// Builds the top level twice, as two frames would; returns its number of entries.
fn top_level(context: &Arc<Context>, acceleration: &Acceleration, culling: Option<&Culling<'_>>) -> u32 {
    let mut top = TopLevel::new(context, acceleration).unwrap();
    let mut frame = || context.run(|recorder| Ok(top.build(recorder, acceleration, culling))).unwrap();
    let count = frame();
    assert_eq!(frame(), count);
    count
}

fn check_all(context: &Arc<Context>, scene: &Scene) -> Vec<Acceleration> {
    let choices = [
        AccelerationOptions::default(),
        AccelerationOptions { copy_budget: 0, compact: false, ..AccelerationOptions::default() },
        AccelerationOptions { copy_budget: 0, batch: 10_000, ..AccelerationOptions::default() },
        AccelerationOptions { grouping: Grouping::PerMesh, ..AccelerationOptions::default() },
        AccelerationOptions { grouping: Grouping::Single, ..AccelerationOptions::default() },
    ];
    let want = expected(scene);
    let all: Vec<_> = choices.into_iter().map(|options| build(context, scene, options)).collect();
    for (acceleration, options) in all.iter().zip(choices) {
        assert!(found(acceleration) == want, "{}: {options:?}", scene.name);
        let stats = acceleration.stats();
        println!("{}: {options:?}\n  {stats:?}", scene.name);
        assert_eq!(stats.triangles + stats.boxes, acceleration.refs().len() as u64);
        assert_eq!(stats.by_kind.iter().sum::<usize>(), stats.structures);
        assert!(stats.bytes <= stats.bytes_before);
        assert_eq!(top_level(context, acceleration, None) as usize, stats.placements);
    }
    all
}

/// A bumpy square of 2 × `n` × `n` triangles.
fn square(name: &str, n: u32) -> Mesh {
    let point = |i: u32| {
        let (x, z) = ((i % (n + 1)) as f32 / n as f32, (i / (n + 1)) as f32 / n as f32);
        Vec3::new(x - 0.5, 0.1 * (9.0 * x).sin() * (7.0 * z).cos(), z - 0.5)
    };
    let cell = |i: u32| {
        let at = i / n * (n + 1) + i % n;
        [[at, at + 1, at + n + 1], [at + 1, at + n + 2, at + n + 1]]
    };
    Mesh {
        name: name.into(),
        positions: (0..(n + 1) * (n + 1)).map(point).collect(),
        triangles: (0..n * n).flat_map(cell).collect(),
        ..Mesh::default()
    }
}

/// Meshes once, often, moving and broken, and shapes that stay and that move.
fn motley() -> Scene {
    let mut broken = square("broken", 8);
    broken.positions.extend([Vec3::splat(1e20), Vec3::ZERO, Vec3::X, 2.0 * Vec3::X]);
    broken.triangles.extend([[0, 1, 81], [3, 3, 4], [82, 83, 84]]);
    let masked = Mesh { material: 1, ..square("masked", 4) };
    let mut scene = Scene {
        name: "motley".into(),
        meshes: [square("once", 20), square("often", 6), broken, masked, square("deforming", 5)]
            .map(Arc::new)
            .into(),
        materials: vec![
            Material::default(),
            Material { alpha_mode: ambray_scene::AlphaMode::Mask(2.0), ..Material::default() },
        ],
        shapes: vec![Shape::Sphere { radius: 0.5 }, Shape::Box { half_extents: Vec3::new(0.1, 1.0, 0.2) }],
        ..Scene::default()
    };
    let mut add = |mesh: u32, at: Vec3, motion: Motion| {
        let turn = Quat::from_rotation_y(at.x + at.z);
        let world_from_object = Affine3A::from_rotation_translation(turn, at);
        scene.instances.push(Instance { mesh, world_from_object, motion });
    };
    add(0, Vec3::ZERO, Motion::Static);
    add(2, Vec3::Y, Motion::Static);
    add(3, Vec3::new(0.0, 2.0, 0.0), Motion::Static);
    add(3, Vec3::new(3.0, 2.0, 0.0), Motion::Rigid);
    add(4, Vec3::new(0.0, 3.0, 0.0), Motion::Deforming);
    for i in 0..500_u32 {
        let motion = if i % 100 == 0 { Motion::Rigid } else { Motion::Static };
        add(1, Vec3::new((i % 25) as f32, -1.0, (i / 25) as f32), motion);
    }
    for i in 0..40_u32 {
        let at = Vec3::new((i % 8) as f32, 5.0, (i / 8) as f32);
        let motion = if i % 10 == 3 { Motion::Rigid } else { Motion::Static };
        let world_from_object = Affine3A::from_translation(at);
        scene.shape_instances.push(ShapeInstance {
            shape: i % 2,
            material: u32::from(i % 5 == 0),
            world_from_object,
            motion,
        });
    }
    scene
}

#[test]
fn the_atrium_is_found_completely() {
    let Some(context) = context() else { return };
    let all = check_all(&context, &ambray_scene::atrium::atrium());
    assert_eq!(all[0].stats().dropped, 0);
    assert!(context.live().acceleration_structures > 4);
    drop(all);
    assert_eq!(context.live(), Live::default());
    assert_valid(&context);
}

#[test]
fn a_motley_scene_is_found_completely() {
    let Some(context) = context() else { return };
    let scene = motley();
    let all = check_all(&context, &scene);
    assert!(all.iter().all(|a| a.stats().dropped == 3));
    // Copied or not, what moves is placed by itself.
    for acceleration in &all {
        let moving = |i: u32| match scene.shape_instance(i) {
            Some(shape) => shape.motion != Motion::Static,
            None => scene.instances[i as usize].motion != Motion::Static,
        };
        let alone = acceleration.placements().iter().filter(|p| p.instance != u32::MAX && moving(p.instance));
        assert_eq!(alone.count(), 1 + 1 + 5 + 4);
    }
    drop(all);
    assert_eq!(context.live(), Live::default());
    assert_valid(&context);
}

#[test]
fn nothing_is_a_scene_too() {
    let Some(context) = context() else { return };
    for acceleration in check_all(&context, &Scene::default()) {
        assert_eq!(acceleration.stats().structures, 0);
    }
    // Only triangles that no ray can hit.
    let mut broken = square("broken", 1);
    broken.positions.fill(Vec3::ONE);
    let scene = Scene {
        meshes: vec![broken.into()],
        instances: vec![Instance::default(); 3],
        materials: vec![Material::default()],
        ..Scene::default()
    };
    assert!(check_all(&context, &scene).iter().all(|a| a.placements().is_empty()));
    assert_eq!(context.live(), Live::default());
    assert_valid(&context);
}

#[test]
fn views_leave_out_what_no_ray_can_meet() {
    let Some(context) = context() else { return };
    let options = AccelerationOptions { copy_budget: 0, ..AccelerationOptions::default() };
    let acceleration = build(&context, &motley(), options);
    let all = acceleration.placements().len() as u32;
    let projection = Projection::Perspective { vertical_fov: 0.6 };
    let camera = Camera::new(Vec3::new(30.0, 0.0, 10.0), Vec3::X, Vec3::Y, projection, 64, 36);
    let count = |reach: f32, has_lights: bool| {
        top_level(&context, &acceleration, Some(&Culling { camera: &camera, reach, has_lights }))
    };
    // All is behind the camera: only what visible points could reach, and what could cast shadows.
    assert_eq!(count(1.0, false), 0);
    assert_eq!(count(f32::INFINITY, false), all);
    assert_eq!(count(1.0, true), all);
    let some = count(10.0, false);
    assert!(0 < some && some < all / 2, "{some} of {all}");
    assert_valid(&context);
}

#[test]
fn moving_instances_are_placed_anew() {
    let Some(context) = context() else { return };
    let mut scene = motley();
    let mut acceleration = build(&context, &scene, AccelerationOptions::default());
    let index = acceleration.placements().iter().position(|p| p.instance == 3).unwrap();
    scene.instances[3].world_from_object = Affine3A::from_translation(Vec3::splat(100.0));
    acceleration.move_to(&scene);
    let bounds = acceleration.boxes().nth(index).unwrap().unwrap();
    assert!(bounds.lo.cmpge(Vec3::splat(99.0)).all() && bounds.hi.cmple(Vec3::splat(101.0)).all());
    // Shrunk to nothing it is left out, and comes back.
    let all = acceleration.placements().len() as u32;
    scene.instances[3].world_from_object = Affine3A::from_scale(Vec3::ZERO);
    acceleration.move_to(&scene);
    assert_eq!(top_level(&context, &acceleration, None), all - 1);
    scene.instances[3].world_from_object = Affine3A::IDENTITY;
    acceleration.move_to(&scene);
    assert_eq!(top_level(&context, &acceleration, None), all);
    assert_valid(&context);
}

#[test]
fn building_can_be_stopped() {
    let Some(context) = context() else { return };
    let cancel = AtomicBool::new(true);
    let control = Control { cancel: &cancel, ..Control::default() };
    let scene = Scene::default();
    let result = Acceleration::build(&context, &scene, &[], &AccelerationOptions::default(), &control);
    assert!(matches!(result, Err(VulkanError::Cancelled(_))));
}
