//! `ambray render`: a scene in, pictures out.

use std::time::Instant;

use ambray::{Renderer, RendererOptions, scene::Scene, settings::Settings};
use ambray_files::{
    Plan,
    atomic::{Batch, Target},
    settings_file,
    video::Kind,
};
use anyhow::bail;
use serde::Serialize;

use super::{check_animation, check_memory, control, explained, following, renderer, sequence, video};
use crate::{
    args::{Grouping, Planes, RenderArgs},
    progress::Progress,
    report::{self, RenderReport, SceneReport},
    scene_source::{self, Source},
    settings, signals, terminal,
};

/// Stem of the picture where no name was given.
const DEFAULT_STEM: &str = "ambray";

/// Renders a scene.
pub fn run(args: &RenderArgs) -> anyhow::Result<()> {
    let request = Request::new(args)?;
    let video = args.output.as_deref().and_then(|path| Some((Kind::of(path)?, path)));
    match (video, args.sequence.frames) {
        (Some((kind, path)), _) => video::run(&request, kind, path),
        (None, Some(frames)) => sequence::run(&request, frames),
        (None, None) => still(&request),
    }
}

/// Renders one picture.
fn still(request: &Request<'_>) -> anyhow::Result<()> {
    let Request { args, settings, saved, .. } = request;
    if let Some(option) = args.sequence.needs_frames() {
        bail!("{option} is not allowed without --frames: it is about sequences");
    }
    let plan = Plan::new(args.output.as_deref(), DEFAULT_STEM, args.format, &Planes::of(&args.aov))?;
    plan.check()?;
    if args.json && plan.main == Target::Stdout {
        bail!("--json is not allowed with -o -: both write to stdout");
    }
    let files: Vec<_> = plan.files().into_iter().map(|(target, _)| target).collect();
    request.check_saved(&files)?;
    check_memory(settings, plan.bytes_per_pixel())?;

    let source = request.open()?;
    let (scene, label) = (SceneReport::of(&source), source.label);
    let mut renderer = request.renderer(source.scene)?;
    let graceful = signals::Graceful::begin();
    let progress = Progress::new("rendering", args.run.quiet);
    let report_share = |share| progress.report(share);
    let frame = renderer.render(settings, control(&args.run, &report_share)).map_err(explained)?;
    drop(progress);

    let start = Instant::now();
    let mut batch = Batch::default();
    plan.write(&frame, settings, &label, &mut batch, signals::cancel_flag())?;
    request.add_saved(&mut batch)?;
    signals::check()?;
    batch.commit()?;
    drop(graceful);

    let outputs = files.iter().chain(saved).map(Target::name).collect();
    let report = RenderReport::of(scene, &renderer, settings, &frame, start.elapsed(), outputs);
    request.tell(&report, &|| report.text(), plan.main == Target::Stdout)
}

/// What was asked for: the command line with its meaning.
pub(super) struct Request<'a> {
    pub(super) args: &'a RenderArgs,
    pub(super) settings: Settings,
    options: RendererOptions,
    /// Where the settings go.
    pub(super) saved: Option<Target>,
}

impl<'a> Request<'a> {
    fn new(args: &'a RenderArgs) -> anyhow::Result<Self> {
        let settings = settings::resolve(&args.settings)?;
        let options = following(&args.backend.options(Grouping::Auto)?, args.updates.updates);
        let saved = args.settings.save_settings.as_deref().map(Target::of);
        if args.json && saved == Some(Target::Stdout) {
            bail!("--json is not allowed with --save-settings -: both write to stdout");
        }
        Ok(Self { args, settings, options, saved })
    }

    /// Refuses settings that cannot be written, or go where one of the pictures goes.
    pub(super) fn check_saved(&self, pictures: &[Target]) -> anyhow::Result<()> {
        let Some(saved) = &self.saved else { return Ok(()) };
        if pictures.contains(saved) {
            bail!("--save-settings {}: the picture goes there", saved.name());
        }
        saved.check()
    }

    /// Adds the settings to what is written.
    pub(super) fn add_saved(&self, batch: &mut Batch) -> anyhow::Result<()> {
        let Some(saved) = &self.saved else { return Ok(()) };
        let toml = settings_file::write(&self.settings);
        batch.add(saved, |out| Ok(out.write_all(toml.as_bytes())?))
    }

    /// Loads the scene.
    pub(super) fn open(&self) -> anyhow::Result<Source> {
        let source = scene_source::open(&self.args.scene.scene, self.args.scene.gltf_scene.as_deref())?;
        check_animation(&self.settings, &source)?;
        Ok(source)
    }

    /// Makes the scene ready.
    pub(super) fn renderer(&self, scene: Scene) -> anyhow::Result<Renderer> {
        renderer(scene, &self.options, &self.args.run)
    }

    /// Tells what was done, as JSON or as `text`; on stderr if a picture went to stdout.
    pub(super) fn tell(
        &self,
        report: &impl Serialize,
        text: &dyn Fn() -> String,
        picture_on_stdout: bool,
    ) -> anyhow::Result<()> {
        if self.args.json {
            terminal::print(&report::json(report)?)
        } else if self.args.run.quiet {
            Ok(())
        } else if picture_on_stdout || self.saved == Some(Target::Stdout) {
            terminal::say(text().trim_end());
            Ok(())
        } else {
            terminal::print(&text())
        }
    }
}
