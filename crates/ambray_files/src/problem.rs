//! Errors that say more than one thing: several problems, or advice.

use std::fmt;

/// Several problems found at once; each deserves its own line.
#[derive(Debug)]
pub struct Problems(pub Vec<String>);

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("; "))
    }
}

impl std::error::Error for Problems {}

/// An error with advice.
#[derive(Debug)]
struct Hinted {
    error: anyhow::Error,
    hint: String,
}

impl fmt::Display for Hinted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#}", self.error)
    }
}

impl std::error::Error for Hinted {}

/// Adds advice to an error, shown on a line of its own.
#[must_use]
pub fn with_hint(error: impl Into<anyhow::Error>, hint: impl Into<String>) -> anyhow::Error {
    anyhow::Error::new(Hinted { error: error.into(), hint: hint.into() })
}

/// The advice that [`with_hint`] added to `error`.
#[must_use]
pub fn hint_of(error: &anyhow::Error) -> Option<&str> {
    error.downcast_ref::<Hinted>().map(|hinted| hinted.hint.as_str())
}

#[cfg(test)]
mod tests {
    use anyhow::{Context as _, anyhow};

    use super::*;

    #[test]
    fn advice_survives_context() {
        let error = with_hint(anyhow!("no such file"), "check the path");
        assert_eq!(
            (format!("{error:#}").as_str(), hint_of(&error)),
            ("no such file", Some("check the path"))
        );
        let error = Err::<(), _>(error).context("scene.glb").unwrap_err();
        assert_eq!(format!("{error:#}"), "scene.glb: no such file");
        assert_eq!(hint_of(&error), Some("check the path"));
        assert_eq!(hint_of(&anyhow!("bare")), None);
    }
}
