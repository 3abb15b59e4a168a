//! What a dropped file is for, by its name.

use std::path::{Path, PathBuf};

use crate::{model::SceneRef, panels::action::Action};

/// What to do with the file at `path`, or why nothing can be done.
pub(super) fn purpose(path: PathBuf) -> Result<Action, String> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("gltf" | "glb" | "obj") => Ok(Action::Open(SceneRef::new(path))),
        Some("toml" | "png" | "exr") => Ok(Action::LoadSettings(path)),
        _ => Err(format!(
            "{}: {}",
            name(&path),
            "neither a scene (.gltf, .glb, .obj) nor settings (.toml, .png, .exr)"
        )),
    }
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_known_by_their_names() {
        assert_eq!(purpose("a/b.GLB".into()), Ok(Action::Open(SceneRef::new("a/b.GLB"))));
        assert_eq!(purpose("look.toml".into()), Ok(Action::LoadSettings("look.toml".into())));
        assert!(purpose("a/notes.txt".into()).unwrap_err().starts_with("notes.txt: neither a scene"));
        assert!(purpose("folder".into()).is_err());
    }
}
