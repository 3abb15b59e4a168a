//! The shared scenes, which are not part of the repository, and scenes made up on the spot.
#![allow(dead_code, reason = "each test file uses its own part of this")]

use std::path::{Path, PathBuf};

use ambray_scene::animation::{Clips, Moment};
use ambray_scene::{LoadError, Loaded, Scene};

/// Folder of the shared scenes; `None`, with a word about it, where it is not there.
///
/// # Panics
/// If it is not there and `AMBRAY_REQUIRE_SCENES=1`.
pub(crate) fn scenes() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    if folder.is_dir() {
        return Some(folder);
    }
    let required = std::env::var_os("AMBRAY_REQUIRE_SCENES").is_some_and(|value| value == "1");
    assert!(!required, "AMBRAY_REQUIRE_SCENES=1, but there are no shared scenes");
    println!("skipped: no shared scenes");
    None
}

/// All files below `folder` with one of the `extensions`, sorted.
pub(crate) fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let (mut found, mut pending) = (Vec::new(), vec![folder.to_path_buf()]);
    while let Some(folder) = pending.pop() {
        for entry in std::fs::read_dir(&folder).expect("readable folder") {
            let path = entry.expect("readable entry").path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|ext| extensions.iter().any(|known| ext == *known)) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Loads a file of the shared scenes that must be there and load.
#[track_caller]
pub(crate) fn load_shared(folder: &Path, name: &str) -> Loaded {
    ambray_scene::load(&folder.join(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// Loads `files`, names and contents, from a folder of their own; the first one is the scene.
pub(crate) fn load_files(files: &[(&str, &[u8])]) -> Result<Loaded, LoadError> {
    let dir = tempfile::tempdir().expect("temporary folder");
    for (name, content) in files {
        std::fs::write(dir.path().join(name), content).expect("write");
    }
    ambray_scene::load(&dir.path().join(files[0].0))
}

/// Loads glTF text.
#[track_caller]
pub(crate) fn load_text(gltf: &str) -> Loaded {
    load_files(&[("x.gltf", gltf.as_bytes())]).unwrap_or_else(|error| panic!("{error}"))
}

/// Fails unless glTF text is refused with one line that ends with `expected`.
#[track_caller]
pub(crate) fn assert_refused(gltf: &str, expected: &str) {
    let text = load_files(&[("x.gltf", gltf.as_bytes())]).expect_err("must be refused").to_string();
    assert!(text.ends_with(expected), "{text}");
    assert_eq!(text.lines().count(), 1);
}

/// Moves `scene` to several moments of its clips; fails where that leaves something unsound.
pub(crate) fn check_poses(scene: &Scene) {
    let Some(rig) = scene.rig.clone() else { return };
    let clips = (0..rig.clips.len().min(4)).map(Clips::One).chain([Clips::All]);
    for (clips, time) in clips.flat_map(|clips| [0.0, 0.37, 1e9].map(|time| (clips, time))) {
        let mut moved = scene.clone();
        let pose = rig.pose(Some(&Moment { clips, time, repeat: time < 1.0 }));
        moved.place(&pose);
        moved.deform(&pose);
        moved.meshes.iter().for_each(|mesh| mesh.validate().expect("valid meshes"));
        assert!(moved.instances.iter().all(|i| i.world_from_object.is_finite()));
        assert!(moved.shape_instances.iter().all(|i| i.world_from_object.is_finite()));
        assert!(moved.cameras.iter().all(|c| c.position.is_finite() && c.forward.is_normalized()));
        assert!(moved.bounds().is_none_or(|(lo, hi)| lo.is_finite() && hi.is_finite()));
        let rest = rig.pose(None);
        moved.place(&rest);
        moved.deform(&rest);
        assert!(moved.instances == scene.instances && moved.meshes == scene.meshes, "back at rest");
    }
}
