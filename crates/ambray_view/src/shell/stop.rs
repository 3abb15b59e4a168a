//! Closes the window from outside.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use winit::event_loop::EventLoopProxy;

use super::Wake;

/// Closes the window in order, from any thread: what is being written is given up, and what is remembered is kept. Clones are
/// one.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<Mutex<State>>);

#[derive(Debug, Default)]
struct State {
    is_requested: bool,
    window: Option<EventLoopProxy<Wake>>,
}

impl Stop {
    /// Closes the window; one that is not open yet is closed as soon as it is.
    pub fn request(&self) {
        let mut state = self.state();
        state.is_requested = true;
        state.tell();
    }

    /// From now on `window` is told.
    pub(super) fn listen(&self, window: EventLoopProxy<Wake>) {
        let mut state = self.state();
        state.window = Some(window);
        state.tell();
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn tell(&self) {
        if let Some(window) = self.window.as_ref().filter(|_| self.is_requested) {
            // A window that is closed needs no telling.
            let _ = window.send_event(Wake::Stop);
        }
    }
}
