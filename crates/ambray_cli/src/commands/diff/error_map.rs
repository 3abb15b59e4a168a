//! Pictures of errors.

use std::{
    collections::HashSet,
    path::{Path, PathBuf},
};

use ambray::{
    display::{self, Picture},
    settings::Range,
};
use ambray_files::{
    Bits,
    atomic::{Batch, Target},
    head::SOFTWARE,
    write_png,
};
use anyhow::{Context as _, bail};
use glam::Vec3;

use super::layer::Compared;
use crate::args::DiffArgs;

/// Writes the errors of the first layer to `output` and those of the others beside it; returns the names of the files.
pub(super) fn write(
    output: Option<&Target>,
    layers: &[Compared],
    (width, height): (usize, usize),
    args: &DiffArgs,
) -> anyhow::Result<Vec<String>> {
    let Some(output) = output else { return Ok(Vec::new()) };
    let size = (u32::try_from(width).context("width")?, u32::try_from(height).context("height")?);
    let mut batch = Batch::default();
    let targets = targets(output, layers)?;
    for (target, layer) in targets.iter().zip(layers) {
        let picture = picture(&layer.errors, args);
        batch.add(target, |out| write_png(out, size, &picture, Bits::Eight, &[("Software", SOFTWARE)]))?;
    }
    batch.commit()?;
    Ok(targets.iter().map(Target::name).collect())
}

/// A file for each layer.
fn targets(output: &Target, layers: &[Compared]) -> anyhow::Result<Vec<Target>> {
    let mut targets = vec![output.clone()];
    for layer in layers.iter().skip(1) {
        match output {
            Target::Stdout => {
                bail!("-o -: there are {} layers, and stdout is one: choose with --layer", layers.len())
            }
            Target::File(path) => targets.push(Target::File(layer_path(path, &layer.report.name))),
        }
    }
    let names: HashSet<String> = targets.iter().map(Target::name).collect();
    if names.len() < targets.len() {
        bail!("output {}: layers have names that would give the same file", output.name());
    }
    Ok(targets)
}

/// `dir/error.png` becomes `dir/error.depth.png`. Names of layers come from files: what could lead elsewhere is replaced.
fn layer_path(path: &Path, layer: &str) -> PathBuf {
    let is_harmless = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ');
    let layer: String = layer.chars().map(|c| if is_harmless(c) { c } else { '_' }).collect();
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!(".{layer}.png"));
    path.with_file_name(name)
}

/// The errors in colours; what is not finite is at the end.
fn picture(errors: &[f32], args: &DiffArgs) -> Picture {
    let largest =
        errors.iter().filter(|error| error.is_finite()).fold(0.0_f32, |most, error| most.max(error.abs()));
    let largest = if largest > 0.0 { largest } else { 1.0 };
    let low = if args.signed { -largest } else { 0.0 };
    let Range(ends) = args.range.unwrap_or(Range([low, largest]));
    let color = |&error: &f32| {
        if args.signed {
            diverging(place(error, ends))
        } else {
            display::shade(args.ramp, place(error.abs(), ends))
        }
    };
    Picture::Rgb { pixels: errors.iter().map(color).collect(), is_color: true }
}

/// Where `error` lies from `low` to `high`, in `[0, 1]`.
fn place(error: f32, [low, high]: [f32; 2]) -> f32 {
    let [error, low, high] = [error, low, high].map(f64::from);
    ((error - low) / (high - low)).clamp(0.0, 1.0) as f32
}

/// Blue at 0, white at a half, red at 1.
fn diverging(t: f32) -> Vec3 {
    let far = (2.0 * t - 1.0).abs();
    if t < 0.5 { Vec3::new(1.0 - far, 1.0 - far, 1.0) } else { Vec3::new(1.0, 1.0 - far, 1.0 - far) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_layers_lead_nowhere_else() {
        let path = |layer| layer_path(Path::new("out/error.png"), layer);
        assert_eq!(path("depth"), Path::new("out/error.depth.png"));
        assert_eq!(path("../../etc/x"), Path::new("out/error..._.._etc_x.png"));
        assert_eq!(path("a\\b\0"), Path::new("out/error.a_b_.png"));
    }

    #[test]
    fn errors_lie_between_their_ends() {
        assert_eq!(place(0.5, [0.0, 1.0]), 0.5);
        assert_eq!([place(-1.0, [0.0, 1.0]), place(f32::INFINITY, [0.0, 1.0])], [0.0, 1.0]);
        assert_eq!(place(0.0, [f32::MIN, f32::MAX]), 0.5);
        assert_eq!([diverging(0.0), diverging(0.5), diverging(1.0)], [Vec3::Z, Vec3::ONE, Vec3::X]);
    }
}
