//! The command line that makes the picture that is seen.

use ambray::{
    Aov, Machine,
    settings::{Settings, Temporal},
};

use super::Shown;
use crate::model::{Model, Side};

/// The call of `ambray render` that makes the picture of `side` with `settings`, which is the mean of `frames` frames; of its
/// settings alone where that is 0 or 1.
pub(super) fn line(model: &Model, shown: &Shown, side: Side, settings: &Settings, frames: u32) -> String {
    let mut more = Vec::new();
    more.extend(backend(shown, side, settings).map(str::to_owned));
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

/// The option that names who makes the picture of `side` with `settings`, since another backend rounds differently; `None` where
/// `ambray render` finds them by itself.
fn backend(shown: &Shown, side: Side, settings: &Settings) -> Option<&'static str> {
    let rendered = shown.sides[side as usize].as_ref();
    // The machine of another method may be another one.
    let rendered = rendered.filter(|rendered| rendered.settings.method == settings.method);
    let machine = rendered.map(|rendered| &rendered.machine);
    match machine.or_else(|| Some(&shown.opened.as_ref()?.machine))? {
        Machine::Cpu { reason: None, .. } => Some("--backend=cpu"),
        // Only until the first picture of the method is there; --backend=vulkan would be an error.
        Machine::Vulkan { .. } if settings.method.is_screen_space() => None,
        Machine::Vulkan { .. } => Some("--backend=vulkan"),
        // The processor stepped in, for the device or for the method: it will again.
        Machine::Cpu { .. } => None,
    }
}
