//! From the word on the command line to a scene in memory.

use std::{
    path::Path,
    time::{Duration, Instant, SystemTime},
};

use ambray::scene::{LoadOptions, Scene, SceneChoice, atrium, load_with, moving};
use anyhow::bail;

use crate::{failure::with_hint, terminal};

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
    /// When the file was changed last, if the system tells.
    pub modified: Option<SystemTime>,
    /// What the loader had to say.
    pub warnings: Vec<String>,
    /// Wall time to load it.
    pub load_time: Duration,
}

/// Loads the scene at `path`, or a built-in one, and shows the warnings.
pub fn open(path: &Path, gltf_scene: Option<&str>) -> anyhow::Result<Source> {
    let start = Instant::now();
    let built_in = BUILT_IN.iter().find(|(word, _)| path == Path::new(word));
    let is_obj = path.extension().is_some_and(|ext| ext.eq_ignore_ascii_case("obj"));
    if gltf_scene.is_some() && (built_in.is_some() || is_obj) {
        bail!("--gltf-scene is not allowed with {}: only glTF files hold several scenes", path.display());
    }
    let (scene, warnings) = if let Some((_, make)) = built_in {
        (make(), Vec::new())
    } else {
        let loaded = load_with(path, &LoadOptions { scene: gltf_scene.map(choice) }).map_err(|error| {
            if path.exists() {
                return error.into();
            }
            with_hint(error, HINT)
        })?;
        (loaded.scene, loaded.warnings)
    };
    for warning in &warnings {
        terminal::warn(&format!("{}: {warning}", path.display()));
    }
    let name = path.display().to_string();
    Ok(Source {
        scene,
        label: gltf_scene.map_or_else(|| name.clone(), |scene| format!("{name}, scene {scene}")),
        path: name,
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
    fn built_in_scenes_are_named_in_help_and_hint() {
        let command = crate::args::command();
        for (word, _) in BUILT_IN {
            assert!(HINT.contains(word), "{word}");
            for name in ["render", "query", "bench", "info"] {
                let sub = command.find_subcommand(name).expect("a command");
                let scene = sub.get_positionals().next().and_then(|arg| arg.get_help()).expect("help");
                assert!(scene.to_string().contains(word), "{name}: {scene}");
            }
        }
    }
}
