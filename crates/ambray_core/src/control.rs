//! How a caller follows and stops long work.

use std::sync::atomic::{AtomicBool, Ordering};

/// Progress, cancellation and threads of a long call. None of it changes the result.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Called from any thread with the share done, in `[0, 1]`.
    pub progress: &'a (dyn Fn(f32) + Sync),
    /// Work stops soon after this is set.
    pub cancel: &'a AtomicBool,
    /// Number of threads, 0 for all cores.
    pub threads: usize,
}

/// The work was cancelled through [`Control::cancel`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

static NEVER: AtomicBool = AtomicBool::new(false);

impl Default for Control<'_> {
    fn default() -> Self {
        Self { progress: &|_| (), cancel: &NEVER, threads: 0 }
    }
}

impl Control<'_> {
    /// Fails if the caller wants to stop.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancel.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }
}

impl std::fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Control")
            .field("cancel", self.cancel)
            .field("threads", &self.threads)
            .finish_non_exhaustive()
    }
}
