//! The window: events in, pictures out.
//!
//! [`run`] opens it. The window itself (`window`) turns what the system says into egui's input, runs the
//! [`App`](crate::app::App), and hands what is to be drawn to a presenter: OpenGL where the processor renders, or Vulkan on
//! the device that renders, so that pictures never leave it. A [`script`] may hold the mouse.

mod gl;
mod icon;
mod input;
mod pictures;
mod present;
pub mod script;
mod stop;
mod vulkan;
mod window;

use std::path::PathBuf;

use ambray::{RendererOptions, settings::Settings};
use anyhow::{Context as _, anyhow};
use winit::{error::EventLoopError, event_loop::EventLoop};

pub use self::stop::Stop;
use self::{script::Script, window::Shell};
use crate::model::SceneRef;

/// What to open, and how.
#[derive(Clone, Debug)]
pub struct ViewOptions {
    /// The scene.
    pub scene: SceneRef,
    /// The look to begin with; `None` for that of the last run.
    pub settings: Option<Settings>,
    /// Who renders.
    pub renderer: RendererOptions,
    /// Threads of the processor, 0 for all cores.
    pub threads: usize,
    /// Where looks, window and recent files are remembered ([`default_path`](crate::memory::default_path)); `None` to forget
    /// them.
    pub memory: Option<PathBuf>,
    /// A walk through the window, for tests and for pictures of documentation: a file of steps, as [`script`] has them.
    pub script: Option<PathBuf>,
    /// What closes the window from outside, such as for Ctrl-C.
    pub stop: Stop,
}

/// Woken up for.
#[derive(Clone, Copy, Debug)]
enum Wake {
    /// The engine has something to say.
    Engine,
    /// Something is to be drawn at this moment.
    Draw(std::time::Instant),
    /// The window is to be closed.
    Stop,
}

/// Opens the window and returns when it is closed: with the settings of the side that was edited last.
///
/// # Errors
/// If there is no display or nothing to draw with, and if a step of the script fails.
pub fn run(options: ViewOptions) -> anyhow::Result<Settings> {
    let script = options.script.as_deref().map(Script::read).transpose()?;
    let event_loop = EventLoop::<Wake>::with_user_event().build().map_err(|error| no_display(&error))?;
    options.stop.listen(event_loop.create_proxy());
    let mut shell = Shell::new(options, script, event_loop.create_proxy());
    event_loop.run_app(&mut shell).context("the window")?;
    shell.finish()
}

/// What it means that there is no event loop.
fn no_display(error: &EventLoopError) -> anyhow::Error {
    let has = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let why = match error {
        _ if cfg!(unix) && !cfg!(target_os = "macos") && !has("DISPLAY") && !has("WAYLAND_DISPLAY") => {
            "neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned()
        }
        EventLoopError::Os(error) => error.to_string(),
        error => error.to_string(),
    };
    anyhow!("there is no display to open a window on: {}", one_line(&why))
}

fn one_line(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}
