//! Animations that are refused, each with one line that names the place, and those that are ignored.

use crate::common::{assert_refused, load_text};
use crate::files::{Data, TRIANGLE, gltf};
use ambray_scene::Loaded;
use ambray_scene::animation::{Interpolation, Property};

const NAN: f32 = f32::NAN;
const TIMES: usize = 1;
const UNSORTED: usize = 2;
const NEGATIVE: usize = 3;
const NO_NUMBER: usize = 4;
const PLACES: usize = 5;
const INFINITE: usize = 6;
const TURNS: usize = 7;
const NO_TURN: usize = 8;
const WEIGHTS: usize = 9;
const NINE: usize = 10;
const MANY: usize = 11;
const MANY_PLACES: usize = 12;
const NONE: usize = 13;
const BYTES: usize = 14;

/// A file with those accessors, four nodes (plain, with a morph target, with a matrix that shears, with one that does not)
/// and `animations`.
fn file(animations: &str) -> String {
    let rest = format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}},
            {{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{{"POSITION":0}}]}}]}}],
        "nodes":[{{"mesh":0}},{{"mesh":1}},
            {{"mesh":0,"matrix":[1,0,0,0, 0.5,1,0,0, 0,0,1,0, 0,0,0,1]}},
            {{"mesh":0,"matrix":[2,0,0,0, 0,2,0,0, 0,0,2,0, 5,6,7,1]}}],
        "animations":{animations}"#
    );
    let identity = [0.0, 0.0, 0.0, 1.0];
    let accessors = [
        TRIANGLE,
        Data::Scalars(&[0.0, 1.0, 2.0]),
        Data::Scalars(&[0.0, 2.0, 2.0]),
        Data::Scalars(&[-1.0, 1.0, 2.0]),
        Data::Scalars(&[0.0, NAN, 2.0]),
        Data::Vec3s(&[[0.0; 3], [1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]),
        Data::Vec3s(&[[0.0; 3], [1.0, f32::INFINITY, 3.0], [4.0, 5.0, 6.0]]),
        Data::Vec4s(&[identity, [0.0, 0.0, 1.0, 1.0], identity]),
        Data::Vec4s(&[identity, [0.0; 4], identity]),
        Data::Scalars(&[0.0, 0.5, 1.0]),
        Data::Vec3s(&[[0.0; 3]; 9]),
        Data::Zeros(4_000_000_000, "SCALAR"),
        Data::Zeros(4_000_000_000, "VEC3"),
        Data::Zeros(0, "SCALAR"),
        Data::Bytes(&[[0, 0, 0, 127], [0, 0, 127, 127], [0, -128, 0, 0]]),
    ];
    gltf(&accessors, &rest)
}

/// One animation with one channel that moves `path` of `node` by a sampler.
fn one(node: usize, path: &str, input: usize, output: usize, interpolation: &str) -> String {
    file(&format!(
        r#"[{{"channels":[{{"sampler":0,"target":{{"node":{node},"path":"{path}"}}}}],
        "samplers":[{{"input":{input},"output":{output},"interpolation":"{interpolation}"}}]}}]"#
    ))
}

#[test]
fn references_lead_somewhere() {
    assert_refused(
        &one(9, "translation", TIMES, PLACES, "LINEAR"),
        "x.gltf: animations[0].channels[0].target.node: node 9 does not exist",
    );
    assert_refused(
        &one(0, "translation", 99, PLACES, "LINEAR"),
        "x.gltf: animations[0].samplers[0].input: accessor 99 does not exist",
    );
    assert_refused(
        &one(0, "translation", TIMES, 99, "LINEAR"),
        "x.gltf: animations[0].samplers[0].output: accessor 99 does not exist",
    );
    // Even of channels that are ignored.
    let unknown = r#"[{},{"channels":[{"sampler":1,"target":{"path":"pointer"}}],"samplers":[{"input":1,"output":1}]}]"#;
    assert_refused(&file(unknown), "x.gltf: animations[1].channels[0].sampler: sampler 1 does not exist");
}

#[test]
fn keyframes_are_in_order() {
    let refused = |input: usize, reason: &str| {
        let expected = format!("x.gltf: animations[0].samplers[0].input: {reason}");
        assert_refused(&one(0, "translation", input, PLACES, "STEP"), &expected);
    };
    refused(UNSORTED, "accessor 2: keyframe 2 at 2 s does not come after the one before");
    refused(NEGATIVE, "accessor 3: keyframe 0 at -1 s is not at a time from 0 on");
    refused(NO_NUMBER, "accessor 4: keyframe 1 at NaN s is not at a time from 0 on");
    refused(NONE, "no keyframes");
    assert_refused(
        &one(0, "translation", BYTES, PLACES, "STEP"),
        "x.gltf: accessors[14].type: 'VEC4' where SCALAR is needed",
    );
}

#[test]
fn values_fit_their_keyframes() {
    let refused = |path: &str, output: usize, interpolation: &str, reason: &str| {
        let expected = format!("x.gltf: animations[0].samplers[0].{reason}");
        assert_refused(&one(1, path, TIMES, output, interpolation), &expected);
    };
    refused("translation", NINE, "LINEAR", "output: 9 elements, 3 keyframes need 3");
    refused("translation", PLACES, "CUBICSPLINE", "output: 3 elements, 3 keyframes need 9");
    refused("weights", NINE, "LINEAR", "output: 9 elements, 3 keyframes need 3");
    refused("scale", INFINITE, "LINEAR", "output: keyframe 1: beyond the range of numbers");
    refused("rotation", NO_TURN, "LINEAR", "output: keyframe 1: quaternion of length zero");
    refused("scale", PLACES, "CUBIC", "interpolation: no such interpolation: 'CUBIC'");
    assert_refused(
        &one(0, "rotation", TIMES, PLACES, "LINEAR"),
        "x.gltf: accessors[5].type: 'VEC3' where VEC4 is needed",
    );
}

#[test]
fn huge_counts_are_refused_before_anything_is_read() {
    assert_refused(
        &one(0, "translation", MANY, MANY_PLACES, "LINEAR"),
        "x.gltf: accessors[11].count: the file expands to more vertex data than its size allows",
    );
    assert_refused(
        &one(0, "translation", MANY, MANY_PLACES, "CUBICSPLINE"),
        "x.gltf: animations[0].samplers[0].output: 4000000000 elements, 4000000000 keyframes need 12000000000",
    );
}

#[test]
fn two_channels_cannot_move_the_same() {
    let channel = r#"{"sampler":0,"target":{"node":0,"path":"translation"}}"#;
    let animation =
        format!(r#"[{{"channels":[{channel},{channel}],"samplers":[{{"input":1,"output":5}}]}}]"#);
    assert_refused(
        &file(&animation),
        "x.gltf: animations[0].channels[1].target: another channel of this animation moves the same",
    );
    // Two animations can.
    let animation = format!(r#"{{"channels":[{channel}],"samplers":[{{"input":1,"output":5}}]}}"#);
    let scene = load_text(&file(&format!("[{animation},{animation}]"))).scene;
    assert_eq!(scene.rig.expect("a rig").clips.len(), 2);
}

#[test]
fn what_lacks_a_part_is_refused() {
    let text = file(r#"[{"channels":[{"target":{"node":0,"path":"scale"}}],"samplers":[]}]"#);
    let error =
        crate::common::load_files(&[("x.gltf", text.as_bytes())]).expect_err("no sampler").to_string();
    assert!(error.contains("animations[0].channels[0]") && error.contains("`sampler`"), "{error}");
    let text =
        file(r#"[{"channels":[{"sampler":0,"target":{"node":0}}],"samplers":[{"input":1,"output":5}]}]"#);
    let error = crate::common::load_files(&[("x.gltf", text.as_bytes())]).expect_err("no path").to_string();
    assert!(error.contains("animations[0].channels[0].target") && error.contains("`path`"), "{error}");
}

#[test]
fn what_is_ignored() {
    let check = |text: String, warnings: &[&str]| {
        let Loaded { scene, warnings: found, .. } = load_text(&text);
        assert!(scene.rig.is_none(), "nothing moves");
        assert_eq!(found, warnings);
    };
    let nothing = "animations move nothing (1)";
    check(file("[]"), &[]);
    check(file("[{}]"), &[nothing]);
    check(file(r#"[{"channels":[],"samplers":[]}]"#), &[nothing]);
    check(
        one(0, "pointer", TIMES, PLACES, "LINEAR"),
        &["animated properties that are not known are ignored (1)", nothing],
    );
    check(
        one(0, "weights", TIMES, WEIGHTS, "LINEAR"),
        &["animated morph weights of nodes without morph targets are ignored (1)", nothing],
    );
    check(
        one(2, "translation", TIMES, PLACES, "LINEAR"),
        &["animated nodes with a matrix that shears stay as they are (1)", nothing],
    );
    // Without a node the specification has us ignore the channel, whatever its sampler holds.
    let nowhere =
        r#"[{"channels":[{"sampler":0,"target":{"path":"scale"}}],"samplers":[{"input":2,"output":6}]}]"#;
    check(file(nowhere), &[nothing]);
}

#[test]
fn what_is_read() {
    let Loaded { scene, warnings, .. } = load_text(&one(3, "translation", TIMES, NINE, "CUBICSPLINE"));
    assert!(warnings.is_empty(), "{warnings:?}");
    let rig = scene.rig.expect("a rig");
    let channel = &rig.clips[0].channels[0];
    assert_eq!((channel.node, channel.property), (3, Property::Translation));
    assert_eq!((channel.interpolation, channel.width()), (Interpolation::Cubic, 3));
    assert_eq!((rig.clips[0].duration, rig.clips[0].name.as_str()), (2.0, ""));
    // The matrix came apart without moving anything.
    let place = scene.instances[3].world_from_object;
    assert_eq!(place.transform_point3(glam::Vec3::ONE), glam::Vec3::new(7.0, 8.0, 9.0));
    // Signed bytes: −128 is −1, as is −127.
    let rig = load_text(&one(0, "rotation", TIMES, BYTES, "LINEAR")).scene.rig.expect("a rig");
    assert_eq!(rig.clips[0].channels[0].values[4..], [0.0, 0.0, 1.0, 1.0, 0.0, -1.0, 0.0, 0.0]);
    let rig = load_text(&one(1, "weights", TIMES, WEIGHTS, "STEP")).scene.rig.expect("a rig");
    assert_eq!((rig.clips[0].channels[0].width(), rig.deformers.len()), (1, 1));
    load_text(&one(0, "rotation", TIMES, TURNS, "LINEAR"));
}
