//! What is known of each setting besides its value: for programs that offer settings to people.

use std::str::FromStr;

use super::{Auto, Range, Rgb, Size, Triple, ValueError, values::expected};

/// Description of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name in files; on the command line after `--`.
    pub name: &'static str,
    /// The group that it belongs to. Fields of a group follow each other.
    pub heading: &'static str,
    /// What it means: unit, range and default, one line.
    pub doc: &'static str,
    /// Stands for the value in help texts, such as `LENGTH`: unit or content.
    pub value_name: &'static str,
    /// What values it has.
    pub kind: Kind,
    /// Which values of this kind are allowed; empty if all are.
    pub allowed: &'static str,
}

/// Kind of the value of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A whole number, not negative.
    Whole,
    /// A number.
    Number,
    /// A number, or `auto`.
    AutoNumber,
    /// `true` or `false`.
    Flag,
    /// One of these alternatives: name and meaning.
    Choice(&'static [(&'static str, &'static str)]),
    /// Width and height.
    Size,
    /// A linear colour.
    Rgb,
    /// A linear colour, or `auto`.
    AutoRgb,
    /// A point or a direction, or `auto`.
    AutoTriple,
    /// The two ends of a range of values, or `auto`.
    AutoRange,
    /// Text, or `auto`.
    AutoText,
}

impl Kind {
    /// Whether the value may be `auto`.
    #[must_use]
    pub const fn has_auto(self) -> bool {
        matches!(self, Self::AutoNumber | Self::AutoRgb | Self::AutoTriple | Self::AutoRange | Self::AutoText)
    }
}

/// A type of the values of settings, spelled as on the command line: its `Display` is what [`Value::read`] reads.
pub trait Value: Sized {
    /// What kind it is.
    const KIND: Kind;

    /// Reads a value.
    ///
    /// # Errors
    ///
    /// If `text` is no value of this kind; tells what was expected.
    fn read(text: &str) -> Result<Self, ValueError>;
}

/// Which values of a setting can be used.
#[derive(Clone, Copy)]
pub(super) struct Domain<T> {
    /// In words; empty if there is nothing to say.
    pub(super) allowed: &'static str,
    pub(super) contains: fn(&T) -> bool,
}

impl<T> Domain<T> {
    /// Every value.
    pub(super) const ALL: Self = Self { allowed: "", contains: |_| true };
}

/// Why a setting could not be set from text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetError {
    /// There is no such setting.
    #[error("there is no setting {0}")]
    Unknown(String),
    /// The text is no value of it.
    #[error("{name} {value} is not allowed: {}", error.expected())]
    Value {
        /// The setting.
        name: &'static str,
        /// The text.
        value: String,
        /// What was expected.
        error: ValueError,
    },
}

macro_rules! values {
    ($($type:ty: $kind:ident = $read:expr;)+) => { $(
        impl Value for $type {
            const KIND: Kind = Kind::$kind;

            fn read(text: &str) -> Result<Self, ValueError> {
                $read(text)
            }
        }
    )+ };
}

values! {
    u32: Whole = |text| parse(text, "a whole number, 0 to 4294967295");
    f32: Number = |text| parse(text, "a number");
    bool: Flag = |text| parse(text, "true or false");
    Size: Size = str::parse;
    Rgb: Rgb = str::parse;
    Auto<f32>: AutoNumber = |text| auto(text, f32::read);
    Auto<Rgb>: AutoRgb = |text| auto(text, str::parse);
    Auto<Triple>: AutoTriple = |text| auto(text, str::parse);
    Auto<Range>: AutoRange = |text| auto(text, str::parse);
    Auto<String>: AutoText = |text| auto(text, |name| Ok(name.to_owned()));
}

fn parse<T: FromStr>(text: &str, what: &str) -> Result<T, ValueError> {
    text.parse().map_err(|_| expected(what))
}

/// The word `auto`, or what `read` reads.
fn auto<T>(text: &str, read: impl Fn(&str) -> Result<T, ValueError>) -> Result<Auto<T>, ValueError> {
    if text == "auto" {
        return Ok(Auto::Auto);
    }
    read(text).map(Auto::Value).map_err(|error| expected(&format!("auto or {}", error.expected())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Settings, SettingsPatch};

    /// Spellings of values of this `kind`, all different.
    fn spellings(kind: Kind) -> Vec<&'static str> {
        let mut spellings = match kind {
            Kind::Whole => vec!["0", "17", "4294967295"],
            Kind::Number | Kind::AutoNumber => vec!["0.1", "-3", "0.000000000000001", "16777216", "-0"],
            Kind::Flag => vec!["true", "false"],
            Kind::Choice(choices) => choices.iter().map(|(name, _)| *name).collect(),
            Kind::Size => vec!["1x2", "1920x1080"],
            Kind::Rgb | Kind::AutoRgb | Kind::AutoTriple => vec!["0.1,2,-3", "1,1,1"],
            Kind::AutoRange => vec!["-1,2.5"],
            Kind::AutoText => vec!["0", "a 'b' \"c\" é", ""],
        };
        spellings.extend(kind.has_auto().then_some("auto"));
        spellings
    }

    #[test]
    fn every_setting_is_read_as_it_is_spelled() {
        for field in Settings::fields() {
            for text in spellings(field.kind) {
                let mut settings = Settings::default();
                assert_eq!(settings.set(field.name, text), Ok(()), "{} {text}", field.name);
                assert_eq!(settings.get(field.name).as_deref(), Some(text), "{}", field.name);
                let others = Settings::fields().iter().filter(|other| other.name != field.name);
                for other in others {
                    assert_eq!(settings.get(other.name), Settings::default().get(other.name));
                }
            }
        }
    }

    #[test]
    fn fields_are_those_of_files_in_their_spelling() {
        let settings = Settings::default();
        let table = serde_json::to_value(SettingsPatch::full(&settings)).unwrap();
        let table = table.as_object().unwrap();
        assert_eq!(table.len(), Settings::fields().len());
        for field in Settings::fields() {
            let value = table.get(field.name).unwrap_or_else(|| panic!("{} is not in files", field.name));
            if let Kind::Choice(choices) = field.kind {
                for (name, meaning) in choices {
                    assert!(!meaning.is_empty(), "{} {name}", field.name);
                    let file = serde_json::json!({ (field.name): name });
                    let patch: SettingsPatch = serde_json::from_value(file).unwrap();
                    let mut settings = Settings::default();
                    patch.apply(&mut settings);
                    assert_eq!(settings.get(field.name).as_deref(), Some(*name));
                }
                assert_eq!(value.as_str(), settings.get(field.name).as_deref());
            }
            assert!(!field.doc.is_empty() && !field.doc.contains('\n'), "{}", field.name);
            assert!(!field.value_name.is_empty() && !field.heading.is_empty(), "{}", field.name);
        }
    }

    #[test]
    fn what_is_refused_is_told_with_what_is_expected() {
        let mut settings = Settings::default();
        let mut told = |name, text| settings.set(name, text).unwrap_err().to_string();
        assert_eq!(told("raduis", "1"), "there is no setting raduis");
        assert_eq!(told("radius", "big"), "radius big is not allowed: auto or a number");
        assert_eq!(told("thin", "thick"), "thin thick is not allowed: one of off, paper, sheet");
        assert_eq!(told("lights", "maybe"), "lights maybe is not allowed: true or false");
        assert_eq!(settings, Settings::default());
        assert_eq!(settings.get("raduis"), None);
    }

    #[test]
    fn what_is_not_allowed_is_told_by_the_field_too() {
        for field in Settings::fields() {
            let mut settings = Settings::default();
            for text in ["-1", "NaN", "0x0", "NaN,NaN,NaN", "NaN,NaN"] {
                let _ = settings.set(field.name, text); // most are no values of its kind
                let problems = settings.validate();
                assert!(problems.iter().all(|p| (p.name, p.allowed) == (field.name, field.allowed)));
                let is_free = field.allowed.is_empty();
                assert!(problems.is_empty() || !is_free, "{} {text}", field.name);
            }
            let numbers = !matches!(field.kind, Kind::Whole | Kind::Flag | Kind::Choice(_) | Kind::AutoText);
            assert!(!numbers || !settings.validate().is_empty(), "{} takes anything", field.name);
        }
    }
}
