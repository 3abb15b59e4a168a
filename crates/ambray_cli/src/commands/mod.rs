//! The commands.

pub mod bench;
pub mod documents;
pub mod info;
pub mod query;
pub mod render;

use ambray::{Control, RenderError};

use crate::{args::RunArgs, failure::Problems, signals};

/// Control of long work: Ctrl-C, threads and a progress bar.
fn control<'a>(run: &RunArgs, progress: &'a (dyn Fn(f32) + Sync)) -> Control<'a> {
    Control { progress, cancel: signals::cancel_flag(), threads: usize::from(run.threads) }
}

/// The renderer's errors in the terms of the program.
fn explained(error: RenderError) -> anyhow::Error {
    match error {
        RenderError::Cancelled => signals::Interrupted.into(),
        RenderError::Settings(problems) => {
            Problems(problems.iter().map(|p| format!("--{p}")).collect()).into()
        }
        other => other.into(),
    }
}
