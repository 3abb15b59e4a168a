//! Textures made ready for many reads over wide footprints.

use std::sync::Arc;

use glam::{Vec2, Vec4};

use super::{
    Image, ImageLevel, Sampler,
    lookup::{Blend, Encoded, Quad, Texels},
};

/// Texels of the largest level that is kept decoded. Bounced light reads footprints of a tenth of the radius and more, which
/// is this level or a smaller one for all but the closest hits; 64 × 64 texels are 64 KiB, all levels below another third.
const DECODED_TEXELS: usize = 64 * 64;

/// An image with its coarse levels decoded, four times their size in the image. Clones share them: a file may have any number
/// of textures of one image.
#[derive(Clone, Debug)]
pub(crate) struct PreparedImage {
    image: Arc<Image>,
    texels_across: f32,
    /// The coarse levels' texels, linear, level after level.
    texels: Arc<[Vec4]>,
    levels: Arc<[Level]>,
}

/// A texture whose coarse levels are decoded.
#[derive(Clone, Debug)]
pub(crate) struct PreparedTexture {
    sampler: Sampler,
    image: PreparedImage,
}

/// A level of the image.
#[derive(Clone, Copy, Debug)]
struct Level {
    size: (u32, u32),
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
            let size = (level.width, level.height);
            if level.texels.len() > DECODED_TEXELS {
                return Level { size, start: FINE };
            }
            let start = texels.len() as u32;
            let encoded = Encoded::<true>::of(level, decode);
            texels.extend((0..level.texels.len()).map(|i| encoded.texel(i)));
            Level { size, start }
        };
        let levels = image.levels.iter().map(&mut place).collect();
        Self { image: Arc::clone(image), texels_across: image.texels_across(), texels: texels.into(), levels }
    }
}

impl PreparedTexture {
    /// Makes `image` ready to be read by `sampler`.
    pub(crate) fn new(image: &PreparedImage, sampler: Sampler) -> Self {
        Self { sampler, image: image.clone() }
    }

    /// Whether the decoded texels of both are the same memory.
    #[cfg(test)]
    pub(crate) fn shares_texels(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.image.texels, &other.image.texels)
    }

    /// Where to look for the value at `uv` of a footprint of `width` texture units. Apart from looking, so that many looks
    /// can wait for memory at once.
    #[inline(always)]
    pub(crate) fn locate(&self, uv: Vec2, width: f32) -> Place {
        let PreparedImage { levels, texels_across, .. } = &self.image;
        let Blend { fine, coarse, share, filter } = self.sampler.blend(levels.len(), width * texels_across);
        let (fine, coarse) = (levels[fine], levels[coarse]);
        // The fine one is the larger of the two.
        if fine.start == FINE {
            return Place::Value(self.read_fine(uv, width));
        }
        let first = (fine.start, self.sampler.quad(fine.size, filter, uv));
        if share == 0.0 {
            return Place::One(first);
        }
        Place::Two(first, (coarse.start, self.sampler.quad(coarse.size, filter, uv)), share)
    }

    /// The bits of [`Sampler::sample`] at a place of [`locate`](Self::locate).
    #[inline(always)]
    pub(crate) fn value(&self, place: &Place) -> Vec4 {
        let read = |(start, quad): &(u32, Quad)| quad.value(Decoded(&self.image.texels[*start as usize..]));
        match place {
            Place::Two(fine, coarse, share) => read(fine).lerp(read(coarse), *share),
            Place::One(level) => read(level),
            Place::Value(value) => *value,
        }
    }

    /// Seldom needed, so its code is not among the rest.
    #[inline(never)]
    fn read_fine(&self, uv: Vec2, width: f32) -> Vec4 {
        self.sampler.sample(&self.image.image, uv, width)
    }
}

/// A place in a [`PreparedTexture`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place {
    /// Between two levels, the share of the second.
    Two((u32, Quad), (u32, Quad), f32),
    /// In one level.
    One((u32, Quad)),
    /// In levels that are not decoded: the value itself.
    Value(Vec4),
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
    use crate::{Filter, Wrap};

    #[test]
    fn prepared_textures_read_the_same_bits() {
        // 300 × 70 texels: three levels are too fine to be decoded.
        let byte = |i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as u8;
        let texels: Vec<[u8; 4]> =
            (0..300 * 70).map(|i| [byte(4 * i), byte(4 * i + 1), byte(4 * i + 2), byte(4 * i + 3)]).collect();
        for srgb in [false, true] {
            let image = Arc::new(Image::new(String::new(), 300, 70, texels.clone(), srgb));
            for (wrap, min, mip) in [
                (Wrap::Repeat, Filter::Linear, Some(Filter::Linear)),
                (Wrap::Mirror, Filter::Nearest, Some(Filter::Linear)),
                (Wrap::Clamp, Filter::Linear, Some(Filter::Nearest)),
                (Wrap::Repeat, Filter::Linear, None),
            ] {
                let sampler = Sampler { wrap: [wrap; 2], mag: Filter::Linear, min, mip };
                let prepared = PreparedTexture::new(&PreparedImage::new(&image), sampler);
                for i in 0..2000 {
                    let uv = Vec2::new(i as f32 * 0.0173 - 9.0, i as f32 * -0.0091 + 3.0);
                    let width = libm::exp2f((i % 23) as f32 * 0.5 - 10.0);
                    let value = prepared.value(&prepared.locate(uv, width));
                    assert_eq!(value, sampler.sample(&image, uv, width));
                }
            }
        }
    }
}
