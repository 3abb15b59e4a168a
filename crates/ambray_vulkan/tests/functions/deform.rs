//! Morph targets and skins: whole meshes, since the shader bends them vertex by vertex where the passes read them.

use std::sync::Arc;

use ambray_core::control::Control;
use ambray_scene::{
    Instance, Material, Mesh, Motion, Scene,
    animation::{Attachment, Deformer, Influence, LARGEST_COORDINATE, MorphTarget, Pose, Rig, Skin},
};
use ambray_vulkan::{DeviceKind, VulkanBackend, VulkanOptions};
use glam::{Affine3A, DAffine3, Mat3, Vec3, Vec4};

use crate::{common, compare::Comparison, random::Random};

const VERTICES: usize = 6000;
const JOINTS: usize = 12;

/// What a mesh has.
#[derive(Clone, Copy, Debug)]
struct Kind {
    normals: bool,
    tangents: bool,
    targets: usize,
    /// Influences of a vertex.
    influences: usize,
}

/// Vectors of every size, a few beyond what is allowed.
fn vectors(random: &mut Random, low: f32, high: f32) -> Vec<Vec3> {
    let number = |random: &mut Random| match random.below(12) {
        0 => 0.0,
        _ => random.signed(low, high),
    };
    (0..VERTICES).map(|_| Vec3::new(number(random), number(random), number(random))).collect()
}

fn deformer(random: &mut Random, kind: Kind) -> Deformer {
    let directions =
        |random: &mut Random| -> Vec<Vec3> { (0..VERTICES).map(|_| random.direction()).collect() };
    let some = |wanted: bool, list: Vec<Vec3>| if wanted { list } else { Vec::new() };
    let target = |random: &mut Random, i: usize| MorphTarget {
        positions: some(i % 4 != 1, vectors(random, -3.0, 2.0)),
        normals: some(i % 4 != 2, vectors(random, -3.0, 0.5)),
        tangents: some(i % 4 != 3, vectors(random, -3.0, 0.5)),
    };
    let influence = |random: &mut Random| Influence {
        joint: random.below(JOINTS) as u32,
        weight: if random.below(3) == 0 { 0.0 } else { random.between(0.0, 1.0) },
    };
    let mut influences: Vec<_> = (0..VERTICES * kind.influences).map(|_| influence(random)).collect();
    // Some vertices without any weight.
    for of_vertex in influences.chunks_mut(kind.influences.max(1)).step_by(17) {
        of_vertex.iter_mut().for_each(|influence| influence.weight = 0.0);
    }
    Deformer {
        skin: (kind.influences > 0).then_some(0),
        positions: vectors(random, -3.0, 3.0),
        normals: some(kind.normals, directions(random)),
        tangents: some(kind.tangents, directions(random))
            .into_iter()
            .map(|t| t.extend(if t.x < 0.0 { -1.0 } else { 1.0 }))
            .collect(),
        targets: (0..kind.targets).map(|i| target(random, i)).collect(),
        influences,
        influences_per_vertex: kind.influences,
        ..Deformer::default()
    }
}

/// A scene of one deforming mesh.
fn scene(deformer: Deformer) -> Scene {
    let mesh = Mesh {
        positions: deformer.positions.clone(),
        normals: deformer.normals.clone(),
        tangents: deformer.tangents.clone(),
        triangles: (0..VERTICES as u32 - 2).map(|i| [i, i + 1, i + 2]).collect(),
        ..Mesh::default()
    };
    let rig = Rig {
        skins: vec![Skin { joints: vec![0; JOINTS], inverse_binds: vec![DAffine3::IDENTITY; JOINTS] }],
        deformers: vec![deformer],
        instances: vec![Attachment { node: None, local: DAffine3::IDENTITY }],
        ..Rig::default()
    };
    Scene {
        meshes: vec![mesh.into()],
        instances: vec![Instance { motion: Motion::Deforming, ..Instance::default() }],
        materials: vec![Material::default()],
        rig: Some(Arc::new(rig)),
        ..Scene::default()
    }
}

fn joint(random: &mut Random, extreme: bool) -> Affine3A {
    let mut m = Mat3::from_cols(random.vector(-2.0, 2.0), random.vector(-2.0, 2.0), random.vector(-2.0, 2.0));
    match random.below(6) {
        // Singular: normals and tangents lose their directions in part, or altogether.
        0 => m.z_axis = m.x_axis,
        1 => m = Mat3::ZERO,
        _ => {}
    }
    let mut t = random.vector(-3.0, 3.0);
    if extreme {
        match random.below(4) {
            0 => t.x = f32::NAN,
            1 => t.y = f32::INFINITY,
            2 => t *= 1e12,
            _ => m *= 1e20,
        }
    }
    Affine3A::from_mat3_translation(m, t)
}

/// Devices that round as the standard says put every vertex where the host does, bit for bit: the shader lets nothing be
/// fused or reordered. Elsewhere ÷ and square roots may be off by some units of the last place.
#[test]
fn vertices_are_deformed_as_on_the_host() {
    let Some(context) = common::context() else { return };
    let is_exact = context.report().kind == DeviceKind::Software;
    let mut random = Random::new(41);
    let kind = |normals, tangents, targets, influences| Kind { normals, tangents, targets, influences };
    let kinds = [
        kind(true, true, 5, 0),
        kind(true, true, 0, 4),
        kind(true, false, 3, 8),
        kind(false, true, 1, 4),
        kind(false, false, 2, 4),
        kind(true, true, 0, 0),
    ];
    let names = ["deformed positions", "deformed normals", "deformed tangents"];
    let mut values = names.map(Comparison::new);
    for kind in kinds {
        let scene = Arc::new(scene(deformer(&mut random, kind)));
        let deformer = &scene.rig.as_ref().expect("just made").deformers[0];
        let mut backend = VulkanBackend::new(&context, &scene, VulkanOptions::default(), &Control::default())
            .unwrap_or_else(|error| panic!("{error}"));
        for round in 0..4 {
            let weight = |random: &mut Random, i: usize| {
                if (i + round).is_multiple_of(3) { 0.0 } else { random.between(-2.0, 2.0) }
            };
            let weights: Vec<f32> = (0..kind.targets).map(|i| weight(&mut random, i)).collect();
            let joints: Vec<_> = (0..JOINTS).map(|_| joint(&mut random, round == 3)).collect();
            let pose = Pose { world: Vec::new(), joints: vec![joints], weights: vec![weights] };
            backend.pose(&scene, &pose, &Control::default()).unwrap_or_else(|error| panic!("{error}"));
            let (positions, normals, tangents) =
                backend.vertices(0).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(positions.len(), VERTICES);
            assert_eq!((normals.is_empty(), tangents.is_empty()), (!kind.normals, !kind.tangents));
            let joints = if kind.influences > 0 { &pose.joints[0][..] } else { &[] };
            for i in 0..VERTICES {
                let expected = deformer.vertex(i, &pose.weights[0], joints);
                let what = || format!("vertex {i} of {kind:?}, pose {round}: {expected:?}");
                assert!(positions[i].abs().max_element() <= LARGEST_COORDINATE, "{}", what());
                let scale = expected.position.abs().max_element().max(1.0);
                values[0].add_vector(expected.position, positions[i], scale, what);
                if kind.normals {
                    values[1].add_vector(expected.normal, normals[i], 1.0, what);
                }
                if kind.tangents {
                    values[2].add_vector(expected.tangent.truncate(), tangents[i].truncate(), 1.0, what);
                    assert_eq!(Vec4::W * expected.tangent.w, Vec4::W * tangents[i].w, "{}", what());
                }
            }
        }
    }
    for values in values {
        values.finish(if is_exact { 0.0 } else { 64.0 });
    }
    common::assert_valid(&context);
}
