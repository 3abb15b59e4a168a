//! What a script asks of the application.

use ambray::settings::Settings;
use anyhow::{Context as _, anyhow, bail};

use crate::app::{App, Severity};

/// Whether the final pictures are shown and nothing is going on.
pub(super) fn is_idle(app: &App) -> bool {
    let (model, shown) = (&app.model, &app.shown);
    let is_open = shown.opened.as_ref().is_some_and(|opened| opened.scene == model.scene)
        || shown.notices.iter().any(|notice| notice.severity == Severity::Error);
    let is_shown = model.sides().iter().all(|&side| {
        let is_final = |rendered: &crate::engine::Rendered| {
            rendered.level.is_final && rendered.settings == *model.of(side) && rendered.aov == model.aov
        };
        !shown.refused[side as usize].is_empty() || shown.sides[side as usize].as_ref().is_some_and(is_final)
    });
    shown.loading.is_none() && is_open && (is_shown || shown.opened.is_none())
}

/// Sets the setting `name` to what `value` spells.
pub(super) fn set(settings: &mut Settings, name: &str, value: &str) -> anyhow::Result<()> {
    let mut table = toml::Table::try_from(&*settings).context("settings")?;
    if !table.contains_key(name) {
        bail!("no setting is called '{name}'");
    }
    let spelled = value.parse().unwrap_or_else(|_| toml::Value::String(value.to_owned()));
    table.insert(name.to_owned(), spelled);
    *settings = table.try_into().map_err(|error| anyhow!("{name}: {error}"))?;
    Ok(())
}
