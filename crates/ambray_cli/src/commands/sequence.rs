//! `ambray render --frames`: a picture for each frame.

use std::time::Instant;

use ambray::{Frame, Renderer, settings::Settings};
use ambray_files::{
    Plan,
    atomic::{Batch, Target},
    folder::Folder,
    numbering::Numbering,
};
use anyhow::{anyhow, bail};

use super::{check_memory, control, explained, render::Request};
use crate::{
    args::{Frames, Planes, RenderArgs},
    failure::with_hint,
    progress::Progress,
    report::{SceneReport, Tally},
    scene_source::Source,
    signals, terminal,
    timeline::Timeline,
};

/// Stem of the files where no name was given.
const DEFAULT_STEM: &str = "ambray_####";

/// Renders the frames of a sequence, each into files of its own.
pub(super) fn run(request: &Request<'_>, frames: Frames) -> anyhow::Result<()> {
    let Request { args, settings, .. } = request;
    let pictures = Pictures::new(args, frames)?;
    request.check_saved(&pictures.targets())?;
    check_memory(settings, pictures.plan.bytes_per_pixel())?;
    let source = request.open()?;
    let timeline = timeline(request, &source, frames)?;
    let label = match timeline.history(frames) {
        Some(history) => format!("{}, {history}", source.label),
        None => source.label.clone(),
    };
    let steps = pictures.steps(&timeline, |number, settings| {
        args.sequence.resume && pictures.at(number).is_made(settings, &label, source.modified)
    });
    let scene = SceneReport::of(&source);
    let mut renderer = request.renderer(source.scene)?;
    let (start, mut tally) = (Instant::now(), Tally::default());
    let graceful = signals::Graceful::begin();
    let mut player = Player { args, renderer: &mut renderer, timeline: &timeline, tally: &mut tally };
    let outcome = player.play(&steps, &|number| pictures.names(number), &mut |number, settings, frame| {
        let mut batch = Batch::default();
        pictures.folder.create()?;
        pictures.at(number).write(frame, settings, &label, &mut batch, signals::cancel_flag())?;
        signals::check()?;
        batch.commit()
    });
    if let Err(error) = outcome {
        tell_finished(&error, tally.finished(), frames, args);
        return Err(error);
    }
    let mut batch = Batch::default();
    request.add_saved(&mut batch)?;
    batch.commit()?;
    request.saved.iter().for_each(|saved| tally.wrote(saved.name(), Default::default()));
    drop(graceful);
    let report = tally.report(scene, &renderer, settings, &timeline, start.elapsed());
    request.tell(&report, &|| report.text(frames, &timeline.rate().to_string()), false)
}

/// The frames in time; an error if nothing would happen in them.
pub(super) fn timeline(request: &Request<'_>, source: &Source, frames: Frames) -> anyhow::Result<Timeline> {
    let Request { args, settings, .. } = request;
    let rate = args.sequence.fps.unwrap_or_default();
    let (moves, holds) = (source.scene.rig.is_some(), args.sequence.hold_time);
    let timeline = Timeline::new(settings.clone(), rate, moves && !holds);
    if moves && holds && !timeline.accumulates() {
        let error = anyhow!("--frames {frames} --hold-time: all frames would be the same");
        return Err(with_hint(error, "--temporal on accumulates light over the frames of one moment"));
    }
    if !moves && !timeline.accumulates() {
        let error =
            anyhow!("--frames {frames}: {} has no animation, all frames would be the same", source.path);
        return Err(with_hint(error, "--temporal on accumulates light over the frames of a still scene"));
    }
    if frames.step() > 1 && timeline.accumulates() {
        bail!(
            "--frames {frames} is not allowed with --temporal on, which needs every frame: leave out the step"
        );
    }
    let last = timeline.settings(frames.end());
    match last.validate().first() {
        Some(problem) => bail!("--frames {frames}: the last frame has {problem}"),
        None => Ok(timeline),
    }
}

/// After Ctrl-C, says what is there.
fn tell_finished(error: &anyhow::Error, finished: usize, frames: Frames, args: &RenderArgs) {
    if error.is::<signals::Interrupted>() && finished > 0 && !args.run.quiet {
        terminal::say(&format!(
            "ambray: {finished} of {} frames are finished; --resume renders the others",
            frames.count()
        ));
    }
}

/// Numbered pictures.
#[derive(Debug)]
struct Pictures {
    plan: Plan,
    numbering: Numbering,
    folder: Folder,
    frames: Frames,
}

impl Pictures {
    fn new(args: &RenderArgs, frames: Frames) -> anyhow::Result<Self> {
        let plan = Plan::new(args.output.as_deref(), DEFAULT_STEM, args.format, &Planes::of(&args.aov))?;
        let Target::File(path) = &plan.main else {
            let error = anyhow!("-o - is not allowed with --frames: stdout takes one picture");
            return Err(with_hint(error, "for one moment: --time SECONDS without --frames"));
        };
        let numbering = Numbering::of(path)?;
        if frames.count() > 1 && !numbering.is_numbered() {
            let error = anyhow!("output {}: {} frames need a name each", path.display(), frames.count());
            let name = numbering.suggestion();
            return Err(with_hint(
                error,
                format!("# stands for the number of the frame: -o {}", name.display()),
            ));
        }
        let pictures = Self { folder: Folder::of(path)?, numbering, plan, frames };
        pictures.targets().iter().try_for_each(Target::check_name)?;
        Ok(pictures)
    }

    /// The files of frame `number`.
    fn at(&self, number: u32) -> Plan {
        self.plan.at(self.numbering.path(number))
    }

    fn targets(&self) -> Vec<Target> {
        let files = |number| self.at(number).files().into_iter().map(|(target, _)| target);
        self.frames.numbers().flat_map(files).collect()
    }

    fn names(&self, number: u32) -> Vec<String> {
        self.at(number).files().iter().map(|(target, _)| target.name()).collect()
    }

    /// What to do with each frame, of which some may be `made` already.
    fn steps(&self, timeline: &Timeline, made: impl Fn(u32, &Settings) -> bool) -> Vec<(u32, Step)> {
        let step =
            |number| (number, if made(number, &timeline.settings(number)) { Step::Keep } else { Step::Make });
        let mut steps: Vec<_> = self.frames.numbers().map(step).collect();
        let last = steps.iter().rposition(|(_, step)| *step == Step::Make).unwrap_or(0);
        if timeline.accumulates() {
            let before = steps[..last].iter_mut().filter(|(_, step)| *step == Step::Keep);
            before.for_each(|(_, step)| *step = Step::Accumulate);
        }
        steps
    }
}

/// What to do with a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Nothing: its files are there.
    Keep,
    /// Render it for the frames after it; its files are there.
    Accumulate,
    /// Render and write it.
    Make,
}

/// Writes a frame with this number and these settings.
pub(super) type Write<'a> = dyn FnMut(u32, &Settings, &Frame) -> anyhow::Result<()> + 'a;

/// Renders frames one after the other; the scene is made ready once.
pub(super) struct Player<'a> {
    pub(super) args: &'a RenderArgs,
    pub(super) renderer: &'a mut Renderer,
    pub(super) timeline: &'a Timeline,
    pub(super) tally: &'a mut Tally,
}

impl Player<'_> {
    /// Takes all `steps`; `names` are the files of a frame.
    pub(super) fn play(
        &mut self,
        steps: &[(u32, Step)],
        names: &dyn Fn(u32) -> Vec<String>,
        write: &mut Write<'_>,
    ) -> anyhow::Result<()> {
        let count = steps.iter().filter(|(_, step)| *step != Step::Keep).count();
        let progress = Progress::new("rendering", self.args.run.quiet);
        let mut done = 0;
        for &(number, step) in steps {
            let (time, outputs) = (self.timeline.time(number), names(number));
            if step == Step::Keep {
                self.tally.kept(number, time, None, outputs);
                continue;
            }
            let settings = self.timeline.settings(number);
            let before = done as f32;
            let report = |share| progress.report((before + share) / count as f32);
            progress.say(format!("frame {number} ({} of {count})", done + 1));
            let control = control(&self.args.run, &report);
            let frame = self.renderer.render(&settings, control).map_err(explained)?;
            signals::check()?;
            let start = Instant::now();
            if step == Step::Make {
                write(number, &settings, &frame)?;
                self.tally.rendered(number, time, &frame, outputs, start.elapsed());
            } else {
                self.tally.kept(number, time, Some(&frame), outputs);
            }
            self.renderer.recycle(frame);
            done += 1;
        }
        Ok(())
    }
}
