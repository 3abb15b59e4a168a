//! A scene as it is loaded is what its rig makes of it at rest, bit for bit.

use crate::common;

use ambray_scene::Scene;

/// Moves `scene` away and back to rest.
pub(crate) fn away_and_back(scene: &Scene) -> Scene {
    use ambray_scene::animation::{Clips, Moment};
    let mut moved = scene.clone();
    let rig = scene.rig.clone().expect("a rig");
    let there = Moment { clips: Clips::All, time: 0.37, repeat: true };
    for pose in [rig.pose(Some(&there)), rig.pose(None)] {
        moved.place(&pose);
        moved.deform(&pose);
    }
    moved
}

/// Fails unless both hold the same numbers, bit for bit.
fn assert_same(a: &Scene, b: &Scene, name: &str) {
    // Debug output has the shortest text that reads back as the same number, and the sign of zero.
    let text = |scene: &Scene| {
        format!("{:?}", (&scene.instances, &scene.shape_instances, &scene.cameras, &scene.lights))
    };
    assert_eq!(text(a), text(b), "{name}");
    for (i, (a, b)) in a.meshes.iter().zip(&b.meshes).enumerate() {
        let bits = |mesh: &ambray_scene::Mesh| -> Vec<u32> {
            let positions = mesh.positions.iter().chain(&mesh.normals).flat_map(|v| v.to_array());
            positions.chain(mesh.tangents.iter().flat_map(|v| v.to_array())).map(f32::to_bits).collect()
        };
        assert!(bits(a) == bits(b), "{name}: mesh {i}");
    }
}

#[test]
fn loaded_scenes_are_their_rigs_at_rest() {
    let Some(folder) = common::scenes() else { return };
    let mut rigs = 0;
    for path in common::files(&folder, &["gltf", "glb"]) {
        let Ok(loaded) = ambray_scene::load(&path) else { continue };
        let scene = loaded.scene;
        let Some(rig) = &scene.rig else { continue };
        rigs += 1;
        let name = path.display().to_string();
        assert_eq!(rig.instances.len(), scene.instances.len(), "{name}");
        assert_eq!(rig.shape_instances.len(), scene.shape_instances.len(), "{name}");
        assert_eq!(
            (rig.cameras.len(), rig.lights.len()),
            (scene.cameras.len(), scene.lights.len()),
            "{name}"
        );
        assert_same(&scene, &away_and_back(&scene), &name);
    }
    assert!(rigs > 30, "{rigs} files with a rig");
}
