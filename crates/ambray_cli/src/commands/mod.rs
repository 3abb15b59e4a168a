//! The commands.

mod animate;
pub mod bench;
pub mod compare;
mod cost;
mod devices;
pub mod diff;
pub mod documents;
pub mod info;
mod movement;
pub mod query;
pub mod render;
mod sequence;
mod thin_cost;
mod video;
pub mod view;

use ambray::{
    Control, RenderError, Renderer, RendererOptions,
    scene::Scene,
    settings::{Settings, Temporal},
};
use anyhow::bail;

use crate::{
    args::{RunArgs, Updates},
    failure::Problems,
    machine,
    progress::Progress,
    report,
    scene_source::Source,
    signals,
};

/// Control of long work: Ctrl-C, threads and a progress bar.
fn control<'a>(run: &RunArgs, progress: &'a (dyn Fn(f32) + Sync)) -> Control<'a> {
    Control { progress, cancel: signals::cancel_flag(), threads: usize::from(run.threads) }
}

/// Makes `scene` ready for the backend that `options` ask for.
fn renderer(scene: Scene, options: &RendererOptions, run: &RunArgs) -> anyhow::Result<Renderer> {
    let progress = Progress::new("building", run.quiet);
    Renderer::open(scene, options, control(run, &|share| progress.report(share))).map_err(explained)
}

/// Memory of a frame with its buffers, bytes a pixel; measured, rounded up.
const FRAME_BYTES: u64 = 220;
/// What [`Temporal::On`] keeps for the next frame, bytes a pixel: on Vulkan devices, the processor needs a little less.
const HISTORY_BYTES: u64 = 168;

/// Memory of a frame with `settings`, bytes.
fn frame_memory(settings: &Settings, extra: u64) -> u64 {
    let history = if settings.temporal == Temporal::On { HISTORY_BYTES } else { 0 };
    u64::from(settings.size.width) * u64::from(settings.size.height) * (FRAME_BYTES + history + extra)
}

/// Refuses a frame that the free memory cannot hold, with `extra` bytes a pixel for the output.
fn check_memory(settings: &Settings, extra: u64) -> anyhow::Result<()> {
    let (size, needed) = (settings.size, frame_memory(settings, extra));
    match machine::free_memory() {
        Some(free) if needed > free => bail!(
            "--size {size} is not allowed here: it needs about {} of memory, and {} are free",
            report::bytes(needed),
            report::bytes(free)
        ),
        _ => Ok(()),
    }
}

/// `options` with the choice of how structures follow what deforms, on every backend.
fn following(options: &RendererOptions, updates: Option<Updates>) -> RendererOptions {
    let mut options = options.clone();
    if let Some(updates) = updates {
        options.build.updates.policy = updates.policy();
        options.acceleration.updates.policy = updates.policy();
    }
    options
}

/// Refuses settings that ask for a moment of an animation where there is none.
fn check_animation(settings: &Settings, source: &Source) -> anyhow::Result<()> {
    let asked = match (settings.animation.value(), settings.time.value()) {
        _ if source.scene.rig.is_some() => return Ok(()),
        (Some(name), _) => format!("--animation {name}"),
        (None, Some(time)) => format!("--time {time}"),
        (None, None) => return Ok(()),
    };
    bail!("{asked} is not allowed: {} has no animation", source.path)
}

/// The renderer's errors in the terms of the program.
fn explained(error: RenderError) -> anyhow::Error {
    match error {
        RenderError::Cancelled => signals::Interrupted.into(),
        RenderError::Settings(problems) => {
            Problems(problems.iter().map(|p| format!("--{p}")).collect()).into()
        }
        // The messages begin with the name of the setting.
        RenderError::UnknownCamera { .. } | RenderError::UnknownAnimation { .. } | RenderError::Camera(_) => {
            anyhow::anyhow!("--{error}")
        }
        other => other.into(),
    }
}

#[cfg(test)]
mod tests {
    use ambray::settings::Size;

    use super::*;

    #[test]
    fn light_that_accumulates_takes_memory() {
        let alone = Settings { size: Size { width: 4000, height: 3000 }, ..Settings::default() };
        let together = Settings { temporal: Temporal::On, ..alone.clone() };
        let each = |settings: &Settings| frame_memory(settings, 32) / 12_000_000;
        // Measured on the processor, at this size and without an output: 215 and 372.
        assert_eq!((each(&alone), each(&together)), (252, 420));
    }
}
