//! `ambray bench --rays`: the tracer alone, on the rays of a frame that were written to files.

mod clock;
mod dump;
mod folder;
mod measure;
mod report;

use ambray::{Isa, RendererOptions, settings::Settings};
use anyhow::{bail, ensure};

use self::{
    folder::RaysFolder,
    measure::Contender,
    report::{BatchReport, RaysReport, SourceReport},
};
use crate::{
    args::{BenchArgs, Kernels},
    machine::Machine,
    progress::Progress,
    report::json,
    signals, terminal,
};

/// Writes the rays of the scene, if one is named, and measures those of the folder; returns the result as JSON.
pub(super) fn run(
    args: &BenchArgs,
    settings: &Settings,
    options: &RendererOptions,
) -> anyhow::Result<String> {
    check(args)?;
    let folder = RaysFolder::new(args.rays.rays.as_deref().unwrap_or_else(|| unreachable!("asked for")));
    let source = match &args.scenes[..] {
        [] => None,
        [scene] => Some(dump::write(scene, &folder, args, settings, options)?),
        [_, second, ..] => bail!("--rays: the scene {} is one too many", second.display()),
    };
    let mut report = RaysReport::new(Machine::detect(), &folder, threads(args), args.rays.rounds(), source);
    if let (Some(source), true) = (&report.source, says(args)) {
        terminal::print(&source.text(settings))?;
    }
    if args.rays.rounds() > 0 || args.rays.builds() > 0 {
        measure(args, &folder, &mut report)?;
    }
    json(&report)
}

fn measure(args: &BenchArgs, folder: &RaysFolder, report: &mut RaysReport) -> anyhow::Result<()> {
    let _graceful = signals::Graceful::begin();
    // Before any work: names may be wrong.
    let names = if args.rays.rounds() > 0 { folder.batches(&args.rays.batches)? } else { Vec::new() };
    if let Some(folder) = &args.rays.write_hits {
        RaysFolder::new(folder).prepare()?;
    }
    if let Some(folder) = &args.rays.check_hits {
        names.iter().try_for_each(|name| RaysFolder::new(folder).hits(name).map(drop))?;
    }
    let triangles = folder.triangles()?;
    let triangles = match args.rays.triangles {
        // Else they were written so.
        Some(count) if args.scenes.is_empty() => triangles.resized(usize::try_from(count)?),
        _ => triangles,
    };
    let scene = triangles.into_scene();
    report.triangles = scene.triangle_count();
    let (isas, builds) = (isas(args), args.rays.builds());
    if builds > 0 {
        let progress = Progress::new("building", args.run.quiet);
        report.builds = measure::builds(&scene, report.threads, builds, &progress)?;
    }
    if says(args) {
        terminal::print(&report.head())?;
    }
    if names.is_empty() {
        return Ok(());
    }
    let contenders = measure::contenders(&scene, &isas, args.rays.qualities(), report.threads)?;
    drop(scene);
    for name in &names {
        let batch = measure_batch(args, folder, name, &contenders, report.threads)?;
        if says(args) {
            terminal::print(&batch.text())?;
        }
        report.batches.push(batch);
    }
    Ok(())
}

fn measure_batch(
    args: &BenchArgs,
    folder: &RaysFolder,
    name: &str,
    contenders: &[Contender],
    threads: usize,
) -> anyhow::Result<BatchReport> {
    let batch = folder.batch(name)?;
    let progress = Progress::new("measuring", args.run.quiet);
    let (rates, hits) = measure::batch(&batch, contenders, threads, args.rays.rounds(), &progress)?;
    if let Some(folder) = &args.rays.write_hits {
        RaysFolder::new(folder).write_hits(name, &hits)?;
    }
    let agreement = match &args.rays.check_hits {
        Some(folder) => Some(hits.agreement(&RaysFolder::new(folder).hits(name)?, batch.kind)?),
        None => None,
    };
    Ok(BatchReport::new(name, &batch, &hits, rates, agreement))
}

/// Refuses what does not go together.
fn check(args: &BenchArgs) -> anyhow::Result<()> {
    let others = [
        ("--frames", args.frames.is_some()),
        ("--seconds", args.seconds > 0.0),
        ("--cost", args.cost),
        ("--bandwidth", args.bandwidth.is_some()),
        ("--thin-cost", args.thin_cost),
        ("--packets", args.kernels.packets.is_some()),
        ("--animate", args.animate.animate),
    ];
    if let Some((name, _)) = others.into_iter().find(|(_, given)| *given) {
        bail!("{name} is not allowed with --rays: it is about whole frames");
    }
    let of_scenes = [
        ("--opaque", args.kernels.opaque),
        ("--gltf-scene", args.gltf_scene.is_some()),
        ("--preset", args.settings.preset.is_some()),
        ("--settings", args.settings.settings.is_some()),
        ("--save-settings", args.settings.save_settings.is_some()),
    ];
    if args.scenes.is_empty() {
        if let Some((name, _)) = of_scenes.into_iter().find(|(_, given)| *given) {
            bail!("{name} is not allowed with --rays without a scene: the rays are those in the folder");
        }
        ensure!(
            args.settings.flags == ambray::settings::SettingsPatch::default(),
            "settings are not allowed with --rays without a scene: the rays are those in the folder"
        );
    }
    let of_rounds = [
        ("--check-hits", args.rays.check_hits.is_some()),
        ("--write-hits", args.rays.write_hits.is_some()),
        ("--batches", !args.rays.batches.is_empty()),
    ];
    if args.rays.rounds() == 0
        && let Some((name, _)) = of_rounds.into_iter().find(|(_, given)| *given)
    {
        bail!("{name} is not allowed with --rounds 0: no rays are traced");
    }
    match isas(args).into_iter().find(|isa| !isa.is_available()) {
        Some(isa) => bail!("--isa {} is not allowed: this machine lacks it", isa.name()),
        None => Ok(()),
    }
}

/// Instruction sets to measure, the best first.
fn isas(args: &BenchArgs) -> Vec<Isa> {
    if args.kernels.isa.is_empty() {
        return Isa::ALL.into_iter().rev().filter(|isa| isa.is_available()).collect();
    }
    args.kernels.isa.iter().copied().map(Kernels::isa).collect()
}

/// Threads to measure with.
fn threads(args: &BenchArgs) -> usize {
    match usize::from(args.run.threads) {
        0 => Machine::detect().cores,
        threads => threads,
    }
}

/// Whether there is text for people.
const fn says(args: &BenchArgs) -> bool {
    !args.json && !args.run.quiet
}
