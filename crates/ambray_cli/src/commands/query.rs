//! `ambray query`: ambient light at the points of a list, read and written in chunks.

use std::{
    fs::File,
    io::{self, BufRead, BufReader, Write, stdin},
    path::Path,
    time::{Duration, Instant},
};

use ambray::{QueryPoint, RenderError, Renderer, settings::Settings};
use ambray_files::{
    atomic::{Batch, Target},
    settings_file,
};
use anyhow::{Context as _, anyhow, bail};

use super::{check_animation, control, explained, renderer};
use crate::{
    args::{Grouping, QueryArgs},
    points::{self, Reader},
    progress::Progress,
    report::{BackendReport, counted, rate},
    scene_source, settings, terminal,
};

/// Points that are evaluated together: enough to keep the threads busy, few enough for small memory.
const CHUNK: usize = 1 << 15;

/// Evaluates points.
pub fn run(args: &QueryArgs) -> anyhow::Result<()> {
    let settings = settings::resolve(&args.settings)?;
    let options = args.backend.options(Grouping::Auto)?;
    let target = Target::of(args.output.as_deref().unwrap_or(Path::new("-")));
    target.check()?;
    let saved = args.settings.save_settings.as_deref().map(Target::of);
    if saved.as_ref() == Some(&target) {
        bail!("--save-settings {}: the results go there", target.name());
    }
    saved.iter().try_for_each(Target::check)?;
    let (input, length) = open(&args.points)?;
    let name = if length.is_none() && args.points == Path::new("-") {
        "stdin".to_owned()
    } else {
        args.points.display().to_string()
    };
    let reader = Reader::new(input, name, args.points_format);

    let source = scene_source::open(&args.scene.scene, args.scene.gltf_scene.as_deref())?;
    check_animation(&settings, &source)?;
    let mut renderer = renderer(source.scene, &options, &args.run)?;
    let mut job =
        Job { args, settings: &settings, renderer: &mut renderer, reader, length, done: Done::default() };
    // Ctrl-C ends the program at once here, even where it waits for more points; temporary files are removed.
    let mut batch = Batch::default();
    if let Some(saved) = &saved {
        let toml = settings_file::write(&settings);
        batch.add(saved, |out| Ok(out.write_all(toml.as_bytes())?))?;
    }
    match &target {
        // Nothing waits in memory: results go out as they come.
        Target::Stdout => job.run(&mut io::stdout().lock())?,
        Target::File(_) => batch.add(&target, |mut out| job.run(&mut out))?,
    }
    batch.commit()?;
    if !args.run.quiet {
        job.done.say(&target);
        terminal::say(BackendReport::of(&renderer).line().trim_end());
    }
    Ok(())
}

/// The points and the length of their file, if it has one.
fn open(path: &Path) -> anyhow::Result<(Box<dyn BufRead>, Option<u64>)> {
    if path == Path::new("-") {
        return Ok((Box::new(stdin().lock()), None));
    }
    let context = || format!("points {}", path.display());
    let file = File::open(path).with_context(context)?;
    let metadata = file.metadata().with_context(context)?;
    if metadata.is_dir() {
        return Err(anyhow!("is a folder")).with_context(context);
    }
    Ok((Box::new(BufReader::with_capacity(1 << 16, file)), metadata.is_file().then_some(metadata.len())))
}

struct Job<'a> {
    args: &'a QueryArgs,
    settings: &'a Settings,
    renderer: &'a mut Renderer,
    reader: Reader<Box<dyn BufRead>>,
    length: Option<u64>,
    done: Done,
}

#[derive(Debug, Default)]
struct Done {
    points: u64,
    rays: u64,
    time: Duration,
}

impl Job<'_> {
    fn run(&mut self, output: &mut dyn Write) -> anyhow::Result<()> {
        let progress = Progress::new("evaluating", self.args.run.quiet);
        // The header waits for the first results: a list that is wrong from the start leaves no output.
        let mut header = if self.args.json { "" } else { points::RESULT_HEADER };
        loop {
            let text = self.chunk()?;
            output.write_all(std::mem::take(&mut header).as_bytes())?;
            if text.is_empty() {
                return Ok(output.flush()?);
            }
            output.write_all(text.as_bytes())?;
            if let Some(length) = self.length {
                progress.report(self.reader.bytes() as f32 / length.max(1) as f32);
            }
        }
    }

    /// Results of the next points; empty at the end.
    fn chunk(&mut self) -> anyhow::Result<String> {
        let located = self.reader.next_chunk(CHUNK)?;
        if located.is_empty() {
            return Ok(String::new());
        }
        let points: Vec<QueryPoint> = located.iter().map(|located| located.point).collect();
        let start = Instant::now();
        let results = self.renderer.query(self.settings, &points, control(&self.args.run, &|_| ())).map_err(
            |error| match error {
                RenderError::Point { index, reason } => {
                    let line = located.get(index).map_or(0, |point| point.line);
                    anyhow!("{}:{line}: {reason}", self.reader.name())
                }
                other => explained(other),
            },
        )?;
        self.done.time += start.elapsed();
        self.done.points += points.len() as u64;
        let mut text = String::new();
        for (point, result) in points.iter().zip(&results) {
            self.done.rays +=
                u64::from(result.ambient_rays) + u64::from(result.chord_rays) + u64::from(result.shadow_rays);
            if self.args.json {
                points::push_json(&mut text, point, result)?;
            } else {
                points::push_csv(&mut text, point, result);
            }
        }
        Ok(text)
    }
}

impl Done {
    /// Tells on stderr, since results may go to stdout.
    fn say(&self, target: &Target) {
        terminal::say(&format!(
            "{}, {} in {:.1} ms, {} a second; wrote {}",
            counted(self.points, "point"),
            counted(self.rays, "ray"),
            self.time.as_secs_f64() * 1e3,
            rate(self.rays, self.time),
            target.name()
        ));
    }
}
