//! Reading images: which texels, which levels, and how they are weighed.

use glam::{Vec2, Vec4};

use super::{Filter, Image, ImageLevel, Sampler, Wrap, mask::AlphaReader, taps::Axes};
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
        let [fine_quad, coarse_quad] = Quad::pair(self.wrap, uv, [fine, coarse], blend.filter);
        let value = fine_quad.value(Encoded::<SRGB>::of(fine, decode));
        if blend.share == 0.0 {
            return value;
        }
        value.lerp(coarse_quad.value(Encoded::<SRGB>::of(coarse, decode)), blend.share)
    }

    /// Which levels of `levels` a footprint of `texels` texels of the full image asks for.
    #[inline(always)]
    fn blend(&self, levels: usize, texels: f32) -> Blend {
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
        AlphaReader::new([level.width, level.height], self).read(uv, |texel| level.texels[texel][3])
    }
}

/// Levels of an image, and how they are weighed.
#[derive(Clone, Copy, Debug)]
struct Blend {
    fine: usize,
    coarse: usize,
    /// Weight of the coarse one; 0 if it need not be read.
    share: f32,
    /// Filter between texels.
    filter: Filter,
}

/// Four texels and how they are weighed; all the same one where nothing is filtered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quad {
    /// Upper and lower, left and right.
    texels: [usize; 4],
    /// Of the right ones, and of the lower ones.
    shares: [f32; 2],
}

impl Quad {
    /// The texels of two columns in two rows, given by where these begin, with the shares of the right ones and of the
    /// lower ones.
    #[inline(always)]
    pub(super) const fn new([left, right]: [usize; 2], [upper, lower]: [usize; 2], shares: [f32; 2]) -> Self {
        Self { texels: [upper + left, upper + right, lower + left, lower + right], shares }
    }

    /// The texels around `uv` of two levels.
    #[inline(always)]
    fn pair(wrap: [Wrap; 2], uv: Vec2, [fine, coarse]: [&ImageLevel; 2], filter: Filter) -> [Self; 2] {
        let axes = Axes::of(wrap);
        let side = |side: u32| side as i32 as f32;
        let size = Vec4::new(side(fine.width), side(fine.height), side(coarse.width), side(coarse.height));
        let half = filter.half();
        let x = axes.reduced(uv) * size - half;
        let left = x.floor();
        let shares = if half == 0.0 { Vec4::ZERO } else { x - left };
        let first = axes.texels(left, size);
        let second = axes.texels(left + 1.0, size);
        let quad = |level: &ImageLevel, u: usize, v: usize| {
            let width = level.width as usize;
            let rows = [first[v] * width, second[v] * width];
            Self::new([first[u], second[u]], rows, [shares[u], shares[v]])
        };
        [quad(fine, 0, 1), quad(coarse, 2, 3)]
    }

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
    Some(log2_above_one(texels).min(last as f32))
}

/// The bits of [`libm::log2f`] for finite numbers above 1, without its cases; anything for others. Its method and coefficients,
/// which are those of FreeBSD's, so that many logarithms can be taken side by side.
#[inline(always)]
pub(super) fn log2_above_one(x: f32) -> f32 {
    // √½, to which x is reduced by powers of two, and 1.
    const ROOT: u32 = 0x3f35_04f3;
    const ONE: u32 = 0x3f80_0000;
    let bits = x.to_bits().wrapping_add(ONE - ROOT);
    let exponent = (bits >> 23) as i32 - 127;
    let f = f32::from_bits((bits & 0x007f_ffff) + ROOT) - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (0.400_009_72 + w * 0.242_790_79);
    let odd = z * (0.666_666_6 + w * 0.284_987_87);
    let half_square = 0.5 * f * f;
    let high = f32::from_bits((f - half_square).to_bits() & 0xffff_f000);
    let low = f - high - half_square + s * (half_square + (odd + even));
    // 1 / ln 2, in two parts.
    const INVERSE: [f32; 2] = [1.442_871_1, -1.760_528_5e-4];
    (low + high) * INVERSE[1] + low * INVERSE[0] + high * INVERSE[0] + exponent as f32
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
    fn logarithms_are_those_of_the_library() {
        for exponent in 0..127 {
            let from = libm::exp2f(exponent as f32);
            for step in 0..5000_u32 {
                let x = f32::from_bits(from.to_bits() + step * 1677 + step % 3);
                if x > 1.0 {
                    assert_eq!(log2_above_one(x).to_bits(), libm::log2f(x).to_bits(), "{x}");
                }
            }
        }
    }
}
