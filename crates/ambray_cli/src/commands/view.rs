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
    use ambray_view::{ViewOptions, memory, model::SceneRef};

    use crate::{
        args::{Grouping, SettingsArgs},
        settings,
    };

    let SettingsArgs { preset, settings: file, flags, .. } = &args.settings;
    let is_look_given = preset.is_some() || file.is_some() || *flags != SettingsPatch::default();
    let settings = is_look_given.then(|| settings::resolve(&args.settings)).transpose()?;
    let saved = args.settings.save_settings.as_deref().map(Target::of);
    if let Some(saved) = &saved {
        saved.check()?;
    }
    let scene = SceneRef { path: args.scene.scene.clone(), gltf_scene: args.scene.gltf_scene.clone() };
    let last = ambray_view::run(ViewOptions {
        scene,
        settings,
        renderer: args.backend.options(Grouping::Auto)?,
        threads: usize::from(args.threads),
        memory: if args.no_memory { None } else { args.memory.clone().or_else(memory::default_path) },
        script: args.script.clone(),
    })?;
    let Some(saved) = &saved else { return Ok(()) };
    let mut batch = Batch::default();
    let toml = settings_file::write(&last);
    batch.add(saved, |out| Ok(out.write_all(toml.as_bytes())?))?;
    batch.commit()
}

/// Says that there is no window.
#[cfg(not(feature = "view"))]
pub fn run(_: &ViewArgs) -> anyhow::Result<()> {
    Err(ambray_files::with_hint(
        anyhow::anyhow!("this ambray was built without its window"),
        "cargo install --path crates/ambray_cli has it; --no-default-features leaves it out",
    ))
}
