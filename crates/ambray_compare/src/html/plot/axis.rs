//! An axis of a plot: its range, its ticks, and where a value lies on it.

use crate::{document::Axis, html::number::short};

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Its value.
    pub(super) value: f64,
    /// What it says; nothing for those between.
    pub(super) label: Option<String>,
}

/// From values to fractions of the length of an axis.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    logarithmic: bool,
    /// Ends, as logarithms where it is logarithmic.
    from: f64,
    to: f64,
}

/// Labelled ticks aimed at on a linear axis.
const TICKS: f64 = 6.0;

impl Scale {
    /// One with room for all of `values` that [`shows`] accepts; nothing if there are none.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Option<Self> {
        let position = |value: f64| if axis.logarithmic { value.log10() } else { value };
        let (from, to) = values
            .filter(|&value| shows(axis, value))
            .map(position)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), value| (from.min(value), to.max(value)));
        if from > to {
            return None;
        }
        // A single value stands in the middle of a range of its own order.
        let least = if axis.logarithmic { 0.5 } else { from.abs().max(to.abs()).max(1e-6) * 0.1 };
        let margin = ((to - from) * 0.06).max((least - (to - from)) / 2.0);
        // What cannot be negative is not drawn from below zero.
        let starts_at_zero = !axis.logarithmic && from >= 0.0 && from <= 0.35 * to;
        let from = if starts_at_zero { 0.0 } else { from - margin };
        Some(Self { logarithmic: axis.logarithmic, from, to: to + margin })
    }

    /// Where `value` lies between the ends, 0 to 1.
    pub(super) fn at(&self, value: f64) -> f64 {
        let position = if self.logarithmic { value.log10() } else { value };
        (position - self.from) / (self.to - self.from)
    }

    /// Its ticks in order.
    pub(super) fn ticks(&self) -> Vec<Tick> {
        if self.logarithmic { self.decades() } else { self.even() }
    }

    /// Ticks at 1, 2 or 5 times a power of ten (Heckbert 1990, "Nice numbers for graph labels").
    fn even(&self) -> Vec<Tick> {
        let rough = (self.to - self.from) / TICKS;
        let power = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
        let step = step.into_iter().find(|&step| step >= rough * 0.999).unwrap_or(10.0 * power);
        let (first, last) = ((self.from / step).ceil() as i64, (self.to / step).floor() as i64);
        let tick = |i: i64| {
            let value = i as f64 * step;
            Tick { value, label: Some(short(value)) }
        };
        (first..=last).map(tick).collect()
    }

    /// Ticks at 1 … 9 times powers of ten. Powers are labelled, of many decades only every so manyth; where these are too
    /// few, further digits are.
    fn decades(&self) -> Vec<Tick> {
        let every = ((self.to - self.from) / TICKS).ceil() as i32;
        let (first, last) = (self.from.floor() as i32, self.to.ceil() as i32);
        let marks: Vec<(i32, i32)> = (first..=last)
            .flat_map(|exponent| (1..=9).map(move |digit| (exponent, digit)))
            .filter(|&(exponent, digit)| (0.0..=1.0).contains(&self.at(power(exponent, digit))))
            .filter(|&(_, digit)| digit == 1 || every == 1)
            .collect();
        let is_labelled = |(exponent, digit): (i32, i32), digits: &[i32]| {
            digits.contains(&digit) && exponent.rem_euclid(every) == 0
        };
        let enough = |digits: &&[i32]| marks.iter().filter(|&&mark| is_labelled(mark, digits)).count() >= 3;
        let digits = LABELLED.into_iter().find(enough).unwrap_or(&[1, 2, 3, 4, 5, 6, 7, 8, 9]);
        let tick = |mark: (i32, i32)| {
            let value = power(mark.0, mark.1);
            Tick { value, label: is_labelled(mark, digits).then(|| short(value)) }
        };
        marks.iter().copied().map(tick).collect()
    }
}

/// Leading digits that are labelled on a logarithmic axis, from many decades to few.
const LABELLED: [&[i32]; 3] = [&[1], &[1, 2, 5], &[1, 2, 3, 5, 7]];

fn power(exponent: i32, digit: i32) -> f64 {
    f64::from(digit) * 10_f64.powi(exponent)
}

/// Whether `value` can be shown on `axis`.
pub(super) fn shows(axis: &Axis, value: f64) -> bool {
    value.is_finite() && (!axis.logarithmic || value > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(logarithmic: bool, values: &[f64]) -> Option<Scale> {
        Scale::new(&Axis { title: String::new(), logarithmic }, values.iter().copied())
    }

    fn labels(scale: &Scale) -> Vec<String> {
        scale.ticks().into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn values_lie_within_and_ratios_are_distances_on_a_logarithmic_axis() {
        let scale = scale(true, &[1.0, 10.0, 100.0]).expect("a scale");
        let at = [1.0, 10.0, 100.0].map(|value| scale.at(value));
        assert!(at[0] > 0.0 && at[2] < 1.0);
        assert!((at[1] - at[0] - (at[2] - at[1])).abs() < 1e-12);
        assert!((at[1] - 0.5).abs() < 1e-12);
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(
            labels(&scale(false, &[0.0, 1.0]).expect("a scale")),
            ["0", "0.2", "0.4", "0.6", "0.8", "1"]
        );
        assert_eq!(labels(&scale(true, &[1.0, 32.0]).expect("a scale")), ["1", "2", "5", "10", "20"]);
        assert_eq!(labels(&scale(true, &[0.002, 2.0]).expect("a scale")), ["0.01", "0.1", "1"]);
        for values in [&[3.0][..], &[-5.0, 7.0], &[1e-9, 2e-9], &[0.0]] {
            let scale = scale(false, values).expect("a scale");
            assert!(scale.ticks().len() >= 2, "{values:?}");
            assert!(scale.ticks().iter().all(|tick| (0.0..=1.0).contains(&scale.at(tick.value))));
        }
    }

    #[test]
    fn less_than_a_decade_has_labels_too() {
        // With margins of 6 % of log₁₀(0.095 / 0.022) = 0.635 the axis is from 0.0202 to 0.1037.
        let narrow = scale(true, &[0.022, 0.095]).expect("a scale");
        assert_eq!(labels(&narrow), ["0.03", "0.05", "0.07", "0.1"]);
        for tenth in 0..10 {
            let value = 10_f64.powf(f64::from(tenth) / 10.0);
            let labels = labels(&scale(true, &[value, value * 1.05]).expect("a scale"));
            assert!((2..=7).contains(&labels.len()), "{value}: {labels:?}");
        }
    }

    #[test]
    fn many_decades_have_few_labels() {
        let scale = scale(true, &[1e-12, 1e12]).expect("a scale");
        assert!((3..=8).contains(&labels(&scale).len()), "{:?}", labels(&scale));
    }

    #[test]
    fn what_cannot_be_shown_is_left_out() {
        assert!(scale(true, &[0.0, -1.0, f64::NAN]).is_none());
        assert!(scale(false, &[f64::INFINITY]).is_none());
        let only = scale(true, &[0.0, 5.0]).expect("a scale");
        assert!((only.at(5.0) - 0.5).abs() < 1e-12);
    }
}
