//! How defaults, preset, settings file and flags join.

use ambray::settings::Settings;
use ambray_files::{
    Problems,
    settings_file::{SettingsFile, read},
};
use anyhow::{Context as _, anyhow};

use crate::args::SettingsArgs;

/// Joins defaults < preset < file < flags, and checks the ranges; the error lists every problem.
///
/// A preset flag replaces the file's preset key, but stays weaker than the file's other keys.
pub fn resolve(args: &SettingsArgs) -> anyhow::Result<Settings> {
    let file = args.settings.as_deref().map(read).transpose()?.unwrap_or_default();
    let settings = join(args, &file);
    let problems = settings.validate();
    if problems.is_empty() {
        return Ok(settings);
    }
    let flags = toml::Table::try_from(&args.flags).context("settings")?;
    let in_file = toml::Table::try_from(&file.patch).context("settings")?;
    let source = |name: &str| match &args.settings {
        _ if flags.contains_key(name) => "--".to_owned(),
        Some(path) if in_file.contains_key(name) => format!("{}: ", path.display()),
        _ => String::new(),
    };
    Err(anyhow!(Problems(
        problems.iter().map(|problem| format!("{}{problem}", source(problem.name))).collect()
    )))
}

fn join(args: &SettingsArgs, file: &SettingsFile) -> Settings {
    let mut settings = Settings::default();
    if let Some(preset) = args.preset.or(file.preset) {
        preset.patch().apply(&mut settings);
    }
    file.patch.apply(&mut settings);
    args.flags.apply(&mut settings);
    settings
}

#[cfg(test)]
mod tests {
    use ambray::settings::{Preset, SettingsPatch};
    use ambray_files::settings_file::parse;

    use super::*;

    #[test]
    fn flags_beat_the_file_which_beats_the_preset() {
        let file = parse("preset = \"draft\"\nspp = 12").unwrap();
        let spp = |args: &SettingsArgs, file: &SettingsFile| join(args, file).spp;
        let flags = SettingsArgs {
            flags: SettingsPatch { spp: Some(3), ..Default::default() },
            ..SettingsArgs::default()
        };
        let preset = SettingsArgs { preset: Some(Preset::Reference), ..SettingsArgs::default() };
        assert_eq!(spp(&flags, &file), 3);
        assert_eq!(spp(&preset, &file), 12, "the file's explicit key is stronger than the preset flag");
        assert_eq!(spp(&preset, &parse("preset = \"draft\"").unwrap()), 1024, "the flag replaces the key");
        assert_eq!(spp(&SettingsArgs::default(), &parse("preset = \"draft\"").unwrap()), 4);
        assert_eq!(spp(&SettingsArgs::default(), &SettingsFile::default()), 8);
    }
}
