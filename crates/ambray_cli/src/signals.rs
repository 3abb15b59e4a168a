//! Ctrl-C: work stops soon and leaves nothing half-written; a second one ends the program at once.

use std::{
    process,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

pub use ambray_files::Interrupted;
use ambray_files::{interruption, temporary};
use anyhow::Context as _;

use crate::{failure::EXIT_INTERRUPTED, terminal};

static CANCEL: AtomicBool = AtomicBool::new(false);
static GRACEFUL: AtomicBool = AtomicBool::new(false);
/// What is told of the first Ctrl-C besides.
static LISTENER: Mutex<Option<Box<dyn Fn() + Send>>> = Mutex::new(None);

/// Starts to listen for Ctrl-C and for requests to terminate.
///
/// Outside of [`Graceful`] work they end the program at once, after removing temporary files.
pub fn install() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        let first = !CANCEL.swap(true, Ordering::Relaxed);
        if !(first && GRACEFUL.load(Ordering::Relaxed)) {
            end_at_once();
        }
        if let Some(tell) = &*LISTENER.lock().unwrap_or_else(PoisonError::into_inner) {
            tell();
        }
    })
    .context("signal handler")
}

fn end_at_once() -> ! {
    temporary::remove_all();
    terminal::say("ambray: interrupted");
    process::exit(i32::from(EXIT_INTERRUPTED))
}

/// The flag that Ctrl-C sets.
#[must_use]
pub fn cancel_flag() -> &'static AtomicBool {
    &CANCEL
}

/// An error if Ctrl-C was pressed.
pub fn check() -> Result<(), Interrupted> {
    interruption::check(&CANCEL)
}

/// While this lives, the first Ctrl-C only sets the [`cancel_flag`], for work that looks at it.
#[derive(Debug)]
pub struct Graceful(());

impl Graceful {
    /// Begins such work.
    #[must_use]
    pub fn begin() -> Self {
        GRACEFUL.store(true, Ordering::Relaxed);
        Self(())
    }

    /// Begins work that does not look at the flag, but is told by `tell`.
    #[must_use]
    pub fn telling(tell: impl Fn() + Send + 'static) -> Self {
        *LISTENER.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(tell));
        Self::begin()
    }
}

impl Drop for Graceful {
    fn drop(&mut self) {
        GRACEFUL.store(false, Ordering::Relaxed);
        *LISTENER.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}
