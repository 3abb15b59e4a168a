//! Events on their way to the window.

use std::sync::mpsc;

use super::contract::{Event, Wake};

/// Where every thread of the engine puts its events.
#[derive(Clone, Debug)]
pub(super) struct Outbox {
    events: mpsc::Sender<Event>,
    wake: Wake,
}

impl Outbox {
    pub(super) fn new(wake: Wake) -> (Self, mpsc::Receiver<Event>) {
        let (events, receiver) = mpsc::channel();
        (Self { events, wake }, receiver)
    }

    /// Tells the window what has happened.
    pub(super) fn send(&self, event: Event) {
        // Nobody listens any more once the window is closing.
        if self.events.send(event).is_ok() {
            (self.wake.0)();
        }
    }
}
