//! Measures of error between maps of openness (spec §10). Maps are rows of values in `[0, 1]` from the top.

use std::f64::consts::TAU;

/// A map of one value a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Pixels in a row.
    pub width: usize,
    /// Values, row by row from the top.
    pub values: Vec<f32>,
}

impl Map {
    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.values.len() / self.width
    }

    /// Mean value.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.values.iter().map(|&v| f64::from(v)).sum::<f64>() / self.values.len() as f64
    }
}

/// Root mean square of `a - b`.
#[must_use]
pub fn rmse(a: &Map, b: &Map) -> f64 {
    masked_rmse(a, b, |_| true)
}

/// Root mean square of `a - b` over the pixels that `mask` accepts.
#[must_use]
pub fn masked_rmse(a: &Map, b: &Map, mask: impl Fn(usize) -> bool) -> f64 {
    let errors =
        (0..a.values.len()).filter(|&i| mask(i)).map(|i| f64::from(a.values[i] - b.values[i]).powi(2));
    let (sum, count) = errors.fold((0.0, 0_u32), |(sum, count), error| (sum + error, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// Flicker: root mean square of how much the error changes between two frames that follow each other. `truth` are those
/// that they should be; the truth may move, and a constant error does not flicker.
#[must_use]
pub fn flicker(frames: [&Map; 2], truth: [&Map; 2]) -> f64 {
    let error = |i: usize| {
        let values = frames[i].values.iter().zip(&truth[i].values).map(|(a, b)| a - b).collect();
        Map { width: frames[i].width, values }
    };
    rmse(&error(0), &error(1))
}

/// Pixels at which the maps differ by more than `least`.
#[must_use]
pub fn changed(a: &Map, b: &Map, least: f32) -> Vec<bool> {
    a.values.iter().zip(&b.values).map(|(a, b)| (a - b).abs() > least).collect()
}

/// Peak signal-to-noise ratio for a peak of 1, decibel.
#[must_use]
pub fn psnr(a: &Map, b: &Map) -> f64 {
    -20.0 * rmse(a, b).log10()
}

/// Pixels whose `reference` differs by more than 0.08 from one of their four neighbours.
#[must_use]
pub fn edges(reference: &Map) -> Vec<bool> {
    let (width, height) = (reference.width, reference.height());
    let at = |x: usize, y: usize| reference.values[y * width + x];
    let differs = |a: f32, b: f32| (a - b).abs() > 0.08;
    (0..reference.values.len())
        .map(|i| {
            let (x, y) = (i % width, i / width);
            (x > 0 && differs(at(x, y), at(x - 1, y)))
                || (x + 1 < width && differs(at(x, y), at(x + 1, y)))
                || (y > 0 && differs(at(x, y), at(x, y - 1)))
                || (y + 1 < height && differs(at(x, y), at(x, y + 1)))
        })
        .collect()
}

/// Mean FLIP error (Andersson et al. 2020) at 67 pixels a degree of the maps shown as grey, by NVIDIA's implementation.
#[must_use]
pub fn flip(reference: &Map, test: &Map) -> f64 {
    let image = |map: &Map| {
        let grey = map.values.iter().flat_map(|v| [(v.clamp(0.0, 1.0) * 255.0).round() as u8; 3]);
        nv_flip::FlipImageRgb8::with_data(map.width as u32, map.height() as u32, &grey.collect::<Vec<u8>>())
    };
    let error = nv_flip::flip(image(reference), image(test), 67.0);
    f64::from(nv_flip::FlipPool::from_image(&error).mean())
}

/// Pattern left in `estimate` against `reference` (spec §10): the largest power at the 15 frequencies (k/4, l/4) of the
/// interleaved pattern, each over the mean power of the 25 × 25 frequencies around it without the inner 5 × 5.
/// Edges of the reference count as no error.
#[must_use]
pub fn pattern_left(estimate: &Map, reference: &Map, edges: &[bool]) -> f64 {
    const REACH: isize = 12;
    const HOLE: isize = 2;
    let (width, height) = (estimate.width, estimate.height());
    let error: Vec<f64> = (0..estimate.values.len())
        .map(|i| if edges[i] { 0.0 } else { f64::from(estimate.values[i] - reference.values[i]) })
        .collect();
    let span: Vec<isize> = (-REACH..=REACH).collect();
    // Discrete Fourier transform of every row at the columns' frequencies around k/4, then down the columns.
    let transform = |k: usize, l: usize| -> Vec<f64> {
        let wave = |size: usize, multiple: usize, offset: isize, position: usize| {
            let bin = (multiple * size / 4) as isize + offset;
            let (sin, cos) = libm::sincos(-TAU * (bin as f64) * position as f64 / size as f64);
            (cos, sin)
        };
        let rows: Vec<Vec<(f64, f64)>> = span
            .iter()
            .map(|&fx| {
                let waves: Vec<_> = (0..width).map(|x| wave(width, k, fx, x)).collect();
                let row = |y: usize| {
                    let values = &error[y * width..][..width];
                    values
                        .iter()
                        .zip(&waves)
                        .fold((0.0, 0.0), |(re, im), (e, w)| (re + e * w.0, im + e * w.1))
                };
                (0..height).map(row).collect()
            })
            .collect();
        let column = |fy: isize, row: &[(f64, f64)]| {
            let sum = row.iter().enumerate().fold((0.0, 0.0), |(re, im), (y, v)| {
                let w = wave(height, l, fy, y);
                (re + v.0 * w.0 - v.1 * w.1, im + v.0 * w.1 + v.1 * w.0)
            });
            sum.0 * sum.0 + sum.1 * sum.1
        };
        span.iter().flat_map(|&fy| rows.iter().map(move |row| column(fy, row))).collect()
    };
    let frequencies = (0..16).map(|i| (i % 4, i / 4)).filter(|&f| f != (0, 0));
    let ratios = frequencies.map(|(k, l)| {
        let power = transform(k, l);
        let side = span.len();
        let offset = |i: usize| span[i % side].abs().max(span[i / side].abs());
        let around: Vec<f64> = (0..power.len()).filter(|&i| offset(i) > HOLE).map(|i| power[i]).collect();
        power[side * side / 2] / (around.iter().sum::<f64>() / around.len() as f64)
    });
    ratios.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(f: impl Fn(usize, usize) -> f32) -> Map {
        Map { width: 64, values: (0..64 * 48).map(|i| f(i % 64, i / 64)).collect() }
    }

    #[test]
    fn errors_of_known_maps() {
        let (a, b) = (map(|_, _| 0.5), map(|x, _| if x % 2 == 0 { 0.6 } else { 0.4 }));
        assert!((rmse(&a, &b) - 0.1).abs() < 1e-6);
        assert!((psnr(&a, &b) - 20.0).abs() < 1e-4);
        assert_eq!(flip(&a, &a), 0.0);
        assert!(flip(&a, &map(|_, _| 0.9)) > 0.1);
    }

    #[test]
    fn edges_are_steps() {
        let step = edges(&map(|x, _| if x < 10 { 0.0 } else { 0.1 }));
        assert!((0..64).all(|x| step[x] == (x == 9 || x == 10)));
    }

    #[test]
    fn a_pattern_of_four_pixels_stands_out_and_noise_does_not() {
        let noise = |x: usize, y: usize| {
            ambray_core::sampling::unit_float(ambray_core::sampling::pcg((y * 64 + x) as u32)) * 0.1
        };
        let flat = map(|_, _| 0.0);
        let none = vec![false; flat.values.len()];
        let plain = pattern_left(&map(noise), &flat, &none);
        let striped = map(|x, y| noise(x, y) + if x % 4 == 0 { 0.05 } else { 0.0 });
        assert!(plain < 15.0, "{plain}");
        assert!(pattern_left(&striped, &flat, &none) > 100.0);
    }
}
