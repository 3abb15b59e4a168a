//! `ambray diff`: how far a picture is from another.

mod error_map;
mod layer;
mod report;

use ambray::settings::Settings;
use ambray_files::{
    atomic::Target,
    planes::{Layer, Planes},
    settings_file,
};
use ambray_metrics::{Better, Measure};
use anyhow::{anyhow, bail};

use self::{
    layer::Compared,
    report::{DiffReport, LayerReport, SettingReport},
};
use crate::{
    args::DiffArgs,
    failure::{OverTolerance, with_hint},
    report::json,
    terminal,
};

/// Width of the window of SSIM, pixels (Wang et al. 2004, §III.B).
const SSIM_WINDOW: usize = 11;

/// Compares two pictures; the error is [`OverTolerance`] if they differ by too much.
pub fn run(args: &DiffArgs) -> anyhow::Result<()> {
    let tolerance = tolerance(args)?;
    let output = args.output.as_deref().map(Target::of);
    check_output(args, output.as_ref())?;

    let [picture, reference] = [Planes::read(&args.picture)?, Planes::read(&args.reference)?];
    check_sizes(args, &picture, &reference)?;
    let shown_with = settings_of(&reference).unwrap_or_default();
    let layers: Vec<Compared> = chosen(args, &picture, &reference)?
        .into_iter()
        .map(|(a, b)| layer::compare(a, b, picture.width, &shown_with))
        .collect::<anyhow::Result<_>>()?;
    let failures = failures(&layers, args.measure, tolerance)?;

    let outputs = error_map::write(output.as_ref(), &layers, (picture.width, picture.height), args)?;
    let report = DiffReport {
        picture: args.picture.display().to_string(),
        reference: args.reference.display().to_string(),
        width: picture.width,
        height: picture.height,
        scenes: (picture.head.scene != reference.head.scene)
            .then(|| [picture.head.scene.clone(), reference.head.scene.clone()]),
        settings: differing_settings(&picture, &reference),
        layers: layers.into_iter().map(|layer| layer.report).collect(),
        measure: args.measure,
        tolerance,
        is_within: failures.is_empty(),
        outputs,
    };
    let told = if args.json {
        terminal::print(&json(&report)?)
    } else if args.quiet {
        Ok(())
    } else {
        terminal::print(&terminal::harmless(&report.text()))
    };
    match failures.split_first() {
        // Also where nobody reads any more: the exit code is still wanted.
        Some((first, rest)) => Err(OverTolerance::new(first, rest.len(), args.quiet).into()),
        None => told,
    }
}

/// The worst value that is allowed.
fn tolerance(args: &DiffArgs) -> anyhow::Result<f64> {
    match (args.tolerance, args.measure.better()) {
        (None, Better::Larger) => Err(with_hint(
            anyhow!("--measure {} needs a --tolerance: larger is better", args.measure),
            "the least value that is good enough",
        )),
        (Some(value), Better::Smaller | Better::NearerZero) if value < 0.0 => {
            bail!("--tolerance {value} is not allowed: {} is 0 at best", args.measure)
        }
        (value, _) => Ok(value.unwrap_or(0.0)),
    }
}

fn check_output(args: &DiffArgs, output: Option<&Target>) -> anyhow::Result<()> {
    let Some(output) = output else {
        if args.signed || args.range.is_some() {
            let option = if args.signed { "--signed" } else { "--range" };
            bail!("{option} is not allowed without --output: it is about the picture of errors");
        }
        return Ok(());
    };
    if let Target::File(path) = output
        && path.extension().is_some_and(|extension| !extension.eq_ignore_ascii_case("png"))
    {
        bail!("output {}: the picture of errors is a PNG", output.name());
    }
    if *output == Target::Stdout && (args.json || !args.quiet) {
        return Err(with_hint(
            anyhow!("-o -: the measures go to stdout"),
            "--quiet leaves it to the picture",
        ));
    }
    output.check_binary()?;
    output.check()
}

fn check_sizes(args: &DiffArgs, picture: &Planes, reference: &Planes) -> anyhow::Result<()> {
    if (picture.width, picture.height) != (reference.width, reference.height) {
        bail!(
            "the sizes differ: {} has {}x{} pixels, {} has {}x{}",
            args.picture.display(),
            picture.width,
            picture.height,
            args.reference.display(),
            reference.width,
            reference.height
        );
    }
    Ok(())
}

/// The layers to compare, in pairs.
fn chosen<'a>(
    args: &DiffArgs,
    picture: &'a Planes,
    reference: &'a Planes,
) -> anyhow::Result<Vec<(&'a Layer, &'a Layer)>> {
    let names = |planes: &'a Planes| planes.layers.iter().map(|layer| layer.name.as_str());
    let list = |planes: &'a Planes| names(planes).collect::<Vec<_>>().join(", ");
    let get = |name: &str| match (picture.layer(name), reference.layer(name)) {
        (Some(a), Some(b)) => Ok((a, b)),
        (a, _) => {
            let (path, planes) =
                if a.is_none() { (&args.picture, picture) } else { (&args.reference, reference) };
            let missing = anyhow!("{} has no layer {name}: it has {}", path.display(), list(planes));
            let mut both = names(picture).filter(|name| reference.layer(name).is_some());
            Err(match both.next() {
                Some(_) => with_hint(missing, "--common compares the layers that both have"),
                None => missing,
            })
        }
    };
    if !args.layer.is_empty() {
        return args.layer.iter().map(|name| get(name)).collect();
    }
    if args.common {
        let both: Vec<_> =
            picture.layers.iter().filter_map(|a| Some((a, reference.layer(&a.name)?))).collect();
        if both.is_empty() {
            bail!("no layer is in both: {} and {}", list(picture), list(reference));
        }
        return Ok(both);
    }
    let alone = names(reference).filter(|name| picture.layer(name).is_none());
    names(picture).chain(alone).map(get).collect()
}

/// What is over the tolerance, a sentence a layer.
fn failures(layers: &[Compared], measure: Measure, tolerance: f64) -> anyhow::Result<Vec<String>> {
    let mut failures = Vec::new();
    for Compared { report, .. } in layers {
        let value = report.measures.get(measure);
        if value.is_none() && !report.has_no_pixels_for(measure) {
            return Err(not_measured(report, measure));
        }
        let side = if measure.better() == Better::Larger { "below" } else { "over" };
        if report.not_finite > 0 {
            let count = crate::report::counted(report.not_finite as u64, "pixel");
            failures.push(format!("{}: {count} infinite or not a number on one side", report.name));
        } else if let Some(value) = value.filter(|&value| !measure.is_within(value, tolerance)) {
            let value = report::number(measure, value);
            failures
                .push(format!("{}: {measure} {value} is {side} the tolerance of {tolerance}", report.name));
        }
    }
    Ok(failures)
}

/// Why `measure` has no value in a layer: its kind, or its size.
fn not_measured(layer: &LayerReport, measure: Measure) -> anyhow::Error {
    let hint = "--layer chooses others, and rmse applies to all";
    if measure == Measure::Ssim && layer.measures.flip.is_some() {
        let side = SSIM_WINDOW;
        let told = anyhow!("--measure ssim needs at least {side}x{side} pixels: its window is that large");
        return with_hint(told, "rmse and flip apply to any size");
    }
    with_hint(anyhow!("--measure {measure} does not apply to layer {}", layer.name), hint)
}

/// The settings that a picture holds, if it holds any that this version reads and allows.
fn settings_of(planes: &Planes) -> Option<Settings> {
    let file = settings_file::parse(planes.head.settings.as_deref()?).ok()?;
    let mut settings = Settings::default();
    file.patch.apply(&mut settings);
    settings.validate().is_empty().then_some(settings)
}

/// Settings in which the pictures differ, `None` unless both hold theirs.
fn differing_settings(picture: &Planes, reference: &Planes) -> Option<Vec<SettingReport>> {
    let (a, b) = (settings_of(picture)?, settings_of(reference)?);
    let differing = Settings::fields().iter().filter_map(|field| {
        let (picture, reference) = (a.get(field.name)?, b.get(field.name)?);
        (picture != reference).then_some(SettingReport { name: field.name, picture, reference })
    });
    Some(differing.collect())
}
