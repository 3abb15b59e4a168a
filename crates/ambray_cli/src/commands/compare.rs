//! `ambray compare`: Ambray against the truth and against other methods, as a report.

mod text;

use ambray::{
    Renderer,
    settings::{Falloff, Method, Settings},
};
use ambray_compare::{
    document::Document,
    experiment::{self, Options, Outcome, SequenceOptions, Work},
    html, output,
    paper::{self, Paper, PaperOptions, TABLE_SIZE, Views},
    report as compare_report,
    truth::{Content, TruthOptions},
};
use ambray_files::{
    atomic::{Batch, Target},
    settings_file, with_hint,
};
use anyhow::{anyhow, bail};
use serde::Serialize;

use super::{check_animation, check_memory, control, explained, renderer};
use crate::{
    args::{Backend, CompareArgs, Grouping},
    machine::Machine,
    progress::Progress,
    report::{self, BackendReport, BuildReport, SceneReport},
    scene_source, settings, signals, terminal,
};

/// Frames a second where nothing else is said, as of `ambray render`.
const FPS: f64 = 30.0;

/// Everything that was measured, and what it depends on.
#[derive(Debug, Serialize)]
struct CompareReport<'a> {
    machine: Machine,
    command: &'a str,
    scene: &'a SceneReport,
    build: BuildReport,
    backend: BackendReport,
    settings: &'a Settings,
    #[serde(flatten)]
    measured: &'a Measured,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Measured {
    Comparison(Box<Outcome>),
    Paper(Box<Paper>),
}

/// Compares.
pub fn run(args: &CompareArgs) -> anyhow::Result<()> {
    let settings = settings::resolve(&args.settings)?;
    check_settings(args, &settings)?;
    let files = Files::new(args)?;
    let table_size = args.settings.flags.size.unwrap_or(TABLE_SIZE);
    if args.paper {
        check_memory(&Settings { size: table_size, ..settings.clone() }, 0)?;
    }
    // Frames of pictures, and of sequences openness of every frame and its truth.
    check_memory(&settings, 3 * super::FRAME_BYTES + u64::from(args.frames.unwrap_or(0)) * 8)?;
    if cfg!(debug_assertions) {
        terminal::warn("this is not a release build: times say little");
    }
    let source = scene_source::open(&args.scene.scene, args.scene.gltf_scene.as_deref())?;
    check_animation(&settings, &source)?;
    if args.frames.is_some() && source.scene.rig.is_none() {
        bail!("--frames is not allowed: {} has no animation", source.path);
    }
    let (scene, label) = (SceneReport::of(&source), source.label);
    let options = args.backend.options(Grouping::Auto)?;
    let mut renderer = renderer(source.scene, &options, &args.run)?;
    let command = command();

    let graceful = signals::Graceful::begin();
    let content = Content::of(renderer.scene());
    let progress = Progress::new("comparing", args.run.quiet);
    let share = |share| progress.report(share);
    let tell = |what: &str| progress.say(what.to_owned());
    let work = Work::new(control(&args.run, &share), &tell);
    let truth = truth(args);
    let (mut document, measured) = if args.paper {
        let options = PaperOptions { truth, runs: args.runs, table_size };
        let views = Views::of(renderer.scene(), &settings);
        let (document, paper) =
            paper::run(&mut renderer, &content, &views, &options, work).map_err(explained)?;
        (document, Measured::Paper(Box::new(paper)))
    } else {
        let outcome = experiment::run(&mut renderer, &content, &settings, &comparison(args, truth), work)
            .map_err(explained)?;
        let document = compare_report::document(
            format!("{label}: openness compared"),
            &outcome,
            Vec::new(),
            command.clone(),
        );
        (document, Measured::Comparison(Box::new(outcome)))
    };
    drop(progress);
    add_facts(&mut document, &label, &settings, &renderer);

    let told = CompareReport {
        machine: Machine::detect(),
        command: &command,
        scene: &scene,
        build: BuildReport::of(&renderer.build_stats()),
        backend: BackendReport::of(&renderer),
        settings: &settings,
        measured: &measured,
    };
    let json = report::json(&told)?;
    let csv = match &measured {
        Measured::Comparison(outcome) => output::csv(outcome),
        Measured::Paper(paper) => output::paper_csv(paper),
    };
    files.write(&html::page(&document), &json, &csv, &settings)?;
    drop(graceful);
    if args.json {
        return terminal::print(&json);
    }
    if args.run.quiet {
        return Ok(());
    }
    terminal::print(&format!("{}{}", text::of(&measured), files.line()))
}

/// Refuses settings that the comparison chooses itself.
fn check_settings(args: &CompareArgs, settings: &Settings) -> anyhow::Result<()> {
    if settings.method != Method::Ambray {
        bail!("--method is not allowed here: --methods chooses what is compared");
    }
    let plain = Settings::default();
    if settings.sampling != plain.sampling {
        bail!("--sampling {} is not allowed here: the methods differ by it", settings.sampling);
    }
    if settings.temporal != plain.temporal {
        bail!("--temporal {} is not allowed here: --frames compares with it and without", settings.temporal);
    }
    if args.fps.is_some() && args.frames.is_none() {
        bail!("--fps is not allowed without --frames: it is about sequences");
    }
    if args.paper
        && let Some(name) = paper::chosen(settings).first()
    {
        bail!("--{name} is not allowed with --paper: the figures choose it");
    }
    Ok(())
}

/// The files that are written.
struct Files {
    page: Target,
    json: Target,
    csv: Target,
    settings: Option<Target>,
}

impl Files {
    fn new(args: &CompareArgs) -> anyhow::Result<Self> {
        let page = &args.output;
        let is_page =
            page.extension().is_some_and(|e| e.eq_ignore_ascii_case("html") || e.eq_ignore_ascii_case("htm"));
        if !is_page {
            return Err(with_hint(
                anyhow!("--output {}: the report is a page", page.display()),
                "give it a name that ends in .html; .json and .csv of the same name are written beside it",
            ));
        }
        let beside = |extension: &str| Target::of(&page.with_extension(extension));
        let settings = args.settings.save_settings.as_deref().map(Target::of);
        if args.json && settings == Some(Target::Stdout) {
            bail!("--json is not allowed with --save-settings -: both write to stdout");
        }
        let files = Self { page: Target::of(page), json: beside("json"), csv: beside("csv"), settings };
        if let Some(saved) = &files.settings
            && [&files.page, &files.json, &files.csv].contains(&saved)
        {
            bail!("--save-settings {}: a part of the report goes there", saved.name());
        }
        [&files.page, &files.json, &files.csv]
            .into_iter()
            .chain(&files.settings)
            .try_for_each(Target::check)?;
        Ok(files)
    }

    fn write(&self, page: &str, json: &str, csv: &str, settings: &Settings) -> anyhow::Result<()> {
        let mut batch = Batch::default();
        for (target, text) in [(&self.page, page), (&self.json, json), (&self.csv, csv)] {
            batch.add(target, |out| Ok(out.write_all(text.as_bytes())?))?;
        }
        if let Some(saved) = &self.settings {
            let toml = settings_file::write(settings);
            batch.add(saved, |out| Ok(out.write_all(toml.as_bytes())?))?;
        }
        signals::check()?;
        batch.commit()
    }

    fn line(&self) -> String {
        format!("written  {}, {}, {}\n", self.page.name(), self.json.name(), self.csv.name())
    }
}

/// The command as it was typed, for a POSIX shell.
fn command() -> String {
    let words: Vec<String> =
        std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let words = words.iter().map(String::as_str);
    shlex::try_join(std::iter::once("ambray").chain(words)).unwrap_or_else(|_| "ambray compare".to_owned())
}

fn truth(args: &CompareArgs) -> TruthOptions {
    let cache = match &args.cache {
        _ if args.no_cache => None,
        None => directories::ProjectDirs::from("", "", "ambray").map(|dirs| dirs.cache_dir().join("truths")),
        named => named.clone(),
    };
    TruthOptions { bound: args.truth_error, most: args.truth_spp, cache }
}

fn comparison(args: &CompareArgs, truth: TruthOptions) -> Options {
    let mut methods = if args.methods.is_empty() { Method::ALL.to_vec() } else { args.methods.clone() };
    if args.backend.backend == Backend::Vulkan {
        let all = methods.len();
        methods.retain(|method| !method.is_screen_space());
        if methods.len() < all {
            terminal::warn(
                "methods in screen space run on the processor only: left out with --backend vulkan",
            );
        }
    }
    let fps = args.fps.map_or(FPS, |rate| rate.per_second());
    let sequence = args.frames.map(|frames| SequenceOptions { frames, fps });
    Options { methods, rays: args.rays.clone(), runs: args.runs, truth, sequence }
}

/// Puts before the facts of `document` what it depends on besides what was measured.
fn add_facts(document: &mut Document, label: &str, settings: &Settings, renderer: &Renderer) {
    let machine = Machine::detect();
    let backend = BackendReport::of(renderer).line();
    let falloff = match settings.falloff {
        Falloff::Power => format!("power, exponent {}", settings.exponent),
        other => other.to_string(),
    };
    let facts = [
        ("scene", label.to_owned()),
        ("size", settings.size.to_string()),
        ("rays a pixel", settings.spp.to_string()),
        ("falloff", falloff),
        ("rendered by", backend.trim_start_matches("backend").trim().to_owned()),
        (
            "processor",
            format!(
                "{}, {} cores",
                machine.cpu.unwrap_or_else(|| machine.architecture.to_owned()),
                machine.cores
            ),
        ),
        ("version", format!("ambray {}", machine.version)),
    ];
    let facts = facts.map(|(name, value)| (name.to_owned(), value));
    document.facts.splice(0..0, facts);
}
