//! What a loader has to say about a file that it could read.

use std::collections::BTreeMap;

/// Collects warnings; the same remark about many things becomes one line with a count.
#[derive(Debug, Default)]
pub(crate) struct Warnings {
    lines: Vec<String>,
    tallies: BTreeMap<&'static str, u64>,
}

impl Warnings {
    /// Adds a line of its own.
    pub(crate) fn push(&mut self, line: String) {
        self.lines.push(line);
    }

    /// Adds `count` to the remark `what`.
    pub(crate) fn tally(&mut self, what: &'static str, count: u64) {
        if count > 0 {
            *self.tallies.entry(what).or_default() += count;
        }
    }

    /// All warnings, one line each.
    pub(crate) fn into_lines(mut self) -> Vec<String> {
        self.lines.extend(self.tallies.iter().map(|(what, count)| format!("{what} ({count})")));
        self.lines
    }
}
