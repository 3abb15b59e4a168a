//! Errors on their way to the user: one line each, a hint below, the exit code.

use std::{fmt, io, process::ExitCode};

use ambray_files::hint_of;
pub use ambray_files::{Problems, with_hint};

use crate::{
    signals::Interrupted,
    terminal::{self, one_line},
};

/// Exit code where pictures differ by more than the tolerance.
pub const EXIT_OVER_TOLERANCE: u8 = 1;
/// Exit code of every error.
pub const EXIT_ERROR: u8 = 2;
/// Exit code after Ctrl-C, as shells have it: 128 + SIGINT.
pub const EXIT_INTERRUPTED: u8 = 130;

/// Prints `error` and returns the exit code. A reader who left (broken pipe) is no error.
#[must_use]
pub fn report(error: &anyhow::Error) -> ExitCode {
    let broken_pipe = |cause: &(dyn std::error::Error + 'static)| {
        cause.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
    };
    if error.chain().any(broken_pipe) {
        return ExitCode::SUCCESS;
    }
    if error.downcast_ref::<Interrupted>().is_some() {
        terminal::say("ambray: interrupted");
        return ExitCode::from(EXIT_INTERRUPTED);
    }
    if let Some(OverTolerance(told)) = error.downcast_ref() {
        told.iter().for_each(|line| terminal::say(line));
        return ExitCode::from(EXIT_OVER_TOLERANCE);
    }
    for line in lines(error) {
        terminal::say(&line);
    }
    ExitCode::from(EXIT_ERROR)
}

/// Pictures differ by more than the tolerance: the answer to a question rather than an error.
#[derive(Debug)]
pub struct OverTolerance(Option<String>);

impl OverTolerance {
    /// The `first` of what is over the tolerance, and how much `more` there is; nothing is said if `quiet`.
    #[must_use]
    pub fn new(first: &str, more: usize, quiet: bool) -> Self {
        let more = if more == 0 { String::new() } else { format!(" (and {more} more)") };
        Self((!quiet).then(|| format!("ambray: {}{more}", one_line(first))))
    }
}

impl fmt::Display for OverTolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.as_deref().unwrap_or("over the tolerance"))
    }
}

impl std::error::Error for OverTolerance {}

/// The lines that tell about `error`.
fn lines(error: &anyhow::Error) -> Vec<String> {
    if let Some(Problems(problems)) = error.downcast_ref() {
        return problems.iter().map(|problem| format!("ambray: error: {}", one_line(problem))).collect();
    }
    let mut lines = vec![format!("ambray: error: {}", one_line(&format!("{error:#}")))];
    lines.extend(hint_of(error).map(|hint| format!("  hint: {hint}")));
    lines
}

#[cfg(test)]
mod tests {
    use anyhow::{Context as _, anyhow};

    use super::*;

    #[test]
    fn context_reads_from_the_outside_in() {
        let error = anyhow!("no such\nfile").context("scene.glb");
        assert_eq!(lines(&error), ["ambray: error: scene.glb: no such file"]);
        let error = with_hint(error, "check the path");
        assert_eq!(lines(&error), ["ambray: error: scene.glb: no such file", "  hint: check the path"]);
    }

    #[test]
    fn each_problem_has_its_line() {
        let error = Err::<(), _>(Problems(vec!["a".to_owned(), "b".to_owned()])).context("x").unwrap_err();
        assert_eq!(lines(&error), ["ambray: error: a", "ambray: error: b"]);
    }
}
