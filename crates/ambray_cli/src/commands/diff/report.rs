//! What `ambray diff` says, as text and as JSON.

use std::fmt::Write as _;

use ambray_metrics::{Measure, Measures};
use serde::Serialize;

use crate::report::{counted, grouped};

/// The differences of two pictures.
#[derive(Debug, Serialize)]
pub(super) struct DiffReport {
    pub(super) picture: String,
    pub(super) reference: String,
    pub(super) width: usize,
    pub(super) height: usize,
    /// The scenes that they show, where these differ.
    pub(super) scenes: Option<[Option<String>; 2]>,
    /// Settings that differ; null unless both pictures hold theirs.
    pub(super) settings: Option<Vec<SettingReport>>,
    pub(super) layers: Vec<LayerReport>,
    pub(super) measure: Measure,
    pub(super) tolerance: f64,
    pub(super) is_within: bool,
    /// Pictures of errors.
    pub(super) outputs: Vec<String>,
}

/// A setting that differs.
#[derive(Debug, Serialize)]
pub(super) struct SettingReport {
    pub(super) name: &'static str,
    pub(super) picture: String,
    pub(super) reference: String,
}

/// The differences of a layer.
#[derive(Debug, Serialize)]
pub(super) struct LayerReport {
    pub(super) name: String,
    pub(super) channels: Vec<String>,
    pub(super) pixels: usize,
    /// Pixels that differ by whatever little.
    pub(super) differing: usize,
    /// Those of them where one side alone is infinite or not a number; they are not in the measures.
    pub(super) not_finite: usize,
    /// Column and row from the top left of the largest error.
    pub(super) largest_at: Option<[usize; 2]>,
    pub(super) measures: Measures,
}

impl LayerReport {
    /// Whether `measure` would apply, but looks at a part of the pixels of which there are none: without edges in the
    /// reference, nothing is wrong at edges.
    pub(super) fn has_no_pixels_for(&self, measure: Measure) -> bool {
        // The parts are measured wherever there is a peak, and so a PSNR.
        matches!(measure, Measure::EdgeRmse | Measure::FlatRmse)
            && self.measures.psnr.is_some()
            && self.measures.get(measure).is_none()
    }
}

impl DiffReport {
    /// A table for people.
    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "{} against {}: {} x {} pixels, {}\n\n",
            self.picture,
            self.reference,
            self.width,
            self.height,
            counted(self.layers.len() as u64, "layer")
        );
        text.push_str(&table(&self.rows()));
        for layer in self.layers.iter().filter(|layer| layer.not_finite > 0) {
            let count = counted(layer.not_finite as u64, "pixel");
            let _ = writeln!(
                text,
                "\n{}: {count} infinite or not a number on one side alone, left out of the numbers",
                layer.name
            );
        }
        if let Some([picture, reference]) = &self.scenes {
            let name = |scene: &Option<String>| scene.clone().unwrap_or_else(|| "not told".to_owned());
            let _ = writeln!(text, "\nscenes differ: {}, {}", name(picture), name(reference));
        }
        if let Some(settings) = self.settings.as_ref().filter(|settings| !settings.is_empty()) {
            let _ = writeln!(text, "\nsettings differ:");
            for setting in settings {
                let _ =
                    writeln!(text, "  {} {} against {}", setting.name, setting.picture, setting.reference);
            }
        }
        text
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let applies = |m: &Measure| self.layers.iter().any(|layer| layer.measures.get(*m).is_some());
        let measures: Vec<Measure> = Measure::ALL.iter().copied().filter(applies).collect();
        let title = |measure: &Measure| match measure.unit() {
            "" => measure.title().to_owned(),
            unit => format!("{} ({unit})", measure.title()),
        };
        let ends = |before: &[&str], middle: Vec<String>, after: &str| {
            let mut row: Vec<String> = before.iter().map(|&cell| cell.to_owned()).collect();
            row.extend(middle);
            row.push(after.to_owned());
            row
        };
        let mut rows = vec![ends(&["layer", "differ"], measures.iter().map(title).collect(), "max at")];
        for layer in &self.layers {
            let cell = |&measure: &Measure| {
                layer.measures.get(measure).map_or_else(|| "-".to_owned(), |value| number(measure, value))
            };
            let at = layer.largest_at.map_or_else(|| "-".to_owned(), |[x, y]| format!("{x},{y}"));
            let share = share(layer.differing, layer.pixels);
            rows.push(ends(&[&layer.name, &share], measures.iter().map(cell).collect(), &at));
        }
        rows
    }
}

/// A share in percent that is 0 and 100 only where it is exactly so, a few pixels as their number.
fn share(count: usize, all: usize) -> String {
    let percent = 100.0 * count as f64 / all as f64;
    if count == 0 {
        "0".to_owned()
    } else if percent < 0.01 {
        format!("{} px", grouped(count as u64))
    } else if count < all && percent > 99.99 {
        "99.99 %".to_owned()
    } else {
        format!("{percent:.2} %")
    }
}

/// A value with the decimals that tell something; one that would vanish in them has its exponent instead.
pub(super) fn number(measure: Measure, value: f64) -> String {
    let decimals = measure.decimals();
    if value == 0.0 {
        "0".to_owned()
    } else if value.abs() < 10.0 * 10.0_f64.powi(-(decimals as i32)) {
        format!("{value:.1e}")
    } else {
        format!("{value:.decimals$}")
    }
}

/// Columns one under another: the first to the left, numbers to the right.
fn table(rows: &[Vec<String>]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for row in rows {
        for (column, cell) in row.iter().enumerate() {
            let width = width(column);
            let _ =
                if column == 0 { write!(text, "{cell:<width$}") } else { write!(text, "  {cell:>width$}") };
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_do_not_vanish() {
        assert_eq!(number(Measure::Rmse, 0.0), "0");
        assert_eq!(number(Measure::Rmse, 0.012_345_6), "0.01235");
        assert_eq!(number(Measure::Bias, -0.000_012_3), "-1.2e-5");
        assert_eq!(number(Measure::Psnr, f64::INFINITY), "inf");
        assert_eq!(number(Measure::Max, 1234.5), "1234.5000");
    }

    #[test]
    fn shares_are_0_and_100_only_where_they_are_exactly_so() {
        assert_eq!(share(0, 1_000_000), "0");
        assert_eq!(share(3, 1_000_000), "3 px");
        assert_eq!(share(999_999, 1_000_000), "99.99 %");
        assert_eq!(share(1_000_000, 1_000_000), "100.00 %");
        assert_eq!(share(123, 1000), "12.30 %");
    }
}
