//! What is shown: the plane, the size of the picture, the panels.

use ambray::{Aov, settings::Size};
use egui::{ComboBox, DragValue, Ui};

use super::Desk;
use crate::model::Resolution;

/// Sizes of the picture in the window, as shares of its place.
const SHARES: [(f32, &str); 3] = [(1.0, "window size"), (0.5, "window size / 2"), (0.25, "window size / 4")];
/// Usual sizes of pictures.
const SIZES: [(u32, u32); 4] = [(1280, 720), (1920, 1080), (2560, 1440), (1024, 1024)];

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    ui.menu_button("Plane", |ui| planes(ui, desk));
    ui.menu_button("Size of the picture", |ui| sizes(ui, desk));
    ui.checkbox(&mut desk.model.has_overlays, "Words and lines on the picture");
    ui.separator();
    let panels = &mut desk.memory.panels;
    ui.checkbox(&mut panels.settings, "Settings");
    ui.checkbox(&mut panels.facts, "Times, histogram, scene");
    ui.checkbox(&mut panels.timeline, "Animation");
    ui.weak("Tab shows or hides all");
}

/// The plane that is shown, to choose from.
pub(super) fn plane(ui: &mut Ui, desk: &mut Desk<'_>) {
    let combo = ComboBox::from_id_salt("plane").width(132.0).selected_text(desk.model.aov.name());
    let response = combo.show_ui(ui, |ui| planes(ui, desk)).response;
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::ComboBox, true, "plane"));
    response.on_hover_text(format!("The plane that is shown: {}", desk.model.aov.description()));
}

fn planes(ui: &mut Ui, desk: &mut Desk<'_>) {
    for &aov in Aov::ALL {
        let is_shown = desk.model.aov == aov;
        if ui.selectable_label(is_shown, aov.name()).on_hover_text(aov.description()).clicked() {
            desk.model.aov = aov;
        }
    }
}

fn sizes(ui: &mut Ui, desk: &mut Desk<'_>) {
    for (share, name) in SHARES {
        ui.radio_value(&mut desk.model.resolution, Resolution::Window(share), name);
    }
    ui.separator();
    for (width, height) in SIZES {
        let size = Size { width, height };
        ui.radio_value(&mut desk.model.resolution, Resolution::Fixed(size), size.to_string());
    }
    ui.horizontal(|ui| {
        let current = desk.model.edited().size;
        let mut size = match desk.model.resolution {
            Resolution::Fixed(size) => size,
            Resolution::Window(_) => current,
        };
        let width = ui.add(DragValue::new(&mut size.width).range(1..=32_768));
        ui.label("\u{d7}");
        let height = ui.add(DragValue::new(&mut size.height).range(1..=32_768));
        if width.changed() || height.changed() {
            desk.model.resolution = Resolution::Fixed(size);
        }
    });
}
