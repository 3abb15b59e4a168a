//! From the word for a scene to the scene in memory.

use std::{
    path::{Path, PathBuf},
    time::{Duration, Instant, SystemTime},
};

use ambray::scene::{LoadOptions, Scene, SceneChoice, atrium, load_with, moving};
use anyhow::bail;

use crate::problem::with_hint;

/// What makes a scene.
type Make = fn() -> Scene;

/// The built-in scenes: their words on the command line, and what makes them. Help texts name them too.
pub const BUILT_IN: [(&str, Make); 3] =
    [("atrium", atrium::atrium), ("banner", moving::banner), ("flock", moving::flock)];

const HINT: &str = "SCENE is a .gltf, .glb or .obj file, or a built-in scene: atrium, banner or flock";

/// A scene with its history.
#[derive(Debug)]
pub struct Source {
    /// The scene.
    pub scene: Scene,
    /// Path of the file, or the word of a built-in scene.
    pub path: String,
    /// What pictures say they show: the path, with the scene within the file if one was asked for.
    pub label: String,
    /// The files that it was read from, also those that could not be; none for built-in scenes.
    pub files: Vec<PathBuf>,
    /// When the file was changed last, if the system tells.
    pub modified: Option<SystemTime>,
    /// What the loader had to say.
    pub warnings: Vec<String>,
    /// Wall time to load it.
    pub load_time: Duration,
}

/// Loads the scene at `path`, or a built-in one if `path` is its word; of a glTF file with several scenes `gltf_scene`, by
/// number or by name.
///
/// # Errors
///
/// If the file cannot be read, or has no such scene.
pub fn open(path: &Path, gltf_scene: Option<&str>) -> anyhow::Result<Source> {
    let start = Instant::now();
    let built_in = BUILT_IN.iter().find(|(word, _)| path == Path::new(word));
    let is_obj = path.extension().is_some_and(|ext| ext.eq_ignore_ascii_case("obj"));
    if gltf_scene.is_some() && (built_in.is_some() || is_obj) {
        bail!("--gltf-scene is not allowed with {}: only glTF files hold several scenes", path.display());
    }
    let (scene, warnings, files) = if let Some((_, make)) = built_in {
        (make(), Vec::new(), Vec::new())
    } else {
        let loaded = load_with(path, &LoadOptions { scene: gltf_scene.map(choice) }).map_err(|error| {
            if path.exists() {
                return error.into();
            }
            with_hint(error, HINT)
        })?;
        (loaded.scene, loaded.warnings, loaded.files)
    };
    let name = path.display().to_string();
    Ok(Source {
        scene,
        label: gltf_scene.map_or_else(|| name.clone(), |scene| format!("{name}, scene {scene}")),
        path: name,
        files,
        modified: path
            .metadata()
            .and_then(|metadata| metadata.modified())
            .ok()
            .filter(|_| built_in.is_none()),
        warnings,
        load_time: start.elapsed(),
    })
}

fn choice(name: &str) -> SceneChoice {
    name.parse().map_or_else(|_| SceneChoice::Name(name.to_owned()), SceneChoice::Index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_scenes_are_named_in_the_hint() {
        for (word, _) in BUILT_IN {
            assert!(HINT.contains(word), "{word}");
        }
        let error = open(Path::new("no such scene"), None).unwrap_err();
        assert_eq!(crate::hint_of(&error), Some(HINT));
    }

    #[test]
    fn built_in_scenes_are_one_scene() {
        let source = open(Path::new("banner"), None).unwrap();
        assert_eq!((source.label.as_str(), source.modified, source.warnings.len()), ("banner", None, 0));
        let error = open(Path::new("banner"), Some("1")).unwrap_err().to_string();
        assert!(error.starts_with("--gltf-scene is not allowed with banner"), "{error}");
    }
}
