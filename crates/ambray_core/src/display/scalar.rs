//! Planes of one number a pixel as shades of a ramp.

use glam::Vec3;

use super::{Picture, picture::eight_bit};
use crate::{
    aov::AovKind,
    settings::{Ramp, Range, Settings},
};

/// `values` of a plane of this `kind` in the ramp of `settings`.
pub(super) fn show(kind: AovKind, values: &[f32], settings: &Settings) -> Picture {
    let Range([low, high]) = settings.range.unwrap_or(ends(kind, values));
    let shades = values.iter().map(|&value| place(value, low, high));
    match settings.ramp {
        Ramp::Grey => Picture::Grey(shades.collect()),
        ramp => Picture::Rgb { pixels: shades.map(|t| shade(ramp, t)).collect(), is_color: true },
    }
}

/// The values at the ends of the ramp where none are set, for a plane of this `kind` with these `values`.
#[must_use]
pub fn ends(kind: AovKind, values: &[f32]) -> Range {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let most = |least: f32| finite().fold(least, f32::max);
    match kind {
        AovKind::Depth => Range([finite().fold(f32::INFINITY, f32::min), most(f32::NEG_INFINITY)]),
        AovKind::Count => Range([0.0, most(1.0)]),
        _ => Range([0.0, 1.0]),
    }
}

/// Where `value` lies from `low` to `high`, in `[0, 1]`; what is infinitely far is at the end.
fn place(value: f32, low: f32, high: f32) -> f32 {
    if value == f32::INFINITY {
        1.0
    } else if high > low {
        // Halves, because the difference of two large numbers may be none.
        ((0.5 * value - 0.5 * low) / (0.5 * high - 0.5 * low)).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Display value of the `ramp` at `t`: its beginning at 0, its end at 1. A ramp of colours has one for each byte of grey.
#[must_use]
pub fn shade(ramp: Ramp, t: f32) -> Vec3 {
    match ramp {
        Ramp::Grey => Vec3::splat(t),
        ramp => Vec3::from_array(color(ramp, eight_bit(t)).map(f32::from)) / 255.0,
    }
}

/// Red, green and blue of the `ramp` where grey would be `grey`.
#[must_use]
pub fn color(ramp: Ramp, grey: u8) -> [u8; 3] {
    let gradient = match ramp {
        Ramp::Grey => return [grey; 3],
        Ramp::Viridis => colorous::VIRIDIS,
        Ramp::Magma => colorous::MAGMA,
        Ramp::Turbo => colorous::TURBO,
        Ramp::Cividis => colorous::CIVIDIS,
    };
    gradient.eval_rational(grey.into(), 256).into_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Auto;

    fn grey(kind: AovKind, values: &[f32], range: Auto<Range>) -> Vec<f32> {
        match show(kind, values, &Settings { range, ..Settings::default() }) {
            Picture::Grey(values) => values,
            Picture::Rgb { .. } => panic!("the ramp is grey by default"),
        }
    }

    #[test]
    fn depth_runs_from_the_nearest_to_the_farthest() {
        let depth = |values: &[f32]| grey(AovKind::Depth, values, Auto::Auto);
        assert_eq!(depth(&[2.0, 4.0, 3.0, f32::INFINITY]), [0.0, 1.0, 0.5, 1.0]);
        assert_eq!(depth(&[2.0, f32::INFINITY]), [0.0, 1.0]);
        assert_eq!(depth(&[f32::INFINITY]), [1.0]);
    }

    #[test]
    fn counts_are_relative_and_openness_is_not() {
        assert_eq!(grey(AovKind::Count, &[0.0, 4.0, 1.0], Auto::Auto), [0.0, 1.0, 0.25]);
        assert_eq!(grey(AovKind::Count, &[0.0], Auto::Auto), [0.0]);
        let openness = [0.1, 0.3, 0.7, 1.0];
        assert_eq!(grey(AovKind::Unit, &openness, Auto::Auto), openness);
    }

    #[test]
    fn a_range_sets_the_ends_for_every_kind() {
        let values = [0.0, 1.0, 2.0, 3.0, 9.0, f32::INFINITY];
        for kind in [AovKind::Unit, AovKind::Depth, AovKind::Count] {
            let range = Auto::Value(Range([1.0, 3.0]));
            assert_eq!(grey(kind, &values, range), [0.0, 0.0, 0.5, 1.0, 1.0, 1.0], "{kind:?}");
        }
        let widest = Auto::Value(Range([-f32::MAX, f32::MAX]));
        assert_eq!(grey(AovKind::Depth, &[-f32::MAX, 0.0, f32::MAX], widest), [0.0, 0.5, 1.0]);
    }

    #[test]
    fn ramps_have_the_colours_that_they_are_known_for() {
        // The ends of matplotlib's tables; turbo and cividis are polynomials, a step from theirs.
        let ends = [
            (Ramp::Viridis, [0x44, 0x01, 0x54], [0xFD, 0xE7, 0x25]),
            (Ramp::Magma, [0x00, 0x00, 0x04], [0xFC, 0xFD, 0xBF]),
            (Ramp::Turbo, [0x22, 0x17, 0x1B], [0x90, 0x0C, 0x00]),
            (Ramp::Cividis, [0x00, 0x20, 0x51], [0xFD, 0xE9, 0x45]),
        ];
        for (ramp, first, last) in ends {
            let settings = Settings { ramp, ..Settings::default() };
            let bytes = show(AovKind::Unit, &[0.0, 1.0], &settings).eight_bit();
            assert_eq!(bytes, [first, last].concat(), "{ramp:?}");
        }
        assert_eq!(shade(Ramp::Grey, 0.25), Vec3::splat(0.25));
        assert!(shade(Ramp::Turbo, f32::NAN).is_finite());
    }
}
