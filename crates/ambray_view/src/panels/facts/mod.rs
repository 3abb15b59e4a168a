//! The right panel: what the picture took, what its values are, what the scene is.

mod histogram;
mod picture;
mod scene;
mod times;

use egui::{CollapsingHeader, RichText, ScrollArea, Ui};

use super::Desk;

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    ui.add_space(4.0);
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        section(ui, desk, "Frame", times::show);
        section(ui, desk, "Values", picture::show);
        section(ui, desk, "Scene", scene::show);
    });
}

fn section(ui: &mut Ui, desk: &mut Desk<'_>, title: &str, content: fn(&mut Ui, &mut Desk<'_>)) {
    let is_open = !desk.memory.panels.closed_sections.contains(title);
    let header = CollapsingHeader::new(RichText::new(title).strong()).id_salt(title).open(Some(is_open));
    let shown = header.show_unindented(ui, |ui| {
        content(ui, desk);
        ui.add_space(6.0);
    });
    if shown.header_response.clicked() {
        desk.memory.panels.toggle_section(title);
    }
}
