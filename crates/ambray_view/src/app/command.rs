//! The command line that makes the picture that is seen.

use ambray::{
    Aov, Machine,
    settings::{Settings, Temporal},
};

use super::Shown;
use crate::model::Model;

/// The call of `ambray render` that makes the picture with `settings`, which is the mean of `frames` frames; of its settings
/// alone where that is 0 or 1.
pub(super) fn line(model: &Model, shown: &Shown, settings: &Settings, frames: u32) -> String {
    let mut more = Vec::new();
    // Another backend rounds differently.
    match shown.opened.as_ref().map(|opened| &opened.machine) {
        Some(Machine::Cpu { reason: None, .. }) => more.push("--backend=cpu".to_owned()),
        Some(Machine::Vulkan { .. }) => more.push("--backend=vulkan".to_owned()),
        // The processor stepped in: it will again.
        Some(Machine::Cpu { .. }) | None => {}
    }
    if model.aov != Aov::Beauty {
        more.push(format!("--aov={}", model.aov.name()));
        more.extend(["-o".to_owned(), "ambray.png".to_owned()]);
    }
    // Frames that are accumulated: the last picture of the sequence is the one that is seen.
    if settings.temporal == Temporal::On && frames > 1 {
        if let Some(name) = more.last_mut().filter(|name| *name == "ambray.png") {
            "ambray_####.png".clone_into(name);
        }
        // They are counted from --frame on.
        more.push(format!("--frames=0..{frames}"));
        if shown.opened.as_ref().is_some_and(|opened| !opened.animations.is_empty()) {
            more.push("--hold-time".to_owned());
        }
    }
    let scene = shown.opened.as_ref().map_or(&model.scene, |opened| &opened.scene);
    ambray_files::command_line::render_command(&scene.path, scene.gltf_scene.as_deref(), settings, &more)
}
