//! What panels and keys ask the application to do.

use std::path::PathBuf;

use crate::model::{SceneRef, Side};

/// Something that a panel cannot do by changing the model.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Open a scene.
    Open(SceneRef),
    /// Read the open scene again.
    Reload,
    /// Ask for a file, then do something with it.
    Ask(Question),
    /// Take the settings of a file: TOML, or a picture that holds its settings.
    LoadSettings(PathBuf),
    /// Write the settings of the edited side as TOML.
    SaveSettings(PathBuf),
    /// Write the picture of the edited side.
    Screenshot(PathBuf),
    /// Write a turn of the camera around its target.
    Turntable {
        /// Where to: a numbered picture or a video.
        path: PathBuf,
        /// Frames of the whole turn.
        frames: u32,
        /// Frames a second of a video.
        fps: f32,
    },
    /// Stop the export that is under way.
    CancelExport,
    /// Close the window.
    Quit,
    /// Take back the last change of the settings.
    Undo,
    /// Make the change that was taken back.
    Redo,
    /// Keep the view under a digit.
    Keep(u8),
    /// Look from where a digit was kept.
    Recall(u8),
    /// Put the command line that makes the picture of a side on the clipboard.
    Copy(Side),
    /// Show or hide the side panels.
    TogglePanels,
    /// Let the window fill the screen, or give it back its size.
    ToggleFullscreen,
    /// Show or hide the help.
    ToggleHelp,
    /// Play or pause the animation.
    TogglePlay,
    /// Go on by so many frames of the animation.
    Step(i32),
    /// Do what a dropped file is for.
    Drop(PathBuf),
}

/// What a file is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    /// The scene to open.
    Scene,
    /// Settings to load.
    Load,
    /// Where to save settings.
    Save,
    /// Where to write the picture.
    Screenshot,
    /// Where to write a turntable.
    Turntable {
        /// Frames of the whole turn.
        frames: u32,
        /// Frames a second of a video.
        fps: f32,
    },
}
