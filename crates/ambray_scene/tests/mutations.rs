//! Small damage to good files, thousands of times: whatever comes of it, no panic and no broken mesh, at rest and moved.

mod common;

use std::path::Path;

use ambray_core::sampling::pcg;

/// Files whose features reach every reader of bytes.
const FILES: &[&str] = &[
    "Box/glTF-Binary/Box.glb",
    "Box/glTF-Embedded/Box.gltf",
    "BoxInterleaved/glTF-Binary/BoxInterleaved.glb",
    "RiggedSimple/glTF-Binary/RiggedSimple.glb",
    "SimpleInstancing/glTF-Binary/SimpleInstancing.glb",
    "BoxAnimated/glTF-Binary/BoxAnimated.glb",
    "InterpolationTest/glTF-Binary/InterpolationTest.glb",
    "SimpleMorph/glTF-Embedded/SimpleMorph.gltf",
    "SimpleSkin/glTF-Embedded/SimpleSkin.gltf",
    "SimpleSparseAccessor/glTF-Embedded/SimpleSparseAccessor.gltf",
    "BoxTextured/glTF-Embedded/BoxTextured.gltf",
    "MultiUVTest/glTF-Binary/MultiUVTest.glb",
];

/// Damaged copies of each file.
const COPIES: u32 = 120;

#[test]
fn damaged_files_never_panic() {
    let Some(folder) = common::scenes() else { return };
    let dir = tempfile::tempdir().expect("temporary folder");
    let (mut loaded, mut refused, mut posed) = (0, 0, 0);
    for (file, name) in FILES.iter().enumerate() {
        let good = std::fs::read(folder.join(name)).expect("a shared scene");
        let path = dir.path().join(Path::new(name).file_name().expect("a name"));
        for copy in 0..COPIES {
            let bytes = damage(&good, file as u32 * COPIES + copy);
            std::fs::write(&path, bytes).expect("write");
            match ambray_scene::load(&path) {
                Ok(result) => {
                    loaded += 1;
                    result.scene.meshes.iter().for_each(|mesh| mesh.validate().expect("valid meshes"));
                    assert!(result.scene.instances.iter().all(|i| i.world_from_object.is_finite()));
                    posed += usize::from(result.scene.rig.is_some());
                    common::check_poses(&result.scene);
                }
                Err(error) => {
                    refused += 1;
                    assert_eq!(error.to_string().lines().count(), 1, "{error}");
                }
            }
        }
    }
    println!("{loaded} loaded, {posed} of them with a rig, {refused} refused");
    assert!(
        loaded > 50 && refused > 50 && posed > 50,
        "{loaded} loaded, {refused} refused: the damage is not of the right size"
    );
}

/// A copy with one to four changes: bits anywhere, or digits of the JSON, which keep it well-formed.
fn damage(good: &[u8], seed: u32) -> Vec<u8> {
    let mut state = pcg(seed);
    let mut random = |below: usize| {
        state = pcg(state);
        state as usize % below
    };
    let mut bytes = good.to_vec();
    let digits: Vec<usize> = (0..bytes.len().min(4000)).filter(|&i| bytes[i].is_ascii_digit()).collect();
    for _ in 0..=random(4) {
        if random(4) == 0 {
            let i = random(bytes.len());
            bytes[i] ^= 1 << random(8);
        } else {
            bytes[digits[random(digits.len())]] = b'0' + random(10) as u8;
        }
    }
    bytes
}

#[test]
fn damaged_obj_files_never_panic() {
    let good =
        b"mtllib a.mtl\nv 0 0 0\nv 1 0 0 1 0 1\nv 0 1 0\nvt 0 1\nvn 0 0 1\nusemtl a\nf 1/1/1 2//1 3/1 -1\n";
    let library = b"newmtl a\nKd 1 0.5 0\nKe 1\nd 0.5\nmap_Kd -s 1 1 1 x.png\nmap_d x.png\nTr 0\n";
    for seed in 0..2000 {
        let (obj, mtl) = (scramble(good, seed), scramble(library, seed + 5000));
        if let Ok(loaded) = common::load_files(&[("x.obj", &obj), ("a.mtl", &mtl)]) {
            loaded.scene.meshes.iter().for_each(|mesh| mesh.validate().expect("valid meshes"));
        }
    }
}

/// A copy with a few bytes replaced, dropped or doubled.
fn scramble(good: &[u8], seed: u32) -> Vec<u8> {
    let mut state = pcg(seed);
    let mut random = |below: usize| {
        state = pcg(state);
        state as usize % below
    };
    let mut bytes = good.to_vec();
    for _ in 0..=random(4) {
        let i = random(bytes.len());
        match random(4) {
            0 => bytes[i] = random(256) as u8,
            1 => drop(bytes.remove(i)),
            2 => bytes.insert(i, bytes[i]),
            _ => bytes[i] = b" \n-/0\\"[random(6)],
        }
    }
    bytes
}
