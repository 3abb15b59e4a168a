//! The folder of scenes that the project tests with but does not ship.

use std::path::PathBuf;

use ambray_scene::Scene;

/// Path of a shared scene, or `None` with a word on standard error where the folder is missing.
///
/// # Panics
/// If the folder is missing and `AMBRAY_REQUIRE_SCENES=1` says that it must be there.
#[must_use]
pub fn scene_path(relative: &str) -> Option<PathBuf> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/scenes"));
    if folder.is_dir() {
        return Some(folder.join(relative));
    }
    let required = std::env::var_os("AMBRAY_REQUIRE_SCENES").is_some_and(|value| value == "1");
    assert!(!required, "AMBRAY_REQUIRE_SCENES=1, but there is no folder shared/scenes beside the project");
    eprintln!("skipped: there is no folder shared/scenes beside the project");
    None
}

/// Loads a shared scene, or `None` as [`scene_path`].
///
/// # Panics
/// If the scene does not load.
#[must_use]
pub fn load(relative: &str) -> Option<Scene> {
    let path = scene_path(relative)?;
    Some(ambray_scene::load(&path).unwrap_or_else(|error| panic!("{error}")).scene)
}
