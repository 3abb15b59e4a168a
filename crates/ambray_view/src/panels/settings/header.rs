//! Head of the settings panel: which side is edited, presets, reset, search.

use ambray::settings::{Preset, Settings};
use egui::{RichText, TextEdit, Ui};

use super::{reset, side_mark};
use crate::{
    model::{Model, Side},
    panels::Desk,
};

/// The presets of the program, with what they are.
const PRESETS: [(Preset, &str, &str); 3] = [
    (Preset::Draft, "draft", "4 interleaved rays per pixel, filtered: for a first look"),
    (Preset::Realtime, "realtime", "8 interleaved rays per pixel, filtered: the method as published"),
    (
        Preset::Reference,
        "reference",
        "1024 rays per pixel, scrambled in every pixel, unfiltered: the truth to compare with",
    ),
];

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>, search: &mut String) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        ui.label(RichText::new("Settings").heading());
        if let Some((_, color)) = side_mark(desk) {
            for side in Side::ALL {
                let is_edited = desk.model.editing == side;
                let text = RichText::new(format!("{side:?}")).strong();
                let text = if is_edited { text.color(color) } else { text };
                let tip = format!("Edit side {side:?}; settings that differ are coloured");
                let response = ui.selectable_label(is_edited, text).on_hover_text(tip);
                response.widget_info(|| {
                    let name = format!("edit side {side:?}");
                    egui::WidgetInfo::selected(egui::WidgetType::SelectableLabel, true, is_edited, name)
                });
                if response.clicked() {
                    desk.model.editing = side;
                }
            }
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.button("Reset all").on_hover_text("Every setting but the camera and the size").clicked() {
                reset_all(desk.model);
            }
            ui.menu_button("Presets", |ui| presets(ui, desk));
        });
    });
    ui.horizontal(|ui| {
        let width = ui.available_width() - if search.is_empty() { 0.0 } else { 26.0 };
        let field = TextEdit::singleline(search).hint_text("Search settings").desired_width(width);
        let response = ui.add(field);
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "search settings"));
        if !search.is_empty() && ui.button("x").on_hover_text("Show all").clicked() {
            search.clear();
        }
    });
    ui.separator();
}

/// Gives all settings their defaults, apart from where the camera is, when it is, and how large the picture is.
fn reset_all(model: &mut Model) {
    let kept = ["size", "time"];
    for field in Settings::fields() {
        if field.heading != "Camera" && !kept.contains(&field.name) {
            reset(model, field);
        }
    }
}

fn presets(ui: &mut Ui, desk: &mut Desk<'_>) {
    for (preset, name, meaning) in PRESETS {
        if ui.button(name).on_hover_text(meaning).clicked() {
            preset.patch().apply(desk.model.edited_mut());
        }
    }
    ui.separator();
    let mut gone = None;
    let presets = desk.memory.presets.clone();
    for (name, patch) in &presets {
        ui.horizontal(|ui| {
            if ui.button(name).on_hover_text("A look that you kept").clicked() {
                patch.apply(desk.model.edited_mut());
            }
            if ui.small_button("x").on_hover_text("Forget this preset").clicked() {
                gone = Some(name.clone());
            }
        });
    }
    if let Some(name) = gone {
        desk.memory.presets.remove(&name);
    }
    keep(ui, desk);
}

/// A field for a name, and a button that keeps the look under it.
fn keep(ui: &mut Ui, desk: &mut Desk<'_>) {
    ui.horizontal(|ui| {
        let field = TextEdit::singleline(desk.preset_name).hint_text("name").desired_width(110.0);
        ui.add(field);
        let name = desk.preset_name.trim().to_owned();
        let button = egui::Button::new("Keep as preset");
        if ui.add_enabled(!name.is_empty(), button).clicked() {
            let look = crate::memory::look_of(desk.model.edited());
            desk.memory.presets.insert(name, look);
            desk.preset_name.clear();
        }
    });
}
