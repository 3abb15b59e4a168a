//! Settings in files: TOML, and pictures that hold their settings.

use std::{fs, io::Read as _, path::Path};

use ambray::settings::{Preset, Settings, SettingsPatch};
use anyhow::{Context as _, anyhow, bail};
use serde::Deserialize;
use toml::de::DeTable;

use crate::{head::Head, problem::Problems};

/// Larger settings files are refused.
const LARGEST_FILE: u64 = 1 << 20;
const NO_SETTINGS: &str = "the picture holds no settings of ambray";
/// Keyword of the text in a PNG picture that holds its settings.
pub const PNG_KEYWORD: &str = "ambray:settings";

/// What a settings file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SettingsFile {
    /// Its `preset` key, weaker than the other keys.
    pub preset: Option<Preset>,
    /// Its other keys.
    pub patch: SettingsPatch,
}

/// Something wrong in a settings file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Line, from 1.
    pub line: usize,
    /// The key with its value, or the reason alone where the file is no TOML.
    pub message: String,
}

/// Reads the text of a settings file; the error lists every problem. Never panics.
pub fn parse(text: &str) -> Result<SettingsFile, Vec<Problem>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let document = DeTable::parse(text).map_err(|error| {
        let line = line_of(text, error.span().map_or(0, |span| span.start));
        vec![Problem { line, message: error.message().to_owned() }]
    })?;
    let mut problems = Vec::new();
    let mut preset = None;
    let mut table = document.into_inner();
    let keys: Vec<_> = table.keys().cloned().collect();
    for key in keys {
        let name = key.get_ref().to_string();
        let start = key.span().start;
        let value = table.get(&key).expect("the key was just listed").clone();
        let found = text.get(value.span()).unwrap_or_default();
        let found: String = found.lines().next().unwrap_or_default().chars().take(60).collect();
        let outcome = if name == "preset" {
            table.remove(&key);
            let span = value.span();
            let one = toml::de::ValueDeserializer::from(toml::Spanned::new(span, value.into_inner()));
            Preset::deserialize(one).map(|value| preset = Some(value))
        } else {
            let single: DeTable<'_> = std::iter::once((key, value)).collect();
            patch(single).map(|_| ())
        };
        if let Err(error) = outcome {
            let message = explain(&name, &found, error.message());
            problems.push(Problem { line: line_of(text, start), message });
        }
    }
    problems.sort_by_key(|problem| problem.line);
    if !problems.is_empty() {
        return Err(problems);
    }
    let patch =
        patch(table).map_err(|error| vec![Problem { line: 1, message: error.message().to_owned() }])?;
    Ok(SettingsFile { preset, patch })
}

fn patch(table: DeTable<'_>) -> Result<SettingsPatch, toml::de::Error> {
    SettingsPatch::deserialize(toml::de::Deserializer::from(toml::Spanned::new(0..0, table)))
}

/// Why `name = value` was refused, with what is allowed.
fn explain(name: &str, value: &str, reason: &str) -> String {
    let names = names();
    if name != "preset" && !names.contains(&name) {
        let near = names.iter().map(|known| (strsim::damerau_levenshtein(known, name), known)).min();
        return match near {
            Some((distance, known)) if distance <= 3 => {
                format!("there is no setting {name}: did you mean {known}?")
            }
            _ => format!("there is no setting {name}: allowed are preset, {}", names.join(", ")),
        };
    }
    let meaning = meaning(name).map(|meaning| format!(" ({meaning})")).unwrap_or_default();
    format!("{name} = {value} is not allowed: {reason}{meaning}")
}

/// The names of all settings, by the alphabet.
fn names() -> Vec<&'static str> {
    let mut names: Vec<_> = Settings::fields().iter().map(|field| field.name).collect();
    names.sort_unstable();
    names
}

/// What a setting means, with its default.
fn meaning(name: &str) -> Option<String> {
    let field = Settings::field(name)?;
    Some(format!("{} [default: {}]", field.doc, Settings::default().get(name)?))
}

fn line_of(text: &str, offset: usize) -> usize {
    1 + text.as_bytes()[..offset.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}

/// Reads a settings file, or the settings in a picture.
pub fn read(path: &Path) -> anyhow::Result<SettingsFile> {
    let context = || format!("settings file {}", path.display());
    let text = match Head::read(path).with_context(context)? {
        Some(head) => head.settings.context(NO_SETTINGS).with_context(context)?,
        None => text_of_file(path).with_context(context)?,
    };
    parse(&text).map_err(|problems| {
        let told = |problem: &Problem| format!("{}:{}: {}", path.display(), problem.line, problem.message);
        anyhow!(Problems(problems.iter().map(told).collect()))
    })
}

fn text_of_file(path: &Path) -> anyhow::Result<String> {
    let mut bytes = Vec::new();
    fs::File::open(path)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST_FILE {
        bail!("larger than {LARGEST_FILE} bytes");
    }
    String::from_utf8(bytes).map_err(|_| anyhow!("neither UTF-8 text nor a PNG or OpenEXR picture"))
}

/// The settings as a file that [`parse`] reads back.
#[must_use]
pub fn write(settings: &Settings) -> String {
    toml::to_string(settings).expect("settings are plain data")
}

#[cfg(test)]
mod tests {
    use ambray::settings::{Auto, Rgb, Thin};

    use super::*;

    #[track_caller]
    fn refused(text: &str, expected: &[(usize, &str)]) {
        let problems = parse(text).expect_err("the file is wrong");
        assert_eq!(problems.len(), expected.len(), "{problems:?}");
        for (problem, (line, part)) in problems.iter().zip(expected) {
            assert_eq!(problem.line, *line, "{problem:?}");
            assert!(problem.message.contains(part), "{problem:?} lacks {part}");
        }
    }

    #[test]
    fn files_are_read() {
        let file = parse("preset = \"draft\"\nspp = 12 # rays\nradius = 2\nambient = [0, 0.5, 1]\n").unwrap();
        let patch = SettingsPatch {
            spp: Some(12),
            radius: Some(Auto::Value(2.0)),
            ambient: Some(Auto::Value(Rgb([0.0, 0.5, 1.0]))),
            ..Default::default()
        };
        assert_eq!(file, SettingsFile { preset: Some(Preset::Draft), patch });
        assert_eq!(parse(""), Ok(SettingsFile::default()));
    }

    #[test]
    fn every_problem_is_named_with_line_key_and_what_is_allowed() {
        refused("raduis = 1", &[(1, "there is no setting raduis: did you mean radius?")]);
        refused("\nxyzzyxyzzy = 1", &[(2, "allowed are preset, ambient")]);
        refused("[render]\nspp = 1", &[(1, "there is no setting render")]);
        refused(
            "spp = 8\nthin = \"thick\"",
            &[(2, "thin = \"thick\" is not allowed: unknown variant `thick`")],
        );
        refused("thin = \"thick\"", &[(1, "`sheet`")]);
        refused(
            "radius = \"wide\"",
            &[(1, "radius = \"wide\" is not allowed: expected a value or \"auto\"")],
        );
        refused("preset = \"fast\"", &[(1, "`reference`")]);
        refused("spp = -1\n\nsize = \"640\"", &[(1, "spp = -1"), (3, "WIDTHxHEIGHT")]);
        refused("spp = ", &[(1, "")]);
        refused("spp = 1\nspp = 2", &[(2, "duplicate")]);
    }

    #[test]
    fn what_is_written_is_read_back() {
        let settings = Settings {
            thin: Thin::Sheet,
            thin_edge: true,
            exponent: 0.1,
            camera: Auto::Value("Kamera ❤ \"1\"".to_owned()),
            ..Settings::default()
        };
        for settings in [settings, Settings::default()] {
            let file = parse(&write(&settings)).unwrap();
            assert_eq!(file.patch, SettingsPatch::full(&settings));
        }
    }

    #[test]
    fn nonsense_never_panics() {
        for text in
            ["\u{feff}spp=1", "=", "a.b.c = 1", "spp = {a=1}", "\0", "preset = 1", "preset.x = 1", "[[spp]]"]
        {
            let _ = parse(text);
        }
    }
}
