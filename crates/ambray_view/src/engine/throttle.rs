//! Progress that does not flood the window.

use std::{
    sync::Mutex,
    time::{Duration, Instant},
};

use super::guard::lock;

/// Shortest time between two reports.
const PAUSE: Duration = Duration::from_millis(50);

/// Lets through a report now and then, the first after a pause: work that is over by then needs none.
#[derive(Debug)]
pub(super) struct Throttle {
    last: Mutex<(Instant, f32)>,
}

impl Throttle {
    pub(super) fn new() -> Self {
        Self { last: Mutex::new((Instant::now(), 0.0)) }
    }

    /// Calls `report` with `share` if it is time for it and the share has grown.
    pub(super) fn report(&self, share: f32, report: impl FnOnce(f32)) {
        let mut last = lock(&self.last);
        if last.0.elapsed() >= PAUSE && share > last.1 {
            *last = (Instant::now(), share);
            report(share);
        }
    }
}
