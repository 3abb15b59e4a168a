//! The help: all keys and what the mouse does.

use egui::{Align2, Context, Label, RichText, ScrollArea, Ui, Window};

use super::{keys::SHORTCUTS, look};
use crate::canvas::ACTIONS;

/// Width of a table, points.
const TABLE: f32 = 380.0;
/// Width of the keys in it, points.
const KEYS: f32 = 142.0;

pub(super) fn show(ctx: &Context, is_open: &mut bool) {
    let room = 0.9 * ctx.content_rect().size();
    // Beside each other where there is room, else below each other.
    let is_wide = room.x > 2.0 * TABLE + 60.0;
    let width = if is_wide { 2.0 * TABLE + 24.0 } else { TABLE.min(room.x - 40.0) };
    let window = Window::new("Keys and mouse").open(is_open).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_CENTER, [0.0, 0.0]).show(ctx, |ui| {
        ui.set_width(width);
        let height = room.y - 60.0;
        let area = ScrollArea::vertical().max_height(height).min_scrolled_height(height);
        area.auto_shrink([false, true]).show(ui, |ui| {
            if is_wide {
                ui.columns(2, |columns| {
                    shortcuts(&mut columns[0]);
                    actions(&mut columns[1]);
                });
            } else {
                shortcuts(ui);
                ui.add_space(10.0);
                actions(ui);
            }
        });
    });
}

fn shortcuts(ui: &mut Ui) {
    table(ui, "Window", SHORTCUTS.iter().map(|shortcut| (shortcut.keys, shortcut.meaning)));
}

fn actions(ui: &mut Ui) {
    table(ui, "Picture", ACTIONS.iter().map(|action| (action.keys, action.meaning)));
}

fn table(ui: &mut Ui, title: &str, rows: impl Iterator<Item = (&'static str, &'static str)>) {
    ui.label(RichText::new(title).heading());
    for (keys, meaning) in rows {
        ui.horizontal_top(|ui| {
            look::cell(ui, KEYS, |ui| ui.add(Label::new(RichText::new(keys).monospace()).wrap()));
            ui.add(Label::new(meaning).wrap());
        });
    }
}
