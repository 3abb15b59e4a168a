//! The engine: loads, renders and exports on threads of its own, so that the window never waits.
//!
//! The window tells it what is wanted; the latest [`Order`] counts. It answers with [`Event`]s.

mod contract;
mod worker;

use std::sync::mpsc;

pub use contract::{
    AnimationInfo, CameraInfo, Content, Difference, EngineOptions, Event, Export, Level, Opened, Order,
    Pixels, Rendered, Statistics, Wake,
};

use crate::model::{SceneRef, Side};

/// Does the work; made once, dropped at the end.
#[derive(Debug)]
pub struct Engine {
    requests: mpsc::Sender<worker::Request>,
    events: mpsc::Receiver<Event>,
}

impl Engine {
    /// Starts the threads.
    #[must_use]
    pub fn new(options: EngineOptions) -> Self {
        let (requests, incoming) = mpsc::channel();
        let (outgoing, events) = mpsc::channel();
        std::thread::spawn(move || worker::run(&options, &incoming, &outgoing));
        Self { requests, events }
    }

    /// Opens another scene. The old one stays until the new one is there, and if that fails.
    pub fn open(&self, scene: &SceneRef) {
        let _ = self.requests.send(worker::Request::Open(scene.clone()));
    }

    /// Says what is wanted now. Cheap where nothing has changed.
    pub fn show(&self, order: Order) {
        let _ = self.requests.send(worker::Request::Show(Box::new(order)));
    }

    /// Asks what the pixel at `(x, y)` of the picture of `side` did; the answer is [`Event::Inspected`].
    pub fn inspect(&self, _side: Side, _pixel: (u32, u32)) {}

    /// Begins an export.
    pub fn export(&self, _export: Export) {}

    /// Stops the export that is under way.
    pub fn cancel_export(&self) {}

    /// What has happened since the last call.
    pub fn poll(&self) -> Vec<Event> {
        self.events.try_iter().collect()
    }
}
