//! The `ambray` program as a library, so that tests and fuzzers reach its parts.
//!
//! The way of a command: [`args`] reads the command line without side effects, [`settings`] joins defaults, preset,
//! file and flags into settings, [`commands`] do the work, [`ambray_files`] writes pictures, [`report`] says what was done.
#![forbid(unsafe_code)]

pub mod args;
pub mod commands;
pub mod failure;
pub mod machine;
pub mod points;
pub mod progress;
pub mod report;
pub mod scene_source;
pub mod settings;
pub mod signals;
pub mod terminal;
pub mod timeline;
pub mod usage;

use std::{ffi::OsString, process::ExitCode};

use args::Command;

/// Runs the program with `arguments`, the program's name first; prints errors and returns the exit code:
/// 0 done, 1 over the tolerance, 2 error, 130 interrupted.
pub fn run<I, T>(arguments: I) -> ExitCode
where
    I: IntoIterator<Item = T>,
    T: Into<OsString>,
{
    terminal::log_warnings();
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let outcome = match args::parse_from(&arguments) {
        Ok(command) => signals::install()
            .and_then(|()| dispatch(&command))
            // Devices are closed by now, which the layer may have had something to say about.
            .and_then(|()| terminal::check_validation()),
        Err(error) if error.use_stderr() => Err(usage::explain(&error, &arguments)),
        Err(help) => {
            let _ = help.print(); // a closed terminal is no reason to fail
            return ExitCode::SUCCESS;
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failure::report(&error),
    }
}

fn dispatch(command: &Command) -> anyhow::Result<()> {
    match command {
        Command::Render(args) => commands::render::run(args),
        Command::View(args) => commands::view::run(args),
        Command::Query(args) => commands::query::run(args),
        Command::Compare(args) => commands::compare::run(args),
        Command::Bench(args) => commands::bench::run(args),
        Command::Diff(args) => commands::diff::run(args),
        Command::Info(args) => commands::info::run(args),
        Command::Completions(args) => commands::documents::completions(args),
        Command::Man => commands::documents::man(),
    }
}
