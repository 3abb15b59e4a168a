//! The menu of files: scenes, settings, pictures.

use egui::{Button, Ui};

use super::{
    Desk,
    action::{Action, Question},
};
use crate::{memory::BUILT_IN, model::SceneRef};

/// What the built-in scenes are.
const MEANINGS: [&str; 3] = [
    "A courtyard: corners, curtains, colour bleeding",
    "A cloth that bends between columns",
    "Two thousand instances that fly",
];

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    item(ui, desk, "Open\u{2026}", "Ctrl+O", Action::Ask(Question::Scene));
    recent(ui, desk);
    ui.menu_button("Built-in scenes", |ui| {
        for (word, meaning) in BUILT_IN.into_iter().zip(MEANINGS) {
            if ui.button(word).on_hover_text(meaning).clicked() {
                desk.actions.push(Action::Open(SceneRef::new(word)));
            }
        }
    });
    item(ui, desk, "Reload", "F5", Action::Reload);
    ui.separator();
    item(ui, desk, "Load settings\u{2026}", "Ctrl+L", Action::Ask(Question::Load));
    item(ui, desk, "Save settings\u{2026}", "Ctrl+Shift+S", Action::Ask(Question::Save));
    ui.separator();
    item(ui, desk, "Screenshot\u{2026}", "Ctrl+S", Action::Ask(Question::Screenshot));
    let turntable = Question::Turntable { frames: 120, fps: 30.0 };
    item(ui, desk, "Turntable\u{2026}", "", Action::Ask(turntable));
    ui.separator();
    item(ui, desk, "Undo", "Ctrl+Z", Action::Undo);
    item(ui, desk, "Redo", "Ctrl+Y", Action::Redo);
    ui.separator();
    item(ui, desk, "Quit", "Ctrl+Q", Action::Quit);
}

fn item(ui: &mut Ui, desk: &mut Desk<'_>, name: &str, keys: &str, action: Action) {
    if ui.add(Button::new(name).shortcut_text(keys)).clicked() {
        desk.actions.push(action);
    }
}

fn recent(ui: &mut Ui, desk: &mut Desk<'_>) {
    ui.add_enabled_ui(!desk.memory.recent.is_empty(), |ui| {
        ui.menu_button("Recent", |ui| {
            let mut is_cleared = false;
            for path in &desk.memory.recent {
                let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
                if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                    desk.actions.push(Action::Open(SceneRef::new(path)));
                }
            }
            ui.separator();
            is_cleared |= ui.button("Forget these").clicked();
            if is_cleared {
                desk.memory.recent.clear();
            }
        });
    });
}
