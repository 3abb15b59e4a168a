//! The scene of a command, with the warnings of the loader shown.

use std::path::Path;

pub use ambray_files::scene_source::Source;

use crate::terminal;

/// Loads the scene at `path`, or a built-in one, and shows the warnings.
pub fn open(path: &Path, gltf_scene: Option<&str>) -> anyhow::Result<Source> {
    let source = ambray_files::scene_source::open(path, gltf_scene)?;
    for warning in &source.warnings {
        terminal::warn(&format!("{}: {warning}", source.path));
    }
    Ok(source)
}

#[cfg(test)]
mod tests {
    use ambray_files::scene_source::BUILT_IN;

    #[test]
    fn built_in_scenes_are_named_in_help() {
        let command = crate::args::command();
        for (word, _) in BUILT_IN {
            for name in ["render", "query", "bench", "info"] {
                let sub = command.find_subcommand(name).expect("a command");
                let scene = sub.get_positionals().next().and_then(|arg| arg.get_help()).expect("help");
                assert!(scene.to_string().contains(word), "{name}: {scene}");
            }
        }
    }
}
