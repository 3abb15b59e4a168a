//! Times of many runs in a few numbers.

use serde::Serialize;

/// How values spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Smallest value.
    pub min: f64,
    /// The value in the middle.
    pub median: f64,
    /// The value that 95 % do not exceed.
    pub p95: f64,
    /// How many values there are.
    pub count: usize,
}

impl Spread {
    /// Of `values`, in any order; zero without values.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let rank = (share * values.len() as f64).ceil() as usize;
            values.get(rank.saturating_sub(1)).copied().unwrap_or_default()
        };
        let middle = values.len() / 2;
        let median = match values.len() {
            0 => 0.0,
            n if n % 2 == 1 => values[middle],
            _ => 0.5 * (values[middle - 1] + values[middle]),
        };
        Self { min: at(0.0), median, p95: at(0.95), count: values.len() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_counted() {
        let spread = Spread::of((1..=100).rev().map(f64::from).collect());
        assert_eq!(spread, Spread { min: 1.0, median: 50.5, p95: 95.0, count: 100 });
        assert_eq!(Spread::of(vec![3.0, 1.0, 2.0]), Spread { min: 1.0, median: 2.0, p95: 3.0, count: 3 });
        assert_eq!(Spread::of(Vec::new()), Spread::default());
    }
}
