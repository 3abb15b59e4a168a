//! Work that is told to stop: a flag says so, and the work ends with an error of its own kind.

use std::{
    fmt,
    sync::atomic::{AtomicBool, Ordering},
};

/// The user stopped the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interrupted;

impl fmt::Display for Interrupted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("interrupted")
    }
}

impl std::error::Error for Interrupted {}

/// An error if the flag `cancel` is set.
pub fn check(cancel: &AtomicBool) -> Result<(), Interrupted> {
    if cancel.load(Ordering::Relaxed) { Err(Interrupted) } else { Ok(()) }
}
