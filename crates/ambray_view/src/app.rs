//! The application without its window: what the user decides, what the engine answers, what is drawn.

mod shown;

pub use shown::{Loading, Notice, Severity, Shown};

use crate::{
    canvas::Canvas,
    engine::{Engine, Order},
    model::{Comparison, Model, Side},
    panels::Panels,
};

/// The application.
#[derive(Debug)]
pub struct App {
    /// What the user decides.
    pub model: Model,
    /// What the engine has delivered.
    pub shown: Shown,
    engine: Engine,
    canvas: Canvas,
    panels: Panels,
    /// The scene that the engine was last asked for.
    asked: Option<crate::model::SceneRef>,
}

impl App {
    /// Begins with `model`; its scene is opened at once.
    #[must_use]
    pub fn new(model: Model, engine: Engine) -> Self {
        Self {
            model,
            shown: Shown::default(),
            engine,
            canvas: Canvas::default(),
            panels: Panels::default(),
            asked: None,
        }
    }

    /// One frame of the window: takes what the engine has delivered, draws, and says what is wanted next.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        for event in self.engine.poll() {
            self.shown.take(event);
        }
        if self.asked.as_ref() != Some(&self.model.scene) {
            self.engine.open(&self.model.scene);
            self.asked = Some(self.model.scene.clone());
        }
        self.panels.show(ui, &mut self.model, &mut self.shown, &self.engine);
        self.canvas.show(ui, &mut self.model, &mut self.shown, &self.engine);
        self.model.share();
        self.engine.show(self.order());
    }

    /// What is wanted now.
    fn order(&self) -> Order {
        let model = &self.model;
        let side = |side: Side| model.sides().contains(&side).then(|| model.of(side).clone());
        Order {
            sides: Side::ALL.map(side),
            aov: model.aov,
            comparison: if model.sides().len() == 1 { Comparison::Off } else { model.comparison },
            is_moving: model.is_moving,
            is_playing: model.playback.is_playing,
        }
    }
}
