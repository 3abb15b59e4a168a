//! The canvas: the picture with everything that is drawn on it and done in it.

use crate::{
    app::Shown,
    engine::{Content, Engine},
    model::Model,
};

/// State of the canvas from frame to frame.
#[derive(Debug, Default)]
pub struct Canvas {}

impl Canvas {
    /// Draws the canvas into the rest of `ui`.
    pub fn show(&mut self, ui: &mut egui::Ui, model: &mut Model, shown: &mut Shown, _engine: &Engine) {
        egui::CentralPanel::default().show(ui, |ui| {
            let size = ui.available_size() * ui.pixels_per_point();
            model.of_mut(model.editing).size =
                ambray::settings::Size { width: (size.x as u32).max(1), height: (size.y as u32).max(1) };
            let Some(rendered) = &shown.sides[0] else { return };
            let Content::Host { pixels, .. } = &rendered.content;
            let size = [pixels.width as usize, pixels.height as usize];
            let image = egui::ColorImage::from_rgba_unmultiplied(size, &pixels.rgba);
            let texture = ui.ctx().load_texture("picture", image, egui::TextureOptions::NEAREST);
            ui.image((texture.id(), ui.available_size()));
        });
    }
}
