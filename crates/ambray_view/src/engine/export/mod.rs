//! Pictures into files, while the view waits.

mod turntable;

use std::{
    path::{Path, PathBuf},
    str::FromStr as _,
    sync::atomic::AtomicBool,
};

use ambray::{
    Aov, Control, Frame, RenderError, Renderer,
    settings::{Settings, Temporal},
};
use ambray_files::{
    Interrupted, Plan, Rate,
    atomic::{Batch, Pending, Target},
    folder::Folder,
    interruption,
    numbering::Numbering,
    video::{Kind, pixels},
};
use anyhow::{Context as _, bail};

use super::{contract::Export, gallery::Gallery};

/// What an export needs.
pub(super) struct Exporter<'a> {
    pub(super) renderer: &'a mut Renderer,
    /// What pictures say they show.
    pub(super) label: &'a str,
    pub(super) gallery: &'a Gallery,
    pub(super) threads: usize,
    pub(super) cancel: &'a AtomicBool,
    /// Called with the share that is done.
    pub(super) progress: &'a (dyn Fn(f32) + Sync),
}

impl Exporter<'_> {
    /// Does what `export` asks for. Each file appears whole or not at all; the finished frames of a turn stay.
    pub(super) fn run(&mut self, export: &Export) -> anyhow::Result<()> {
        match export {
            Export::Screenshot { path, settings, aov } => self.screenshot(path, settings, *aov),
            Export::Turntable { path, settings, aov, frames, fps } => {
                let rate = Rate::from_str(&fps.to_string()).map_err(|expected| {
                    anyhow::anyhow!("{fps} frames a second are not allowed: expected {expected}")
                })?;
                if *frames == 0 {
                    bail!("a turn of no frames");
                }
                match Kind::of(path) {
                    Some(kind) => self.video(path, kind, settings, *aov, *frames, rate),
                    None => self.pictures(path, settings, *aov, *frames),
                }
            }
        }
    }

    /// The picture that hangs if it is the one that is asked for, with all frames that it has accumulated; else a new one.
    fn screenshot(&mut self, path: &Path, settings: &Settings, aov: Aov) -> anyhow::Result<()> {
        let plan = plan(path, aov)?;
        plan.check()?;
        let mut batch = Batch::default();
        if let Some(shot) = self.gallery.finished(settings) {
            let settings = Settings { frame: shot.settings.frame, ..settings.clone() };
            let label = if shot.frames > 1 {
                // As the last picture of a sequence says it that was rendered with the copied command line.
                format!("{}, accumulated from frame 0", self.label)
            } else {
                self.label.to_owned()
            };
            self.write(&plan, &shot.frame, &settings, aov, &label, &mut batch)?;
        } else {
            let frame = self.render(settings, [0.0, 1.0])?;
            self.write(&plan, &frame, settings, aov, self.label, &mut batch)?;
        }
        interruption::check(self.cancel)?;
        batch.commit()
    }

    /// A turn in numbered pictures.
    fn pictures(&mut self, path: &Path, settings: &Settings, aov: Aov, frames: u32) -> anyhow::Result<()> {
        let plan = plan(path, aov)?;
        let numbering = Numbering::of(path)?;
        if frames > 1 && !numbering.is_numbered() {
            let name = numbering.suggestion();
            bail!("{frames} frames need a name each: # stands for the number, such as {}", name.display());
        }
        let files: Vec<PathBuf> = (0..frames).map(|number| numbering.path(number)).collect();
        files.iter().try_for_each(|path| Target::File(path.clone()).check_name())?;
        Folder::of(path)?.create()?;
        self.turn(settings, frames, &mut |exporter, number, settings, frame| {
            let (plan, mut batch) = (plan.at(files[number as usize].clone()), Batch::default());
            exporter.write(&plan, frame, settings, aov, exporter.label, &mut batch)?;
            batch.commit()
        })
    }

    /// A turn in one file.
    fn video(
        &mut self,
        path: &Path,
        kind: Kind,
        settings: &Settings,
        aov: Aov,
        frames: u32,
        rate: Rate,
    ) -> anyhow::Result<()> {
        Target::of(path).check()?;
        kind.check(settings.size, rate)?;
        let pending = Pending::new(path)?;
        let cancel = self.cancel;
        let mut video = kind.begin(&pending, settings.size, rate, cancel)?;
        self.turn(settings, frames, &mut |_, _, settings, frame| {
            let rgb = if aov == Aov::Beauty { pixels(frame, settings)? } else { plane(frame, aov, settings) };
            video.frame(&rgb)
        })?;
        video.finish()?;
        let mut batch = Batch::default();
        batch.push(pending);
        interruption::check(self.cancel)?;
        batch.commit()
    }

    /// Renders the frames of a turn. Light that accumulates is carried from one to the next, as in every sequence.
    fn turn(
        &mut self,
        settings: &Settings,
        frames: u32,
        take: &mut dyn FnMut(&Self, u32, &Settings, &Frame) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        let view = self.renderer.view(settings)?;
        let (low, high) = self.renderer.scene().bounds().unwrap_or_default();
        let center = 0.5 * low + 0.5 * high;
        self.renderer.forget_frames();
        for number in 0..frames {
            let mut settings =
                turntable::turned(settings, &view.camera, center, number as f32 / frames as f32);
            if settings.temporal == Temporal::On {
                settings.frame = settings.frame.wrapping_add(number);
            }
            let share = [number, number + 1].map(|done| done as f32 / frames as f32);
            let frame = self.render(&settings, share)?;
            take(self, number, &settings, &frame)?;
            self.renderer.recycle(frame);
            interruption::check(self.cancel)?;
        }
        Ok(())
    }

    fn render(&mut self, settings: &Settings, [from, to]: [f32; 2]) -> anyhow::Result<Frame> {
        let progress = |share: f32| (self.progress)(from + (to - from) * share);
        let control = Control { progress: &progress, cancel: self.cancel, threads: self.threads };
        self.renderer.render(settings, control).map_err(|error| match error {
            RenderError::Cancelled => Interrupted.into(),
            other => other.into(),
        })
    }

    /// Adds `frame` to `batch` as `ambray render` writes it; in PNG the plane `aov` takes the place of the picture.
    fn write(
        &self,
        plan: &Plan,
        frame: &Frame,
        settings: &Settings,
        aov: Aov,
        label: &str,
        batch: &mut Batch,
    ) -> anyhow::Result<()> {
        let written = if plan.planes.is_empty() && aov != Aov::Beauty {
            plan.write_plane(frame, aov, settings, label, batch)
        } else {
            plan.write(frame, settings, label, batch, self.cancel)
        };
        written.context("the picture cannot be written")
    }
}

/// The file at `path`; OpenEXR has the plane `aov` besides the picture.
fn plan(path: &Path, aov: Aov) -> anyhow::Result<Plan> {
    let is_exr = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"));
    let planes: &[Aov] = if is_exr { &[aov] } else { &[] };
    Plan::new(Some(path), "ambray", None, planes)
}

/// A plane as red, green and blue.
fn plane(frame: &Frame, aov: Aov, settings: &Settings) -> Vec<u8> {
    let rgba = ambray::display::show(frame, aov, settings).rgba8();
    rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
}
