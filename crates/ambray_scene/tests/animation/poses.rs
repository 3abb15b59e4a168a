//! Poses of the shared scenes against the reference: nodes, joints, and triangles in the world.

use std::path::Path;

use ambray_scene::Scene;
use ambray_scene::animation::{Clips, Moment};

use crate::common;
use crate::reference::{Corners, Matrix, Reference};

/// Files with animations, or folders of them.
const FILES: &[&str] = &[
    "Fox/glTF/Fox.gltf",
    "CesiumMan/glTF-Binary/CesiumMan.glb",
    "RiggedFigure/glTF-Binary/RiggedFigure.glb",
    "RiggedSimple/glTF-Binary/RiggedSimple.glb",
    "SimpleSkin/glTF-Embedded/SimpleSkin.gltf",
    "SkinnedCylinder/03_skinned_cylinder.gltf",
    "BoxAnimated/glTF-Binary/BoxAnimated.glb",
    "CesiumMilkTruck/glTF-Binary/CesiumMilkTruck.glb",
    "InterpolationTest/glTF-Binary/InterpolationTest.glb",
    "AnimatedMorphCube/glTF/AnimatedMorphCube.gltf",
    "AnimatedMorphCube/glTF-Quantized/AnimatedMorphCube.gltf",
    "AnimatedTriangle/glTF/AnimatedTriangle.gltf",
    "MorphStressTest/glTF-Binary/MorphStressTest.glb",
    "SimpleMorph/glTF-Embedded/SimpleMorph.gltf",
    "AssetGenerator/Animation_Node",
    "AssetGenerator/Animation_NodeMisc",
    "AssetGenerator/Animation_Skin",
    "AssetGenerator/Animation_SkinMisc",
];

#[test]
fn poses_of_the_shared_scenes() {
    let Some(folder) = common::scenes() else { return };
    let mut checked = 0;
    for name in FILES {
        let path = folder.join(name);
        let files = if path.is_dir() { common::files(&path, &["gltf", "glb"]) } else { vec![path] };
        for file in files.iter().filter(|file| file.exists()) {
            checked += check_file(file);
        }
    }
    assert!(checked > 900, "{checked} poses");
}

/// Checks all clips of a file, and returns the number of poses.
fn check_file(path: &Path) -> usize {
    let scene = ambray_scene::load(path).unwrap_or_else(|error| panic!("{error}")).scene;
    let reference = Reference::read(path);
    check_triangles(&scene, &reference.triangles(None, 0.0), path, "at rest");
    let Some(rig) = scene.rig.clone() else {
        assert_eq!(reference.clips(), 0, "{}", path.display());
        return 1;
    };
    assert_eq!(rig.clips.len(), reference.clips());
    // Many files have animations by the dozen.
    let step = if scene.triangle_count() > 3000 { 3 } else { 1 };
    let mut poses = 1;
    for clip in 0..rig.clips.len() {
        let keyframes = reference.times(clip);
        let duration = f64::from(rig.clips[clip].duration);
        assert_eq!(Some(&duration), keyframes.last());
        let between = (0..=16).map(|k| duration * f64::from(k) / 15.0);
        let few = keyframes.iter().copied().step_by(keyframes.len().div_ceil(6));
        for time in between.step_by(step).chain(few.step_by(step)) {
            let mut moved = scene.clone();
            let pose = rig.pose(Some(&Moment { clips: Clips::One(clip), time, repeat: false }));
            moved.place(&pose);
            moved.deform(&pose);
            let at = format!("clip {clip} at {time} s");
            let world = reference.world(Some(clip), time);
            for (rank, node) in reference.order(false).into_iter().enumerate() {
                check_matrix(&pose.world[rank].into(), &world[node], path, &at);
            }
            if let (Some(skin), Some(joints)) = (reference.first_skin(), pose.joints.first()) {
                let expected = reference.joints(skin, &world);
                assert_eq!(joints.len(), expected.len());
                for (joint, expected) in joints.iter().zip(&expected) {
                    let joint = glam::DAffine3 {
                        matrix3: glam::Mat3::from(joint.matrix3).as_dmat3(),
                        translation: joint.translation.as_dvec3(),
                    };
                    check_matrix(&joint.into(), expected, path, &at);
                }
            }
            check_triangles(&moved, &reference.triangles(Some(clip), time), path, &at);
            let around = Moment { clips: Clips::One(clip), time: time + 2.0 * duration, repeat: true };
            let again = rig.pose(Some(&around));
            if time < duration {
                let near =
                    |(a, b): (&glam::DAffine3, &glam::DAffine3)| a.abs_diff_eq(*b, 1e-3 * size(&moved));
                assert!(again.world.iter().zip(&pose.world).all(near), "{} {at}", path.display());
            }
            poses += 1;
        }
    }
    poses
}

fn size(scene: &Scene) -> f64 {
    let (lo, hi) = scene.bounds().expect("something");
    f64::from((hi - lo).max_element().max(lo.abs().max(hi.abs()).max_element()))
}

fn check_matrix(found: &glam::DMat4, expected: &Matrix, path: &Path, at: &str) {
    let found = found.to_cols_array_2d();
    let largest = expected.iter().flatten().fold(1.0, |most: f64, x| most.max(x.abs()));
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 2e-6 * largest;
    let same = found.as_flattened().iter().zip(expected.as_flattened()).all(near);
    assert!(same, "{} {at}: {found:?} instead of {expected:?}", path.display());
}

fn check_triangles(scene: &Scene, expected: &[Vec<Corners>], path: &Path, at: &str) {
    let name = path.display();
    assert_eq!(scene.instances.len(), expected.len(), "{name}");
    let tolerance = 3e-6 * size(scene);
    for (instance, expected) in scene.instances.iter().zip(expected) {
        let mesh = &scene.meshes[instance.mesh as usize];
        mesh.validate().expect("a sound mesh");
        let m = instance.world_from_object;
        let normal_matrix = ambray_scene::surface::normal_matrix(m.matrix3);
        assert_eq!(mesh.triangles.len(), expected.len(), "{name}");
        for (triangle, corners) in mesh.triangles.iter().zip(expected) {
            for (&i, (position, normal)) in triangle.iter().zip(corners) {
                let found = m.transform_point3(mesh.positions[i as usize]).as_dvec3();
                let distance = found.distance((*position).into());
                assert!(distance <= tolerance, "{name} {at}: {found} instead of {position:?}");
                let Some(&n) = mesh.normals.get(i as usize) else { continue };
                let found = (normal_matrix * glam::Vec3A::from(n)).normalize().as_dvec3();
                let distance = found.distance((*normal).into());
                assert!(distance < 1e-3 || normal[0].is_nan(), "{name} {at}: {found} instead of {normal:?}");
            }
        }
    }
}
