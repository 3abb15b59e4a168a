//! The command line that makes the picture that is seen.

use ambray::{Aov, settings::Temporal};

use super::Shown;
use crate::model::{Model, Side};

/// The call of `ambray render` that makes the picture of `side`.
pub(super) fn line(model: &Model, shown: &Shown, side: Side) -> String {
    let settings = model.of(side);
    let mut more = Vec::new();
    if model.aov != Aov::Beauty {
        more.push(format!("--aov={}", model.aov.name()));
        more.extend(["-o".to_owned(), "ambray.png".to_owned()]);
    }
    // Frames that are accumulated: the last picture of the sequence is the one that is seen.
    let frames = shown.sides[side as usize].as_ref().map_or(1, |rendered| rendered.frames);
    if settings.temporal == Temporal::On && frames > 1 {
        if let Some(name) = more.last_mut() {
            "ambray_####.png".clone_into(name);
        }
        more.push(format!("--frames={}..{}", settings.frame, settings.frame + frames));
    }
    let scene = shown.opened.as_ref().map_or(&model.scene, |opened| &opened.scene);
    ambray_files::command_line::render_command(&scene.path, scene.gltf_scene.as_deref(), settings, &more)
}
