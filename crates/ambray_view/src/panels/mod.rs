//! The panels around the canvas. They change the [`Model`] and the [`Memory`], and ask for [`Action`]s.

pub mod action;
mod bottom;
mod camera_menu;
mod compare_menu;
mod dialogs;
mod drop_hint;
mod facts;
mod file_menu;
mod help;
pub mod keys;
pub mod look;
mod messages;
mod refusal;
mod settings;
mod top;
mod view_menu;

pub(crate) use bottom::duration;
use settings::became;

use action::Action;
use egui::{Panel, Ui, UiBuilder};

use crate::{app::Shown, memory::Memory, model::Model};
use dialogs::Dialogs;

/// State of the panels from frame to frame.
#[derive(Debug, Default)]
pub struct Panels {
    search: String,
    preset_name: String,
    dialogs: Dialogs,
    is_help_open: bool,
    is_styled: bool,
}

/// The least and the largest width of the settings, points.
const SETTINGS_WIDTHS: (f32, f32) = (260.0, 560.0);

/// Draws the content of a panel without letting it make the panel wider.
fn contained(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let place = ui.available_rect_before_wrap();
    add(&mut ui.new_child(UiBuilder::new().max_rect(place)));
    ui.advance_cursor_after_rect(place);
}

/// What lies before the panels in one frame.
#[derive(Debug)]
pub struct Desk<'a> {
    /// What the user decides.
    pub model: &'a mut Model,
    /// What the engine has delivered.
    pub shown: &'a mut Shown,
    /// What is remembered.
    pub memory: &'a mut Memory,
    /// What is asked of the application.
    pub actions: Vec<Action>,
    /// Whether a slider is being dragged.
    pub is_dragging: bool,
    /// Name of the preset that is about to be kept.
    pub preset_name: &'a mut String,
}

/// What the panels ask for.
#[derive(Debug, Default)]
pub struct Wishes {
    /// What to do.
    pub actions: Vec<Action>,
    /// Whether a slider is being dragged.
    pub is_dragging: bool,
}

impl Panels {
    /// Draws the panels at the edges of `ui`, and takes the keys that belong to them.
    pub fn show(&mut self, ui: &mut Ui, model: &mut Model, shown: &mut Shown, memory: &mut Memory) -> Wishes {
        if !self.is_styled {
            look::apply(ui.ctx());
            self.is_styled = true;
        }
        let actions = if self.dialogs.is_open() { Vec::new() } else { keys::pressed(ui.ctx()) };
        let preset_name = &mut self.preset_name;
        let mut desk = Desk { model, shown, memory, actions, is_dragging: false, preset_name };
        let dropped = ui.input(|input| input.raw.dropped_files.clone());
        desk.actions.extend(dropped.iter().map(|file| Action::Drop(file.path().to_owned())));

        Panel::top("menus").show(ui, |ui| top::show(ui, &mut desk));
        if desk.memory.panels.timeline {
            Panel::bottom("timeline").show(ui, |ui| bottom::show(ui, &mut desk));
        }
        // The picture keeps half of the window.
        let half = 0.5 * ui.available_width();
        if desk.memory.panels.facts {
            let widest = (half - SETTINGS_WIDTHS.0).clamp(240.0, 520.0);
            let panel = Panel::right("facts").default_size(280.0_f32.min(widest)).size_range(240.0..=widest);
            panel.show(ui, |ui| contained(ui, |ui| facts::show(ui, &mut desk)));
        }
        if desk.memory.panels.settings {
            let (least, most) = SETTINGS_WIDTHS;
            let widest = (ui.available_width() - half).clamp(least, most);
            let panel =
                Panel::left("settings").default_size(330.0_f32.min(widest)).size_range(least..=widest);
            panel.show(ui, |ui| contained(ui, |ui| settings::show(ui, &mut desk, &mut self.search)));
        }
        let canvas = ui.available_rect_before_wrap();
        help::show(ui.ctx(), &mut self.is_help_open);
        self.dialogs.show(ui.ctx(), &mut desk);
        if desk.model.has_overlays {
            messages::show(ui.ctx(), &mut desk, canvas);
        }
        drop_hint::show(ui.ctx());
        Wishes { actions: desk.actions, is_dragging: desk.is_dragging }
    }

    /// Asks for a file.
    pub fn ask(&mut self, question: action::Question, name: &str) {
        self.dialogs.ask(question, name);
    }

    /// Shows or hides the help.
    pub const fn toggle_help(&mut self) {
        self.is_help_open = !self.is_help_open;
    }

    /// Whether the help is shown.
    #[must_use]
    pub const fn is_help_open(&self) -> bool {
        self.is_help_open
    }
}
