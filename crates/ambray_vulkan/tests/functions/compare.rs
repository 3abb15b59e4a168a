//! Values of both languages side by side.

use glam::Vec3;

/// Pairs of values that should agree.
pub(crate) struct Comparison {
    name: &'static str,
    cases: usize,
    unequal: usize,
    /// In units of the last place of the scale.
    largest: f64,
    worst: String,
}

impl Comparison {
    pub(crate) fn new(name: &'static str) -> Self {
        Self { name, cases: 0, unequal: 0, largest: 0.0, worst: String::new() }
    }

    /// Counts a difference in units of the last place of numbers as large as `scale`: that of the terms that `expected` is
    /// the sum of, where they cancel.
    pub(crate) fn add(&mut self, expected: f32, actual: f32, scale: f32, what: impl FnOnce() -> String) {
        self.cases += 1;
        if expected == actual || (expected.is_nan() && actual.is_nan()) {
            return;
        }
        self.unequal += 1;
        // Below the smallest normal number, units of the last place stay the same; shaders may flush what is there to zero.
        let unit = f64::from(f32::EPSILON) * f64::from(scale.abs().max(f32::MIN_POSITIVE));
        let difference = (f64::from(expected) - f64::from(actual)).abs() / unit;
        // Not a number is farther than everything.
        let difference = if difference.is_nan() { f64::INFINITY } else { difference };
        if difference > self.largest {
            self.largest = difference;
            self.worst = format!("{actual:e} for {expected:e} at {}", what());
        }
    }

    pub(crate) fn add_vector(&mut self, expected: Vec3, actual: Vec3, scale: f32, what: impl Fn() -> String) {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            self.add(expected[axis], actual[axis], scale, || format!("{name} of {}", what()));
        }
    }

    /// Fails if anything differed by more than `tolerance` units of the last place; 0 wants equality.
    #[track_caller]
    pub(crate) fn finish(self, tolerance: f64) {
        let Self { name, cases, unequal, largest, worst } = self;
        println!("{name}: {unequal} of {cases} differ, by {largest:.2} units at most: {worst}");
        assert!(cases > 0 && largest <= tolerance, "{name}: {largest:.2} units: {worst}");
    }
}
