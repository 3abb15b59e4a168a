//! The report of a sequence of frames.

use std::{fmt::Write as _, time::Duration};

use ambray::{Frame, RayCounts, Renderer, settings::Settings};
use serde::Serialize;

use super::{
    BackendReport, BuildReport, RayReport, SceneReport, Spread, StageReport, ViewReport, camera_line,
    counted, length, milliseconds, rays_line, scene_line,
};
use crate::{args::Frames, timeline::Timeline};

/// The report of `ambray render` for a sequence.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SequenceReport {
    /// Version of ambray.
    pub version: &'static str,
    /// The scene.
    pub scene: SceneReport,
    /// The acceleration structures.
    pub build: BuildReport,
    /// Who rendered.
    pub backend: BackendReport,
    /// What was chosen for the first frame that was rendered; null if all were kept.
    pub view: Option<ViewReport>,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Ambient rays per pixel.
    pub spp: u32,
    /// Threads used; 0 on a device.
    pub threads: usize,
    /// Frames a second.
    pub fps: f64,
    /// All frames in their order, those that were kept too.
    pub frames: Vec<FrameReport>,
    /// Frames that were rendered; with `--temporal on` also kept ones, which later frames need.
    pub rendered: usize,
    /// Frames that were kept, since their files were there.
    pub kept: usize,
    /// Time of a frame, without writing it; null if all were kept.
    pub frame_ms: Option<Spread>,
    /// Rays of all frames.
    pub rays: RayReport,
    /// Time to encode and write all files.
    pub write_ms: f64,
    /// The whole sequence, wall time, without loading the scene.
    pub total_ms: f64,
    /// Files that were written: the pictures in their order, or the video.
    pub outputs: Vec<String>,
    /// The settings that the sequence began with.
    pub settings: Settings,
}

/// One frame of a sequence.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameReport {
    /// Its number.
    pub frame: u32,
    /// Time in the animation, seconds; null if the scene has none.
    pub time: Option<f64>,
    /// Whether its files were there already.
    pub kept: bool,
    /// What it took; null if it was not rendered.
    pub times: Option<StageReport>,
    /// Its rays; null if it was not rendered.
    pub rays: Option<RayReport>,
    /// Time to encode and write its files.
    pub write_ms: f64,
    /// Its files, the picture first; empty in a video.
    pub outputs: Vec<String>,
}

/// What is known while the frames are made.
#[derive(Debug, Default)]
pub struct Tally {
    frames: Vec<FrameReport>,
    view: Option<ViewReport>,
    threads: usize,
    times: Vec<Duration>,
    rays: RayCounts,
    write_time: Duration,
    outputs: Vec<String>,
}

impl Tally {
    /// Counts a frame that was rendered, and written to `outputs` in `write_time`.
    pub fn rendered(
        &mut self,
        number: u32,
        time: Option<f64>,
        frame: &Frame,
        outputs: Vec<String>,
        write_time: Duration,
    ) {
        self.write_time += write_time;
        self.outputs.extend_from_slice(&outputs);
        self.kept(number, time, Some(frame), outputs);
        if let Some(report) = self.frames.last_mut() {
            (report.kept, report.write_ms) = (false, milliseconds(write_time));
        }
    }

    /// Counts a frame whose files `outputs` were there; it may have been rendered for those after it.
    pub fn kept(&mut self, number: u32, time: Option<f64>, frame: Option<&Frame>, outputs: Vec<String>) {
        let stats = frame.map(|frame| &frame.stats);
        if let Some(frame) = frame {
            self.view.get_or_insert_with(|| ViewReport::of(&frame.view));
            self.threads = frame.stats.threads;
            self.times.push(frame.stats.times.total);
            self.rays = self.rays + frame.stats.rays;
        }
        self.frames.push(FrameReport {
            frame: number,
            time,
            kept: true,
            times: stats.map(|stats| StageReport::of(&stats.times)),
            rays: stats.map(|stats| RayReport::of(stats.rays, stats.times.total)),
            write_ms: 0.0,
            outputs,
        });
    }

    /// Counts a file that was written besides the frames, such as a video, whose end took `time`.
    pub fn wrote(&mut self, output: String, time: Duration) {
        self.write_time += time;
        self.outputs.push(output);
    }

    /// Frames whose files are there.
    #[must_use]
    pub fn finished(&self) -> usize {
        self.frames.iter().filter(|frame| !frame.outputs.is_empty()).count()
    }

    /// The report of a sequence by `renderer` that took `total` in all.
    #[must_use]
    pub fn report(
        self,
        scene: SceneReport,
        renderer: &Renderer,
        settings: &Settings,
        timeline: &Timeline,
        total: Duration,
    ) -> SequenceReport {
        let kept = self.frames.iter().filter(|frame| frame.kept).count();
        SequenceReport {
            version: env!("CARGO_PKG_VERSION"),
            scene,
            build: BuildReport::of(&renderer.build_stats()),
            backend: BackendReport::with(renderer, settings),
            view: self.view,
            width: settings.size.width,
            height: settings.size.height,
            spp: settings.spp,
            threads: self.threads,
            fps: timeline.rate().per_second(),
            rendered: self.times.len(),
            kept,
            frame_ms: (!self.times.is_empty()).then(|| Spread::of(&self.times)),
            rays: RayReport::of(self.rays, self.times.iter().sum()),
            write_ms: milliseconds(self.write_time),
            total_ms: milliseconds(total),
            frames: self.frames,
            outputs: self.outputs,
            settings: settings.clone(),
        }
    }
}

impl SequenceReport {
    /// For people; `frames` are the numbers, `rate` is the rate as it was given.
    #[must_use]
    pub fn text(&self, frames: Frames, rate: &str) -> String {
        let mut text = scene_line(&self.scene, &self.build);
        text.push_str(&self.backend.line());
        let mut line = |name: &str, rest: String| {
            let _ = writeln!(text, "{name:<9}{rest}"); // writing to a string cannot fail
        };
        let count = counted(frames.count() as u64, "frame");
        let kept = match self.kept {
            0 => String::new(),
            kept => format!("; {kept} kept, {} rendered", self.rendered),
        };
        line("sequence", format!("{count}, {frames}, {rate} fps{kept}"));
        if let (Some(view), Some(spread)) = (&self.view, &self.frame_ms) {
            let threads = match self.threads {
                0 => String::new(),
                threads => format!(", {}", counted(threads as u64, "thread")),
            };
            line("view", camera_line(&view.camera));
            let (size, radius) = (format!("{}x{}", self.width, self.height), length(view.radius));
            line("frame", format!("{size}, {} rays/pixel, radius {radius}{threads}", self.spp));
            let Spread { median, min, max, .. } = spread;
            let seconds = self.total_ms * 1e-3;
            line(
                "time",
                format!("{seconds:.1} s; a frame: median {median:.1} ms, min {min:.1} ms, max {max:.1} ms"),
            );
            line("rays", rays_line(&self.rays));
        }
        line("wrote", format!("{} ({:.0} ms)", self.wrote(), self.write_ms));
        text
    }

    /// The files in a few words.
    fn wrote(&self) -> String {
        match self.outputs.as_slice() {
            [] => "nothing: every frame was there".to_owned(),
            [one] => one.clone(),
            [first, .., last] => format!("{first} to {last}, {}", counted(self.outputs.len() as u64, "file")),
        }
    }
}
