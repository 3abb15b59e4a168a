//! Reading images: which texels, which levels, and how they are weighed.

use glam::{Vec2, Vec4};

use super::{Filter, Image, ImageLevel, Sampler, Wrap};
use crate::srgb;

impl Sampler {
    /// Linear RGBA at `uv`, for a footprint of `width` texture units (1 = the whole image; 0 reads level 0).
    ///
    /// Texel (i, j) has its centre at (i + ½, j + ½) / size. The mip level is log₂(`width` · √(texels of the image)); at level 0 and
    /// below the image is magnified. Each texel is decoded before it is filtered. A `uv` that is not finite reads as 0.
    #[inline(always)]
    #[must_use]
    pub fn sample(&self, image: &Image, uv: Vec2, width: f32) -> Vec4 {
        if image.srgb {
            self.sample_as::<true>(image, uv, width)
        } else {
            self.sample_as::<false>(image, uv, width)
        }
    }

    #[inline(always)]
    fn sample_as<const SRGB: bool>(&self, image: &Image, uv: Vec2, width: f32) -> Vec4 {
        let decode = image.decoder();
        let blend = self.blend(image.levels.len(), width * image.texels_across());
        let (fine, coarse) = (&image.levels[blend.fine], &image.levels[blend.coarse]);
        let quad = self.quad((fine.width, fine.height), blend.filter, uv);
        let value = quad.value(Encoded::<SRGB>::of(fine, decode));
        if blend.share == 0.0 {
            return value;
        }
        let quad = self.quad((coarse.width, coarse.height), blend.filter, uv);
        value.lerp(quad.value(Encoded::<SRGB>::of(coarse, decode)), blend.share)
    }

    /// Which levels of `levels` a footprint of `texels` texels of the full image asks for.
    #[inline(always)]
    pub(super) fn blend(&self, levels: usize, texels: f32) -> Blend {
        let last = levels - 1;
        let one = |level: usize, filter: Filter| Blend { fine: level, coarse: level, share: 0.0, filter };
        let Some(level) = level_of(texels, last) else { return one(0, self.mag) };
        match self.mip {
            None => one(0, self.min),
            Some(Filter::Nearest) => one((level + 0.5) as usize, self.min),
            Some(Filter::Linear) => {
                let fine = level as usize;
                let share = level - fine as f32;
                Blend { fine, coarse: (fine + 1).min(last), share, filter: self.min }
            }
        }
    }

    /// Alpha at `uv` of the full image, magnified: what a ray meets when it tests whether something is there.
    #[must_use]
    pub fn alpha_at(&self, image: &Image, uv: Vec2) -> f32 {
        let level = &image.levels[0];
        let alpha =
            |x: usize, y: usize| srgb::UNIT[usize::from(level.texels[y * level.width as usize + x][3])];
        let [u, v] = self.taps((level.width, level.height), self.mag, uv);
        let row = |y: usize| {
            if u.share == 0.0 {
                alpha(u.first, y)
            } else {
                lerp(alpha(u.first, y), alpha(u.second, y), u.share)
            }
        };
        if v.share == 0.0 { row(v.first) } else { lerp(row(v.first), row(v.second), v.share) }
    }

    /// The texels around `uv` of a level of width and height `size`.
    #[inline(always)]
    pub(super) fn quad(&self, size: (u32, u32), filter: Filter, uv: Vec2) -> Quad {
        let [u, v] = self.taps(size, filter, uv);
        let width = size.0 as usize;
        let [upper, lower] = [v.first * width, v.second * width];
        let texels = [upper + u.first, upper + u.second, lower + u.first, lower + u.second];
        Quad { texels, shares: [u.share, v.share] }
    }

    #[inline(always)]
    fn taps(&self, (width, height): (u32, u32), filter: Filter, uv: Vec2) -> [Taps; 2] {
        [Taps::new(uv.x, width, self.wrap[0], filter), Taps::new(uv.y, height, self.wrap[1], filter)]
    }
}

/// Levels of an image, and how they are weighed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blend {
    pub(super) fine: usize,
    pub(super) coarse: usize,
    /// Weight of the coarse one; 0 if it need not be read.
    pub(super) share: f32,
    /// Filter between texels.
    pub(super) filter: Filter,
}

/// Four texels and how they are weighed; all the same one where nothing is filtered.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Quad {
    /// Upper and lower, left and right.
    texels: [usize; 4],
    /// Of the right ones, and of the lower ones.
    shares: [f32; 2],
}

impl Quad {
    #[inline(always)]
    pub(super) fn value(&self, level: impl Texels) -> Vec4 {
        let ([a, b, c, d], [right, below]) = (self.texels, self.shares);
        let upper = level.texel(a).lerp(level.texel(b), right);
        let lower = level.texel(c).lerp(level.texel(d), right);
        upper.lerp(lower, below)
    }
}

/// The texels of a level.
pub(super) trait Texels {
    /// Linear RGBA of texel number `i`, row by row from the top.
    fn texel(&self, i: usize) -> Vec4;
}

/// The texels of a level as the image has them.
pub(super) struct Encoded<'a, const SRGB: bool> {
    level: &'a ImageLevel,
    /// What the bytes of the colour channels mean.
    decode: &'a [f32; 256],
}

impl<'a, const SRGB: bool> Encoded<'a, SRGB> {
    #[inline(always)]
    pub(super) const fn of(level: &'a ImageLevel, decode: &'a [f32; 256]) -> Self {
        Self { level, decode }
    }
}

impl<const SRGB: bool> Texels for Encoded<'_, SRGB> {
    #[inline(always)]
    fn texel(&self, i: usize) -> Vec4 {
        let [r, g, b, a] = self.level.texels[i];
        if SRGB {
            let decode = |byte: u8| self.decode[usize::from(byte)];
            Vec4::new(decode(r), decode(g), decode(b), srgb::UNIT[usize::from(a)])
        } else {
            // The bits of `UNIT`, by one division of four.
            Vec4::new(f32::from(r), f32::from(g), f32::from(b), f32::from(a)) / 255.0
        }
    }
}

/// log₂ of a footprint of `texels` texels, at most `last`; `None` where the image is magnified.
#[inline(always)]
fn level_of(texels: f32, last: usize) -> Option<f32> {
    // The logarithm of negative widths is NaN, as that of NaN.
    if texels.is_nan() || texels <= 1.0 {
        return None;
    }
    // Far surfaces read the smallest level: no logarithm for them.
    if texels >= (1_u64 << last.min(63)) as f32 {
        return Some(last as f32);
    }
    Some(libm::log2f(texels).min(last as f32))
}

/// The largest integer that is no larger: [`f32::floor`] but for the sign of zero, without the call that it is on processors
/// that cannot be relied on to have an instruction for it.
#[inline(always)]
fn floor(x: f32) -> f32 {
    let towards_zero = x as i32 as f32;
    let floor = if towards_zero > x { towards_zero - 1.0 } else { towards_zero };
    // From here on there are only integers.
    if x.abs() < 8_388_608.0 { floor } else { x }
}

#[inline(always)]
fn lerp(a: f32, b: f32, share: f32) -> f32 {
    a + (b - a) * share
}

/// The two texels that a coordinate falls between along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Taps {
    first: usize,
    second: usize,
    /// Weight of `second`.
    share: f32,
}

impl Taps {
    #[inline(always)]
    fn new(coordinate: f32, size: u32, wrap: Wrap, filter: Filter) -> Self {
        let x = wrap.reduce(coordinate) * size as f32;
        match filter {
            Filter::Nearest => {
                let texel = wrap.texel(floor(x) as i64, size);
                Self { first: texel, second: texel, share: 0.0 }
            }
            Filter::Linear => {
                let left = floor(x - 0.5);
                let (first, second) = (wrap.texel(left as i64, size), wrap.texel(left as i64 + 1, size));
                Self { first, second, share: x - 0.5 - left }
            }
        }
    }
}

impl Wrap {
    /// The coordinate of the same texel near the unit interval, so that huge ones keep their integer part exact.
    #[inline(always)]
    fn reduce(self, coordinate: f32) -> f32 {
        if !coordinate.is_finite() {
            return 0.0;
        }
        match self {
            Self::Repeat => coordinate - floor(coordinate),
            Self::Mirror => coordinate - 2.0 * floor(0.5 * coordinate),
            Self::Clamp => coordinate.clamp(-1.0, 2.0),
        }
    }

    /// Texel that stands for the one at `index`, which may lie outside the image: by no more than a period, as
    /// [`reduce`](Self::reduce) makes it.
    #[inline(always)]
    fn texel(self, index: i64, size: u32) -> usize {
        let size = i64::from(size);
        // No division: it would take longer than the rest of the lookup.
        let within = |index: i64, period: i64| {
            if index < 0 {
                index + period
            } else if index >= period {
                index - period
            } else {
                index
            }
        };
        let inside = match self {
            Self::Repeat => within(index, size),
            Self::Mirror => {
                let index = within(index, 2 * size);
                if index < size { index } else { 2 * size - 1 - index }
            }
            Self::Clamp => index.clamp(0, size - 1),
        };
        inside as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shortcuts of [`level_of`] are the logarithm's own values.
    #[test]
    fn levels_are_the_logarithm_of_the_footprint() {
        let around = |x: f32| [x.next_down(), x, x.next_up()];
        let widths = (-140..127).flat_map(|e| around(libm::exp2f(e as f32))).chain([0.0, 1.5, 3.0, 700.3]);
        for texels in widths.chain([-1.0, f32::NAN, f32::INFINITY]) {
            for last in 0..16 {
                let level = libm::log2f(texels);
                let expected = (level > 0.0).then(|| level.min(last as f32));
                assert_eq!(level_of(texels, last), expected, "{texels} of {last}");
            }
        }
    }

    #[test]
    fn floors() {
        let near = |x: f32| [x.next_down(), x, x.next_up(), -x, (-x).next_up(), (-x).next_down()];
        let values = [0.0, 0.5, 1.0, 1.5, 2.0, 1e-40, 4_194_303.5, 8_388_607.0, 8_388_608.0, 3e9, 1e30];
        for x in values.into_iter().flat_map(near) {
            assert_eq!(floor(x), x.floor(), "{x:?}");
        }
    }

    #[test]
    fn texels_outside_stand_for_those_inside() {
        for size in 1..5_u32 {
            let period = i64::from(size);
            for index in -1..=period {
                assert_eq!(Wrap::Repeat.texel(index, size) as i64, index.rem_euclid(period));
            }
            for index in -1..=2 * period {
                let there = index.rem_euclid(2 * period);
                let reflected = if there < period { there } else { 2 * period - 1 - there };
                assert_eq!(Wrap::Mirror.texel(index, size) as i64, reflected);
            }
        }
    }
}
