//! Damaged and hostile files: each loads if it is harmless, or is refused with one line that names it.

mod common;

use std::time::{Duration, Instant};

use ambray_scene::LoadError;

/// Files that must load, and why that is right; all others must be refused.
///
/// `magnum-animation-missing-target-node.gltf` is valid in itself, but its buffer is not there.
const HARMLESS: &[(&str, &str)] = &[
    ("assetgen-Compatibility_00.gltf", "control file"),
    ("assetgen-Compatibility_02.gltf", "glTF 2.1 without a minimum version"),
    ("assimp-BoxWithInfinites.glb", "triangles that are not finite are dropped"),
    ("assimp-SceneWithoutNodes.gltf", "empty scene"),
    ("gen-nan-matrix.glb", "singular instances are dropped"),
    ("gen-nan-positions.glb", "triangles that are not finite are dropped"),
    (
        "gltf-rs-non_sparse_accessor_without_buffer_view.gltf",
        "such accessors are zeros, and no node shows it",
    ),
    ("meshoptimizer-fuzz.glb", "valid"),
    // Defects of what is not used, or not read at all.
    ("validator-accessor-float_normalized.gltf", "an accessor that nothing uses"),
    (
        "validator-accessor_data-out_of_range_elements_float.gltf",
        "wrong minimum and maximum, which are not read",
    ),
    (
        "validator-accessor_data-out_of_range_elements_sint8.gltf",
        "wrong minimum and maximum, which are not read",
    ),
    (
        "validator-accessor_data-out_of_range_elements_uint32.gltf",
        "wrong minimum and maximum, which are not read",
    ),
    ("validator-animation-channel_node_matrix.gltf", "a matrix without shear falls into parts"),
    ("validator-buffer_view-invalid_stride_wrong_target.gltf", "a stride that nothing uses"),
    ("validator-camera-extra_type.gltf", "superfluous camera data"),
    ("validator-camera-orthographic_xy.gltf", "a camera that no node uses"),
    ("validator-image-invalid_data_uri.gltf", "an image that no material uses"),
    ("validator-image-invalid_image_data.gltf", "an image that no material uses"),
    ("validator-image-invalid_uri_scheme.gltf", "an image that no material uses"),
    ("validator-mesh-accessor_attribute_uint32.gltf", "a mesh that no node shows"),
    ("validator-mesh-accessor_unequal_count.gltf", "a mesh that no node shows"),
    ("validator-mesh-indices_invalid_format.gltf", "a mesh that no node shows"),
    ("validator-mesh-invalid_attribute_escaped_name.gltf", "an unknown attribute"),
    ("validator-mesh-morph_attribute_invalid_count.gltf", "a mesh that no node shows"),
    ("validator-mesh_data-index_buffer_oob.gltf", "a mesh that no node shows"),
    ("validator-node-matrix_indecomposable.gltf", "a sheared node, which is placed as it says"),
    ("validator-node-skin_with_no_mesh.gltf", "a skin without use"),
    ("validator-root-extensions_undeclared_wrong_pointer.gltf", "an unknown extension"),
    ("validator-skin-ibm_invalid_format.gltf", "a skin without use"),
    ("validator-skin-no_joints_in_scene.gltf", "joints are posed wherever they are"),
];

#[test]
fn each_file_loads_or_is_refused_in_one_line() {
    let Some(folder) = common::scenes() else { return };
    let files = common::files(&folder.join("invalid"), &["gltf", "glb"]);
    assert!(files.len() > 100, "{} files", files.len());
    let mut faults = Vec::new();
    for path in files {
        let name = path.file_name().expect("files have names").to_string_lossy().into_owned();
        let harmless = HARMLESS.iter().any(|(known, _)| *known == name);
        let start = Instant::now();
        let result = ambray_scene::load(&path);
        let took = start.elapsed();
        println!(
            "{name}: {}",
            result.as_ref().map_or_else(ToString::to_string, |l| format!("{:?}", l.warnings))
        );
        match &result {
            Ok(loaded) if harmless => {
                for mesh in &loaded.scene.meshes {
                    mesh.validate().expect("loaded meshes keep their invariants");
                }
                common::check_poses(&loaded.scene);
            }
            Ok(_) => faults.push(format!("{name} must be refused")),
            Err(_) if harmless => faults.push(format!("{name} must load")),
            Err(error) => {
                let text = error.to_string();
                if text.lines().count() != 1 || !text.contains(&name) || text.len() > 1000 {
                    faults.push(format!("{name}: unclear message: {text}"));
                }
            }
        }
        if took > Duration::from_secs(5) {
            faults.push(format!("{name} took {took:?}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[track_caller]
fn check_message(name: &str, expected: &str) {
    let Some(folder) = common::scenes() else { return };
    let path = folder.join(name);
    let text = ambray_scene::load(&path).expect_err("must be refused").to_string();
    assert_eq!(text, format!("{}: {expected}", path.display()));
}

#[test]
fn messages_say_what_is_wrong() {
    check_message(
        "invalid/gen-required-unknown-extension.glb",
        "extensionsRequired[0]: required extension 'XYZ_not_supported' is not supported",
    );
    check_message(
        "invalid/gen-parent-uri.gltf",
        "buffers[0].uri: path '../../../../../../outside/box.bin' does not stay in the scene's folder",
    );
    check_message(
        "invalid/gen-png-bomb-header.gltf",
        "images[0]: image of 60000 × 60000 texels, the limit is 16384",
    );
    check_message(
        "ExtensionsRequired/CesiumBalloonKTX2.glb",
        "extensionsRequired[0]: required extension 'KHR_texture_basisu' is not supported",
    );
}

#[test]
fn kinds_of_errors() {
    let dir = tempfile::tempdir().expect("temporary folder");
    let load = |name: &str, bytes: &[u8]| {
        std::fs::write(dir.path().join(name), bytes).expect("write");
        ambray_scene::load(&dir.path().join(name)).expect_err("must be refused")
    };
    assert!(matches!(load("a.gltf", b"hello"), LoadError::Syntax { .. }));
    assert!(matches!(load("b.gltf", b"{\"asset\":{\"version\":\"1.0\"}}"), LoadError::Unsupported { .. }));
    assert!(matches!(
        load("c.gltf", b"{\"asset\":{\"version\":\"2.0\"},\"scene\":3}"),
        LoadError::Invalid { .. }
    ));
    assert!(matches!(load("d.gltf", &[b'['; 1000]), LoadError::TooLarge { .. }));
    assert!(matches!(load("e.txt", b"hello"), LoadError::Unsupported { .. }));
    let missing = ambray_scene::load(&dir.path().join("missing.glb")).expect_err("is not there");
    assert!(matches!(missing, LoadError::Io { .. }));
    assert!(matches!(ambray_scene::load(dir.path()).expect_err("a folder"), LoadError::Io { .. }));
}

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_not_opened() {
    let dir = tempfile::tempdir().expect("temporary folder");
    let pipe = dir.path().join("pipe.gltf");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success());
    if made {
        assert!(ambray_scene::load(&pipe).is_err());
    }
    assert!(ambray_scene::load(std::path::Path::new("/dev/zero")).is_err());
    let link = dir.path().join("zero.gltf");
    std::os::unix::fs::symlink("/dev/zero", &link).expect("link");
    assert!(ambray_scene::load(&link).is_err());
    let scene = dir.path().join("scene.gltf");
    for uri in ["zero.gltf", ".", "file:///dev/zero", "/dev/zero", "http://localhost/a.bin"] {
        let json = format!(
            "{{\"asset\":{{\"version\":\"2.0\"}},\"buffers\":[{{\"byteLength\":4,\"uri\":\"{uri}\"}}]}}"
        );
        std::fs::write(&scene, json).expect("write");
        let text = ambray_scene::load(&scene).expect_err("must be refused").to_string();
        assert!(text.contains("scene.gltf: buffers[0].uri: "), "{text}");
    }
}
