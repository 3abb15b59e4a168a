//! The level at which an animation plays: as fine as it can be without stuttering.

use ambray::settings::Size;

use super::{levels::cost, rate::Rate};
use crate::engine::contract::Level;

/// A coarser level is taken where a picture would take longer, seconds.
const SLOW: f64 = 0.060;
/// A finer level is taken where it would take less, seconds. Far enough below [`SLOW`] that levels do not alternate.
const FAST: f64 = 0.035;
/// Scales and the share of the rays a pixel, coarsest first.
const LADDER: [(f32, u32); 6] = [(0.125, 2), (0.125, 1), (0.25, 1), (0.5, 1), (0.75, 1), (1.0, 1)];

/// Where on the ladder an animation plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pace(usize);

impl Default for Pace {
    fn default() -> Self {
        Self(2)
    }
}

impl Pace {
    /// The level of the next picture of `size` with `spp` rays a pixel, 0 if it takes none, of which `sides` are rendered for
    /// each moment.
    pub(super) fn next(&mut self, size: Size, spp: u32, rate: Rate, sides: usize) -> Level {
        let level = |rung: usize| {
            let (scale, part) = LADDER[rung];
            Level { scale, spp: (spp / part).max(spp.min(1)), is_final: scale == 1.0 }
        };
        let seconds = |rung: usize| rate.seconds(cost(size, &level(rung)) * sides as f64);
        while self.0 > 0 && seconds(self.0).is_some_and(|seconds| seconds > SLOW) {
            self.0 -= 1;
        }
        while self.0 + 1 < LADDER.len() && seconds(self.0 + 1).is_some_and(|seconds| seconds < FAST) {
            self.0 += 1;
        }
        level(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{super::rate::work, *};

    const SIZE: Size = Size { width: 640, height: 360 };

    fn rate(seconds: f64) -> Rate {
        let mut rate = Rate::default();
        rate.measured(work(SIZE, 8), seconds);
        rate
    }

    #[track_caller]
    fn check(pace: &mut Pace, seconds: f64, sides: usize, expected: f32) {
        assert_eq!(pace.next(SIZE, 8, rate(seconds), sides).scale, expected);
    }

    #[test]
    fn fast_scenes_play_in_full() {
        let mut pace = Pace::default();
        check(&mut pace, 0.01, 1, 1.0);
        assert!(pace.next(SIZE, 8, rate(0.01), 1).is_final);
        check(&mut pace, 0.04, 2, 0.75);
    }

    #[test]
    fn slow_scenes_play_coarsely_and_never_stop() {
        let mut pace = Pace::default();
        check(&mut pace, 0.5, 1, 0.25);
        check(&mut pace, 100.0, 1, 0.125);
        assert_eq!(pace.next(SIZE, 1, rate(100.0), 2).spp, 1);
        assert_eq!(pace.next(SIZE, 0, rate(100.0), 2).spp, 0);
    }

    #[test]
    fn the_level_does_not_alternate_between_measurements_that_differ_a_little() {
        let mut pace = Pace::default();
        for _ in 0..20 {
            check(&mut pace, 0.030, 1, 1.0);
            check(&mut pace, 0.055, 1, 1.0);
        }
        check(&mut pace, 0.070, 1, 0.75);
        for _ in 0..20 {
            check(&mut pace, 0.040, 1, 0.75);
            check(&mut pace, 0.070, 1, 0.75);
        }
    }
}
