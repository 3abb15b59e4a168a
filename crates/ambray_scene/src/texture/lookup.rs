//! Reading images: which texels, which levels, and how they are weighed.

use glam::{Vec2, Vec4};

use super::{Filter, Image, ImageLevel, Sampler, Wrap};
use crate::srgb;

impl Sampler {
    /// Linear RGBA at `uv`, for a footprint of `width` texture units (1 = the whole image; 0 reads level 0).
    ///
    /// Texel (i, j) has its centre at (i + ½, j + ½) / size. The mip level is log₂(`width` · √(texels of the image)); at level 0 and
    /// below the image is magnified. Each texel is decoded before it is filtered. A `uv` that is not finite reads as 0.
    #[must_use]
    pub fn sample(&self, image: &Image, uv: Vec2, width: f32) -> Vec4 {
        let decode = image.decoder();
        self.over_levels(image.levels.len(), width * image.texels_across(), |level, filter| {
            self.at_level(&image.levels[level], decode, filter, uv)
        })
    }

    /// Reads the levels that a footprint of `texels` texels of the full image asks for, with the filter between texels that
    /// is theirs, and blends them.
    #[inline(always)]
    pub(super) fn over_levels(
        &self,
        levels: usize,
        texels: f32,
        read: impl Fn(usize, Filter) -> Vec4,
    ) -> Vec4 {
        let last = levels - 1;
        let Some(level) = level_of(texels, last) else { return read(0, self.mag) };
        match self.mip {
            None => read(0, self.min),
            Some(Filter::Nearest) => read((level + 0.5) as usize, self.min),
            Some(Filter::Linear) => {
                let lower = level as usize;
                let share = level - lower as f32;
                let fine = read(lower, self.min);
                if share == 0.0 {
                    return fine;
                }
                fine.lerp(read((lower + 1).min(last), self.min), share)
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

    /// The value of one level, whose colours `decode` decodes.
    #[inline(always)]
    pub(super) fn at_level(
        &self,
        level: &ImageLevel,
        decode: &[f32; 256],
        filter: Filter,
        uv: Vec2,
    ) -> Vec4 {
        self.between_texels((level.width, level.height), filter, uv, |texel| {
            let [r, g, b, a] = level.texels[texel].map(usize::from);
            Vec4::new(decode[r], decode[g], decode[b], srgb::UNIT[a])
        })
    }

    /// The value of a level of `size` texels, given its texels row by row.
    #[inline(always)]
    pub(super) fn between_texels(
        &self,
        size: (u32, u32),
        filter: Filter,
        uv: Vec2,
        texel: impl Fn(usize) -> Vec4,
    ) -> Vec4 {
        let [u, v] = self.taps(size, filter, uv);
        let [first, second] = [v.first, v.second].map(|row| row * size.0 as usize);
        if filter == Filter::Nearest {
            return texel(first + u.first);
        }
        let upper = texel(first + u.first).lerp(texel(first + u.second), u.share);
        let lower = texel(second + u.first).lerp(texel(second + u.second), u.share);
        upper.lerp(lower, v.share)
    }

    #[inline(always)]
    fn taps(&self, (width, height): (u32, u32), filter: Filter, uv: Vec2) -> [Taps; 2] {
        [Taps::new(uv.x, width, self.wrap[0], filter), Taps::new(uv.y, height, self.wrap[1], filter)]
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
                let texel = wrap.texel(x.floor() as i64, size);
                Self { first: texel, second: texel, share: 0.0 }
            }
            Filter::Linear => {
                let left = (x - 0.5).floor();
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
            Self::Repeat => coordinate - coordinate.floor(),
            Self::Mirror => coordinate - 2.0 * (0.5 * coordinate).floor(),
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
