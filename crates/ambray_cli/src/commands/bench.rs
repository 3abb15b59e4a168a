//! `ambray bench`: the time of whole frames, or of their rays alone.

mod rays;

use std::{
    fmt::Write as _,
    path::Path,
    time::{Duration, Instant},
};

use ambray::{Isa, RayCounts, Renderer, RendererOptions, settings::Settings};
use ambray_files::{
    atomic::{Batch, Target},
    settings_file,
};
use anyhow::bail;
use serde::Serialize;

use super::{
    animate, check_animation, check_memory, control,
    cost::CostReport,
    explained, following, renderer,
    thin_cost::{self, ThinCost},
};
use crate::{
    args::{BenchArgs, Packets, SettingsArgs},
    machine::Machine,
    progress::Progress,
    report::{
        self, AccelerationReport, BackendReport, BuildReport, RayReport, SceneReport, Spread, StageReport,
        ViewReport, quantile,
    },
    scene_source::{self, Source},
    settings, signals, terminal,
};

/// Frames that are measured unless `--frames` says otherwise.
const FRAMES: u32 = 100;

/// The result of `ambray bench`.
#[derive(Clone, Debug, Serialize)]
struct BenchReport {
    machine: Machine,
    /// Threads used; 0 on a device.
    threads: usize,
    warmup: u32,
    settings: Settings,
    scenes: Vec<SceneBench>,
}

#[derive(Clone, Debug, Serialize)]
struct SceneBench {
    scene: SceneReport,
    build: BuildReport,
    backend: BackendReport,
    /// The acceleration structures of a device; null on the processor.
    acceleration: Option<AccelerationReport>,
    view: ViewReport,
    frames: usize,
    /// Wall time of a frame that stays on the device.
    frame_ms: Spread,
    /// Medians of the stages.
    stages: StageReport,
    rays: RayReport,
    cost: CostReport,
    /// With `--thin-cost`; the rest is of the frame without thin detection then.
    thin_cost: Option<Vec<ThinCost>>,
}

/// Measures the scenes.
pub fn run(args: &BenchArgs) -> anyhow::Result<()> {
    let settings =
        settings::resolve(&SettingsArgs { flags: thin_cost::flags(args)?, ..args.settings.clone() })?;
    let mut options = following(&args.backend.options(args.grouping.grouping)?, args.updates.updates);
    check_animate(args)?;
    if args.rays.rays.is_none() {
        options.build.isa = only_isa(args)?;
        options.build.packets = args.kernels.packets.map_or_else(Default::default, Packets::packets);
    }
    let target = args.output.as_deref().map(Target::of);
    let saved = args.settings.save_settings.as_deref().map(Target::of);
    if target.is_some() && target == saved {
        bail!(
            "--save-settings {}: the result goes there",
            saved.as_ref().map(Target::name).unwrap_or_default()
        );
    }
    if args.json && [&target, &saved].contains(&&Some(Target::Stdout)) {
        bail!("--json is not allowed with output or settings on stdout: both write there");
    }
    target.iter().chain(&saved).try_for_each(Target::check)?;
    check_memory(&settings, 0)?;
    if cfg!(debug_assertions) {
        terminal::warn("this is not a release build: times say little");
    }
    let json = if args.rays.rays.is_some() {
        rays::run(args, &settings, &options)?
    } else if args.animate.animate {
        animate::run(args, &settings, &options)?
    } else {
        all(args, &settings, &options)?
    };
    let mut batch = Batch::default();
    if let Some(target) = &target {
        batch.add(target, |out| Ok(out.write_all(json.as_bytes())?))?;
    }
    if let Some(saved) = &saved {
        let toml = settings_file::write(&settings);
        batch.add(saved, |out| Ok(out.write_all(toml.as_bytes())?))?;
    }
    batch.commit()?;
    if args.json { terminal::print(&json) } else { Ok(()) }
}

/// Refuses options that do not go together.
fn check_animate(args: &BenchArgs) -> anyhow::Result<()> {
    let others = [
        ("--seconds", args.seconds > 0.0),
        ("--cost", args.cost),
        ("--bandwidth", args.bandwidth.is_some()),
        ("--thin-cost", args.thin_cost),
    ];
    let other = others.into_iter().find_map(|(name, given)| given.then_some(name));
    match (args.animate.animate, args.animate.needs_animate(), other) {
        (true, _, Some(other)) => bail!("{other} is not allowed with --animate: it is about one pose"),
        (false, Some(option), _) => bail!("{option} is not allowed without --animate"),
        _ => Ok(()),
    }
}

/// The instruction set that frames are asked to be rendered with.
fn only_isa(args: &BenchArgs) -> anyhow::Result<Option<Isa>> {
    if let Some(option) = args.rays.needs_rays() {
        bail!("{option} is not allowed without --rays");
    }
    match args.kernels.isa[..] {
        [] => Ok(None),
        [kernels] if kernels.isa().is_available() => Ok(Some(kernels.isa())),
        [kernels] => bail!("--isa {} is not allowed: this machine lacks it", kernels.isa().name()),
        _ => bail!("--isa: more than one instruction set is not allowed without --rays"),
    }
}

/// The scene at `path`, as it is to be measured.
pub(super) fn opened(path: &Path, args: &BenchArgs) -> anyhow::Result<Source> {
    let mut source = scene_source::open(path, args.gltf_scene.as_deref())?;
    if args.kernels.opaque {
        source.scene.remove_transparent();
    }
    Ok(source)
}

/// Measures all scenes; returns the result as JSON.
fn all(args: &BenchArgs, settings: &Settings, options: &RendererOptions) -> anyhow::Result<String> {
    let mut report = BenchReport {
        machine: Machine::detect(),
        threads: 0,
        warmup: args.warmup,
        settings: settings.clone(),
        scenes: Vec::new(),
    };
    for scene in &args.rendered() {
        let (bench, threads) = measure(scene, args, settings, options)?;
        report.threads = threads;
        if !args.json && !args.run.quiet {
            terminal::print(&bench.text(args.cost, settings))?;
        }
        report.scenes.push(bench);
    }
    report::json(&report)
}

/// Measures one scene; also returns the number of threads.
fn measure(
    path: &Path,
    args: &BenchArgs,
    settings: &Settings,
    options: &RendererOptions,
) -> anyhow::Result<(SceneBench, usize)> {
    let source = opened(path, args)?;
    check_animation(settings, &source)?;
    let scene = SceneReport::of(&source);
    let mut renderer = renderer(source.scene, options, &args.run)?;
    let backend = BackendReport::with(&renderer, settings);
    let _graceful = signals::Graceful::begin();
    let variants = if args.thin_cost { thin_cost::variants(settings) } else { vec![settings.clone()] };
    let measured = frames(&mut renderer, args, &variants)?;
    if BackendReport::with(&renderer, settings) != backend {
        bail!("the device failed while it was measured: the times mean nothing");
    }
    let first = &measured[0];
    let stages = first.stages();
    let view = renderer.view(settings).map_err(explained)?;
    let bench = SceneBench {
        scene,
        build: BuildReport::of(&renderer.build_stats()),
        backend,
        acceleration: renderer.acceleration_stats().as_ref().map(AccelerationReport::of),
        view: ViewReport::of(&view),
        frames: first.times.len(),
        frame_ms: Spread::of(&first.times),
        stages,
        rays: RayReport::of(first.rays, first.median()),
        cost: CostReport::of(&renderer, settings, first.rays, &stages, args.bandwidth),
        thin_cost: args.thin_cost.then(|| thin_cost::costs(&measured, settings.size)),
    };
    Ok((bench, first.threads))
}

/// Frames of one choice of settings.
#[derive(Debug, Default)]
pub(super) struct Measured {
    /// In ascending order.
    times: Vec<Duration>,
    stages: Vec<StageReport>,
    /// Of the last frame.
    pub(super) rays: RayCounts,
    threads: usize,
}

/// Measures frames of all `variants` in turn, so that a machine that slows down does so for all of them.
fn frames(renderer: &mut Renderer, args: &BenchArgs, variants: &[Settings]) -> anyhow::Result<Vec<Measured>> {
    let progress = Progress::new("measuring", args.run.quiet);
    let mut measure =
        |settings: &Settings| renderer.measure(settings, control(&args.run, &|_| ())).map_err(explained);
    for _ in 0..args.warmup {
        variants.iter().try_for_each(|settings| measure(settings).map(|_| ()))?;
    }
    let start = Instant::now();
    let mut measured: Vec<Measured> = variants.iter().map(|_| Measured::default()).collect();
    let mut rounds = 0_u32;
    loop {
        for (measured, settings) in measured.iter_mut().zip(variants) {
            let stats = measure(settings)?;
            measured.times.push(stats.times.total);
            measured.stages.push(StageReport::of(&stats.times));
            (measured.rays, measured.threads) = (stats.rays, stats.threads);
        }
        rounds += 1;
        let by_frames = f64::from(rounds) / f64::from(args.frames.unwrap_or(FRAMES));
        let by_time = if args.seconds > 0.0 { start.elapsed().as_secs_f64() / args.seconds } else { 1.0 };
        progress.report(by_frames.min(by_time) as f32);
        if by_frames >= 1.0 && by_time >= 1.0 {
            measured.iter_mut().for_each(|measured| measured.times.sort_unstable());
            return Ok(measured);
        }
    }
}

impl Measured {
    /// Median time of a frame.
    pub(super) fn median(&self) -> Duration {
        quantile(&self.times, 0.5)
    }

    /// Medians of the stages.
    pub(super) fn stages(&self) -> StageReport {
        medians(&self.stages)
    }
}

fn medians(stages: &[StageReport]) -> StageReport {
    let median = |stage: fn(&StageReport) -> f64| {
        let mut times: Vec<f64> = stages.iter().map(stage).collect();
        times.sort_by(f64::total_cmp);
        quantile(&times, 0.5)
    };
    StageReport {
        primary_ms: median(|s| s.primary_ms),
        direct_ms: median(|s| s.direct_ms),
        ambient_ms: median(|s| s.ambient_ms),
        filter_ms: median(|s| s.filter_ms),
        deformation_ms: median(|s| s.deformation_ms),
        bottom_level_ms: median(|s| s.bottom_level_ms),
        top_level_ms: median(|s| s.top_level_ms),
        transfer_ms: median(|s| s.transfer_ms),
        tracing_ms: median(|s| s.tracing_ms),
        idle_ms: median(|s| s.idle_ms),
        total_ms: median(|s| s.total_ms),
    }
}

impl SceneBench {
    fn text(&self, with_cost: bool, settings: &Settings) -> String {
        let mut text = report::scene_line(&self.scene, &self.build);
        text.push_str(&self.backend.line());
        let Spread { median, p95, min, .. } = self.frame_ms;
        let frames = self.frames;
        let _ = writeln!(text, "frames   {frames}: median {median:.2} ms, p95 {p95:.2} ms, min {min:.2} ms");
        let _ = writeln!(text, "stages   median {}", report::times_line(&self.stages));
        let _ = writeln!(text, "rays     {}", report::rays_line(&self.rays));
        if with_cost {
            text.push_str(&self.cost.text());
        }
        if let Some(costs) = &self.thin_cost {
            text.push_str(&thin_cost::table(costs, settings.size));
        }
        text
    }
}
