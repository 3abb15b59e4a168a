//! The fuzzy measure μ(d): degree to which a direction first blocked at distance d counts as open (spec §2).

/// Fuzzy measure μ of the distance to the first hit. All kinds are 0 at contact, never decrease, and are 1 on a miss.
///
/// Lengths are scene units. *Falloff* is 1 − μ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Openness {
    /// (d/R)^α below R, 1 from there on.
    Power {
        /// Near-field radius R > 0.
        radius: f32,
        /// Exponent α > 0.
        exponent: f32,
    },
    /// 1 − exp(−σ d), without an end.
    Exponential {
        /// Rate σ > 0, per scene unit.
        sigma: f32,
    },
    /// (1 − exp(−σ d)) / (1 − exp(−σ R)) below R, 1 from there on: continuous at R.
    ExponentialTruncated {
        /// Near-field radius R > 0.
        radius: f32,
        /// Rate σ > 0, per scene unit.
        sigma: f32,
    },
    /// 0 below R, 1 from there on: classical ambient occlusion.
    Step {
        /// Near-field radius R > 0.
        radius: f32,
    },
}

impl Openness {
    /// μ(d) for a first hit at distance `d` ≥ 0; 1 for an infinite one.
    #[must_use]
    pub fn at(&self, d: f32) -> f32 {
        if d >= self.reach() {
            return 1.0;
        }
        match *self {
            Self::Power { radius, exponent: 1.0 } => d / radius,
            Self::Power { radius, exponent } => libm::powf(d / radius, exponent),
            Self::Exponential { sigma } => -libm::expm1f(-sigma * d),
            Self::ExponentialTruncated { radius, sigma } => {
                libm::expm1f(-sigma * d) / libm::expm1f(-sigma * radius)
            }
            Self::Step { .. } => 0.0,
        }
    }

    /// [`at`](Self::at) of each of some distances, side by side where it takes no more than a division.
    #[inline(always)]
    #[must_use]
    pub fn at_each<const L: usize>(&self, distances: &[f32; L]) -> [f32; L] {
        let mut mu = [0.0; L];
        match *self {
            Self::Power { radius, exponent: 1.0 } => {
                for (mu, &d) in mu.iter_mut().zip(distances) {
                    *mu = if d >= radius { 1.0 } else { d / radius };
                }
            }
            _ => mu.iter_mut().zip(distances).for_each(|(mu, &d)| *mu = self.at(d)),
        }
        mu
    }

    /// Distance from which μ is 1: the `t_max` of ambient rays. Infinite for [`Openness::Exponential`].
    #[must_use]
    #[inline(always)]
    pub const fn reach(&self) -> f32 {
        match *self {
            Self::Power { radius, .. }
            | Self::ExponentialTruncated { radius, .. }
            | Self::Step { radius } => radius,
            Self::Exponential { .. } => f32::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_at_contact_rising_and_open_far_away() {
        let kinds = [
            Openness::Power { radius: 2.0, exponent: 0.5 },
            Openness::Power { radius: 2.0, exponent: 1.0 },
            Openness::Power { radius: 2.0, exponent: 3.0 },
            Openness::Exponential { sigma: 1.5 },
            Openness::ExponentialTruncated { radius: 2.0, sigma: 1.5 },
            Openness::Step { radius: 2.0 },
        ];
        for kind in kinds {
            assert_eq!(kind.at(0.0), 0.0, "{kind:?}");
            assert_eq!(kind.at(f32::INFINITY), 1.0, "{kind:?}");
            let values: Vec<f32> = (0..400).map(|i| kind.at(i as f32 * 0.01)).collect();
            assert!(values.windows(2).all(|w| w[0] <= w[1]), "{kind:?} decreases");
            assert!(values.iter().all(|v| (0.0..=1.0).contains(v)), "{kind:?} leaves [0, 1]");
            let distances = [0.0, 0.3, 1.7, 2.0, 9.0, f32::INFINITY];
            assert_eq!(kind.at_each(&distances), distances.map(|d| kind.at(d)), "{kind:?}");
        }
    }
}
