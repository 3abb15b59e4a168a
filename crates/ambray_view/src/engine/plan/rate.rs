//! How long a picture will take, from what earlier ones took.

use ambray::settings::Size;

/// What a pixel costs besides its ambient rays, in ambient rays: a primary ray, a shadow ray and the filter.
const FIXED: f64 = 3.0;
/// Weight of a new measurement against the earlier ones: pictures of one scene differ, but the machine may be busy for once.
const FRESH: f64 = 0.6;

/// The work of a picture, in ambient rays.
pub(super) fn work(size: Size, spp: u32) -> f64 {
    f64::from(size.width) * f64::from(size.height) * (f64::from(spp) + FIXED)
}

/// Ambient rays a second with the scene that is open; unknown before its first picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Rate(Option<f64>);

impl Rate {
    /// Takes in that `work` took `seconds`.
    pub(super) fn measured(&mut self, work: f64, seconds: f64) {
        if !(work > 0.0 && seconds > 0.0) {
            return;
        }
        let now = work / seconds;
        self.0 = Some(self.0.map_or(now, |before| before + FRESH * (now - before)));
    }

    /// Whether anything was measured yet.
    pub(super) const fn is_known(self) -> bool {
        self.0.is_some()
    }

    /// How long `work` will take, seconds, if that can be known.
    pub(super) fn seconds(self, work: f64) -> Option<f64> {
        self.0.map(|rate| work / rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_settle_on_what_is_measured_again_and_again() {
        let mut rate = Rate::default();
        assert_eq!(rate.seconds(1.0), None);
        rate.measured(100.0, 1.0);
        assert_eq!(rate.seconds(50.0), Some(0.5));
        for _ in 0..40 {
            rate.measured(200.0, 1.0);
        }
        assert!((rate.seconds(100.0).unwrap() - 0.5).abs() < 1e-9);
        rate.measured(0.0, 1.0);
        rate.measured(1.0, 0.0);
        assert!(rate.seconds(100.0).unwrap().is_finite());
    }
}
