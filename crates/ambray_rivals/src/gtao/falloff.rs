//! How much a sample counts by its distance.

/// Weight 1 near by, falling linearly to 0 at the radius.
///
/// XeGTAO's idea after Jimenez et al. 2016, §4.3 "Bounding the sampling area".
#[derive(Clone, Copy, Debug)]
pub(crate) struct Falloff {
    /// Distance from which the weight is 0, scene units.
    pub(crate) radius: f32,
    /// Length over which it falls, scene units; 0 for a step.
    pub(crate) range: f32,
}

impl Falloff {
    /// The weight at `distance`.
    pub(crate) fn weight(self, distance: f32) -> f32 {
        if distance < self.radius { ((self.radius - distance) / self.range).min(1.0) } else { 0.0 }
    }

    /// The same shape, `factor` times as large.
    pub(crate) fn scaled(self, factor: f32) -> Self {
        Self { radius: factor * self.radius, range: factor * self.range }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falls_linearly_over_its_range() {
        let falloff = Falloff { radius: 2.0, range: 1.0 };
        let weights = [0.0, 1.0, 1.25, 1.5, 2.0, f32::INFINITY].map(|distance| falloff.weight(distance));
        assert_eq!(weights, [1.0, 1.0, 0.75, 0.5, 0.0, 0.0]);
    }

    #[test]
    fn without_a_range_is_a_step() {
        let step = Falloff { radius: 2.0, range: 0.0 };
        assert_eq!([0.0, 1.999, 2.0].map(|distance| step.weight(distance)), [1.0, 1.0, 0.0]);
    }
}
