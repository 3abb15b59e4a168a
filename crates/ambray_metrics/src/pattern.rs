//! How much of the interleaved pattern is left.

use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::Map;

/// The frequencies around a multiple of a quarter with which it is compared: 25 × 25 without the inner 5 × 5 (spec §10).
const REACH: isize = 12;
const HOLE: isize = 2;
const SIDE: usize = 2 * REACH as usize + 1;

/// Pattern left in `estimate` against `reference` (spec §10): the largest power at the 15 frequencies (k/4, l/4) of the
/// interleaved pattern, each over the mean power of the 25 × 25 frequencies around it without the inner 5 × 5.
/// Without unit; white noise gives a few, an unfiltered pattern hundreds; 0 where there is no error at all.
/// Where `edges` holds, the error counts as none.
#[must_use]
pub fn pattern_left(estimate: &Map, reference: &Map, edges: &[bool]) -> f64 {
    let errors = estimate.minus(reference).zip(edges);
    let error: Vec<f64> = errors.map(|(e, &edge)| if edge { 0.0 } else { e }).collect();
    let (width, height) = (estimate.width, estimate.height());
    let largest = |k: usize| {
        let rows = rows(&error, width, k);
        (0..4).filter(|&l| (k, l) != (0, 0)).map(|l| ratio(&powers(&rows, height, l))).fold(0.0, f64::max)
    };
    (0..4).into_par_iter().map(largest).reduce(|| 0.0, f64::max)
}

/// A complex number.
type Complex = (f64, f64);

/// Discrete Fourier transform of every row at the 25 frequencies around k/4, row by row.
fn rows(error: &[f64], width: usize, k: usize) -> Vec<[Complex; SIDE]> {
    let waves: [Vec<Complex>; SIDE] = std::array::from_fn(|f| waves(width, k, f));
    let sum = |row: &[f64], waves: &[Complex]| {
        row.iter().zip(waves).fold((0.0, 0.0), |(re, im), (e, w)| (re + e * w.0, im + e * w.1))
    };
    error.par_chunks(width.max(1)).map(|row| std::array::from_fn(|f| sum(row, &waves[f]))).collect()
}

/// Power at the 25 × 25 frequencies around (k/4, l/4), of the `rows` at those around k/4.
fn powers(rows: &[[Complex; SIDE]], height: usize, l: usize) -> Vec<f64> {
    let power = |i: usize| {
        let waves = waves(height, l, i / SIDE);
        let (re, im) = rows.iter().zip(&waves).fold((0.0, 0.0), |(re, im), (row, w)| {
            let v = row[i % SIDE];
            (re + v.0 * w.0 - v.1 * w.1, im + v.0 * w.1 + v.1 * w.0)
        });
        re * re + im * im
    };
    (0..SIDE * SIDE).into_par_iter().map(power).collect()
}

/// exp(−2πi b x / size) over x at the frequency that is the `f`th of those around `multiple`/4.
fn waves(size: usize, multiple: usize, f: usize) -> Vec<Complex> {
    let bin = (multiple * size / 4) as isize + f as isize - REACH;
    let wave = |position: usize| {
        // The product is reduced as integers, so that the angle keeps its precision.
        let phase = (bin * position as isize).rem_euclid(size as isize) as f64 / size as f64;
        let (sin, cos) = libm::sincos(-TAU * phase);
        (cos, sin)
    };
    (0..size).map(wave).collect()
}

/// The power in the middle over the mean power around it.
fn ratio(powers: &[f64]) -> f64 {
    let offset = |i: usize| {
        let [x, y] = [i % SIDE, i / SIDE].map(|f| (f as isize - REACH).abs());
        x.max(y)
    };
    let around: Vec<f64> = (0..powers.len()).filter(|&i| offset(i) > HOLE).map(|i| powers[i]).collect();
    let middle = powers[powers.len() / 2];
    if middle == 0.0 { 0.0 } else { middle / (around.iter().sum::<f64>() / around.len() as f64) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(f: impl Fn(usize, usize) -> f32) -> Map {
        Map { width: 64, values: (0..64 * 48).map(|i| f(i % 64, i / 64)).collect() }
    }

    #[test]
    fn a_pattern_of_four_pixels_stands_out_and_noise_does_not() {
        let mut random = fastrand::Rng::with_seed(1);
        let noise: Vec<f32> = (0..64 * 48).map(|_| random.f32() * 0.1).collect();
        let noise = |x: usize, y: usize| noise[y * 64 + x];
        let flat = map(|_, _| 0.0);
        let none = vec![false; flat.values.len()];
        let plain = pattern_left(&map(noise), &flat, &none);
        let striped = map(|x, y| noise(x, y) + if x % 4 == 0 { 0.05 } else { 0.0 });
        assert!(plain < 15.0, "{plain}");
        assert!(pattern_left(&striped, &flat, &none) > 100.0);
    }

    #[test]
    fn errors_at_edges_do_not_count() {
        let (striped, flat) = (map(|x, _| if x % 4 == 0 { 0.05 } else { 0.0 }), map(|_, _| 0.0));
        assert_eq!(pattern_left(&striped, &flat, &vec![true; 64 * 48]), 0.0);
        assert_eq!(pattern_left(&flat, &flat, &vec![false; 64 * 48]), 0.0);
    }
}
