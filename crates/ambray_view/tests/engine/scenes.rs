//! Scenes that open, fail and change.

use std::{fs, path::Path};

use ambray_view::{
    engine::Event,
    model::{SceneRef, Side},
};

use crate::common::{Desk, assert_exact, host, order, settings};

/// A triangle whose vertices are in a file of their own, and its upper corner.
fn write_triangle(folder: &Path, top: f32) {
    let corners: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, top, 0.0]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    fs::write(folder.join("corners.bin"), bytes).expect("the buffer is written");
    let gltf = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "buffers":[{"uri":"corners.bin","byteLength":36}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}"#;
    fs::write(folder.join("scene.gltf"), gltf).expect("the scene is written");
}

fn failure(event: &Event) -> Option<String> {
    match event {
        Event::OpenFailed { message, .. } => Some(message.clone()),
        Event::Opened(opened) => panic!("{:?} has opened", opened.scene),
        _ => None,
    }
}

#[test]
fn a_bad_file_leaves_the_old_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let bad = folder.path().join("bad.gltf");
    fs::write(&bad, "{\"asset\": 7").expect("written");
    let mut desk = Desk::with("atrium");
    for path in [bad, folder.path().join("nothing.glb"), folder.path().to_owned()] {
        desk.engine.open(&SceneRef::new(&path));
        let message = desk.until("the failure", failure);
        assert_eq!(message.lines().count(), 1, "{message}");
    }
    let wanted = settings(48, 27);
    desk.engine.show(order(&wanted));
    assert_exact("atrium", &desk.finished(Side::A, &wanted));
}

#[test]
fn the_newest_of_several_scenes_is_opened() {
    let mut desk = Desk::new();
    for _ in 0..5 {
        desk.engine.open(&SceneRef::new("flock"));
        desk.engine.open(&SceneRef::new("banner"));
    }
    desk.until("the last scene", |event| match event {
        Event::Opened(opened) => (opened.scene.path == Path::new("banner")).then_some(()),
        _ => None,
    });
    let wanted = settings(48, 27);
    desk.engine.show(order(&wanted));
    assert_exact("banner", &desk.finished(Side::A, &wanted));
}

#[test]
fn loading_is_told_before_the_scene_is_there() {
    let mut desk = Desk::with("atrium");
    let stages = |event: &Event| match event {
        Event::Loading { stage, .. } => Some(*stage),
        _ => None,
    };
    let told: Vec<_> = desk.events.iter().filter_map(stages).collect();
    assert!(told.starts_with(&["reading", "building"]), "{told:?}");
    desk.engine.open(&SceneRef::new("atrium"));
    assert!(desk.opened().is_reload);
}

#[test]
fn a_scene_is_read_again_when_one_of_its_files_changes() {
    let folder = tempfile::tempdir().expect("a folder");
    write_triangle(folder.path(), 1.0);
    let path = folder.path().join("scene.gltf");
    let mut desk = Desk::with(&path);
    let wanted = settings(48, 27);
    desk.engine.show(order(&wanted));
    let before = desk.finished(Side::A, &wanted);

    // A file beside the scene is none of it.
    fs::write(folder.path().join("notes.txt"), "nothing").expect("written");
    write_triangle(folder.path(), 3.0);
    let opened = desk.opened();
    assert!(opened.is_reload);
    assert_eq!((opened.bounds.1.y, opened.scene.path.as_path()), (3.0, path.as_path()));
    let after = desk.finished(Side::A, &wanted);
    assert!(host(&after).1 != host(&before).1, "the picture is still that of the old scene");

    fs::write(&path, "{ half a fi").expect("written");
    desk.until("the failure", failure);
    write_triangle(folder.path(), 2.0);
    assert_eq!(desk.opened().bounds.1.y, 2.0);
}
