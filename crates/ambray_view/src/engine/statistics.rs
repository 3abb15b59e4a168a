//! The values of a plane in numbers.

use rayon::prelude::*;

use super::contract::Statistics;

/// Steps of the histogram.
const BINS: usize = 256;
/// Pixels that a task takes. Sums are made of such parts in their order, so they do not depend on the number of threads.
const PART: usize = 1 << 14;

/// The numbers of one channel of one part.
#[derive(Clone, Copy)]
struct Extent {
    low: f32,
    high: f32,
    sum: f64,
    count: u64,
}

impl Extent {
    const NONE: Self = Self { low: f32::INFINITY, high: f32::NEG_INFINITY, sum: 0.0, count: 0 };

    fn of(values: impl Iterator<Item = f32>) -> Self {
        values.filter(|value| value.is_finite()).fold(Self::NONE, |extent, value| {
            extent.and(&Self { low: value, high: value, sum: f64::from(value), count: 1 })
        })
    }

    const fn and(self, other: &Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            sum: self.sum + other.sum,
            count: self.count + other.count,
        }
    }
}

impl Statistics {
    /// Of `values` with so many `channels` a pixel; what is not finite does not count.
    #[must_use]
    pub fn of(values: &[f32], channels: usize) -> Self {
        let parts = values.par_chunks(PART * channels);
        let channel = |part: &[f32], c: usize| Extent::of(part.iter().skip(c).step_by(channels).copied());
        let extents: Vec<Vec<Extent>> =
            parts.map(|part| (0..channels).map(|c| channel(part, c)).collect()).collect();
        let of_channel = |c: usize| extents.iter().fold(Extent::NONE, |sum, part| sum.and(&part[c]));
        let each: Vec<Extent> = (0..channels).map(of_channel).collect();
        let all = each.iter().fold(Extent::NONE, Extent::and);
        let (low, high) = if all.count > 0 { (all.low, all.high) } else { (0.0, 0.0) };
        Self {
            histogram: histogram(values, channels, (low, high)),
            low,
            high,
            mean: each
                .iter()
                .map(|e| if e.count > 0 { (e.sum / e.count as f64) as f32 } else { 0.0 })
                .collect(),
        }
    }
}

/// Values in each of equal steps from `low` to `high`, for each channel.
fn histogram(values: &[f32], channels: usize, (low, high): (f32, f32)) -> Vec<Vec<u32>> {
    let (low, width) = (f64::from(low), f64::from(high) - f64::from(low));
    let bin = |value: f32| {
        let place = if width > 0.0 { (f64::from(value) - low) / width } else { 0.0 };
        ((place * BINS as f64) as usize).min(BINS - 1)
    };
    let none = || vec![vec![0; BINS]; channels];
    let counted = values.par_chunks(PART * channels).fold(none, |mut bins, part| {
        for (i, &value) in part.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            bins[i % channels][bin(value)] += 1;
        }
        bins
    });
    counted.reduce(none, |mut a, b| {
        a.iter_mut().flatten().zip(b.iter().flatten()).for_each(|(a, b)| *a += b);
        a
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_channel_is_counted_by_itself() {
        let statistics = Statistics::of(&[0.0, 1.0, 0.5, 1.0, 1.0, f32::NAN], 2);
        assert_eq!((statistics.low, statistics.high), (0.0, 1.0));
        assert_eq!(statistics.mean, [0.5, 1.0]);
        let [first, second] = &statistics.histogram[..] else { panic!("two channels") };
        assert_eq!((first[0], first[128], first[255], first.iter().sum::<u32>()), (1, 1, 1, 3));
        assert_eq!((second[255], second.iter().sum::<u32>()), (2, 2));
    }

    #[test]
    fn planes_without_a_finite_value_have_empty_histograms() {
        for values in [&[][..], &[f32::INFINITY, f32::NAN]] {
            let statistics = Statistics::of(values, 1);
            assert_eq!((statistics.low, statistics.high, &statistics.mean[..]), (0.0, 0.0, &[0.0][..]));
            assert_eq!(statistics.histogram[0].iter().sum::<u32>(), 0);
        }
    }

    #[test]
    fn one_value_is_in_one_bin() {
        let statistics = Statistics::of(&vec![7.0; 100_000], 1);
        assert_eq!((statistics.low, statistics.high, statistics.histogram[0][0]), (7.0, 7.0, 100_000));
    }
}
