//! A script at work: each step takes at least one frame of the window.

use std::{
    collections::VecDeque,
    fs,
    path::Path,
    time::{Duration, Instant},
};

use anyhow::{Context as _, bail};
use egui::{Event, Pos2, RawInput, Vec2};
use winit::{dpi::PhysicalSize, event::WindowEvent, window::Window};

use super::{Script, Step};
use crate::{
    app::{App, Severity},
    engine::Pixels,
    model::SceneRef,
    panels::action::Action,
    shell::input,
};

/// How long a step may take: far more than any does, so that a script that hangs ends with an error.
const PATIENCE: Duration = Duration::from_secs(300);
/// Frames a second of the video of a turn.
const TURN_FPS: f32 = 25.0;
/// Frames in a row without work after which nothing more is to come.
const IDLE_FRAMES: u32 = 3;

/// What a script wants of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::shell) enum Wish {
    /// The next frame at once.
    NextFrame,
    /// The next frame when there is news.
    News,
    /// The window is to be closed.
    Close,
}

/// What it is at.
#[derive(Debug)]
enum Doing {
    /// Events of the frames to come.
    Events(VecDeque<Vec<Event>>),
    /// Until nothing has been going on for so many frames.
    Waiting { idle: u32 },
    /// Until the picture is the mean of so many frames.
    Accumulating(u32),
    /// Until the window has this size.
    Resizing(PhysicalSize<u32>),
    /// The next picture of the window goes to this file.
    Shooting(std::path::PathBuf),
}

/// A script at work.
#[derive(Debug)]
pub(in crate::shell) struct Runner {
    script: Script,
    /// Line of the step at work.
    line: usize,
    doing: Option<Doing>,
    since: Instant,
}

impl Runner {
    /// Begins `script`.
    pub(in crate::shell) fn new(script: Script) -> Self {
        Self { script, line: 0, doing: None, since: Instant::now() }
    }

    /// Whether it wants the pixels of this frame.
    pub(in crate::shell) const fn wants_copy(&self) -> bool {
        matches!(self.doing, Some(Doing::Shooting(_)))
    }

    /// Before a frame: begins the next step if the last one is done. Events go to the `system`'s, and from there to egui.
    ///
    /// # Errors
    /// If the step fails; the message names file and line.
    pub(in crate::shell) fn begin_frame(
        &mut self,
        app: &mut App,
        window: &Window,
        system: &mut egui_winit::State,
    ) -> anyhow::Result<()> {
        if self.doing.is_none()
            && let Some((line, step)) = self.script.steps.pop()
        {
            (self.line, self.since) = (line, Instant::now());
            let begun = self.begin(step, app, window, system);
            self.doing = begun.with_context(|| self.place())?;
        }
        Ok(())
    }

    /// Once the window is closed.
    ///
    /// # Errors
    /// If there were steps left to be done.
    pub(in crate::shell) fn check_done(&self) -> anyhow::Result<()> {
        if self.doing.is_some() || !self.script.steps.is_empty() {
            bail!("{}: the window was closed here, before the script was done", self.place());
        }
        Ok(())
    }

    /// Adds the events of this frame to what egui hears.
    pub(in crate::shell) fn add_input(&mut self, input: &mut RawInput) {
        if let Some(Doing::Events(frames)) = &mut self.doing {
            let events = frames.pop_front().unwrap_or_default();
            input.events.extend(events);
            if frames.is_empty() {
                self.doing = None;
            }
        }
        // Nobody else has the keyboard while a script holds it.
        input.focused = true;
    }

    /// After a frame: what is wanted next. `copy` are the pixels of the window where they were wanted.
    ///
    /// # Errors
    /// If the step fails; the message names file and line.
    pub(in crate::shell) fn end_frame(
        &mut self,
        app: &App,
        window: &Window,
        copy: Option<Pixels>,
    ) -> anyhow::Result<Wish> {
        let wish = match &mut self.doing {
            None if self.script.steps.is_empty() => return Ok(Wish::Close),
            None | Some(Doing::Events(_)) => Wish::NextFrame,
            Some(Doing::Waiting { idle }) => {
                *idle = if app.is_idle() { *idle + 1 } else { 0 };
                let (is_idle, is_done) = (*idle > 0, *idle >= IDLE_FRAMES);
                if is_done {
                    self.doing = None;
                }
                if is_idle { Wish::NextFrame } else { Wish::News }
            }
            Some(Doing::Accumulating(count)) => {
                if app.frames(app.model.editing) >= *count {
                    self.doing = None;
                }
                Wish::News
            }
            Some(Doing::Resizing(size)) => {
                if window.inner_size() == *size {
                    self.doing = None;
                }
                Wish::News
            }
            Some(Doing::Shooting(path)) => {
                if let Some(pixels) = copy {
                    write_png(path, &pixels).with_context(|| self.place())?;
                    self.doing = None;
                }
                Wish::NextFrame
            }
        };
        if self.since.elapsed() > PATIENCE {
            return Err(anyhow::anyhow!("not done after {} s", PATIENCE.as_secs())).context(self.place());
        }
        Ok(wish)
    }

    /// Does what `step` says; `None` if that was all.
    fn begin(
        &mut self,
        step: Step,
        app: &mut App,
        window: &Window,
        system: &mut egui_winit::State,
    ) -> anyhow::Result<Option<Doing>> {
        let scale = egui_winit::pixels_per_point(system.egui_ctx(), window);
        let pos = |(x, y): (f32, f32)| Pos2::new(x / scale, y / scale);
        let frames = match step {
            Step::Wait => return Ok(Some(Doing::Waiting { idle: 0 })),
            Step::Open(path) => {
                app.model.scene = SceneRef::new(path);
                return Ok(None);
            }
            Step::Drop(path) => {
                let _ = system.on_window_event(window, &WindowEvent::DroppedFile(path));
                return Ok(None);
            }
            Step::Set { name, value } => {
                app.set(&name, &value)?;
                return Ok(None);
            }
            Step::Edit(side) => {
                app.model.editing = side;
                return Ok(None);
            }
            Step::Compare(comparison) => {
                app.model.comparison = comparison;
                return Ok(None);
            }
            Step::Divider(share) => {
                app.model.divider = share;
                return Ok(None);
            }
            Step::Show(aov) => {
                app.model.aov = aov;
                return Ok(None);
            }
            Step::Overlays(has) => {
                app.model.has_overlays = has;
                return Ok(None);
            }
            Step::Frames(count) => return Ok(Some(Doing::Accumulating(count))),
            Step::Resize(width, height) => {
                let size = PhysicalSize::new(width, height);
                let _ = window.request_inner_size(size);
                return Ok(Some(Doing::Resizing(size)));
            }
            Step::Screenshot(path) => return Ok(Some(Doing::Shooting(path))),
            Step::Turntable { path, frames } => {
                app.perform(system.egui_ctx(), Action::Turntable { path, frames, fps: TURN_FPS });
                return Ok(None);
            }
            Step::Copy(path) => {
                let line = app.command_line(app.model.editing);
                fs::write(&path, line + "\n").with_context(|| path.display().to_string())?;
                return Ok(None);
            }
            Step::ExpectError(text) => return expect_error(app, Some(&text)).map(|()| None),
            Step::ExpectNoError => return expect_error(app, None).map(|()| None),
            Step::Quit => {
                self.script.steps.clear();
                return Ok(None);
            }
            Step::Key { key, modifiers, text } => input::key(key, modifiers, text.as_deref()),
            Step::Type(text) => input::text(&text),
            Step::Move(x, y) => input::move_to(pos((x, y))),
            Step::Click { at, count, modifiers } => input::click(pos(at), count, modifiers),
            Step::Scroll { at, lines } => input::scroll(pos(at), lines),
            Step::Drag { from, by: (dx, dy), with } => {
                input::drag(pos(from), Vec2::new(dx, dy) / scale, with)
            }
        };
        Ok(Some(Doing::Events(frames.into())))
    }

    fn place(&self) -> String {
        format!("{}:{}", self.script.path.display(), self.line)
    }
}

/// Fails unless there is a message of an error with `text` in it, or, without a text, none at all.
fn expect_error(app: &App, text: Option<&str>) -> anyhow::Result<()> {
    let errors = app.shown.notices.iter().filter(|notice| notice.severity == Severity::Error);
    let errors: Vec<&str> = errors.map(|notice| notice.text.as_str()).collect();
    match text {
        Some(text) if !errors.iter().any(|error| error.contains(text)) => {
            bail!("expected an error with '{text}'; there are {errors:?}")
        }
        None if !errors.is_empty() => bail!("expected no error; there are {errors:?}"),
        _ => Ok(()),
    }
}

fn write_png(path: &Path, pixels: &Pixels) -> anyhow::Result<()> {
    let write = || -> anyhow::Result<()> {
        let file = std::io::BufWriter::new(fs::File::create(path)?);
        let mut encoder = png::Encoder::new(file, pixels.width, pixels.height);
        encoder.set_color(png::ColorType::Rgb);
        let rgb: Vec<u8> =
            pixels.rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&rgb)?;
        Ok(writer.finish()?)
    };
    write().with_context(|| path.display().to_string())
}
