//! Textures made ready for many reads over wide footprints.

use std::sync::Arc;

use glam::Vec4;

use super::{
    Image, ImageLevel, Sampler,
    looks::Mode,
    lookup::{Encoded, Quad, Texels},
};

/// Texels of the largest level that is kept decoded. Bounced light reads footprints of a tenth of the radius and more, which
/// is this level or a smaller one for all but the closest hits; 64 × 64 texels are 64 KiB, all levels below another third.
const DECODED_TEXELS: usize = 64 * 64;

/// An image with its coarse levels decoded, four times their size in the image. Clones share them: a file may have any number
/// of textures of one image.
#[derive(Clone, Debug)]
pub(crate) struct PreparedImage {
    image: Arc<Image>,
    pub(super) texels_across: f32,
    /// What the bytes of the colour channels mean.
    decode: &'static [f32; 256],
    /// The coarse levels' texels, linear, level after level.
    texels: Arc<[Vec4]>,
    pub(super) levels: Arc<[Level]>,
}

/// A texture whose coarse levels are decoded, to be read by [`Looks`](super::Looks).
#[derive(Clone, Debug)]
pub(crate) struct PreparedTexture {
    pub(super) mode: Mode,
    pub(super) image: PreparedImage,
}

/// A level of the image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    pub(super) size: [i32; 2],
    /// Where it begins among the decoded texels; [`FINE`] if it is not there.
    start: u32,
}

/// Not decoded.
const FINE: u32 = u32::MAX;

impl PreparedImage {
    /// Decodes the coarse levels of `image`.
    pub(crate) fn new(image: &Arc<Image>) -> Self {
        let (decode, mut texels) = (image.decoder(), Vec::new());
        let mut place = |level: &ImageLevel| {
            let size = [level.width as i32, level.height as i32];
            if level.texels.len() > DECODED_TEXELS {
                return Level { size, start: FINE };
            }
            let start = texels.len() as u32;
            let encoded = Encoded::<true>::of(level, decode);
            texels.extend((0..level.texels.len()).map(|i| encoded.texel(i)));
            Level { size, start }
        };
        let levels = image.levels.iter().map(&mut place).collect();
        let texels_across = image.texels_across();
        Self { image: Arc::clone(image), texels_across, decode, texels: texels.into(), levels }
    }

    /// Number of the smallest level.
    #[inline(always)]
    pub(super) fn last_level(&self) -> u32 {
        self.levels.len() as u32 - 1
    }
}

impl PreparedTexture {
    /// Makes `image` ready to be read by `sampler`.
    pub(crate) fn new(image: &PreparedImage, sampler: &Sampler) -> Self {
        Self { mode: Mode::of(sampler), image: image.clone() }
    }

    /// Whether the decoded texels of both are the same memory.
    #[cfg(test)]
    pub(crate) fn shares_texels(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.image.texels, &other.image.texels)
    }

    /// The value of a `quad` of a level.
    #[inline(always)]
    pub(super) fn read(&self, level: usize, quad: &Quad) -> Vec4 {
        let PreparedImage { image, decode, texels, levels, .. } = &self.image;
        let start = levels[level].start;
        if start == FINE {
            // The bits of images that are not sRGB too.
            quad.value(Encoded::<true>::of(&image.levels[level], decode))
        } else {
            quad.value(Decoded(&texels[start as usize..]))
        }
    }
}

/// Decoded texels of a level, and of those after it.
struct Decoded<'a>(&'a [Vec4]);

impl Texels for Decoded<'_> {
    #[inline(always)]
    fn texel(&self, i: usize) -> Vec4 {
        self.0[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Filter, Wrap, texture::Looks};
    use glam::Vec2;

    #[test]
    fn prepared_textures_read_the_same_bits() {
        // 300 × 70 texels: three levels are too fine to be decoded.
        let byte = |i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as u8;
        let texels: Vec<[u8; 4]> =
            (0..300 * 70).map(|i| [byte(4 * i), byte(4 * i + 1), byte(4 * i + 2), byte(4 * i + 3)]).collect();
        let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
        let filters = [Filter::Nearest, Filter::Linear];
        for srgb in [false, true] {
            let image = Arc::new(Image::new(String::new(), 300, 70, texels.clone(), srgb));
            let image_prepared = PreparedImage::new(&image);
            for number in 0..9 * 2 * 2 * 3 {
                let sampler = Sampler {
                    wrap: [wraps[number % 3], wraps[number / 3 % 3]],
                    mag: filters[number / 9 % 2],
                    min: filters[number / 18 % 2],
                    mip: [None, Some(Filter::Nearest), Some(Filter::Linear)][number / 36],
                };
                check(&PreparedTexture::new(&image_prepared, &sampler), &sampler, &image);
            }
        }
    }

    fn check(prepared: &PreparedTexture, sampler: &Sampler, image: &Image) {
        let odd = [f32::NAN, f32::INFINITY, f32::MAX, -3e9, 8_388_607.5, -0.0, 1e-40, -1e-9, 1.0, 2.0, -1.0];
        let coordinates = (0..500).map(|i| i as f32 * 0.0173 - 4.0).chain(odd);
        let looks: Vec<(Vec2, f32)> = (coordinates.enumerate())
            .map(|(i, u)| {
                let width = [f32::NAN, -1.0, 0.0, f32::INFINITY].get(i % 41).copied();
                let width = width.unwrap_or(libm::exp2f((i % 23) as f32 * 0.5 - 10.0));
                (if i % 2 == 0 { Vec2::new(u, 3.0 - 0.7 * u) } else { Vec2::new(0.37 * u, u) }, width)
            })
            .collect();
        let (mut batch, mut taken) = (Looks::new(), 0);
        for (tag, &(uv, width)) in looks.iter().enumerate() {
            batch.push(prepared, uv, width, tag as u32);
            if batch.is_full() || tag + 1 == looks.len() {
                batch.take(|tag, value| {
                    let (uv, width) = looks[tag as usize];
                    assert_eq!(value, sampler.sample(image, uv, width), "{uv} {width} {sampler:?}");
                    taken += 1;
                });
            }
        }
        assert_eq!(taken, looks.len());
    }
}
