//! What the user reads: stdout that may be closed early, stderr that may be absent. Nothing here panics.

use std::{
    borrow::Cow,
    io::{self, Write as _},
    sync::atomic::{AtomicUsize, Ordering},
};

use ambray::vulkan::VALIDATION_LOG;
use anyhow::anyhow;
use log::{LevelFilter, Log, Metadata, Record};

use crate::report::counted;

/// Messages of Vulkan's validation layer that were shown.
static VALIDATION_MESSAGES: AtomicUsize = AtomicUsize::new(0);

/// Writes `text` to stdout.
pub fn print(text: &str) -> anyhow::Result<()> {
    print_bytes(text.as_bytes())
}

/// Writes `bytes` to stdout.
pub fn print_bytes(bytes: &[u8]) -> anyhow::Result<()> {
    ambray_files::atomic::write_stdout(bytes)
}

/// Writes lines to stderr, if there is one.
pub fn say(lines: &str) {
    let _ = writeln!(io::stderr(), "{}", harmless(lines));
}

/// Tells of something odd that does not stop the work.
pub fn warn(message: &str) {
    say(&format!("ambray: warning: {}", one_line(message)));
}

/// The lines of `text` as one.
#[must_use]
pub fn one_line(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

/// `text` with its control characters spelled out, but ends of lines: names from files must not command the terminal.
pub(crate) fn harmless(text: &str) -> Cow<'_, str> {
    let is_command = |c: char| c.is_control() && c != '\n';
    if !text.contains(is_command) {
        return Cow::Borrowed(text);
    }
    let spell = |c: char| if is_command(c) { c.escape_default().to_string() } else { c.to_string() };
    Cow::Owned(text.chars().map(spell).collect())
}

/// Shows warnings that Ambray's libraries log.
pub fn log_warnings() {
    // Fails only if a logger is set already, which then shows them.
    if log::set_logger(&WARNINGS).is_ok() {
        log::set_max_level(LevelFilter::Warn);
    }
}

/// An error if Vulkan's validation layer had anything to say so far.
pub fn check_validation() -> anyhow::Result<()> {
    match VALIDATION_MESSAGES.load(Ordering::Relaxed) {
        0 => Ok(()),
        count => Err(anyhow!("Vulkan's validation layer had {}", counted(count as u64, "message"))),
    }
}

static WARNINGS: Warnings = Warnings;

#[derive(Debug)]
struct Warnings;

impl Log for Warnings {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        // Libraries of windows warn of desktops that lack something, which is nobody's business here.
        let is_ours = ["ambray", "gpu_allocator"].iter().any(|name| metadata.target().starts_with(name));
        is_ours && metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &Record<'_>) {
        if !self.enabled(record.metadata()) {
            return;
        }
        if record.target() == VALIDATION_LOG {
            VALIDATION_MESSAGES.fetch_add(1, Ordering::Relaxed);
            warn(&format!("vulkan: {}", record.args()));
        } else {
            warn(&record.args().to_string());
        }
    }

    fn flush(&self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_command_the_terminal() {
        assert_eq!(harmless("a\nC:\\é 'b'"), "a\nC:\\é 'b'");
        assert_eq!(harmless("\u{1b}[2J\r\t\u{7}\u{7f}\u{9b}2J"), "\\u{1b}[2J\\r\\t\\u{7}\\u{7f}\\u{9b}2J");
    }

    #[test]
    fn messages_of_the_validation_layer_are_an_error_in_the_end() {
        let log = |target: &str| {
            let record = Record::builder().target(target).level(log::Level::Warn).build();
            WARNINGS.log(&record);
        };
        log("ambray");
        assert!(check_validation().is_ok());
        log(VALIDATION_LOG);
        let error = check_validation().unwrap_err().to_string();
        assert_eq!(error, "Vulkan's validation layer had 1 message");
    }
}
