//! Poses that a person can work out.

use ambray_core::light::Light;
use ambray_scene::animation::{Clips, Moment};
use ambray_scene::{Motion, Scene};
use glam::{DQuat, DVec3, Vec3};

use crate::common::{self, load_shared, load_text};
use crate::files::{Data, TRIANGLE, gltf};

/// The scene at `time` of clip `clip`.
fn at(scene: &Scene, clip: usize, time: f64) -> Scene {
    let mut moved = scene.clone();
    let rig = scene.rig.as_ref().expect("a rig");
    let pose = rig.pose(Some(&Moment { clips: Clips::One(clip), time, repeat: false }));
    moved.place(&pose);
    moved.deform(&pose);
    moved
}

/// World positions of all vertices of all instances.
fn points(scene: &Scene) -> Vec<Vec3> {
    let of = |i: &ambray_scene::Instance| {
        let m = i.world_from_object;
        scene.meshes[i.mesh as usize]
            .positions
            .iter()
            .map(move |&p| m.transform_point3(p))
            .collect::<Vec<_>>()
    };
    scene.instances.iter().flat_map(of).collect()
}

#[track_caller]
fn assert_points(scene: &Scene, expected: &[[f32; 3]]) {
    let found = points(scene);
    let near = |(a, b): (&Vec3, &[f32; 3])| a.abs_diff_eq(Vec3::from(*b), 1e-5);
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(near), "{found:?}");
}

#[test]
fn interpolation_test() {
    let Some(folder) = common::scenes() else { return };
    let scene = load_shared(&folder, "InterpolationTest/glTF-Binary/InterpolationTest.glb").scene;
    let rig = scene.rig.expect("a rig");
    assert_eq!(rig.clips.len(), 9);
    let world = |clip: &str, node: &str, time: f64| {
        let clips = Clips::One(rig.clip(clip).expect("a clip of that name"));
        let node = rig.nodes.iter().position(|n| n.name == node).expect("a node of that name");
        rig.pose(Some(&Moment { clips, time, repeat: false })).world[node]
    };
    // Keyframes at 10/24 s and 21/24 s: 0.5 and 1.
    let time = |share: f64| (10.0 + 11.0 * share) / 24.0;
    for (clip, node, expected) in [
        ("Step Scale", "Cube", [0.5, 0.5, 0.5]),
        ("Linear Scale", "Cube.001", [0.625, 0.75, 0.875]),
        // Flat tangents: 0.5 + (3t² − 2t³) / 2.
        ("CubicSpline Scale", "Cube.002", [0.578_125, 0.75, 0.921_875]),
    ] {
        for (share, expected) in [0.25, 0.5, 0.75].into_iter().zip(expected) {
            let size = world(clip, node, time(share)).matrix3.x_axis.length();
            assert!((size - expected).abs() < 1e-6, "{clip} {share}: {size}");
        }
    }
    // From 0 to 45° and on to 90° and 135° about −z, keyframes at 10/24, 21/24 and 30/24 s.
    let angle = |clip: &str, node: &str, time: f64| {
        let x = world(clip, node, time).matrix3.x_axis;
        (-x.y).atan2(x.x).to_degrees()
    };
    for (clip, node, share, expected) in [
        ("Step Rotation", "Cube.003", 0.5, 45.0),
        ("Linear Rotation", "Cube.005", 0.0, 45.0),
        ("Linear Rotation", "Cube.005", 0.5, 67.5),
        ("Linear Rotation", "Cube.005", 1.0, 90.0),
    ] {
        let found = angle(clip, node, time(share));
        assert!((found - expected).abs() < 1e-3, "{clip} {share}: {found}");
    }
    // Up to 10 at 10/24 s and down to 6 at 20/24 s.
    let height = |clip: &str, node: &str, time: f64| world(clip, node, time).translation.y;
    for (clip, node, expected) in [
        ("Linear Translation", "Cube.009", 9.0),
        ("CubicSpline Translation", "Cube.008", 10.0 - 4.0 * 0.15625),
    ] {
        let found = height(clip, node, 12.5 / 24.0);
        assert!((found - expected).abs() < 1e-5, "{clip}: {found}");
    }
}

#[test]
fn a_triangle_turns_once_a_second() {
    let Some(folder) = common::scenes() else { return };
    let scene = load_shared(&folder, "AnimatedTriangle/glTF/AnimatedTriangle.gltf").scene;
    for k in 0..=16 {
        let turn = f64::from(k) / 16.0;
        let placed = at(&scene, 0, turn).instances[0].world_from_object;
        let expected = DQuat::from_rotation_z(turn * std::f64::consts::TAU) * DVec3::X;
        // The quaternions of the file have three digits.
        let found = placed.transform_vector3(Vec3::X).as_dvec3();
        assert!(found.abs_diff_eq(expected, 1e-3), "{turn}: {found}");
    }
}

/// Times 0 and 1, and a channel for accessor `output` from them.
fn animation(channels: &[(usize, &str, usize)]) -> String {
    let channel = |(i, (node, path, _)): (usize, &(usize, &str, usize))| {
        format!(r#"{{"sampler":{i},"target":{{"node":{node},"path":"{path}"}}}}"#)
    };
    let sampler = |(_, _, output): &(usize, &str, usize)| format!(r#"{{"input":1,"output":{output}}}"#);
    let channels_text: Vec<_> = channels.iter().enumerate().map(channel).collect();
    let samplers: Vec<_> = channels.iter().map(sampler).collect();
    let (channels, samplers) = (channels_text.join(","), samplers.join(","));
    format!(r#""animations":[{{"channels":[{channels}],"samplers":[{samplers}]}}]"#)
}

const TIMES: Data<'_> = Data::Scalars(&[0.0, 1.0]);
const UP: Data<'_> = Data::Vec3s(&[[0.0; 3], [0.0, 2.0, 0.0]]);

#[test]
fn what_is_hidden_at_rest_may_appear() {
    let grow = Data::Vec3s(&[[0.0; 3], [2.0; 3]]);
    let rest = r#""meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "extensions":{"KHR_implicit_shapes":{"shapes":[{"type":"sphere"}]}},
        "nodes":[{"mesh":0,"scale":[0,0,0],"extensions":{"AMBRAY_implicit_surface":{"shape":0}}},
            {"mesh":0,"scale":[0,0,0]},
            {"mesh":0,"translation":[1e300,0,0]}],"#;
    let text = gltf(
        &[TRIANGLE, TIMES, grow, UP],
        &format!("{rest}{}", animation(&[(0, "scale", 2), (2, "translation", 3)])),
    );
    let loaded = load_text(&text);
    assert_eq!(loaded.warnings, ["instances whose transform is singular or not finite are dropped (1)"]);
    let scene = loaded.scene;
    assert_eq!((scene.instances.len(), scene.shape_instances.len()), (2, 1));
    assert!(scene.instances.iter().all(|i| i.motion == Motion::Rigid && i.world_from_object.is_finite()));
    assert_eq!(scene.bounds(), Some((Vec3::ZERO, Vec3::ZERO)));
    let moved = at(&scene, 0, 0.5);
    assert_eq!(moved.instances[0].world_from_object.transform_point3(Vec3::X), Vec3::X);
    assert_eq!(moved.instances[1].world_from_object.transform_point3(Vec3::X), Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(moved.shape_instances[0].world_from_object, moved.instances[0].world_from_object);
    let back = at(&moved, 0, 0.0);
    assert_eq!(back.instances[0], scene.instances[0]);
}

#[test]
fn cameras_lights_and_instances_follow_their_nodes() {
    let quarter = std::f32::consts::FRAC_1_SQRT_2;
    let turn = Data::Vec4s(&[[0.0, 0.0, 0.0, 1.0], [0.0, quarter, 0.0, quarter]]);
    let offsets = Data::Vec3s(&[[1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]);
    let rest = r#""meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "cameras":[{"type":"perspective","perspective":{"yfov":1}}],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"directional"},{"type":"spot","spot":{}}]}},
        "nodes":[{"children":[1,2,3,4]},
            {"camera":0,"translation":[0,0,-1]},
            {"extensions":{"KHR_lights_punctual":{"light":0}}},
            {"translation":[0,0,-2],"extensions":{"KHR_lights_punctual":{"light":1}}},
            {"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":3}}}}],"#;
    let text =
        gltf(&[TRIANGLE, TIMES, turn, offsets], &format!("{rest}{}", animation(&[(0, "rotation", 2)])));
    let scene = load_text(&text).scene;
    let moved = at(&scene, 0, 1.0);
    // A quarter turn about y takes −z to −x and x to −z.
    let camera = &moved.cameras[0];
    assert!(camera.position.abs_diff_eq(Vec3::NEG_X, 1e-6) && camera.forward.abs_diff_eq(Vec3::NEG_X, 1e-6));
    assert!(camera.up.abs_diff_eq(Vec3::Y, 1e-6));
    let Light::Directional { to_light, .. } = moved.lights[0] else { panic!("{:?}", moved.lights[0]) };
    assert!(to_light.abs_diff_eq(Vec3::X, 1e-6), "{to_light}");
    let Light::Point { position, cone: Some(cone), .. } = moved.lights[1] else { panic!("a spot light") };
    assert!(position.abs_diff_eq(Vec3::NEG_X * 2.0, 1e-6) && cone.axis.abs_diff_eq(Vec3::NEG_X, 1e-6));
    assert_points(
        &moved,
        &[
            [0.0, 0.0, -1.0],
            [0.0, 0.0, -2.0],
            [0.0, 1.0, -1.0],
            [0.0, 0.0, -3.0],
            [0.0, 0.0, -4.0],
            [0.0, 1.0, -3.0],
        ],
    );
}

#[test]
fn skeletons_within_skeletons() {
    // Node 0 is a joint that carries a plain triangle, and the skinned one, whose node is a child of its joint. Node 3, a
    // joint outside of the scene that is shown, pulls half of one corner.
    let joints = Data::Joints(&[[0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0]]);
    let weights = Data::Vec4s(&[[1.0, 0.0, 0.0, 0.0], [0.25, 0.25, 0.0, 0.0], [0.0; 4]]);
    let rest = r#""meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},
            {"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4}}]}],
        "skins":[{"joints":[0,3]}],
        "scenes":[{"nodes":[0]}],
        "nodes":[{"mesh":0,"children":[1]},{"children":[2],"translation":[50,0,0]},
            {"mesh":1,"skin":0,"scale":[9,9,9]},{"translation":[0,0,4]}],"#;
    let accessors = [TRIANGLE, TIMES, UP, joints, weights];
    let text = gltf(&accessors, &format!("{rest}{}", animation(&[(0, "translation", 2)])));
    let scene = load_text(&text).scene;
    let rig = scene.rig.clone().expect("a rig");
    assert_eq!((rig.skins.len(), rig.deformers.len(), rig.nodes.len()), (1, 1, 4));
    assert_eq!((rig.instances[0].node, rig.instances[1].node), (Some(0), None));
    let motions: Vec<_> = scene.instances.iter().map(|i| i.motion).collect();
    assert_eq!(motions, [Motion::Rigid, Motion::Deforming]);
    assert!(scene.meshes[1].normals.is_empty(), "flat shading");
    let plain = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let skinned = [[0.0, 0.0, 0.0], [1.0, 0.0, 2.0], [0.0, 1.0, 0.0]];
    assert_points(&scene, &[plain, skinned].concat());
    let plain = [[0.0, 2.0, 0.0], [1.0, 2.0, 0.0], [0.0, 3.0, 0.0]];
    let skinned = [[0.0, 2.0, 0.0], [1.0, 1.0, 2.0], [0.0, 3.0, 0.0]];
    assert_points(&at(&scene, 0, 1.0), &[plain, skinned].concat());
}

#[test]
fn nodes_that_share_a_mesh_and_a_skin_deform_on_their_own() {
    // Two nodes morph one mesh by weights of their own, two more are skinned by one skin, with eight influences a vertex.
    let joints = Data::Joints(&[[0, 0, 0, 0]; 3]);
    let quarter = Data::Vec4s(&[[0.25, 0.0, 0.0, 0.0]; 3]);
    let weights = Data::Scalars(&[0.0, 1.0]);
    let rest = r#""meshes":[{"weights":[0.5],"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":0}]}]},
            {"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":4,"WEIGHTS_0":5,"JOINTS_1":4,"WEIGHTS_1":5}}]}],
        "skins":[{"joints":[4]}],
        "nodes":[{"mesh":0},{"mesh":0,"weights":[1]},{"mesh":1,"skin":0},{"mesh":1,"skin":0},{}],"#;
    let accessors = [TRIANGLE, TIMES, weights, UP, joints, quarter];
    let channels = [(0, "weights", 2), (4, "translation", 3)];
    let scene = load_text(&gltf(&accessors, &format!("{rest}{}", animation(&channels)))).scene;
    let rig = scene.rig.clone().expect("a rig");
    assert_eq!((rig.skins.len(), rig.deformers.len()), (1, 3), "node 1 is posed for good");
    assert_eq!(rig.deformers[1].influences_per_vertex, 8);
    let triangle = |scale: f32, up: f32| [[0.0, up, 0.0], [scale, up, 0.0], [0.0, scale + up, 0.0]];
    assert_points(
        &scene,
        &[triangle(1.5, 0.0), triangle(2.0, 0.0), triangle(1.0, 0.0), triangle(1.0, 0.0)].concat(),
    );
    let moved = at(&scene, 0, 1.0);
    assert_points(
        &moved,
        &[triangle(2.0, 0.0), triangle(2.0, 0.0), triangle(1.0, 2.0), triangle(1.0, 2.0)].concat(),
    );
    assert!(std::sync::Arc::ptr_eq(&scene.meshes[1], &moved.meshes[1]), "what does not deform is shared");
}
