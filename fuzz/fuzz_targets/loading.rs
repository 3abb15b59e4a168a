//! A scene file with arbitrary content: it loads into a scene that is sound and stays so when it moves, or ends in a
//! one-line error.

use std::{fs, path::PathBuf, sync::OnceLock};

use ambray_scene::{
    Scene,
    animation::{Clips, Moment},
};

/// Loads `content` from a file with the given extension.
pub fn load(content: &[u8], extension: &str) {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| tempfile::tempdir().expect("a temporary folder"));
    let path: PathBuf = folder.path().join("scene").with_extension(extension);
    fs::write(&path, content).expect("the temporary folder is writable");
    match ambray_scene::load(&path) {
        Ok(loaded) => {
            let scene = loaded.scene;
            for mesh in &scene.meshes {
                mesh.validate().expect("a loaded mesh is sound");
                assert!((mesh.material as usize) < scene.materials.len());
            }
            for instance in &scene.instances {
                assert!((instance.mesh as usize) < scene.meshes.len());
                assert!(instance.world_from_object.is_finite());
            }
            for instance in &scene.shape_instances {
                assert!((instance.shape as usize) < scene.shapes.len());
                assert!((instance.material as usize) < scene.materials.len());
                assert!(instance.world_from_object.is_finite());
            }
            pose(&scene);
        }
        Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{error}"),
    }
}

/// Moves `scene` to a few moments.
fn pose(scene: &Scene) {
    let Some(rig) = &scene.rig else { return };
    let mut moved = scene.clone();
    for moment in [
        Moment { clips: Clips::All, time: 0.25, repeat: true },
        Moment { clips: Clips::One(0), time: 1e9, repeat: false },
    ] {
        let pose = rig.pose(Some(&moment));
        moved.place(&pose);
        moved.deform(&pose);
        for mesh in &moved.meshes {
            mesh.validate().expect("a mesh that moves is sound");
        }
        for instance in &moved.instances {
            assert!(instance.world_from_object.is_finite());
        }
    }
    // Back at rest, it is what was loaded.
    let rest = rig.pose(None);
    moved.place(&rest);
    moved.deform(&rest);
    assert!(moved.instances == scene.instances && moved.meshes == scene.meshes);
}
