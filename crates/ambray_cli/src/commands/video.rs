//! `ambray render -o out.mp4`: a sequence as one file.

use std::{path::Path, time::Instant};

use ambray_files::{
    atomic::{Batch, Pending, Target},
    video::{Kind, pixels},
};
use anyhow::{Context as _, anyhow, bail};

use super::{
    check_memory,
    render::Request,
    sequence::{Player, Step, timeline},
};
use crate::{
    args::Frames,
    failure::with_hint,
    report::{SceneReport, Tally},
    scene_source::Source,
    signals,
    timeline::playing,
};

/// Memory that a frame takes on its way into the video, bytes a pixel.
const BYTES_PER_PIXEL: u64 = 32;

/// Renders a sequence into the video of this `kind` at `path`.
pub(super) fn run(request: &Request<'_>, kind: Kind, path: &Path) -> anyhow::Result<()> {
    let Request { args, settings, .. } = request;
    let context = || format!("output {}", path.display());
    check_options(request).with_context(context)?;
    let target = Target::of(path);
    target.check()?;
    let rate = args.sequence.fps.unwrap_or_default().every(args.sequence.frames.map_or(1, |f| f.step()));
    kind.check(settings.size, rate).with_context(context)?;
    request.check_saved(std::slice::from_ref(&target))?;
    check_memory(settings, BYTES_PER_PIXEL)?;
    let source = request.open()?;
    let frames = match args.sequence.frames {
        Some(frames) => frames,
        None if args.sequence.hold_time => {
            bail!("--hold-time is not allowed without --frames: how many frames?")
        }
        None => whole(request, &source)?,
    };
    let timeline = timeline(request, &source, frames)?;
    let steps: Vec<_> = frames.numbers().map(|number| (number, Step::Make)).collect();
    let scene = SceneReport::of(&source);
    let mut renderer = request.renderer(source.scene)?;
    let (start, mut tally) = (Instant::now(), Tally::default());
    let graceful = signals::Graceful::begin();
    let pending = Pending::new(path).with_context(context)?;
    let mut video =
        kind.begin(&pending, settings.size, rate, signals::cancel_flag()).with_context(context)?;
    let mut player = Player { args, renderer: &mut renderer, timeline: &timeline, tally: &mut tally };
    player.play(&steps, &|_| Vec::new(), &mut |_, settings, frame| {
        video.frame(&pixels(frame, settings)?).with_context(context)
    })?;
    let end = Instant::now();
    video.finish().with_context(context)?;
    let mut batch = Batch::default();
    batch.push(pending);
    request.add_saved(&mut batch)?;
    signals::check()?;
    batch.commit()?;
    drop(graceful);
    tally.wrote(target.name(), end.elapsed());
    request.saved.iter().for_each(|saved| tally.wrote(saved.name(), Default::default()));
    let report = tally.report(scene, &renderer, settings, &timeline, start.elapsed());
    request.tell(&report, &|| report.text(frames, &timeline.rate().to_string()), false)
}

/// Refuses options that are about pictures.
fn check_options(request: &Request<'_>) -> anyhow::Result<()> {
    let args = request.args;
    if let Some(format) = args.format {
        bail!("--format {} is not allowed with a video", format.name());
    }
    if !args.aov.is_empty() {
        bail!("--aov is not allowed with a video, which shows the picture alone");
    }
    if args.sequence.resume {
        bail!("--resume is not allowed with a video, which is one file");
    }
    Ok(())
}

/// The frames that show the whole animation once; it begins again where they end.
fn whole(request: &Request<'_>, source: &Source) -> anyhow::Result<Frames> {
    let Some(rig) = &source.scene.rig else {
        let error = anyhow!("{} has no animation to make a video of", source.path);
        return Err(with_hint(
            error,
            "--temporal on --frames 0..60 shows how light accumulates in a still scene",
        ));
    };
    // A name that is not there is told by the renderer, with those that are.
    let duration = playing(&request.settings, rig).map_or(0.0, |clips| rig.duration(clips));
    let rate = request.args.sequence.fps.unwrap_or_default();
    Frames::first(rate.frames_in(f64::from(duration))).ok_or_else(|| {
        let most = Frames::MOST;
        let error = anyhow!("the animation lasts {duration} s, more than {most} frames at {rate} fps");
        with_hint(error, "--frames 0..300 chooses a part of it")
    })
}
