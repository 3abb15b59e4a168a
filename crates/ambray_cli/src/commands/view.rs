//! `ambray view`: a window to see and tune ambient light.

use crate::args::ViewArgs;

/// Opens the window.
#[cfg(feature = "view")]
pub fn run(args: &ViewArgs) -> anyhow::Result<()> {
    use ambray::settings::SettingsPatch;
    use ambray_files::{
        atomic::{Batch, Target},
        settings_file,
    };
    use ambray_view::{Stop, ViewOptions, memory, model::SceneRef};

    use crate::{
        args::{Grouping, SettingsArgs},
        settings, signals,
    };

    let SettingsArgs { preset, settings: file, flags, .. } = &args.settings;
    let is_look_given = preset.is_some() || file.is_some() || *flags != SettingsPatch::default();
    let settings = is_look_given.then(|| settings::resolve(&args.settings)).transpose()?;
    let saved = args.settings.save_settings.as_deref().map(Target::of);
    if let Some(saved) = &saved {
        saved.check()?;
    }
    let scene = SceneRef { path: args.scene.scene.clone(), gltf_scene: args.scene.gltf_scene.clone() };
    // Ctrl-C closes the window in order, so that an export leaves nothing half written.
    let stop = Stop::default();
    let stopping = stop.clone();
    let graceful = signals::Graceful::telling(move || stopping.request());
    let last = ambray_view::run(ViewOptions {
        scene,
        settings,
        renderer: args.backend.options(Grouping::Auto)?,
        threads: usize::from(args.threads),
        // A script begins where every script begins, and leaves what the user has alone.
        memory: match &args.memory {
            _ if args.no_memory => None,
            None if args.script.is_some() => None,
            named => named.clone().or_else(memory::default_path),
        },
        script: args.script.clone(),
        stop,
    })?;
    if let Some(saved) = &saved {
        let mut batch = Batch::default();
        let toml = settings_file::write(&last);
        batch.add(saved, |out| Ok(out.write_all(toml.as_bytes())?))?;
        batch.commit()?;
    }
    drop(graceful);
    Ok(signals::check()?)
}

/// Says that there is no window.
#[cfg(not(feature = "view"))]
pub fn run(_: &ViewArgs) -> anyhow::Result<()> {
    Err(ambray_files::with_hint(
        anyhow::anyhow!("this ambray was built without its window"),
        "cargo install --path crates/ambray_cli has it; --no-default-features leaves it out",
    ))
}
