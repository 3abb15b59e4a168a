//! The bar at the top: menus, the comparison, and the command line.

use egui::{MenuBar, RichText, Ui};

use super::{Desk, action::Action, camera_menu, compare_menu, file_menu, look, view_menu};
use crate::model::{Comparison, Side};

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file_menu::show(ui, desk));
        ui.menu_button("View", |ui| view_menu::show(ui, desk));
        ui.menu_button("Camera", |ui| camera_menu::show(ui, desk));
        ui.menu_button("Compare", |ui| compare_menu::show(ui, desk));
        ui.separator();
        view_menu::plane(ui, desk);
        ui.separator();
        comparison(ui, desk);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.button("?").on_hover_text("Keys and mouse (? or F1)").clicked() {
                desk.actions.push(Action::ToggleHelp);
            }
            copy(ui, desk);
            scene_name(ui, desk);
        });
    });
}

fn comparison(ui: &mut Ui, desk: &mut Desk<'_>) {
    for (comparison, name, tip) in [
        (Comparison::Off, "A", "Show side A alone"),
        (Comparison::Split, "A | B", "Compare two settings, with a divider to drag"),
        (Comparison::Difference, "A \u{2212} B", "Show the difference, with its RMSE"),
    ] {
        let is_chosen = desk.model.comparison == comparison;
        if ui.selectable_label(is_chosen, name).on_hover_text(tip).clicked() {
            desk.model.compare(comparison);
        }
    }
}

fn copy(ui: &mut Ui, desk: &mut Desk<'_>) {
    if desk.model.comparison == Comparison::Off {
        let button = ui.button("Copy as command line");
        let tip = "Puts the call of ambray render that makes this picture on the clipboard (Ctrl+Shift+C)";
        if button.on_hover_text(tip).clicked() {
            desk.actions.push(Action::Copy(Side::A));
        }
        return;
    }
    ui.menu_button("Copy as command line", |ui| {
        for (side, color) in [(Side::A, look::SIDE_A), (Side::B, look::SIDE_B)] {
            let text = RichText::new(format!("for side {side:?}")).color(color);
            if ui.button(text).clicked() {
                desk.actions.push(Action::Copy(side));
            }
        }
    });
}

fn scene_name(ui: &mut Ui, desk: &Desk<'_>) {
    let path = desk.shown.opened.as_ref().map_or(&desk.model.scene.path, |opened| &opened.scene.path);
    let name =
        path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into());
    let label = egui::Label::new(RichText::new(name).weak()).truncate();
    ui.add(label).on_hover_text(path.display().to_string());
}
