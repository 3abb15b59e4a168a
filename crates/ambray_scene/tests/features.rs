//! Features of glTF and OBJ that no shared scene has, in files made up on the spot.

mod common;

use ambray_core::light::{Cone, Light};
use ambray_scene::{AlphaMode, LoadOptions, Loaded, SceneChoice, load_with};
use common::{assert_refused, load_files, load_text};
use glam::{Vec2, Vec3, Vec4};

/// One triangle as non-indexed float positions, base64.
const TRIANGLE: &str = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

/// A glTF file that has that triangle as mesh 0, with `rest` in its root object.
fn gltf(rest: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{TRIANGLE}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        {rest}}}"#
    )
}

#[track_caller]
fn load(rest: &str) -> Loaded {
    load_text(&gltf(rest))
}

#[track_caller]
fn check_refused(rest: &str, expected: &str) {
    assert_refused(&gltf(rest), expected);
}

#[test]
fn lights() {
    let rest = r#""extensions":{"KHR_lights_punctual":{"lights":[
            {"type":"directional","color":[1,0.5,0],"intensity":2},
            {"type":"point","intensity":8,"range":5},
            {"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}}]}},
        "nodes":[
            {"rotation":[-0.70710678,0,0,0.70710678],"extensions":{"KHR_lights_punctual":{"light":0}}},
            {"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":1}}},
            {"extensions":{"KHR_lights_punctual":{"light":2}}}]"#;
    let lights = load(rest).scene.lights;
    // A quarter turn about -x makes -z point down.
    let Light::Directional { to_light, irradiance } = lights[0] else { panic!("{:?}", lights[0]) };
    assert!(to_light.abs_diff_eq(Vec3::Y, 1e-6) && irradiance == Vec3::new(2.0, 1.0, 0.0));
    assert_eq!(
        lights[1],
        Light::Point {
            position: Vec3::new(1.0, 2.0, 3.0),
            intensity: Vec3::splat(8.0),
            range: 5.0,
            cone: None
        }
    );
    let cone = Cone { axis: Vec3::NEG_Z, cos_inner: 0.1_f32.cos(), cos_outer: 0.2_f32.cos() };
    let spot =
        Light::Point { position: Vec3::ZERO, intensity: Vec3::ONE, range: f32::INFINITY, cone: Some(cone) };
    assert_eq!(lights[2], spot);
}

#[test]
fn scenes_are_chosen() {
    let rest = r#""nodes":[{"mesh":0},{"mesh":0,"translation":[1,0,0]}],
        "scene":1,"scenes":[{"name":"a","nodes":[0,1]},{"name":"b","nodes":[1]}]"#;
    assert_eq!(load(rest).scene.instances.len(), 1);
    let dir = tempfile::tempdir().expect("temporary folder");
    let path = dir.path().join("x.gltf");
    std::fs::write(&path, gltf(rest)).expect("write");
    let count = |scene| {
        let loaded = load_with(&path, &LoadOptions { scene: Some(scene) });
        loaded.map(|loaded| loaded.scene.instances.len()).map_err(|error| error.to_string())
    };
    assert_eq!(count(SceneChoice::Index(0)), Ok(2));
    assert_eq!(count(SceneChoice::Name("a".into())), Ok(2));
    assert_eq!(count(SceneChoice::Name("b".into())), Ok(1));
    assert!(
        count(SceneChoice::Index(2)).is_err_and(|text| text.ends_with("scenes: no scene 2, the file has 2"))
    );
    assert!(count(SceneChoice::Name("c".into())).is_err_and(|text| text.contains("no scene 'c'")));
    // Without scenes, all root nodes are shown.
    assert_eq!(load(r#""nodes":[{"children":[1]},{"mesh":0},{"mesh":0}]"#).scene.instances.len(), 2);
}

#[test]
fn transforms() {
    let rest = r#""nodes":[{"children":[1],"scale":[2,2,2]},{"mesh":0,"translation":[1,0,0]},
        {"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]},{"mesh":0,"scale":[1,0,1]}]"#;
    let loaded = load(rest);
    let place = |i: usize, p: Vec3| loaded.scene.instances[i].world_from_object.transform_point3(p);
    assert_eq!(place(0, Vec3::X), Vec3::new(4.0, 0.0, 0.0));
    assert_eq!(place(1, Vec3::X), Vec3::new(4.0, 6.0, 7.0));
    assert_eq!(loaded.scene.instances.len(), 2);
    assert_eq!(loaded.warnings, ["instances whose transform is singular or not finite are dropped (1)"]);
}

#[test]
fn expansion_is_bounded() {
    // Instances by the billion from a few bytes.
    let rest =
        r#""nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}}}],"#;
    let text = gltf(rest.trim_end_matches(',')).replace(
        r#""type":"VEC3"}]"#,
        r#""type":"VEC3"},{"componentType":5126,"count":4000000000,"type":"VEC3"}]"#,
    );
    let error = load_files(&[("x.gltf", text.as_bytes())]).expect_err("too many").to_string();
    assert!(error.contains("4000000000 instances, the limit is"), "{error}");
    // Zeros by the gigabyte.
    let text = gltf(r#""nodes":[{"mesh":0}]"#).replace(
        r#""bufferView":0,"componentType":5126,"count":3"#,
        r#""componentType":5126,"count":4000000000"#,
    );
    let error = load_files(&[("x.gltf", text.as_bytes())]).expect_err("too many").to_string();
    assert!(error.contains("expands to more vertex data than its size allows"), "{error}");
}

#[test]
fn broken_references_and_values() {
    check_refused(r#""nodes":[{"mesh":1}]"#, "nodes[0].mesh: mesh 1 does not exist");
    check_refused(r#""materials":[{"alphaMode":"HALF"}]"#, "materials[0].alphaMode: no such mode: 'HALF'");
    check_refused(
        r#""materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"extensions":{"KHR_texture_basisu":{"source":0}}}],"images":[{"uri":"a.ktx2"}]"#,
        "textures[0].source: the only source is a KTX2 image of KHR_texture_basisu",
    );
    check_refused(
        r#""nodes":[{"mesh":0,"rotation":[0,0,0,0]}]"#,
        "nodes[0].rotation: quaternion of length zero",
    );
    let text = gltf(r#""nodes":[{"mesh":0}]"#).replace("\"count\":3", "\"count\":4");
    let error = load_files(&[("x.gltf", text.as_bytes())]).expect_err("too long").to_string();
    assert!(error.ends_with("x.gltf: accessors[0]: ends at byte 48 of a 36-byte view"), "{error}");
}

#[test]
fn unknown_extensions() {
    let loaded = load(r#""extensionsUsed":["KHR_materials_sheen","ACME_x"],"nodes":[{"mesh":0}]"#);
    assert_eq!(
        loaded.warnings,
        ["extension 'KHR_materials_sheen' is ignored: sheen", "unknown extension 'ACME_x' is ignored"]
    );
    check_refused(r#""extensionsRequired":["ACME_x"]"#, "required extension 'ACME_x' is not supported");
}

#[test]
fn names_cannot_break_messages() {
    let loaded = load(r#""extensionsUsed":["a\nb"],"nodes":[{"mesh":0}]"#);
    assert_eq!(loaded.warnings, ["unknown extension 'a\\nb' is ignored"]);
    check_refused(r#""materials":[{"alphaMode":"a\u001b[31m\nb"}]"#, r"no such mode: 'a\u{1b}[31m\nb'");
}

#[test]
fn obj_with_materials() {
    let obj = "mtllib my lib.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n\
               o part\nusemtl leaf\nf 1/1 2/2 3/3\nusemtl nowhere\nf 1 2 3\nl 1 2\n";
    let mtl = "newmtl leaf\nKd 0.5 0.25 1\nKe 1 2 3\nmap_Kd leaf.png\nmap_d leaf.png\n";
    let loaded =
        load_files(&[("x.obj", obj.as_bytes()), ("my lib.mtl", mtl.as_bytes()), ("leaf.png", &png())])
            .expect("loads");
    let scene = loaded.scene;
    assert_eq!((scene.name.as_str(), scene.triangle_count(), scene.meshes.len()), ("x", 2, 2));
    let leaf = &scene.materials[0];
    assert_eq!((leaf.base_color, leaf.emission), (Vec4::new(0.5, 0.25, 1.0, 1.0), Vec3::new(1.0, 2.0, 3.0)));
    assert_eq!(leaf.alpha_mode, AlphaMode::Mask(0.5));
    assert_eq!(scene.images[0].levels[0].texels, [[255, 0, 0, 128]]);
    assert_eq!(scene.meshes[0].uvs[0][2], Vec2::new(0.0, 0.0));
    assert_eq!((scene.meshes[0].material, scene.meshes[1].material), (0, 1));
    assert_eq!(loaded.warnings.len(), 2, "{:?}", loaded.warnings);
}

#[test]
fn obj_without_its_library() {
    for library in ["gone.mtl", "../../gone.mtl", "/dev/zero"] {
        let obj = format!("mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        let loaded = load_files(&[("x.obj", obj.as_bytes())]).expect("loads");
        assert_eq!(loaded.scene.triangle_count(), 1);
        assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    }
    let error = load_files(&[("x.obj", b"v 0 0 0\nf 1 2 3\n")]).expect_err("out of range").to_string();
    assert!(error.ends_with("x.obj: line 2: vertex 2 of 1"), "{error}");
}

/// A PNG of one half-transparent red texel.
fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_pixel(1, 1, image::Rgba([255, 0, 0, 128]));
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("encodes");
    bytes.into_inner()
}
