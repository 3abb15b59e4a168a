//! Grain: what is left of the noise after the filter, without slow drift.

use crate::{Map, errors::root_mean_square};

/// Half the side of the 9 × 9 box that takes the slow part out (spec §10).
const REACH: usize = 4;

/// Grain: root mean square of e - mean₉ₓ₉(e), e = `filtered` - `filtered_truth` (spec §10), in the unit of the map; 0 is
/// best. At the border the box is clipped to the map.
#[must_use]
pub fn grain(filtered: &Map, filtered_truth: &Map) -> f64 {
    let error: Vec<f64> = filtered.minus(filtered_truth).collect();
    let (width, height) = (filtered.width, filtered.height());
    // A box clipped to the map is a product of intervals, so the mean of it is that of rows, then of columns.
    let across = box_mean(width, height, |along, line| error[line * width + along]);
    let mean = box_mean(height, width, |along, line| across[along * width + line]);
    root_mean_square((0..error.len()).map(|i| error[i] - mean[(i % width) * height + i / width]))
}

/// Means along `lines` of `length` values each, line by line.
fn box_mean(length: usize, lines: usize, value: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let mut means = Vec::with_capacity(length * lines);
    for line in 0..lines {
        for along in 0..length {
            let interval = along.saturating_sub(REACH)..(along + REACH + 1).min(length);
            let count = interval.len() as f64;
            means.push(interval.map(|i| value(i, line)).sum::<f64>() / count);
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grain_of(f: impl Fn(usize, usize) -> f32) -> f64 {
        let map = |f: &dyn Fn(usize, usize) -> f32| Map {
            width: 36,
            values: (0..36 * 27).map(|i| f(i % 36, i / 36)).collect(),
        };
        grain(&map(&f), &map(&|_, _| 0.0))
    }

    #[test]
    fn a_constant_error_has_no_grain() {
        assert!(grain_of(|_, _| 0.25) < 1e-15);
    }

    #[test]
    fn a_chequered_error_is_nearly_all_grain() {
        let grain = grain_of(|x, y| if (x + y) % 2 == 0 { 0.5 } else { -0.5 });
        // The mean of a box of n pixels is ±0.5/n of the middle's sign for odd n, 25 to 81, and 0 for even n.
        assert!((0.5 * (1.0 - 1.0 / 25.0)..0.5).contains(&grain), "{grain}");
    }

    #[test]
    fn a_single_wrong_pixel_inside_gives_the_closed_form() {
        // In its box of 81 pixels the mean is 1/81: (1 − 1/81)² + 80/81² = 80/81 of 36 · 27 pixels.
        let grain = grain_of(|x, y| if (x, y) == (17, 12) { 1.0 } else { 0.0 });
        assert!((grain - (80.0_f64 / 81.0 / (36.0 * 27.0)).sqrt()).abs() < 1e-12, "{grain}");
    }
}
