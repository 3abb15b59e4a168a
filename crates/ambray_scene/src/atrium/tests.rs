use std::time::Instant;

use ambray_core::light::Light;
use glam::Vec3;

use super::{Scene, atrium, curtains};
use crate::modelling::shapes;

#[test]
fn size_is_as_promised() {
    let scene = atrium();
    let triangles = scene.triangle_count();
    assert!((50_000..=150_000).contains(&triangles), "{triangles} triangles");
    let (lo, hi) = scene.bounds().unwrap();
    assert!(lo.cmpge(Vec3::new(-10.1, -0.5, -7.3)).all() && hi.cmple(Vec3::new(10.1, 9.0, 7.3)).all());
    assert!((hi - lo).cmpgt(Vec3::new(20.0, 9.0, 14.0)).all(), "{lo} {hi}");
}

#[test]
fn meshes_and_references_are_valid() {
    let scene = atrium();
    for mesh in &scene.meshes {
        mesh.validate().unwrap_or_else(|error| panic!("{}: {error}", mesh.name));
        assert!(!mesh.name.is_empty() && (mesh.material as usize) < scene.materials.len(), "{}", mesh.name);
        for vector in mesh.normals.iter().copied().chain(mesh.tangents.iter().map(|t| t.truncate())) {
            assert!((vector.length() - 1.0).abs() < 1e-5, "{}: {vector}", mesh.name);
        }
    }
    assert!(scene.instances.iter().all(|i| (i.mesh as usize) < scene.meshes.len()));
    for material in &scene.materials {
        assert!(!material.name.is_empty());
        for texture in [material.base_color_texture, material.normal_texture].into_iter().flatten() {
            let image = scene.textures[texture.texture as usize].image;
            assert_eq!(scene.images[image as usize].srgb, Some(texture) != material.normal_texture);
        }
    }
}

#[test]
fn triangles_have_area_and_normals_on_their_front() {
    for mesh in &atrium().meshes {
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = mesh.corners(t as u32);
            let area = (b - a).cross(c - a);
            assert!(0.5 * area.length() > shapes::LEAST_AREA, "{} {t}", mesh.name);
            for &i in triangle.iter().filter(|_| !mesh.normals.is_empty()) {
                assert!(mesh.normals[i as usize].dot(area.normalize()) > 0.3, "{} {t}", mesh.name);
            }
        }
    }
}

#[test]
fn curtains_end_just_above_the_floor() {
    let scene = atrium();
    let curtains: Vec<_> = scene.meshes.iter().filter(|m| m.name.ends_with("curtain")).collect();
    assert_eq!(curtains.len(), 9);
    for mesh in curtains {
        let lowest = mesh.positions.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
        assert!((0.01..0.04).contains(&lowest) && lowest >= curtains::GAP, "{} {lowest}", mesh.name);
    }
}

#[test]
fn every_mesh_and_material_is_used() {
    let scene = atrium();
    for (k, mesh) in scene.meshes.iter().enumerate() {
        assert!(scene.instances.iter().any(|i| i.mesh as usize == k), "{}", mesh.name);
    }
    for (k, material) in scene.materials.iter().enumerate() {
        assert!(scene.meshes.iter().any(|m| m.material as usize == k), "{}", material.name);
    }
}

#[test]
fn lit_and_seen() {
    let scene = atrium();
    let names: Vec<_> = scene.cameras.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["arcade", "courtyard", "curtain-hem", "gallery"]);
    for camera in &scene.cameras {
        assert!((camera.forward.length() - 1.0).abs() < 1e-6 && camera.forward.dot(camera.up).abs() < 1e-6);
    }
    assert!(matches!(scene.lights[..], [Light::Directional { .. }]));
    assert!(scene.ambient.is_some() && scene.radius.is_some());
}

/// FNV-1a over all geometry, placements and texels of the finest level.
fn fingerprint(scene: &Scene) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut byte = |b: u8| hash = (hash ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3);
    let mut word = |w: u32| w.to_le_bytes().into_iter().for_each(&mut byte);
    for mesh in &scene.meshes {
        let positions = mesh.positions.iter().chain(&mesh.normals).flat_map(|p| p.to_array());
        let others = mesh.uvs.iter().flatten().flat_map(|uv| uv.to_array());
        let tangents = mesh.tangents.iter().flat_map(|t| t.to_array());
        positions.chain(others).chain(tangents).for_each(|x| word(x.to_bits()));
        mesh.triangles.iter().flatten().for_each(|&i| word(i));
        word(mesh.material);
    }
    for instance in &scene.instances {
        word(instance.mesh);
        instance.world_from_object.to_cols_array().into_iter().for_each(|x| word(x.to_bits()));
    }
    for image in &scene.images {
        image.levels[0].texels.iter().for_each(|t| word(u32::from_le_bytes(*t)));
    }
    hash
}

#[test]
fn the_same_on_every_machine() {
    assert_eq!(fingerprint(&atrium()), FINGERPRINT, "after a change of the scene, store the left value");
}

/// Value of [`fingerprint`] for the scene as it is meant to be.
const FINGERPRINT: u64 = 11_209_942_112_733_696_743;

/// Generous, since machines differ; a release build takes a quarter of a second.
#[test]
fn built_in_no_time() {
    let start = Instant::now();
    std::hint::black_box(atrium());
    assert!(start.elapsed().as_secs_f32() < 3.0, "{:?}", start.elapsed());
}
