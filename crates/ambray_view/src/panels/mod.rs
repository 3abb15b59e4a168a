//! The panels around the canvas.

use crate::{app::Shown, engine::Engine, model::Model};

/// State of the panels from frame to frame.
#[derive(Debug, Default)]
pub struct Panels {}

impl Panels {
    /// Draws the panels at the edges of `ui`.
    pub fn show(&mut self, ui: &mut egui::Ui, model: &mut Model, shown: &mut Shown, _engine: &Engine) {
        egui::Panel::left("settings").show(ui, |ui| {
            ui.label(format!("{}", model.scene.path.display()));
            for notice in &shown.notices {
                ui.label(&notice.text);
            }
        });
    }
}
