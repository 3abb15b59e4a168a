//! The two texels that a coordinate falls between along one axis of an image.
//!
//! Without branches, so that many coordinates can be worked on at once: [`Axis`] is for loops over many of them, [`Axes`] for
//! a single place.

use glam::{Vec2, Vec4};

use super::{Filter, Wrap};

/// What is outside the image along an axis: it repeats, unless it is said otherwise.
#[derive(Clone, Copy, Debug)]
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

/// Both axes twice, side by side: with the bits of [`Axis`] for each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// Periods, of the size of the image: 2 where it is mirrored.
    period: Vec4,
    /// 1 where it is clamped, else 0.
    is_clamp: Vec4,
}

impl Axes {
    /// Those of a sampler.
    #[inline(always)]
    pub(super) fn of([u, v]: [Wrap; 2]) -> Self {
        let period = |wrap: Wrap| if wrap == Wrap::Mirror { 2.0 } else { 1.0 };
        let is_clamp = |wrap: Wrap| if wrap == Wrap::Clamp { 1.0 } else { 0.0 };
        Self { period: twice(period(u), period(v)), is_clamp: twice(is_clamp(u), is_clamp(v)) }
    }

    /// See [`Axis::reduced`].
    #[inline(always)]
    pub(super) fn reduced(&self, uv: Vec2) -> Vec4 {
        let x = twice(uv.x, uv.y);
        let x = Vec4::select(x.abs().cmplt(Vec4::INFINITY), x, Vec4::ZERO);
        // One period or half of it.
        let inverse = Vec4::splat(1.5) - 0.5 * self.period;
        let repeated = x - self.period * (inverse * x).floor();
        let clamped = x.max(Vec4::NEG_ONE).min(Vec4::splat(2.0));
        Vec4::select(self.is_clamp.cmpgt(Vec4::ZERO), clamped, repeated)
    }

    /// The texels at `indices`, which are integers, along axes of `size` texels: see [`Axis::texel`].
    #[inline(always)]
    pub(super) fn texels(&self, indices: Vec4, size: Vec4) -> [usize; 4] {
        let period = self.period * size;
        let within = indices + Vec4::select(indices.cmplt(Vec4::ZERO), period, Vec4::ZERO);
        let within = within - Vec4::select(within.cmpge(period), period, Vec4::ZERO);
        let within = within.min(2.0 * size - Vec4::ONE - within);
        let clamped = indices.max(Vec4::ZERO).min(size - Vec4::ONE);
        let texels = Vec4::select(self.is_clamp.cmpgt(Vec4::ZERO), clamped, within);
        // From 2²³ on the last bits of a number are an integer, and sides are shorter.
        let [a, b, c, d] = (texels + Vec4::splat(8_388_608.0)).to_array();
        let integer = |x: f32| (x.to_bits() & 0x007f_ffff) as usize;
        [integer(a), integer(b), integer(c), integer(d)]
    }
}

/// `x` and `y`, and once more.
#[inline(always)]
pub(super) fn twice(x: f32, y: f32) -> Vec4 {
    Vec4::new(x, y, x, y)
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

    impl Axis {
        fn of(wrap: Wrap) -> Self {
            Self { is_mirror: wrap == Wrap::Mirror, is_clamp: wrap == Wrap::Clamp }
        }
    }

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
    fn single_places_have_the_same_bits() {
        let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
        let odd = [f32::NAN, f32::INFINITY, f32::MAX, -3e9, 8_388_607.5, -0.0, 1e-40, -1e-9, 1.0, 2.0];
        for (i, u) in (0..999).map(|i| i as f32 * 0.0173 - 4.0).chain(odd).enumerate() {
            let [a, b] = [wraps[i % 3], wraps[i / 3 % 3]];
            let (uv, size) = (Vec2::new(u, 1.0 - 0.3 * u), [1 + (i as i32 * 7) % 40, 1 + (i as i32 * 5) % 9]);
            let axes = Axes::of([a, b]);
            let reduced = axes.reduced(uv);
            assert_eq!(reduced.x, Axis::of(a).reduced(uv.x));
            assert_eq!(reduced.w, Axis::of(b).reduced(uv.y));
            let left = reduced.truncate().truncate() * Vec2::new(size[0] as f32, size[1] as f32);
            let left = left.map(|x| (x - 0.5).floor());
            let texels = axes.texels(twice(left.x, left.y), twice(size[0] as f32, size[1] as f32));
            assert_eq!(texels[0] as i32, Axis::of(a).texel(left.x as i32, size[0]));
            assert_eq!(texels[3] as i32, Axis::of(b).texel(left.y as i32, size[1]));
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
