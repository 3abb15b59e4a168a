//! The application without its window: what the user decides, what the engine answers, what is drawn.

mod actions;
mod clock;
mod command;
mod drop;
mod errands;
mod history;
mod script;
mod shown;

use std::time::Duration;

pub use shown::{Loading, Notice, Severity, Shown, TIMINGS, Timing};

pub(crate) use errands::write;

use crate::{
    canvas::Canvas,
    engine::{Engine, Event, Order},
    memory::{Memory, Store, look_of},
    model::{Bookmark, Comparison, Model, SceneRef, Side},
    panels::{Panels, Wishes},
};
use ambray::settings::{Auto, Settings};
use clock::Clock;
use errands::Errands;
use history::History;

/// The application.
#[derive(Debug)]
pub struct App {
    /// What the user decides.
    pub model: Model,
    /// What the engine has delivered.
    pub shown: Shown,
    /// What is remembered.
    pub memory: Memory,
    engine: Engine,
    canvas: Canvas,
    panels: Panels,
    store: Store,
    errands: Errands,
    history: History,
    clock: Clock,
    /// The scene that the engine was last asked for.
    asked: Option<SceneRef>,
    /// The scene that could not be opened, while none is shown.
    failed: Option<SceneRef>,
    /// The last order.
    sent: Option<Order>,
    /// The last settings of each side that can be rendered.
    valid: [Settings; 2],
    /// The last line that was put on the clipboard.
    copied: Option<String>,
    /// Whether a picture of side A has arrived since the last frame of the window.
    has_arrived: bool,
    is_quitting: bool,
}

impl App {
    /// Begins with `model`; its scene is opened at once. Nothing is remembered.
    #[must_use]
    pub fn new(model: Model, engine: Engine) -> Self {
        Self::remembering(model, engine, Memory::default(), Store::none())
    }

    /// As [`new`](Self::new), with what is remembered of earlier runs, and where it lies.
    #[must_use]
    pub fn remembering(mut model: Model, engine: Engine, memory: Memory, store: Store) -> Self {
        model.bookmarks = memory.bookmarks_of(&model.scene);
        let valid = model.settings.each_ref().map(|settings| {
            if settings.validate().is_empty() { settings.clone() } else { Settings::default() }
        });
        Self {
            model,
            shown: Shown::default(),
            memory,
            engine,
            canvas: Canvas::default(),
            panels: Panels::default(),
            store,
            errands: Errands::default(),
            history: History::default(),
            clock: Clock::default(),
            asked: None,
            failed: None,
            sent: None,
            valid,
            copied: None,
            has_arrived: false,
            is_quitting: false,
        }
    }

    /// One frame of the window: takes what the engine has delivered, draws, and says what is wanted next.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        let now = ui.input(|input| input.time);
        self.hear();
        let has_arrived = std::mem::take(&mut self.has_arrived);
        self.take_outcomes();
        self.clock.tick(&mut self.model, self.shown.opened.as_deref(), has_arrived, now);
        if self.asked.as_ref() != Some(&self.model.scene) {
            self.ask_for_scene();
        }
        let Wishes { actions, is_dragging } =
            self.panels.show(ui, &mut self.model, &mut self.shown, &mut self.memory);
        self.canvas.show(ui, &mut self.model, &mut self.shown, &self.engine);
        for action in actions {
            self.perform(ui.ctx(), action);
        }
        self.model.share();
        let is_typing = ui.ctx().text_edit_focused();
        self.history.observe(&self.model.settings, is_dragging || self.model.is_moving || is_typing);
        self.order(is_dragging);
        self.remember(ui.ctx(), now);
    }

    /// Takes what the engine has delivered. Called also where nothing is drawn, so that pictures do not pile up behind a
    /// window that is hidden.
    pub fn hear(&mut self) {
        for event in self.engine.poll() {
            match &event {
                // A word of a build that was given up.
                Event::Loading { scene, .. } if self.asked.as_ref() != Some(scene) => continue,
                Event::Opened(opened) => {
                    let before = self.shown.opened.as_ref();
                    if before.is_some_and(|before| before.scene != opened.scene) {
                        self.leave();
                    }
                    self.failed = None;
                    self.sent = None;
                    self.memory.opened(&opened.scene.path);
                }
                Event::OpenFailed { scene, .. } if *scene == self.model.scene => self.scene_failed(),
                Event::Picture(rendered) => self.has_arrived |= rendered.side == Side::A,
                _ => {}
            }
            self.shown.take(event);
        }
    }

    /// Leaves what belongs to the scene that was shown so far: places, animations and moments fit no other.
    fn leave(&mut self) {
        for settings in &mut self.model.settings {
            Bookmark::default().apply(settings);
            (settings.animation, settings.time) = (Auto::Auto, Auto::Auto);
        }
        self.model.playback.is_playing = false;
        self.history = History::default();
    }

    /// Goes back to the scene that is still shown, if there is one.
    fn scene_failed(&mut self) {
        match &self.shown.opened {
            Some(opened) => {
                self.model.scene = opened.scene.clone();
                self.model.bookmarks = self.memory.bookmarks_of(&self.model.scene);
                self.asked = Some(self.model.scene.clone());
            }
            None => self.failed = Some(self.model.scene.clone()),
        }
    }

    fn ask_for_scene(&mut self) {
        if let Some(before) = &self.asked {
            self.memory.keep_bookmarks(before, &self.model.bookmarks);
            self.model.bookmarks = self.memory.bookmarks_of(&self.model.scene);
        }
        self.failed = None;
        self.engine.open(&self.model.scene);
        self.asked = Some(self.model.scene.clone());
    }

    /// Tells the engine what is wanted where that has changed.
    fn order(&mut self, is_dragging: bool) {
        for side in Side::ALL {
            // What cannot be rendered is shown in the panel; the last picture that could be stays.
            if self.model.of(side).validate().is_empty() {
                self.valid[side as usize] = self.model.of(side).clone();
            }
        }
        let model = &self.model;
        let side = |side: Side| model.sides().contains(&side).then(|| self.valid[side as usize].clone());
        let order = Order {
            sides: Side::ALL.map(side),
            aov: model.aov,
            comparison: if model.sides().len() == 1 { Comparison::Off } else { model.comparison },
            is_moving: model.is_moving || is_dragging,
            is_playing: model.playback.is_playing,
        };
        if self.sent.as_ref() != Some(&order) {
            self.engine.show(order.clone());
            self.sent = Some(order);
        }
    }

    fn remember(&mut self, ctx: &egui::Context, now: f64) {
        self.note();
        let (is_waiting, told) = self.store.keep(&self.memory, now);
        if is_waiting {
            ctx.request_repaint_after(Duration::from_millis(500));
        }
        if let Some(message) = told {
            self.shown.notify(Severity::Warning, message);
        }
    }

    /// Brings the memory up to date.
    fn note(&mut self) {
        self.memory.settings = look_of(self.model.of(Side::A));
        if self.asked.as_ref() == Some(&self.model.scene) {
            self.memory.keep_bookmarks(&self.model.scene, &self.model.bookmarks);
        }
    }

    /// Writes what is to be remembered. For the end of the program; says what went wrong.
    pub fn finish(&mut self) -> Option<String> {
        self.note();
        self.store.finish(&self.memory)
    }

    /// The canvas.
    pub const fn canvas_mut(&mut self) -> &mut Canvas {
        &mut self.canvas
    }
}
