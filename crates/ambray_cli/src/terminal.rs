//! What the user reads: stdout that may be closed early, stderr that may be absent. Nothing here panics.

use std::io::{self, Write as _};

use log::{LevelFilter, Log, Metadata, Record};

/// Writes `text` to stdout.
pub fn print(text: &str) -> anyhow::Result<()> {
    print_bytes(text.as_bytes())
}

/// Writes `bytes` to stdout.
pub fn print_bytes(bytes: &[u8]) -> anyhow::Result<()> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(bytes)?;
    Ok(stdout.flush()?)
}

/// Writes a line to stderr, if there is one.
pub fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Tells of something odd that does not stop the work.
pub fn warn(message: &str) {
    say(&format!("ambray: warning: {message}"));
}

/// Shows warnings that libraries log.
pub fn log_warnings() {
    // Fails only if a logger is set already, which then shows them.
    if log::set_logger(&WARNINGS).is_ok() {
        log::set_max_level(LevelFilter::Warn);
    }
}

static WARNINGS: Warnings = Warnings;

#[derive(Debug)]
struct Warnings;

impl Log for Warnings {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &Record<'_>) {
        if self.enabled(record.metadata()) {
            warn(&record.args().to_string());
        }
    }

    fn flush(&self) {}
}
