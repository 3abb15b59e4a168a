//! Everything that the user decides, as plain data.

use std::{collections::BTreeMap, path::PathBuf};

use ambray::{
    Aov,
    settings::{Auto, Settings, Size, Triple},
};
use serde::{Deserialize, Serialize};

/// Which scene is open.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SceneRef {
    /// Path of a file, or the word of a built-in scene.
    pub path: PathBuf,
    /// Scene of a glTF file, by name or number.
    pub gltf_scene: Option<String>,
}

impl SceneRef {
    /// The scene that `path` names.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), gltf_scene: None }
    }
}

/// One of the two pictures that are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Side {
    /// The picture; on the left of the divider.
    #[default]
    A,
    /// What it is compared with; on the right.
    B,
}

impl Side {
    /// Both.
    pub const ALL: [Self; 2] = [Self::A, Self::B];

    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }
}

/// How two settings are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Comparison {
    /// Only side A is shown.
    #[default]
    Off,
    /// A and B beside each other, with a divider to drag.
    Split,
    /// A − B.
    Difference,
}

/// Size of the rendered picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// That of the place in the window, times a factor above 0.
    Window(f32),
    /// A size of its own, scaled to the place in the window.
    Fixed(Size),
}

/// How fast an animation plays, and whether it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Whether time goes on.
    pub is_playing: bool,
    /// Seconds of the animation in a second.
    pub speed: f32,
    /// Frames a second of a single step.
    pub fps: f32,
}

impl Default for Playback {
    fn default() -> Self {
        Self { is_playing: false, speed: 1.0, fps: 24.0 }
    }
}

/// A place to look from, kept to come back to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Bookmark {
    /// Camera of the file.
    pub camera: Auto<String>,
    /// Position, world space.
    pub camera_position: Auto<Triple>,
    /// Point that the camera looks at, world space.
    pub camera_target: Auto<Triple>,
    /// Direction that is upright in the picture.
    pub camera_up: Auto<Triple>,
    /// Full vertical angle of view, degrees.
    pub vertical_fov: Auto<f32>,
    /// Height of an orthographic view, scene units.
    pub orthographic_height: Auto<f32>,
}

impl Bookmark {
    /// The place that `settings` look from.
    #[must_use]
    pub fn of(settings: &Settings) -> Self {
        Self {
            camera: settings.camera.clone(),
            camera_position: settings.camera_position.clone(),
            camera_target: settings.camera_target.clone(),
            camera_up: settings.camera_up.clone(),
            vertical_fov: settings.vertical_fov.clone(),
            orthographic_height: settings.orthographic_height.clone(),
        }
    }

    /// Makes `settings` look from here.
    pub fn apply(&self, settings: &mut Settings) {
        let place = self.clone();
        settings.camera = place.camera;
        settings.camera_position = place.camera_position;
        settings.camera_target = place.camera_target;
        settings.camera_up = place.camera_up;
        settings.vertical_fov = place.vertical_fov;
        settings.orthographic_height = place.orthographic_height;
    }
}

/// Everything that the user decides.
#[derive(Clone, Debug)]
pub struct Model {
    /// The scene that was asked for last.
    pub scene: SceneRef,
    /// Settings of side A and of side B, complete.
    pub settings: [Settings; 2],
    /// The side that the panel edits.
    pub editing: Side,
    /// How the sides are compared.
    pub comparison: Comparison,
    /// Place of the divider, share of the width from the left.
    pub divider: f32,
    /// The plane that is shown.
    pub aov: Aov,
    /// Size of the picture.
    pub resolution: Resolution,
    /// The animation.
    pub playback: Playback,
    /// Whether the pixel inspector is open.
    pub is_inspecting: bool,
    /// Whether words and lines are drawn over the picture; without them it can be seen byte for byte.
    pub has_overlays: bool,
    /// Places to look from in this scene, by digit.
    pub bookmarks: BTreeMap<u8, Bookmark>,
    /// Whether the camera or a slider is being dragged: quick pictures are worth more than fine ones.
    pub is_moving: bool,
}

impl Model {
    /// Shows `scene` with `settings`.
    #[must_use]
    pub fn new(scene: SceneRef, settings: Settings) -> Self {
        Self {
            scene,
            settings: [settings.clone(), settings],
            editing: Side::A,
            comparison: Comparison::Off,
            divider: 0.5,
            aov: Aov::Beauty,
            resolution: Resolution::Window(1.0),
            playback: Playback::default(),
            is_inspecting: false,
            has_overlays: true,
            bookmarks: BTreeMap::new(),
            is_moving: false,
        }
    }

    /// Settings of `side`.
    #[must_use]
    pub const fn of(&self, side: Side) -> &Settings {
        &self.settings[side as usize]
    }

    /// Settings of `side`, to be changed. What the sides share must be changed on both: [`share`](Self::share).
    pub const fn of_mut(&mut self, side: Side) -> &mut Settings {
        &mut self.settings[side as usize]
    }

    /// Gives the other side what both share, from the side that is edited: camera, size, moment and display. Without a
    /// comparison that is side A.
    pub fn share(&mut self) {
        if self.comparison == Comparison::Off {
            self.editing = Side::A; // B cannot be seen
        }
        let from = self.of(self.editing).clone();
        let to = self.of_mut(self.editing.other());
        *to = Settings {
            size: from.size,
            exposure: from.exposure,
            tone_map: from.tone_map,
            ramp: from.ramp,
            range: from.range,
            animation: from.animation,
            time: from.time,
            animation_loop: from.animation_loop,
            camera: from.camera,
            camera_position: from.camera_position,
            camera_target: from.camera_target,
            camera_up: from.camera_up,
            vertical_fov: from.vertical_fov,
            orthographic_height: from.orthographic_height,
            ..to.clone()
        };
    }

    /// Settings of the side that the panel edits.
    #[must_use]
    pub const fn edited(&self) -> &Settings {
        self.of(self.editing)
    }

    /// Settings of the side that the panel edits, to be changed.
    pub const fn edited_mut(&mut self) -> &mut Settings {
        self.of_mut(self.editing)
    }

    /// Compares both sides, or not; without a comparison only side A can be edited.
    pub fn compare(&mut self, comparison: Comparison) {
        self.comparison = comparison;
        if comparison == Comparison::Off {
            self.editing = Side::A;
        }
    }

    /// The sides that are shown.
    #[must_use]
    pub fn sides(&self) -> &'static [Side] {
        if self.comparison == Comparison::Off { &[Side::A] } else { &Side::ALL }
    }
}
