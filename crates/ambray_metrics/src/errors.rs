//! Measures that look at each pixel by itself.

use crate::Map;

/// Root mean square of `a - b`, in the unit of the map; 0 is best.
#[must_use]
pub fn rmse(a: &Map, b: &Map) -> f64 {
    masked_rmse(a, b, |_| true)
}

/// Root mean square of `a - b` over the pixels that `mask` accepts; 0 where it accepts none.
#[must_use]
pub fn masked_rmse(a: &Map, b: &Map, mask: impl Fn(usize) -> bool) -> f64 {
    root_mean_square(a.minus(b).enumerate().filter(|&(i, _)| mask(i)).map(|(_, error)| error))
}

/// Root mean square of `errors`; 0 if there are none.
pub(crate) fn root_mean_square(errors: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = errors.fold((0.0, 0_usize), |(sum, count), e| (sum + e * e, count + 1));
    (sum / count.max(1) as f64).sqrt()
}

/// Peak signal-to-noise ratio for a peak of 1, decibel; larger is better, infinite for equal maps.
#[must_use]
pub fn psnr(a: &Map, b: &Map) -> f64 {
    psnr_of(rmse(a, b))
}

/// Peak signal-to-noise ratio for a peak of 1 of what differs by `rmse`, decibel.
#[must_use]
pub fn psnr_of(rmse: f64) -> f64 {
    -20.0 * libm::log10(rmse)
}

/// Signed mean of `a - b`, in the unit of the map: above 0 where the estimate `a` is too large on the whole. 0 is best.
#[must_use]
pub fn bias(a: &Map, b: &Map) -> f64 {
    a.minus(b).sum::<f64>() / a.values.len().max(1) as f64
}

/// The error `|a - b|` that a `share` of the pixels does not exceed, in the unit of the map; 0 is best. Between two pixels
/// it is interpolated linearly, as NumPy does (Hyndman and Fan 1996, definition 7).
#[must_use]
pub fn percentile(a: &Map, b: &Map, share: f64) -> f64 {
    quantile(a.minus(b).map(f64::abs).collect(), share)
}

/// Quantile of `values` at `share` in `[0, 1]`; 0 if there are none.
pub(crate) fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let position = share.clamp(0.0, 1.0) * last as f64;
    let below = (position as usize).min(last);
    let (_, &mut low, above) = values.select_nth_unstable_by(below, f64::total_cmp);
    let high = above.iter().copied().min_by(f64::total_cmp).unwrap_or(low);
    low + (position - below as f64) * (high - low)
}

/// The largest error `|a - b|`, in the unit of the map; 0 is best.
#[must_use]
pub fn largest(a: &Map, b: &Map) -> f64 {
    a.minus(b).map(f64::abs).fold(0.0, f64::max)
}

/// Pixels at which the maps differ by more than `least`.
#[must_use]
pub fn changed(a: &Map, b: &Map, least: f32) -> Vec<bool> {
    a.check_size(b);
    a.values.iter().zip(&b.values).map(|(a, b)| (a - b).abs() > least).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(values: &[f32]) -> Map {
        Map { width: values.len(), values: values.to_vec() }
    }

    #[test]
    fn errors_of_known_maps() {
        let (a, b) = (map(&[0.5; 64]), map(&[0.75, 0.25].repeat(32)));
        assert_eq!((rmse(&a, &b), bias(&a, &b), largest(&a, &b)), (0.25, 0.0, 0.25));
        assert!((psnr(&a, &b) - 12.041_199_826_559_248).abs() < 1e-12); // −20 log10 ¼ = 40 log10 2
        assert_eq!(psnr(&a, &a), f64::INFINITY);
        assert_eq!(masked_rmse(&a, &b, |_| false), 0.0);
    }

    #[test]
    fn the_bias_has_the_sign_of_the_estimate() {
        assert_eq!(bias(&map(&[1.0, 0.5]), &map(&[0.5, 0.5])), 0.25);
        assert_eq!(bias(&map(&[0.5, 0.5]), &map(&[1.0, 0.5])), -0.25);
    }

    #[test]
    fn quantiles_lie_between_pixels() {
        let errors = map(&[3.0, 0.0, -1.0, 2.0]);
        let zero = map(&[0.0; 4]);
        // Sorted 0, 1, 2, 3: position 0.5 · 3 = 1.5.
        assert_eq!(percentile(&errors, &zero, 0.5), 1.5);
        assert_eq!((percentile(&errors, &zero, 0.0), percentile(&errors, &zero, 1.0)), (0.0, 3.0));
        assert_eq!(quantile(Vec::new(), 0.99), 0.0);
    }

    #[test]
    fn many_small_errors_are_not_lost_in_the_sum() {
        // In single precision the sum of squares would stop growing long before 2²² terms.
        let count = 1 << 22;
        let (a, b) =
            (Map { width: 2048, values: vec![1e-3; count] }, Map { width: 2048, values: vec![0.0; count] });
        assert!((rmse(&a, &b) / f64::from(1e-3_f32) - 1.0).abs() < 1e-9);
    }

    #[test]
    #[should_panic(expected = "one size")]
    fn maps_of_other_sizes_are_refused() {
        let _ = rmse(&map(&[0.0; 4]), &Map { width: 2, values: vec![0.0; 4] });
    }
}
