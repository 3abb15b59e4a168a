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
mod settings;
mod top;
mod view_menu;

pub(crate) use bottom::duration;
use settings::became;

use action::Action;
use egui::{Panel, Ui};

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
        if desk.memory.panels.settings {
            let panel = Panel::left("settings").default_size(348.0).size_range(300.0..=560.0);
            panel.show(ui, |ui| settings::show(ui, &mut desk, &mut self.search));
        }
        if desk.memory.panels.facts {
            let panel = Panel::right("facts").default_size(296.0).size_range(240.0..=520.0);
            panel.show(ui, |ui| facts::show(ui, &mut desk));
        }
        help::show(ui.ctx(), &mut self.is_help_open);
        self.dialogs.show(ui.ctx(), &mut desk);
        messages::show(ui.ctx(), &mut desk);
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
