//! What can go wrong while loading, and how it is told: one line, the file first.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Why a scene could not be loaded. The text is one line, `path: place: reason`.
///
/// The variants say what the caller can do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file, or one that it refers to, cannot be read: check the path and its permissions.
    #[error("{}", line(path, at, reason))]
    Io {
        /// Scene file.
        path: PathBuf,
        /// Place in the scene file that asked for the read, empty for the scene file itself.
        at: String,
        /// What the system said.
        reason: String,
    },
    /// The bytes are not the format they claim to be: the file is damaged or of another kind.
    #[error("{}", line(path, at, reason))]
    Syntax {
        /// Scene file.
        path: PathBuf,
        /// Line or byte offset.
        at: String,
        /// What is wrong there.
        reason: String,
    },
    /// The format is right but the content contradicts itself or its specification: fix the exporter.
    #[error("{}", line(path, at, reason))]
    Invalid {
        /// Scene file.
        path: PathBuf,
        /// JSON path.
        at: String,
        /// What is wrong there.
        reason: String,
    },
    /// The file asks for something that Ambray lacks: export it without, or convert it.
    #[error("{}", line(path, at, reason))]
    Unsupported {
        /// Scene file.
        path: PathBuf,
        /// JSON path.
        at: String,
        /// What is lacking.
        reason: String,
    },
    /// The file exceeds one of the [limits](crate::limits).
    #[error("{}", line(path, at, reason))]
    TooLarge {
        /// Scene file.
        path: PathBuf,
        /// JSON path.
        at: String,
        /// Which limit, and by what.
        reason: String,
    },
}

/// `path: at: reason` without line breaks, whatever the names in the file hold.
fn line(path: &Path, at: &str, reason: &str) -> String {
    let parts = [path.to_string_lossy(), at.into(), reason.into()];
    let mut text = String::new();
    for part in parts.iter().filter(|part| !part.is_empty()) {
        if !text.is_empty() {
            text.push_str(": ");
        }
        push_printable(&mut text, part);
    }
    text
}

/// Appends `part` with control characters and line separators escaped.
fn push_printable(text: &mut String, part: &str) {
    for c in part.chars() {
        if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') {
            let _ = write!(text, "{}", c.escape_default()); // writing to a string cannot fail
        } else {
            text.push(c);
        }
    }
}

/// Text from a file, fit for a one-line message: printable and of bounded length.
pub(crate) fn quoted(text: &str) -> String {
    const LONGEST: usize = 80;
    let mut shown = String::from("'");
    push_printable(&mut shown, &text.chars().take(LONGEST).collect::<String>());
    shown.push_str(if text.chars().nth(LONGEST).is_some() { "…'" } else { "'" });
    shown
}

/// A [`LoadError`] that does not know its file yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    kind: Kind,
    at: String,
    reason: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Io,
    Syntax,
    Invalid,
    Unsupported,
    TooLarge,
}

/// Result of the loader's inner functions.
pub(crate) type Outcome<T> = Result<T, Fault>;

impl Fault {
    pub(crate) fn io(at: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { kind: Kind::Io, at: at.into(), reason: reason.into() }
    }

    pub(crate) fn syntax(at: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { kind: Kind::Syntax, at: at.into(), reason: reason.into() }
    }

    pub(crate) fn invalid(at: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { kind: Kind::Invalid, at: at.into(), reason: reason.into() }
    }

    pub(crate) fn unsupported(at: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { kind: Kind::Unsupported, at: at.into(), reason: reason.into() }
    }

    pub(crate) fn too_large(at: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { kind: Kind::TooLarge, at: at.into(), reason: reason.into() }
    }

    /// What is wrong, without the place.
    pub(crate) fn reason(&self) -> &str {
        &self.reason
    }

    /// The public error, now that the file is known.
    pub(crate) fn in_file(self, path: &Path) -> LoadError {
        let Self { kind, at, reason } = self;
        let path = path.to_path_buf();
        match kind {
            Kind::Io => LoadError::Io { path, at, reason },
            Kind::Syntax => LoadError::Syntax { path, at, reason },
            Kind::Invalid => LoadError::Invalid { path, at, reason },
            Kind::Unsupported => LoadError::Unsupported { path, at, reason },
            Kind::TooLarge => LoadError::TooLarge { path, at, reason },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn message_is_one_line() {
        let error = Fault::invalid("nodes[1]", "name 'a\nb\u{2028}'").in_file(Path::new("dir/x.gltf"));
        assert_eq!(error.to_string(), "dir/x.gltf: nodes[1]: name 'a\\nb\\u{2028}'");
        let error = Fault::io("", "no such file").in_file(Path::new("x.glb"));
        assert_eq!(error.to_string(), "x.glb: no such file");
    }

    #[test]
    fn long_names_are_cut() {
        assert_eq!(quoted("short"), "'short'");
        assert_eq!(quoted(&"x".repeat(500)).chars().count(), 83);
    }
}
