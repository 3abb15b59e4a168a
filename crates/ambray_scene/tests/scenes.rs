//! The shared scenes: counts and boxes as their table has them, and what each was chosen for.

mod common;

use std::f32::consts::{FRAC_PI_8, PI};
use std::path::Path;

use ambray_core::camera::Projection;
use ambray_scene::{AlphaMode, Filter, LoadError, Material, Scene, Wrap};
use common::load_shared;
use glam::{Affine2, Vec2, Vec3, Vec4};

/// Files that need what we lack.
const REFUSED: &[(&str, &str)] = &[
    ("Box/glTF-Draco/Box.gltf", "KHR_draco_mesh_compression"),
    ("CesiumMan/glTF-Draco/CesiumMan.gltf", "KHR_draco_mesh_compression"),
    ("Duck/glTF-Draco/Duck.gltf", "KHR_draco_mesh_compression"),
    ("ExtensionsRequired/BoxMeshopt-separate/BoxMeshopt.gltf", "EXT_meshopt_compression"),
    ("ExtensionsRequired/BoxMeshopt.glb", "EXT_meshopt_compression"),
    ("ExtensionsRequired/CesiumBalloonKTX2.glb", "KHR_texture_basisu"),
];

/// Files whose box differs from the table's, ours, and why.
const OTHER_BOXES: &[(&str, [f32; 6])] = &[
    // The table's includes points and lines.
    ("MeshPrimitiveModes/glTF/MeshPrimitiveModes.gltf", [-2.866, -4.0, 0.0, 2.866, -2.0, 0.0]),
    // The table leaves out the default morph weights of 0.5: the apex at y = 0.5 moves by 0.5 twice.
    ("SimpleMorph/glTF-Embedded/SimpleMorph.gltf", [0.0, 0.0, 0.0, 1.0, 1.5, 0.0]),
];

/// Rows of the README's tables whose second cell is a file or folder in backquotes.
fn rows(folder: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(folder.join("README.md")).expect("the scenes' README");
    let cells = |line: &str| line.split('|').map(|cell| cell.trim().trim_matches('`').to_owned()).collect();
    text.lines().filter(|line| line.starts_with('|')).map(cells).collect()
}

/// Reads `(x, y, z) to (x, y, z)`.
fn parse_box(cell: &str) -> Option<[f32; 6]> {
    let numbers: Vec<f32> = cell
        .split(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e')))
        .filter_map(|word| word.parse().ok())
        .collect();
    numbers.try_into().ok()
}

#[test]
fn counts_and_boxes_are_those_of_the_table() {
    let Some(folder) = common::scenes() else { return };
    let (mut faults, mut checked) = (Vec::new(), 0);
    for row in rows(&folder) {
        let Some(path) = row.get(2).filter(|path| path.ends_with(".gltf") || path.ends_with(".glb")) else {
            continue;
        };
        let Ok(triangles) = row[3].replace(',', "").parse::<u64>() else { continue };
        checked += 1;
        let result = ambray_scene::load(&folder.join(path));
        if let Some((_, extension)) = REFUSED.iter().find(|(name, _)| name == path) {
            let named =
                matches!(&result, Err(LoadError::Unsupported { reason, .. }) if reason.contains(extension));
            if !named {
                faults.push(format!("{path}: {extension} must be refused by name"));
            }
            continue;
        }
        let scene = match result {
            Ok(loaded) => loaded.scene,
            Err(error) => {
                faults.push(error.to_string());
                continue;
            }
        };
        if scene.triangle_count() != triangles {
            faults.push(format!("{path}: {} triangles instead of {triangles}", scene.triangle_count()));
        }
        for mesh in &scene.meshes {
            mesh.validate().unwrap_or_else(|error| faults.push(format!("{path}: {error}")));
        }
        let other = OTHER_BOXES.iter().find(|(name, _)| name == path).map(|(_, other)| *other);
        if let Some(expected) = other.or_else(|| parse_box(&row[8])) {
            check_box(path, &scene, expected, &mut faults);
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(checked > 70, "{checked} files in the table");
}

fn check_box(path: &str, scene: &Scene, expected: [f32; 6], faults: &mut Vec<String>) {
    let Some((lo, hi)) = scene.bounds() else {
        faults.push(format!("{path}: no box"));
        return;
    };
    // The table has four digits; what is nearly zero there depends on rounding.
    let noise = 2e-6 * (hi - lo).length();
    let ours = [lo.x, lo.y, lo.z, hi.x, hi.y, hi.z];
    if ours.iter().zip(expected).any(|(a, b)| (a - b).abs() > noise + 6e-4 * b.abs()) {
        faults.push(format!("{path}: box {ours:?} instead of {expected:?}"));
    }
}

#[test]
fn asset_generator_totals_are_those_of_the_table() {
    let Some(folder) = common::scenes() else { return };
    for row in rows(&folder).iter().filter(|row| row[1].starts_with("AssetGenerator/")) {
        let files = common::files(&folder.join(&row[1]), &["gltf", "glb"]);
        let load =
            |path: &std::path::PathBuf| ambray_scene::load(path).unwrap_or_else(|error| panic!("{error}"));
        let total: u64 = files.iter().map(|path| load(path).scene.triangle_count()).sum();
        assert_eq!(
            (files.len().to_string(), total.to_string()),
            (row[2].clone(), row[3].clone()),
            "{}",
            row[1]
        );
    }
}

fn material<'s>(scene: &'s Scene, name: &str) -> &'s Material {
    scene.materials.iter().find(|material| material.name == name).expect("a material of that name")
}

#[test]
fn packagings_hold_the_same_scene() {
    let Some(folder) = common::scenes() else { return };
    for (a, b) in [
        ("Box/glTF/Box.gltf", "Box/glTF-Binary/Box.glb"),
        ("Box/glTF/Box.gltf", "Box/glTF-Embedded/Box.gltf"),
        ("BoxTextured/glTF/BoxTextured.gltf", "BoxTextured/glTF-Embedded/BoxTextured.gltf"),
        ("CesiumMan/glTF/CesiumMan.gltf", "CesiumMan/glTF-Binary/CesiumMan.glb"),
        ("SimpleInstancing/glTF/SimpleInstancing.gltf", "SimpleInstancing/glTF-Binary/SimpleInstancing.glb"),
        ("UnicodeTest/glTF/Unicode❤♻Test.gltf", "UnicodeTest/glTF-Binary/Unicode❤♻Test.glb"),
    ] {
        let (a, b) = (load_shared(&folder, a).scene, load_shared(&folder, b).scene);
        assert_eq!((&a.meshes, &a.instances, &a.materials), (&b.meshes, &b.instances, &b.materials));
        assert_eq!(a.images.len(), b.images.len());
    }
}

#[test]
fn quantised_equals_float() {
    let Some(folder) = common::scenes() else { return };
    let float = load_shared(&folder, "Duck/glTF/Duck.gltf").scene;
    let quantised = load_shared(&folder, "Duck/glTF-Quantized/Duck.gltf").scene;
    let world = |scene: &Scene| -> Vec<[Vec3; 3]> {
        let instance = scene.instances[0];
        let mesh = &scene.meshes[instance.mesh as usize];
        let corners = |i| mesh.corners(i).map(|p| instance.world_from_object.transform_point3(p));
        (0..mesh.triangles.len() as u32).map(corners).collect()
    };
    let centre = |t: &[Vec3; 3]| (t[0] + t[1] + t[2]) / 3.0;
    let mean = |scene: &Scene| {
        let all = world(scene);
        all.iter().map(centre).sum::<Vec3>() / all.len() as f32
    };
    // Triangles may be reordered; their mean is not moved by that.
    assert!(mean(&float).abs_diff_eq(mean(&quantised), 1e-4), "{} {}", mean(&float), mean(&quantised));
    assert!(quantised.meshes[0].normals.iter().all(|n| n.is_normalized()));
    let uv = |scene: &Scene| {
        let mesh = &scene.meshes[0];
        let material = &scene.materials[mesh.material as usize];
        let transform = material.base_color_texture.expect("a texture").transform;
        let corners = mesh.triangles.iter().flatten();
        corners.map(|&i| transform.transform_point2(mesh.uvs[0][i as usize])).sum::<Vec2>()
            / (3 * mesh.triangles.len()) as f32
    };
    assert!(uv(&float).abs_diff_eq(uv(&quantised), 1e-3), "{} {}", uv(&float), uv(&quantised));
}

#[test]
fn topologies_and_sparse_accessors() {
    let Some(folder) = common::scenes() else { return };
    let loaded = load_shared(&folder, "MeshPrimitiveModes/glTF/MeshPrimitiveModes.gltf");
    assert_eq!(loaded.warnings.iter().filter(|line| line.contains("points or lines")).count(), 1);
    // Lists, strips and fans of one file face the same way.
    for instance in &loaded.scene.instances {
        let mesh = &loaded.scene.meshes[instance.mesh as usize];
        for i in 0..mesh.triangles.len() as u32 {
            let [a, b, c] = mesh.corners(i).map(|p| instance.world_from_object.transform_point3(p));
            assert!((b - a).cross(c - a).z > 0.0, "{} {i}", mesh.name);
        }
    }
    let sparse = load_shared(&folder, "SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf").scene;
    let positions = &sparse.meshes[0].positions;
    assert_eq!(
        positions[8..=12],
        [(1, 2), (2, 1), (3, 3), (4, 1), (5, 4)].map(|(x, y)| Vec3::new(x as f32, y as f32, 0.0))
    );
}

#[test]
fn colours_and_texture_coordinates() {
    let Some(folder) = common::scenes() else { return };
    let scene = load_shared(&folder, "BoxVertexColors/glTF-Binary/BoxVertexColors.glb").scene;
    let mesh = &scene.meshes[0];
    // The cube from 0 to 1 is coloured by position, up to the axes' sense.
    assert_eq!(mesh.colors.len(), 24);
    assert!(
        mesh.colors
            .iter()
            .all(|c| c.w == 1.0 && c.truncate().to_array().iter().all(|&x| x == 0.0 || x == 1.0))
    );
    assert_eq!(scene.materials, [Material::default()]);

    let scene = load_shared(&folder, "MultiUVTest/glTF-Binary/MultiUVTest.glb").scene;
    assert_eq!(scene.meshes[0].uvs.len(), 2);
    let material = &scene.materials[0];
    assert_eq!(material.base_color_texture.map(|texture| texture.uv_set), Some(0));
    assert_eq!(material.emission_texture.map(|texture| texture.uv_set), Some(1));

    let scene = load_shared(&folder, "TextureTransformTest/glTF/TextureTransformTest.gltf").scene;
    let transform = |name: &str| material_transform(&scene, name);
    let at = |name: &str| transform(name).transform_point2(Vec2::new(0.25, 0.75));
    assert_eq!(at("Offset U"), Vec2::new(0.75, 0.75));
    assert_eq!(at("Offset UV"), Vec2::new(0.75, 1.25));
    assert!(at("Scale").abs_diff_eq(Vec2::new(0.375, 1.125), 1e-6));
    let (sin, cos) = FRAC_PI_8.sin_cos();
    assert!(at("Rotation").abs_diff_eq(Vec2::new(0.25 * cos + 0.75 * sin, 0.75 * cos - 0.25 * sin), 1e-6));
    assert_eq!(transform("Correct"), Affine2::IDENTITY);
}

fn material_transform(scene: &Scene, name: &str) -> Affine2 {
    material(scene, name).base_color_texture.expect("a texture").transform
}

#[test]
fn materials() {
    let Some(folder) = common::scenes() else { return };
    let scene = load_shared(&folder, "AlphaBlendModeTest/glTF-Binary/AlphaBlendModeTest.glb").scene;
    for (name, mode) in [
        ("MatOpaque", AlphaMode::Opaque),
        ("MatBlend", AlphaMode::Blend),
        ("MatCutoff25", AlphaMode::Mask(0.25)),
        ("MatCutoff75", AlphaMode::Mask(0.75)),
        ("MatCutoffDefault", AlphaMode::Mask(0.5)),
    ] {
        assert_eq!(material(&scene, name).alpha_mode, mode, "{name}");
    }
    let scene = load_shared(&folder, "EmissiveStrengthTest/glTF-Binary/EmissiveStrengthTest.glb").scene;
    let mut strengths: Vec<f32> = scene.materials.iter().map(|material| material.emission.y / 0.5).collect();
    strengths.sort_by(f32::total_cmp);
    assert_eq!(strengths, [0.0, 1.0, 2.0, 4.0, 8.0, 16.0]);

    let scene = load_shared(&folder, "UnlitTest/glTF-Binary/UnlitTest.glb").scene;
    assert!(scene.materials.iter().all(|material| material.unlit));
    assert!(material(&scene, "Orange").base_color.abs_diff_eq(Vec4::new(1.0, 0.217_637_64, 0.0, 1.0), 1e-6));

    let scene = load_shared(&folder, "TextureSettingsTest/glTF-Binary/TextureSettingsTest.glb").scene;
    let wraps: Vec<[Wrap; 2]> = scene.textures.iter().map(|texture| texture.sampler.wrap).collect();
    for wrap in [[Wrap::Repeat, Wrap::Mirror], [Wrap::Clamp, Wrap::Repeat], [Wrap::Repeat; 2]] {
        assert!(wraps.contains(&wrap), "{wrap:?}");
    }
    let sampler = scene.textures[0].sampler;
    assert_eq!(
        (sampler.min, sampler.mip, sampler.mag),
        (Filter::Nearest, Some(Filter::Linear), Filter::Linear)
    );
}

#[test]
fn images() {
    let Some(folder) = common::scenes() else { return };
    let webp = load_shared(&folder, "ExtensionsRequired/BoxTexturedWebP/box-textured-webp.gltf").scene;
    let with_fallback =
        load_shared(&folder, "ExtensionsRequired/BoxTexturedWebP/box-textured-with-fallback.gltf").scene;
    assert_eq!(webp.images.len(), 1);
    assert_eq!(webp.images[0].levels, with_fallback.images[0].levels);
    assert!(webp.images[0].srgb && webp.images[0].levels[0].width > 1);
    let odd = load_shared(&folder, "BoxTexturedNonPowerOfTwo/glTF-Binary/BoxTexturedNonPowerOfTwo.glb").scene;
    let last = odd.images[0].levels.last().expect("levels");
    assert_eq!((last.width, last.height), (1, 1));
    // Normal maps are linear, and tangents come with them.
    let helmet = load_shared(&folder, "DamagedHelmet/glTF-Binary/DamagedHelmet.glb").scene;
    let normal = helmet.materials[0].normal_texture.expect("a normal map");
    assert!(!helmet.images[helmet.textures[normal.texture as usize].image as usize].srgb);
    assert!(!helmet.meshes[0].tangents.is_empty());
}

#[test]
fn cameras() {
    let Some(folder) = common::scenes() else { return };
    let scene = load_shared(&folder, "Cameras/glTF/Cameras.gltf").scene;
    let [perspective, orthographic] = scene.cameras.as_slice() else { panic!("two cameras") };
    assert_eq!(perspective.projection, Projection::Perspective { vertical_fov: 0.7 });
    assert_eq!(orthographic.projection, Projection::Orthographic { height: 2.0 });
    for camera in &scene.cameras {
        assert_eq!(camera.position, Vec3::new(0.5, 0.5, 3.0));
        assert_eq!((camera.forward, camera.up), (Vec3::NEG_Z, Vec3::Y));
    }
    assert!(matches!(
        load_shared(&folder, "Duck/glTF/Duck.gltf").scene.cameras[0].projection,
        Projection::Perspective { vertical_fov } if vertical_fov > 0.0 && vertical_fov < PI
    ));
}

#[test]
fn sharing() {
    let Some(folder) = common::scenes() else { return };
    let scene = load_shared(&folder, "SimpleInstancing/glTF-Binary/SimpleInstancing.glb").scene;
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 125));
    let scene = load_shared(&folder, "SimpleMeshes/glTF/SimpleMeshes.gltf").scene;
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 2));
    let scene = load_shared(&folder, "Sponza/Sponza.gltf").scene;
    assert_eq!((scene.meshes.len(), scene.instances.len(), scene.materials.len()), (103, 103, 25));
    assert_eq!(scene.materials[14].name, "fabric_e");
    assert_eq!(scene.meshes[54].material, 14);
    assert!(matches!(material(&scene, "chain").alpha_mode, AlphaMode::Mask(_)));
}
