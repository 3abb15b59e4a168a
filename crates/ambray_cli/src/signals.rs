//! Ctrl-C: work stops soon and leaves nothing half-written; a second one ends the program at once.

use std::{
    fmt, fs,
    path::{Path, PathBuf},
    process,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use anyhow::Context as _;

use crate::{failure::EXIT_INTERRUPTED, terminal};

static CANCEL: AtomicBool = AtomicBool::new(false);
static GRACEFUL: AtomicBool = AtomicBool::new(false);
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The user pressed Ctrl-C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interrupted;

impl fmt::Display for Interrupted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("interrupted")
    }
}

impl std::error::Error for Interrupted {}

/// Starts to listen for Ctrl-C and for requests to terminate.
///
/// Outside of [`Graceful`] work they end the program at once, after removing temporary files.
pub fn install() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        let first = !CANCEL.swap(true, Ordering::Relaxed);
        if !(first && GRACEFUL.load(Ordering::Relaxed)) {
            end_at_once();
        }
    })
    .context("signal handler")
}

fn end_at_once() -> ! {
    for path in TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner).iter() {
        let _ = fs::remove_file(path); // gone already if it was just renamed
    }
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
    if CANCEL.load(Ordering::Relaxed) { Err(Interrupted) } else { Ok(()) }
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
}

impl Drop for Graceful {
    fn drop(&mut self) {
        GRACEFUL.store(false, Ordering::Relaxed);
    }
}

/// A path that is removed if the program is ended at once while this lives.
#[derive(Debug)]
pub struct Temporary(PathBuf);

impl Temporary {
    /// Registers `path`.
    #[must_use]
    pub fn register(path: &Path) -> Self {
        TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner).retain(|path| *path != self.0);
    }
}
