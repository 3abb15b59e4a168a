//! Progress bar on stderr for work that takes long, if stderr is a terminal.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Work shorter than this shows no bar.
const SHORT: Duration = Duration::from_millis(500);
/// Steps of the bar.
const STEPS: u64 = 1000;

/// A progress bar that appears once the work turns out long and vanishes when it is dropped.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
}

impl Progress {
    /// Bar for the work called `what`; never shown if `quiet`.
    #[must_use]
    pub fn new(what: &'static str, quiet: bool) -> Self {
        // indicatif draws nothing where stderr is no terminal.
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(STEPS), target).with_message(what);
        let style = ProgressStyle::with_template("{msg} {bar:40} {percent}% {eta}");
        bar.set_style(style.expect("the template is well-formed"));
        Self { bar, start: Instant::now() }
    }

    /// Names the part of the work that is under way.
    pub fn say(&self, what: String) {
        if self.start.elapsed() > SHORT {
            self.bar.set_message(what);
        }
    }

    /// Shows that `share` of the work is done, in `[0, 1]`.
    pub fn report(&self, share: f32) {
        if self.start.elapsed() > SHORT {
            self.bar.set_position((share.clamp(0.0, 1.0) * STEPS as f32) as u64);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
