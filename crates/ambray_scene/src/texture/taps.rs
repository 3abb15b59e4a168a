//! The two texels that a coordinate falls between along one axis of an image.
//!
//! Without branches, so that many coordinates can be worked on at once.

use super::{Filter, Wrap};

/// What is outside the image along an axis: it repeats, unless it is said otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) is_mirror: bool,
    pub(super) is_clamp: bool,
}

/// Two neighbouring texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Taps {
    pub(super) first: i32,
    pub(super) second: i32,
    /// Weight of `second`.
    pub(super) share: f32,
}

impl Axis {
    pub(super) const REPEAT: Self = Self { is_mirror: false, is_clamp: false };

    #[inline(always)]
    pub(super) fn of(wrap: Wrap) -> Self {
        Self { is_mirror: wrap == Wrap::Mirror, is_clamp: wrap == Wrap::Clamp }
    }

    /// The coordinate of the same texel near the unit interval, so that huge ones keep their integer part exact; 0 for those
    /// that are not finite.
    #[inline(always)]
    pub(super) fn reduced(self, coordinate: f32) -> f32 {
        let x = if coordinate.abs() < f32::INFINITY { coordinate } else { 0.0 };
        let (period, inverse) = if self.is_mirror { (2.0, 0.5) } else { (1.0, 1.0) };
        let periods = inverse * x;
        // From 2²³ on there are only integers, which may be beyond those of 32 bits.
        let whole = if periods.abs() < 8_388_608.0 { floor(periods) as f32 } else { periods };
        let repeated = x - period * whole;
        let clamped = if x < -1.0 { -1.0 } else { x };
        let clamped = if clamped > 2.0 { 2.0 } else { clamped };
        if self.is_clamp { clamped } else { repeated }
    }

    /// The texels around the [reduced](Self::reduced) coordinate `x` of `size` texels, with the [half](Filter::half) of the
    /// filter.
    #[inline(always)]
    pub(super) fn taps(self, x: f32, size: i32, half: f32) -> Taps {
        let x = x * size as f32 - half;
        let left = floor(x);
        let share = if half == 0.0 { 0.0 } else { x - left as f32 };
        Taps { first: self.texel(left, size), second: self.texel(left + 1, size), share }
    }

    /// Texel that stands for the one at `index`, which may lie outside the image: by no more than a period, as
    /// [`reduced`](Self::reduced) makes it.
    #[inline(always)]
    fn texel(self, index: i32, size: i32) -> i32 {
        // No division: it would take longer than the rest of the lookup.
        let period = if self.is_mirror { 2 * size } else { size };
        let within = if index < 0 { index + period } else { index };
        let within = if within >= period { within - period } else { within };
        // The one that is in the image; in a period of the size of the image that is `within` itself.
        let within = within.min(2 * size - 1 - within);
        if self.is_clamp { index.max(0).min(size - 1) } else { within }
    }
}

impl Filter {
    /// How far from its edge a texel counts alone, texels; 0 where each does all over itself.
    #[inline(always)]
    pub(super) fn half(self) -> f32 {
        if self == Self::Linear { 0.5 } else { 0.0 }
    }
}

/// The largest integer that is no larger than `x`, of those of 32 bits.
#[inline(always)]
fn floor(x: f32) -> i32 {
    let towards_zero = x as i32;
    // Wrapping, for what is so far from them that the result is thrown away.
    towards_zero.wrapping_sub(i32::from(towards_zero as f32 > x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floors() {
        let near = |x: f32| [x.next_down(), x, x.next_up(), -x, (-x).next_up(), (-x).next_down()];
        let values = [0.0, 0.5, 1.0, 1.5, 2.0, 1e-40, 4_194_303.5, 8_388_607.0, 8_388_608.0, 2e9];
        for x in values.into_iter().flat_map(near) {
            assert_eq!(floor(x) as f32, x.floor(), "{x:?}");
        }
    }

    #[test]
    fn reduced_coordinates_are_those_of_the_same_texel() {
        for x in [0.0, 0.3, -0.3, 1.0, 1.7, -5.25, 8_388_607.5, 3e9, -1e30_f32] {
            assert_eq!(Axis::of(Wrap::Repeat).reduced(x), x - x.floor());
            assert_eq!(Axis::of(Wrap::Mirror).reduced(x), x - 2.0 * (0.5 * x).floor());
            assert_eq!(Axis::of(Wrap::Clamp).reduced(x), x.clamp(-1.0, 2.0));
        }
    }

    #[test]
    fn texels_outside_stand_for_those_inside() {
        for size in 1..5 {
            for index in -1..=size {
                assert_eq!(Axis::of(Wrap::Repeat).texel(index, size), index.rem_euclid(size));
                assert_eq!(Axis::of(Wrap::Clamp).texel(index, size), index.clamp(0, size - 1));
            }
            for index in -1..=2 * size {
                let there = index.rem_euclid(2 * size);
                let reflected = if there < size { there } else { 2 * size - 1 - there };
                assert_eq!(Axis::of(Wrap::Mirror).texel(index, size), reflected);
            }
        }
    }
}
