//! Every valid shared scene renders, and looks as it did: coverage, openness and brightness of a 16 × 9 thumbnail.
//!
//! `AMBRAY_BLESS=1` writes the thumbnails anew; look at the pictures before committing them.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use ambray::{Control, Frame, Renderer};
use ambray_core::settings::{Settings, Size};
use conformance::shared;
use serde_json::{Value, json};

/// Files that need a decoder which this project lacks, with the extension that the refusal must name.
const REFUSED: [(&str, &str); 5] = [
    ("glTF-Draco/", "KHR_draco_mesh_compression"),
    ("BoxMeshopt.glb", "EXT_meshopt_compression"),
    ("BoxMeshopt-separate/", "EXT_meshopt_compression"),
    ("CesiumBalloonKTX2.glb", "KHR_texture_basisu"),
    ("Draco", "KHR_draco_mesh_compression"),
];

/// Nothing is seen here: the cutoff is above 1.
const INVISIBLE: &str = "AssetGenerator/Material_AlphaMask/Material_AlphaMask_03.gltf";

const SNAPSHOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/snapshots/scenes.json");
/// Each thumbnail pixel is the mean of 4 × 4 pixels.
const THUMBNAIL: (usize, usize) = (16, 9);

fn scenes(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> =
        fs::read_dir(folder).expect("the folder can be read").flatten().map(|e| e.path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() && path.file_name().is_some_and(|name| name != "invalid") {
            scenes(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "gltf" || extension == "glb") {
            found.push(path);
        }
    }
}

fn thumbnail(frame: &Frame) -> Value {
    let mean = |f: &dyn Fn(usize) -> f32| -> Vec<f64> {
        let cell = |cell: usize| {
            let (x, y) = (cell % THUMBNAIL.0 * 4, cell / THUMBNAIL.0 * 4);
            let pixels = (0..16).map(|i| (y + i / 4) * frame.width as usize + x + i % 4);
            (f64::from(pixels.map(f).sum::<f32>() / 16.0) * 1000.0).round() / 1000.0
        };
        (0..THUMBNAIL.0 * THUMBNAIL.1).map(cell).collect()
    };
    json!({
        "coverage": mean(&|i| f32::from(u8::from(frame.gbuffer[i].is_surface()))),
        "openness": mean(&|i| frame.ambient[i].x),
        "brightness": mean(&|i| (frame.beauty[i].element_sum() / 3.0).min(4.0)),
    })
}

/// Largest difference of two thumbnails, over all planes.
fn difference(a: &Value, b: &Value) -> f64 {
    let values = |v: &Value| -> Vec<f64> {
        ["coverage", "openness", "brightness"]
            .iter()
            .flat_map(|plane| v[plane].as_array().into_iter().flatten().filter_map(Value::as_f64))
            .collect()
    };
    let (a, b) = (values(a), values(b));
    if a.len() != b.len() {
        f64::INFINITY
    } else {
        a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

#[test]
fn every_valid_scene_looks_as_it_did() {
    let Some(root) = shared::scene_path("") else { return };
    let mut files = Vec::new();
    scenes(&root, &mut files);
    assert!(files.len() > 100, "{} scenes", files.len());
    let bless = std::env::var_os("AMBRAY_BLESS").is_some();
    let stored: BTreeMap<String, Value> = fs::read_to_string(SNAPSHOT)
        .ok()
        .and_then(|text| serde_json::from_str(&text).ok())
        .unwrap_or_default();
    let (mut rendered, mut failures) = (BTreeMap::new(), Vec::new());
    for file in files {
        let name = file.strip_prefix(&root).expect("it is below the folder").to_string_lossy().into_owned();
        let refused = REFUSED.iter().find(|(part, _)| name.contains(part)).map(|(_, extension)| extension);
        let scene = match (ambray_scene::load(&file), refused) {
            (Ok(loaded), None) => loaded.scene,
            (Err(error), Some(extension)) if error.to_string().contains(extension) => continue,
            (Ok(_), Some(extension)) => panic!("{name} loaded without {extension}"),
            (Err(error), _) => {
                failures.push(error.to_string());
                continue;
            }
        };
        let settings = Settings { size: Size { width: 64, height: 36 }, spp: 4, ..Settings::default() };
        let mut renderer = Renderer::new(scene);
        let frame =
            renderer.render(&settings, Control::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
        if !frame.beauty.iter().all(|v| v.is_finite()) {
            failures.push(format!("{name}: a pixel is not finite"));
        }
        let seen = frame.gbuffer.iter().filter(|pixel| pixel.is_surface()).count();
        let empty = renderer.scene().triangle_count() == 0 || name == INVISIBLE;
        if (seen == 0) != empty {
            failures.push(format!(
                "{name}: {seen} pixels see a surface of {} triangles",
                renderer.scene().triangle_count()
            ));
        }
        let thumbnail = thumbnail(&frame);
        match stored.get(&name) {
            _ if bless => {}
            None => failures.push(format!("{name}: no thumbnail is stored")),
            Some(stored) => {
                let difference = difference(stored, &thumbnail);
                if difference > 0.02 {
                    failures.push(format!("{name}: the thumbnail differs by {difference:.3}"));
                }
            }
        }
        rendered.insert(name, thumbnail);
    }
    if bless {
        let text = serde_json::to_string(&rendered).expect("thumbnails are plain data").replace("},", "},\n");
        fs::create_dir_all(Path::new(SNAPSHOT).parent().expect("a folder")).expect("it can be made");
        fs::write(SNAPSHOT, text + "\n").expect("the snapshot can be written");
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
