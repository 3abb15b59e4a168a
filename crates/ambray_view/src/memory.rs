//! What is remembered from one run to the next: looks, recent files, bookmarks, the state of the window.

mod store;

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use ambray::settings::{Settings, SettingsPatch};
use serde::{Deserialize, Serialize};

pub use store::{Store, default_path};

use crate::model::{Bookmark, SceneRef};

/// Recent files that are kept.
const RECENT: usize = 10;

/// What is remembered.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", default)]
pub struct Memory {
    /// Scenes that were open, the newest first.
    pub recent: Vec<PathBuf>,
    /// The window.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<WindowState>,
    /// The panels.
    pub panels: PanelsState,
    /// The look of the last run: every setting that fits any scene.
    pub settings: SettingsPatch,
    /// Looks that the user named.
    pub presets: BTreeMap<String, SettingsPatch>,
    /// Bookmarks of each scene, by digit.
    pub bookmarks: BTreeMap<String, BTreeMap<String, Bookmark>>,
}

/// Size and place of the window, points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", default)]
pub struct WindowState {
    /// Width of the content.
    pub width: f32,
    /// Height of the content.
    pub height: f32,
    /// Whether it fills the screen.
    pub is_maximized: bool,
}

/// Which panels are open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", default)]
pub struct PanelsState {
    /// The settings, on the left.
    pub settings: bool,
    /// Times, histogram and scene, on the right.
    pub facts: bool,
    /// The animation, at the bottom.
    pub timeline: bool,
    /// Groups of settings that are open.
    pub open_groups: BTreeSet<String>,
    /// Sections of the right panel that are closed.
    pub closed_sections: BTreeSet<String>,
    /// Whether the histogram counts by factors.
    pub log_histogram: bool,
}

impl Default for PanelsState {
    fn default() -> Self {
        let open = ["Picture", "Ambient light", "Colour bleeding", "Thin objects"];
        Self {
            settings: true,
            facts: true,
            timeline: true,
            open_groups: open.map(str::to_owned).into(),
            closed_sections: BTreeSet::new(),
            log_histogram: true,
        }
    }
}

impl PanelsState {
    /// Opens or closes a group of settings.
    pub fn toggle_group(&mut self, heading: &str) {
        if !self.open_groups.remove(heading) {
            self.open_groups.insert(heading.to_owned());
        }
    }

    /// Opens or closes a section of the right panel.
    pub fn toggle_section(&mut self, title: &str) {
        if !self.closed_sections.remove(title) {
            self.closed_sections.insert(title.to_owned());
        }
    }
}

/// The settings that fit any scene: all but size, camera and moment.
#[must_use]
pub fn look_of(settings: &Settings) -> SettingsPatch {
    SettingsPatch {
        size: None,
        animation: None,
        time: None,
        frame: None,
        camera: None,
        camera_position: None,
        camera_target: None,
        camera_up: None,
        vertical_fov: None,
        orthographic_height: None,
        ..SettingsPatch::full(settings)
    }
}

impl Memory {
    /// Puts `scene` first among the recent ones; built-in scenes are always at hand.
    pub fn opened(&mut self, scene: &Path) {
        if is_built_in(scene) {
            return;
        }
        let scene = std::path::absolute(scene).unwrap_or_else(|_| scene.to_owned());
        self.recent.retain(|other| *other != scene);
        self.recent.insert(0, scene);
        self.recent.truncate(RECENT);
    }

    /// The bookmarks of `scene`.
    #[must_use]
    pub fn bookmarks_of(&self, scene: &SceneRef) -> BTreeMap<u8, Bookmark> {
        let kept = self.bookmarks.get(&key(scene)).into_iter().flatten();
        kept.filter_map(|(digit, bookmark)| Some((digit.parse().ok()?, bookmark.clone()))).collect()
    }

    /// Remembers the bookmarks of `scene`.
    pub fn keep_bookmarks(&mut self, scene: &SceneRef, bookmarks: &BTreeMap<u8, Bookmark>) {
        let kept: BTreeMap<_, _> =
            bookmarks.iter().map(|(digit, bookmark)| (digit.to_string(), bookmark.clone())).collect();
        if kept.is_empty() {
            self.bookmarks.remove(&key(scene));
        } else {
            self.bookmarks.insert(key(scene), kept);
        }
    }
}

/// Words that name scenes of the program, not files.
pub const BUILT_IN: [&str; 3] = ["atrium", "banner", "flock"];

fn is_built_in(scene: &Path) -> bool {
    BUILT_IN.iter().any(|word| Path::new(word) == scene)
}

fn key(scene: &SceneRef) -> String {
    if is_built_in(&scene.path) {
        return scene.path.display().to_string();
    }
    let path = std::path::absolute(&scene.path).unwrap_or_else(|_| scene.path.clone());
    match &scene.gltf_scene {
        Some(name) => format!("{} # {name}", path.display()),
        None => path.display().to_string(),
    }
}
