//! Distributions of times.

use std::time::Duration;

use serde::Serialize;

use super::milliseconds;

/// Distribution of the time of a frame, milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Half of the frames took no longer.
    pub median: f64,
    /// 95 of 100 frames took no longer.
    pub p95: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
    /// Their mean.
    pub mean: f64,
}

impl Spread {
    /// Of `times`, at least one, in any order.
    #[must_use]
    pub fn of(times: &[Duration]) -> Self {
        let mut times = times.to_vec();
        times.sort_unstable();
        let mean = times.iter().sum::<Duration>().div_f64(times.len() as f64);
        Self {
            median: milliseconds(quantile(&times, 0.5)),
            p95: milliseconds(quantile(&times, 0.95)),
            min: milliseconds(quantile(&times, 0.0)),
            max: milliseconds(quantile(&times, 1.0)),
            mean: milliseconds(mean),
        }
    }
}

/// The smallest value that is not below the share `q` of the ascending `values`, at least one: nearest rank.
#[must_use]
pub fn quantile<T: Copy>(values: &[T], q: f64) -> T {
    let rank = (q * values.len() as f64).ceil() as usize;
    values[rank.saturating_sub(1).min(values.len() - 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_of_nearest_rank() {
        let values: Vec<u32> = (1..=100).collect();
        assert_eq!([0.0, 0.5, 0.95, 1.0].map(|q| quantile(&values, q)), [1, 50, 95, 100]);
        assert_eq!(quantile(&[7], 0.95), 7);
    }

    #[test]
    fn times_need_no_order() {
        let spread = Spread::of(&[30, 10, 20].map(Duration::from_millis));
        assert_eq!((spread.min, spread.median, spread.max, spread.mean), (10.0, 20.0, 30.0, 20.0));
    }
}
