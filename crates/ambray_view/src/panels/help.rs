//! The help: all keys and what the mouse does.

use egui::{Context, Grid, RichText, Ui, Window};

use super::keys::SHORTCUTS;
use crate::canvas::ACTIONS;

pub(super) fn show(ctx: &Context, is_open: &mut bool) {
    let window = Window::new("Keys and mouse").open(is_open).collapsible(false).resizable(false);
    window.default_pos([260.0, 60.0]).show(ctx, |ui| {
        ui.horizontal_top(|ui| {
            let shortcuts = SHORTCUTS.iter().map(|shortcut| (shortcut.keys, shortcut.meaning));
            table(ui, "Window", shortcuts);
            ui.separator();
            table(ui, "Picture", ACTIONS.iter().map(|action| (action.keys, action.meaning)));
        });
    });
}

fn table(ui: &mut Ui, title: &str, rows: impl Iterator<Item = (&'static str, &'static str)>) {
    ui.vertical(|ui| {
        ui.label(RichText::new(title).strong());
        Grid::new(title).num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
            for (keys, meaning) in rows {
                ui.label(RichText::new(keys).monospace());
                ui.label(meaning);
                ui.end_row();
            }
        });
    });
}
