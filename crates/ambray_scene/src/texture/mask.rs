//! The alpha of an image, apart from its colours: rays that ask where something is read less memory.

use std::sync::Arc;

use glam::{Vec2, Vec4};

use super::{
    Filter, Image, Sampler,
    taps::{Axes, twice},
};
use crate::srgb;

/// The alpha of the full image, row by row from the top. Clones share it.
#[derive(Clone, Debug)]
pub(crate) struct AlphaPlane {
    size: [u32; 2],
    alphas: Arc<[u8]>,
}

/// An alpha plane with a way to read it.
#[derive(Clone, Debug)]
pub(crate) struct Mask {
    reader: AlphaReader,
    alphas: Arc<[u8]>,
}

/// How the alpha of an image is read.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlphaReader {
    axes: Axes,
    size: Vec4,
    width: usize,
    filter: Filter,
}

impl AlphaPlane {
    /// That of `image`.
    pub(crate) fn of(image: &Image) -> Self {
        let full = &image.levels[0];
        let alphas = full.texels.iter().map(|texel| texel[3]).collect();
        Self { size: [full.width, full.height], alphas }
    }
}

impl Mask {
    /// Makes `plane` ready to be read by `sampler`.
    pub(crate) fn new(plane: &AlphaPlane, sampler: &Sampler) -> Self {
        Self { reader: AlphaReader::new(plane.size, sampler), alphas: Arc::clone(&plane.alphas) }
    }

    /// The bits of [`Sampler::alpha_at`].
    #[inline(always)]
    pub(crate) fn at(&self, uv: Vec2) -> f32 {
        self.reader.read(uv, |texel| self.alphas[texel])
    }
}

impl AlphaReader {
    /// For an image of that size.
    #[inline(always)]
    pub(super) fn new([width, height]: [u32; 2], sampler: &Sampler) -> Self {
        let size = twice(width as i32 as f32, height as i32 as f32);
        Self { axes: Axes::of(sampler.wrap), size, width: width as usize, filter: sampler.mag }
    }

    /// The alpha at `uv` of an image, whose texels' `alpha` is given.
    #[inline(always)]
    pub(super) fn read(&self, uv: Vec2, alpha: impl Fn(usize) -> u8) -> f32 {
        let half = self.filter.half();
        let x = self.axes.reduced(uv) * self.size - half;
        let left = x.floor();
        let [right_share, lower_share, ..] = if half == 0.0 { [0.0; 4] } else { (x - left).to_array() };
        // The second two are the neighbours of the first two.
        let texels = self.axes.texels(left + Vec4::new(0.0, 0.0, 1.0, 1.0), self.size);
        let [left, upper, right, lower] = texels;
        let row = |row: usize| {
            let alpha = |column: usize| srgb::UNIT[usize::from(alpha(row * self.width + column))];
            lerp(alpha(left), alpha(right), right_share)
        };
        lerp(row(upper), row(lower), lower_share)
    }
}

#[inline(always)]
fn lerp(a: f32, b: f32, share: f32) -> f32 {
    a + (b - a) * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Wrap;

    #[test]
    fn masks_read_the_alpha_of_the_image() {
        let texel = |i: u32| [1, 2, 3, (i.wrapping_mul(2_654_435_761) >> 24) as u8];
        let image = Image::new(String::new(), 17, 9, (0..17 * 9).map(texel).collect(), true);
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            for mag in [Filter::Nearest, Filter::Linear] {
                let sampler = Sampler { wrap: [wrap, Wrap::Repeat], mag, ..Sampler::default() };
                let mask = Mask::new(&AlphaPlane::of(&image), &sampler);
                for i in 0..500 {
                    let uv = Vec2::new(i as f32 * 0.0173 - 4.0, 3.0 - i as f32 * 0.0091);
                    assert_eq!(mask.at(uv), sampler.alpha_at(&image, uv), "{uv} {sampler:?}");
                }
            }
        }
    }
}
