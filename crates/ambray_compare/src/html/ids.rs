//! Names that are safe as ids, in addresses and as files.

use std::collections::HashSet;

/// Lower-case ASCII letters and digits of `text`, words joined by a hyphen; `fallback` where nothing is left.
pub(super) fn slug(text: &str, fallback: &str) -> String {
    let words: Vec<String> = text
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    // Devices of Windows, which cannot be files there whatever their ending.
    let is_device = |name: &str| matches!(name, "aux" | "con" | "nul" | "prn");
    match words.join("-") {
        name if name.is_empty() => fallback.to_owned(),
        name if is_device(&name) => format!("{name}-{fallback}"),
        name => name,
    }
}

/// Gives every name once.
#[derive(Debug, Default)]
pub(super) struct Unique {
    given: HashSet<String>,
}

impl Unique {
    /// `name`, or `name-2`, `name-3`, … where it has been given before.
    pub(super) fn name(&mut self, name: &str) -> String {
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        let free = std::iter::once(name.to_owned()).chain(numbered).find(|name| !self.given.contains(name));
        let free = free.expect("numbers do not end");
        self.given.insert(free.clone());
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slug_has_letters_digits_and_hyphens_only() {
        assert_eq!(slug("GTAO, 8 spp (XeGTAO's)", "x"), "gtao-8-spp-xegtao-s");
        assert_eq!(slug("../../etc/passwd", "x"), "etc-passwd");
        assert_eq!(slug("π ≈ …", "picture"), "picture");
        assert_eq!(slug("AUX", "picture"), "aux-picture");
    }

    #[test]
    fn a_name_is_given_once() {
        let mut unique = Unique::default();
        let names = ["a", "a-2", "a", "a"].map(|name| unique.name(name));
        assert_eq!(names, ["a", "a-2", "a-3", "a-4"]);
    }
}
