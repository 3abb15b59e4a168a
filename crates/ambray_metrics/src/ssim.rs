//! Structural similarity (Wang et al. 2004, "Image Quality Assessment: From Error Visibility to Structural Similarity").

use rayon::prelude::*;

use crate::Map;

/// Width of the Gaussian, pixels, and how far its 11 × 11 window reaches (Wang et al. 2004, §III-B).
const SIGMA: f64 = 1.5;
const REACH: usize = 5;
/// (K₁ L)² and (K₂ L)² for K₁ = 0.01, K₂ = 0.03 (Wang et al. 2004, eqs. 7 and 9, §III-C) and the range L = 1.
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Mean structural similarity of maps whose values range from 0 to 1; at most 1, which is best. `None` if a side is
/// shorter than the window of 11 pixels.
///
/// The mean is over pixels whose whole window lies in the map, so a border of 5 pixels is left out. This is
/// `structural_similarity(a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1)` of
/// scikit-image.
#[must_use]
pub fn ssim(a: &Map, b: &Map) -> Option<f64> {
    a.check_size(b);
    let (width, height) = (a.width, a.height());
    if width.min(height) <= 2 * REACH {
        return None;
    }
    let kernel = kernel();
    let columns = width - 2 * REACH;
    // Rows are summed apart, so that the sum does not depend on the threads.
    let rows: Vec<f64> = (REACH..height - REACH)
        .into_par_iter()
        .map(|y| {
            let down: Vec<Moments> =
                (0..width).map(|x| window(&kernel, |k| moments(a, b, x, y + k - REACH))).collect();
            (0..columns).map(|x| similarity(window(&kernel, |k| down[x + k]))).sum()
        })
        .collect();
    Some(rows.iter().sum::<f64>() / (columns * rows.len()) as f64)
}

/// The weights of the window along one axis; their sum is 1.
fn kernel() -> [f64; 2 * REACH + 1] {
    let weights: [f64; 2 * REACH + 1] = std::array::from_fn(|k| {
        let x = k as f64 - REACH as f64;
        libm::exp(-0.5 * x * x / (SIGMA * SIGMA))
    });
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

/// Means of a, b, a², b² and a b.
type Moments = [f64; 5];

fn moments(a: &Map, b: &Map, x: usize, y: usize) -> Moments {
    let [a, b] = [a, b].map(|map| f64::from(map.values[y * map.width + x]));
    [a, b, a * a, b * b, a * b]
}

fn window(kernel: &[f64], at: impl Fn(usize) -> Moments) -> Moments {
    let mut sum = Moments::default();
    for (k, weight) in kernel.iter().enumerate() {
        for (sum, value) in sum.iter_mut().zip(at(k)) {
            *sum += weight * value;
        }
    }
    sum
}

/// Wang et al. 2004, eq. 13.
fn similarity([mean_a, mean_b, a2, b2, ab]: Moments) -> f64 {
    let (variance_a, variance_b) = (a2 - mean_a * mean_a, b2 - mean_b * mean_b);
    let covariance = ab - mean_a * mean_b;
    (2.0 * mean_a * mean_b + C1) * (2.0 * covariance + C2)
        / ((mean_a * mean_a + mean_b * mean_b + C1) * (variance_a + variance_b + C2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(value: f32, width: usize, height: usize) -> Map {
        Map { width, values: vec![value; width * height] }
    }

    #[test]
    fn flat_maps_differ_by_their_luminance_alone() {
        // Without variance eq. 13 is (2 a b + C1) / (a² + b² + C1).
        let (a, b) = (flat(0.5, 16, 12), flat(0.25, 16, 12));
        let expected = (2.0 * 0.125 + 1e-4) / (0.25 + 0.0625 + 1e-4);
        assert!((ssim(&a, &b).unwrap() - expected).abs() < 1e-12);
        assert_eq!(ssim(&a, &a), Some(1.0), "exactly, since both sides round alike");
    }

    #[test]
    fn a_map_smaller_than_the_window_has_none() {
        assert_eq!(ssim(&flat(0.5, 10, 40), &flat(0.5, 10, 40)), None);
        assert_eq!(ssim(&flat(0.5, 40, 10), &flat(0.5, 40, 10)), None);
        assert!(ssim(&flat(0.5, 11, 11), &flat(0.5, 11, 11)).is_some());
    }
}
