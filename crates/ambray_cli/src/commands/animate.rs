//! `ambray bench --animate`: what it takes to follow an animation, and what it costs the rays.
//!
//! All ways of updating play the same poses in turn, each with a renderer of its own, so that a machine that slows down does
//! so for all of them.

use std::{fmt::Write as _, path::Path, time::Duration};

use ambray::{
    PoseStats, Renderer, RendererOptions, StageTimes,
    settings::{Settings, Temporal},
};
use anyhow::{anyhow, bail};
use serde::Serialize;

use super::{bench::opened, control, explained, following, renderer};
use crate::{
    args::{BenchArgs, Updates},
    failure::with_hint,
    machine::Machine,
    progress::Progress,
    report::{
        self, BackendReport, BuildReport, SceneReport, Spread, bytes, counted, milliseconds, quantile, short,
    },
    scene_source::Source,
    signals, terminal,
    timeline::{Timeline, clips_name, playing},
};

/// Poses that are measured unless `--frames` says otherwise.
const MOST_POSES: u32 = 120;
/// Frames that are traced at each pose unless `--repeats` says otherwise.
const REPEATS: u32 = 3;

/// The result of `ambray bench --animate`.
#[derive(Debug, Serialize)]
struct AnimateReport {
    machine: Machine,
    warmup: u32,
    /// Frames that were traced at each pose; the fastest counts.
    repeats: u32,
    fps: f64,
    settings: Settings,
    scenes: Vec<SceneAnimate>,
}

#[derive(Debug, Serialize)]
struct SceneAnimate {
    scene: SceneReport,
    /// What plays.
    animation: String,
    /// How long it takes, seconds.
    duration: f32,
    poses: u32,
    backend: BackendReport,
    build: BuildReport,
    policies: Vec<PolicyReport>,
}

/// One way of updating over all poses.
#[derive(Debug, Serialize)]
struct PolicyReport {
    updates: &'static str,
    /// Bending vertices.
    deformation_ms: Spread,
    /// Refitting or rebuilding structures of what deforms.
    bottom_level_ms: Spread,
    /// Building the top-level structure.
    top_level_ms: Spread,
    /// Primary rays, direct light and ambient rays.
    trace_ms: Spread,
    /// Filter and composition.
    filter_ms: Spread,
    /// Everything, wall time.
    frame_ms: Spread,
    /// Time to trace over that after a rebuild, pose by pose; null where rebuilding was not measured.
    slowdown: Option<Slowdown>,
    /// Refits over all poses.
    refitted: u32,
    /// Rebuilds over all poses.
    rebuilt: u32,
    /// Structures that are kept for what deforms in the end.
    kept: u32,
    /// Largest surface-area cost of refitted structures over that of their builds.
    decay: f32,
    /// Memory of all structures in the end.
    acceleration_bytes: u64,
    frames: Vec<PoseReport>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct Slowdown {
    median: f64,
    worst: f64,
}

/// One pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct PoseReport {
    frame: u32,
    time: Option<f64>,
    deformation_ms: f64,
    bottom_level_ms: f64,
    top_level_ms: f64,
    trace_ms: f64,
    filter_ms: f64,
    frame_ms: f64,
    refitted: u32,
    rebuilt: u32,
    kept: u32,
    decay: f32,
}

/// Measures the scenes; returns the result as JSON.
pub(super) fn run(
    args: &BenchArgs,
    settings: &Settings,
    options: &RendererOptions,
) -> anyhow::Result<String> {
    let rate = args.animate.fps.unwrap_or_default();
    let mut report = AnimateReport {
        machine: Machine::detect(),
        warmup: args.warmup,
        repeats: repeats(args, settings.temporal),
        fps: rate.per_second(),
        settings: settings.clone(),
        scenes: Vec::new(),
    };
    for path in &args.rendered() {
        let scene = measure(path, args, settings, options)?;
        if !args.json && !args.run.quiet {
            terminal::print(&scene.text(&rate.to_string(), settings))?;
        }
        report.scenes.push(scene);
    }
    report::json(&report)
}

fn measure(
    path: &Path,
    args: &BenchArgs,
    settings: &Settings,
    options: &RendererOptions,
) -> anyhow::Result<SceneAnimate> {
    let source = opened(path, args)?;
    let (animation, duration) = animation(settings, &source)?;
    let rate = args.animate.fps.unwrap_or_default();
    let timeline = Timeline::new(settings.clone(), rate, true);
    let poses = rate.frames_in(f64::from(duration)).min(args.frames.unwrap_or(MOST_POSES));
    let scene = SceneReport::of(&source);
    let chosen = match &args.updates.updates {
        Some(updates) => std::slice::from_ref(updates),
        None => &Updates::ALL[..],
    };
    let track = |&updates: &Updates| {
        let options = following(options, Some(updates));
        let renderer = renderer(source.scene.clone(), &options, &args.run)?;
        Ok(Track { updates, renderer, poses: Vec::new() })
    };
    let mut tracks: Vec<Track> = chosen.iter().map(track).collect::<anyhow::Result<_>>()?;
    let first = &tracks[0].renderer;
    let (backend, build) = (BackendReport::of(first), BuildReport::of(&first.build_stats()));
    let _graceful = signals::Graceful::begin();
    play(&mut tracks, &timeline, poses, args)?;
    if tracks.iter().any(|track| BackendReport::of(&track.renderer) != backend) {
        bail!("the device failed while it was measured: the times mean nothing");
    }
    let baseline = tracks.iter().find(|track| track.updates == Updates::Rebuild);
    let policies = tracks.iter().map(|track| track.report(baseline, &timeline)).collect();
    Ok(SceneAnimate { scene, animation, duration, poses, backend, build, policies })
}

/// Frames to trace at each pose.
fn repeats(args: &BenchArgs, temporal: Temporal) -> u32 {
    // Nothing moves between two frames of the same pose, which makes accumulation cheaper than it is.
    args.animate.repeats.unwrap_or(if temporal == Temporal::On { 1 } else { REPEATS })
}

/// The animation that plays, and its duration.
fn animation(settings: &Settings, source: &Source) -> anyhow::Result<(String, f32)> {
    let Some(rig) = &source.scene.rig else {
        let error = anyhow!("{} has no animation: --animate has nothing to play", source.path);
        return Err(with_hint(error, "built-in scenes that move: banner, flock"));
    };
    // A name that is not there is told by the renderer, with those that are.
    let clips = playing(settings, rig);
    Ok(clips.map_or_else(Default::default, |clips| (clips_name(clips, rig), rig.duration(clips))))
}

/// One way of updating.
struct Track {
    updates: Updates,
    renderer: Renderer,
    poses: Vec<Pose>,
}

/// What a pose took: the move, and the fastest of its frames.
#[derive(Clone, Copy, Debug, Default)]
struct Pose {
    moved: PoseStats,
    frame: StageTimes,
}

/// Plays `count` poses on all tracks in turn.
fn play(tracks: &mut [Track], timeline: &Timeline, count: u32, args: &BenchArgs) -> anyhow::Result<()> {
    let progress = Progress::new("measuring", args.run.quiet);
    let control = control(&args.run, &|_| ());
    // The last pose comes before the first one where an animation repeats: programs are compiled and memory is there.
    let before = timeline.settings(count - 1);
    for track in &mut *tracks {
        track.renderer.pose(&before, control).map_err(explained)?;
        for _ in 0..args.warmup {
            track.renderer.measure(&before, control).map_err(explained)?;
        }
    }
    for number in 0..count {
        let settings = timeline.settings(number);
        for track in &mut *tracks {
            let moved = track.renderer.pose(&settings, control).map_err(explained)?;
            track
                .poses
                .push(Pose { moved, frame: StageTimes { total: Duration::MAX, ..Default::default() } });
        }
        for _ in 0..repeats(args, settings.temporal) {
            for track in &mut *tracks {
                let stats = track.renderer.measure(&settings, control).map_err(explained)?;
                if let Some(pose) = track.poses.last_mut().filter(|pose| stats.times.total < pose.frame.total)
                {
                    pose.frame = stats.times;
                }
            }
        }
        // Nobody is always the first one, whose data are not in the caches.
        tracks.rotate_left(1);
        progress.report((number + 1) as f32 / count as f32);
    }
    tracks.sort_by_key(|track| Updates::ALL.iter().position(|&updates| updates == track.updates));
    Ok(())
}

impl Pose {
    fn trace(&self) -> Duration {
        self.frame.primary + self.frame.direct + self.frame.ambient
    }

    /// On a device each frame builds its own top level, on the processor each move.
    fn top_level(&self) -> Duration {
        self.moved.top_level + self.frame.top_level
    }

    fn total(&self) -> Duration {
        self.moved.total + self.frame.total
    }

    fn report(&self, frame: u32, timeline: &Timeline) -> PoseReport {
        let PoseStats { refitted, rebuilt, kept, decay, .. } = self.moved;
        PoseReport {
            frame,
            time: timeline.time(frame),
            deformation_ms: milliseconds(self.moved.deformation),
            bottom_level_ms: milliseconds(self.moved.bottom_level),
            top_level_ms: milliseconds(self.top_level()),
            trace_ms: milliseconds(self.trace()),
            filter_ms: milliseconds(self.frame.filter),
            frame_ms: milliseconds(self.total()),
            refitted,
            rebuilt,
            kept,
            decay,
        }
    }
}

impl Track {
    fn report(&self, baseline: Option<&Self>, timeline: &Timeline) -> PolicyReport {
        let spread = |time: fn(&Pose) -> Duration| {
            let times: Vec<_> = self.poses.iter().map(time).collect();
            Spread::of(&times)
        };
        PolicyReport {
            updates: self.updates.name(),
            deformation_ms: spread(|pose| pose.moved.deformation),
            bottom_level_ms: spread(|pose| pose.moved.bottom_level),
            top_level_ms: spread(Pose::top_level),
            trace_ms: spread(Pose::trace),
            filter_ms: spread(|pose| pose.frame.filter),
            frame_ms: spread(Pose::total),
            slowdown: baseline.map(|baseline| Slowdown::of(&self.poses, &baseline.poses)),
            refitted: self.poses.iter().map(|pose| pose.moved.refitted).sum(),
            rebuilt: self.poses.iter().map(|pose| pose.moved.rebuilt).sum(),
            kept: self.poses.last().map_or(0, |pose| pose.moved.kept),
            decay: self.poses.iter().map(|pose| pose.moved.decay).fold(1.0, f32::max),
            acceleration_bytes: self.renderer.build_stats().acceleration_bytes,
            frames: (0..).zip(&self.poses).map(|(number, pose)| pose.report(number, timeline)).collect(),
        }
    }
}

impl Slowdown {
    /// Of `poses`, at least one, over the same poses of `baseline`.
    fn of(poses: &[Pose], baseline: &[Pose]) -> Self {
        let ratio =
            |(pose, base): (&Pose, &Pose)| pose.trace().as_secs_f64() / base.trace().as_secs_f64().max(1e-9);
        let mut ratios: Vec<f64> = poses.iter().zip(baseline).map(ratio).collect();
        ratios.sort_by(f64::total_cmp);
        let rounded = |ratio: f64| (ratio * 1e4).round() / 1e4;
        Self { median: rounded(quantile(&ratios, 0.5)), worst: rounded(quantile(&ratios, 1.0)) }
    }
}

impl SceneAnimate {
    fn text(&self, rate: &str, settings: &Settings) -> String {
        let mut text = report::scene_line(&self.scene, &self.build);
        text.push_str(&self.backend.line());
        let (poses, size) = (counted(u64::from(self.poses), "pose"), settings.size);
        let _ = writeln!(
            text, // writing to a string cannot fail
            "plays    animation {}, {:.2} s: {poses} at {rate} fps, {size}, {} rays/pixel",
            self.animation,
            self.duration,
            settings.spp
        );
        let mut row = |cells: [&str; 13]| {
            let [updates, numbers @ ..] = cells;
            let _ = write!(text, "{updates:<9}");
            for number in numbers {
                let _ = write!(text, "{number:>9}");
            }
            text.push('\n');
        };
        row([
            "updates", "deform", "bottom", "top", "trace", "filter", "frame ms", "p95", "slower", "worst",
            "rebuilt", "kept", "decay",
        ]);
        for policy in &self.policies {
            let ratio = |ratio: fn(&Slowdown) -> f64| {
                policy
                    .slowdown
                    .as_ref()
                    .map_or_else(|| "-".to_owned(), |slowdown| format!("{:.3}", ratio(slowdown)))
            };
            row([
                &format!("  {}", policy.updates),
                &short(policy.deformation_ms.median),
                &short(policy.bottom_level_ms.median),
                &short(policy.top_level_ms.median),
                &short(policy.trace_ms.median),
                &short(policy.filter_ms.median),
                &short(policy.frame_ms.median),
                &short(policy.frame_ms.p95),
                &ratio(|slowdown| slowdown.median),
                &ratio(|slowdown| slowdown.worst),
                &policy.rebuilt.to_string(),
                &policy.kept.to_string(),
                &format!("{:.2}", policy.decay),
            ]);
        }
        let memory =
            |policy: &PolicyReport| format!("{} {}", policy.updates, bytes(policy.acceleration_bytes));
        let memory: Vec<_> = self.policies.iter().map(memory).collect();
        let _ = writeln!(text, "memory   {}", memory.join(", "));
        let _ = writeln!(
            text,
            "         medians; slower: time to trace over that after a rebuild, pose by pose; decay: largest cost of a \
             refitted structure over that of its build"
        );
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slowdown_compares_pose_by_pose() {
        let pose = |ms| {
            let frame = StageTimes { ambient: Duration::from_millis(ms), ..Default::default() };
            Pose { frame, ..Default::default() }
        };
        let slowdown = Slowdown::of(&[pose(20), pose(12), pose(44)], &[pose(10), pose(10), pose(40)]);
        assert_eq!(slowdown, Slowdown { median: 1.2, worst: 2.0 });
    }
}
