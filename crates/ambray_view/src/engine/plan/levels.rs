//! The levels through which a picture is refined.

use ambray::settings::Size;

use super::rate::{Rate, work};
use crate::engine::contract::Level;

/// Levels before one that takes less than this, seconds, are left out: nobody would see them.
const BRIEF: f64 = 0.1;
/// The coarsest scale.
const COARSEST: f32 = 0.125;
/// Rays a pixel of coarse pictures where more than [`FEW`] are asked for.
const QUICK: u32 = 4;
/// Up to so many rays a pixel there is no level with fewer of them.
const FEW: u32 = 8;

/// Size of a picture of `size` at `scale`: at least one pixel, and rounded up.
pub(super) fn scaled(size: Size, scale: f32) -> Size {
    let side = |pixels: u32| ((f64::from(pixels) * f64::from(scale)).ceil() as u32).clamp(1, pixels.max(1));
    Size { width: side(size.width), height: side(size.height) }
}

/// The work of `level` of a picture of `size`.
pub(super) fn cost(size: Size, level: &Level) -> f64 {
    work(scaled(size, level.scale), level.spp)
}

/// Levels from the first picture that takes at most `quick` seconds to the one that is asked for: the scale doubles up to 1, then the rays
/// a pixel quadruple. Where `spp` is 0, since the method takes no rays, the size alone changes.
pub(super) fn plan(size: Size, spp: u32, rate: Rate, quick: f64) -> Vec<Level> {
    let fits = |level: &Level| rate.seconds(cost(size, level)).is_some_and(|seconds| seconds <= quick);
    let last = Level { scale: 1.0, spp, is_final: true };
    if fits(&last) {
        return vec![last];
    }
    let few = if spp <= FEW { spp } else { QUICK };
    let mut levels = vec![first(few, rate, fits)];
    let mut scale = levels[0].scale;
    while scale < 1.0 {
        scale *= 2.0;
        levels.push(Level { scale, spp: few, is_final: false });
    }
    let mut rays = few;
    while rays < spp {
        rays = rays.saturating_mul(4).min(spp);
        levels.push(Level { scale: 1.0, spp: rays, is_final: false });
    }
    if levels.last().is_some_and(|level| level.scale == 1.0 && level.spp == spp) {
        levels.pop();
    }
    levels.push(last);
    without_brief(&levels, |level| rate.seconds(cost(size, level)))
}

/// The largest picture that is quick enough, else the coarsest.
fn first(quick: u32, rate: Rate, fits: impl Fn(&Level) -> bool) -> Level {
    let level = |scale, spp| Level { scale, spp, is_final: false };
    let sizes = [1.0, 0.5, 0.25, COARSEST].map(|scale| level(scale, quick));
    let least = quick.min(1);
    let fewer = [quick / 2, quick / 4].map(|spp| level(COARSEST, spp.max(least)));
    let rays = if rate.is_known() { (quick / 4).max(least) } else { quick };
    sizes.into_iter().chain(fewer).find(|level| fits(level)).unwrap_or(level(COARSEST, rays))
}

/// `levels` without those, but for the first, that are followed by a brief one.
fn without_brief(levels: &[Level], seconds: impl Fn(&Level) -> Option<f64>) -> Vec<Level> {
    let is_brief = |level: &Level| seconds(level).is_some_and(|seconds| seconds <= BRIEF);
    let is_kept = |&(i, _): &(usize, &Level)| i == 0 || !levels.get(i + 1).is_some_and(is_brief);
    levels.iter().enumerate().filter(is_kept).map(|(_, level)| *level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size { width: 1280, height: 720 };

    /// A rate at which a picture with `spp` rays a pixel takes `seconds`.
    fn rate(spp: u32, seconds: f64) -> Rate {
        let mut rate = Rate::default();
        rate.measured(work(SIZE, spp), seconds);
        rate
    }

    #[track_caller]
    fn check(spp: u32, rate: Rate, expected: &[(f32, u32)]) {
        let levels = plan(SIZE, spp, rate, 0.05);
        let actual: Vec<_> = levels.iter().map(|level| (level.scale, level.spp)).collect();
        assert_eq!(actual, expected);
        let last = levels.len() - 1;
        assert!(levels.iter().enumerate().all(|(i, level)| level.is_final == (i == last)));
    }

    #[test]
    fn a_quick_picture_has_one_level() {
        check(8, rate(8, 0.04), &[(1.0, 8)]);
        check(1024, rate(1024, 0.04), &[(1.0, 1024)]);
    }

    #[test]
    fn the_first_level_is_the_largest_that_is_quick_enough() {
        check(8, rate(8, 0.15), &[(0.5, 8), (1.0, 8)]);
        check(8, rate(8, 0.7), &[(0.25, 8), (0.5, 8), (1.0, 8)]);
        check(8, rate(8, 3.0), &[(0.125, 8), (0.25, 8), (0.5, 8), (1.0, 8)]);
    }

    #[test]
    fn the_slowest_begin_with_fewer_rays() {
        check(8, rate(8, 5.0), &[(0.125, 4), (0.25, 8), (0.5, 8), (1.0, 8)]);
        check(8, rate(8, 60.0), &[(0.125, 2), (0.25, 8), (0.5, 8), (1.0, 8)]);
    }

    #[test]
    fn many_rays_come_after_the_full_size() {
        check(64, rate(4, 0.15), &[(0.5, 4), (1.0, 4), (1.0, 16), (1.0, 64)]);
        check(100, rate(4, 0.15), &[(0.5, 4), (1.0, 4), (1.0, 16), (1.0, 64), (1.0, 100)]);
    }

    #[test]
    fn levels_that_nobody_would_see_are_left_out() {
        check(16, rate(16, 0.09), &[(1.0, 4), (1.0, 16)]);
        check(8, rate(8, 0.09), &[(0.5, 8), (1.0, 8)]);
        check(16, rate(4, 0.06), &[(0.5, 4), (1.0, 4), (1.0, 16)]);
    }

    #[test]
    fn without_a_measurement_the_first_level_is_the_coarsest() {
        let none = Rate::default();
        check(8, none, &[(0.125, 8), (0.25, 8), (0.5, 8), (1.0, 8)]);
        check(16, none, &[(0.125, 4), (0.25, 4), (0.5, 4), (1.0, 4), (1.0, 16)]);
        check(1, none, &[(0.125, 1), (0.25, 1), (0.5, 1), (1.0, 1)]);
    }

    #[test]
    fn without_rays_the_size_alone_changes() {
        let sizes = [(0.125, 0), (0.25, 0), (0.5, 0), (1.0, 0)];
        check(0, Rate::default(), &sizes);
        check(0, rate(0, 0.04), &[(1.0, 0)]);
        check(0, rate(0, 0.15), &[(0.5, 0), (1.0, 0)]);
        // However slow: there is nothing but the size to save at.
        check(0, rate(0, 60.0), &sizes);
    }

    #[test]
    fn scaled_pictures_have_pixels() {
        let size = |width, height| Size { width, height };
        assert_eq!(scaled(size(1280, 720), 0.125), size(160, 90));
        assert_eq!(scaled(size(3, 9), 0.5), size(2, 5));
        assert_eq!(scaled(size(1, 1), 0.125), size(1, 1));
        assert_eq!(scaled(size(333, 777), 1.0), size(333, 777));
    }
}
