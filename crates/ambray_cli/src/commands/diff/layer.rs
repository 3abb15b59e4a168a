//! A layer of one picture against that of another.

use ambray::{Aov, AovKind, display, settings::Settings};
use ambray_files::planes::{Layer, Meaning};
use ambray_metrics::{Map, Measures};
use anyhow::bail;
use glam::Vec3;

use super::report::LayerReport;

/// What came out for a layer.
#[derive(Debug)]
pub(super) struct Compared {
    pub(super) report: LayerReport,
    /// The error of every pixel, with its sign: that of the channel with the largest one. Infinite where one side alone is
    /// not finite.
    pub(super) errors: Vec<f32>,
}

/// Compares a `layer` with its `reference`; colours are seen as `shown_with` shows them.
pub(super) fn compare(
    layer: &Layer,
    reference: &Layer,
    width: usize,
    shown_with: &Settings,
) -> anyhow::Result<Compared> {
    if layer.channels != reference.channels {
        let [a, b] = [layer, reference].map(|layer| layer.channels.join(", "));
        bail!("layer {}: the channels differ: {a} and {b}", layer.name);
    }
    let errors = errors(layer, reference);
    let finite = |(i, error): (usize, &f32)| error.is_finite().then_some((i, error.abs()));
    let largest = errors.iter().enumerate().filter_map(finite).max_by(|a, b| a.1.total_cmp(&b.1));
    let report = LayerReport {
        name: layer.name.clone(),
        channels: layer.channels.clone(),
        pixels: errors.len(),
        differing: errors.iter().filter(|&&error| error != 0.0).count(),
        not_finite: errors.iter().filter(|error| !error.is_finite()).count(),
        largest_at: largest.filter(|&(_, error)| error > 0.0).map(|(i, _)| [i % width, i / width]),
        measures: measures(layer, reference, &errors, width, shown_with),
    };
    Ok(Compared { report, errors })
}

/// Equal infinities are equal, and so are two that are not a number.
fn is_same(a: f32, b: f32) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

/// The error of each pixel, see [`Compared::errors`].
fn errors(layer: &Layer, reference: &Layer) -> Vec<f32> {
    let mut errors = vec![0.0_f32; layer.values.first().map_or(0, Vec::len)];
    for (a, b) in layer.values.iter().zip(&reference.values) {
        for ((error, &a), &b) in errors.iter_mut().zip(a).zip(b) {
            if is_same(a, b) {
                continue;
            }
            let own = if a.is_finite() && b.is_finite() {
                // In double precision, so that the smallest difference is one and the largest is finite.
                (f64::from(a) - f64::from(b)).clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
            } else {
                f32::INFINITY
            };
            if own.abs() > error.abs() {
                *error = own;
            }
        }
    }
    errors
}

fn measures(
    layer: &Layer,
    reference: &Layer,
    errors: &[f32],
    width: usize,
    shown_with: &Settings,
) -> Measures {
    // What is not finite on both sides is no error; what is so on one side is counted apart. Both count as 0 here.
    let maps = |layer: &Layer| -> Vec<Map> {
        let value = |(&value, error): (&f32, &f32)| {
            if value.is_finite() && error.is_finite() { value } else { 0.0 }
        };
        let map = |values: &Vec<f32>| Map { width, values: values.iter().zip(errors).map(value).collect() };
        layer.values.iter().map(map).collect()
    };
    let [estimate, reference] = [maps(layer), maps(reference)];
    let levels = || Measures::of_levels(&estimate, &reference);
    match layer.meaning {
        Meaning::Shown => levels().seen_as(&estimate, &reference),
        meaning => match meaning.kind() {
            Some(AovKind::Unit) => levels().seen_as(&estimate, &reference),
            Some(AovKind::Color) => {
                let [a, b] = [&estimate, &reference].map(|maps| shown(maps, meaning, shown_with));
                levels().seen_as(&a, &b)
            }
            _ => Measures::of_values(&estimate, &reference),
        },
    }
}

/// Display values of linear red, green and blue, as PNG files show them.
fn shown(linear: &[Map], meaning: Meaning, settings: &Settings) -> Vec<Map> {
    let mut shown = linear.to_vec();
    for i in 0..linear[0].values.len() {
        let color = Vec3::from_array(std::array::from_fn(|channel| linear[channel].values[i]));
        let display = if meaning == Meaning::Plane(Aov::Albedo) {
            display::encode(color)
        } else {
            display::display(color, settings.exposure, settings.tone_map)
        };
        for (map, value) in shown.iter_mut().zip(display.to_array()) {
            map.values[i] = value;
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(meaning: Meaning, values: &[&[f32]]) -> Layer {
        Layer {
            name: "layer".to_owned(),
            channels: (0..values.len()).map(|i| i.to_string()).collect(),
            meaning,
            values: values.iter().map(|values| values.to_vec()).collect(),
        }
    }

    fn compared(a: &[&[f32]], b: &[&[f32]]) -> Compared {
        let [a, b] = [a, b].map(|values| layer(Meaning::Plane(Aov::Depth), values));
        compare(&a, &b, 2, &Settings::default()).unwrap()
    }

    #[test]
    fn equal_infinities_are_equal_and_others_are_counted() {
        let (inf, nan) = (f32::INFINITY, f32::NAN);
        let same = compared(&[&[inf, nan, -inf, 1.0]], &[&[inf, nan, -inf, 1.0]]);
        assert_eq!((same.report.differing, same.report.not_finite, same.report.measures.rmse), (0, 0, 0.0));
        let other = compared(&[&[inf, 2.0, inf, 1.0]], &[&[-inf, inf, nan, 3.0]]);
        assert_eq!((other.report.differing, other.report.not_finite), (4, 3));
        // The three are left out of the numbers: (1 − 3)² over 4 pixels.
        assert_eq!((other.report.measures.rmse, other.report.measures.max), (1.0, 2.0));
        assert_eq!(other.report.largest_at, Some([1, 1]));
    }

    #[test]
    fn the_largest_error_of_the_channels_is_that_of_the_pixel() {
        let a: [&[f32]; 2] = [&[1.0, 0.0, 0.0, 0.0], &[0.0, 2.0, 0.0, 0.0]];
        let b: [&[f32]; 2] = [&[0.0, 1.0, 0.0, 0.0], &[3.0, 0.0, 0.0, 0.0]];
        let compared = compared(&a, &b);
        assert_eq!(compared.errors, [-3.0, 2.0, 0.0, 0.0]);
        assert_eq!((compared.report.differing, compared.report.largest_at), (2, Some([0, 0])));
    }

    #[test]
    fn a_difference_of_one_bit_is_a_difference() {
        let next = f32::from_bits(1.0_f32.to_bits() + 1);
        let compared = compared(&[&[1.0, next]], &[&[1.0, 1.0]]);
        assert_eq!(compared.report.differing, 1);
        assert!(compared.report.measures.rmse > 0.0);
        let wide = super::compare(
            &layer(Meaning::Unknown, &[&[f32::MAX]]),
            &layer(Meaning::Unknown, &[&[f32::MIN]]),
            1,
            &Settings::default(),
        );
        assert_eq!(wide.unwrap().report.not_finite, 0);
    }

    #[test]
    fn measures_that_mean_nothing_are_left_out() {
        let depth = compared(&[&[1.0, 2.0]], &[&[1.0, 3.0]]).report.measures;
        assert_eq!((depth.psnr, depth.flip, depth.flat_rmse), (None, None, None));
        let values: &[&[f32]] = &[&[0.5, 0.25]];
        let unit = layer(Meaning::Plane(Aov::Openness), values);
        let measures = compare(&unit, &unit, 2, &Settings::default()).unwrap().report.measures;
        assert_eq!((measures.psnr, measures.flip), (Some(f64::INFINITY), Some(0.0)));
    }

    #[test]
    fn colours_are_seen_as_they_are_shown() {
        // Linear 0.214041 is 0.5 in sRGB; with an exposure of −64 all is black.
        let [a, b] =
            [[0.214_041_1_f32; 3], [0.0; 3]].map(|rgb| rgb.map(|v| Map { width: 1, values: vec![v] }));
        let albedo = shown(&a, Meaning::Plane(Aov::Albedo), &Settings::default());
        assert!((albedo[1].values[0] - 0.5).abs() < 1e-6);
        let dark = Settings { exposure: -64.0, ..Settings::default() };
        assert!(shown(&a, Meaning::Color, &dark)[0].values[0] < 1e-6);
        assert_eq!(shown(&b, Meaning::Color, &dark)[2].values, [0.0]);
    }
}
