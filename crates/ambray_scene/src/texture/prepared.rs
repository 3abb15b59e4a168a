//! Textures made ready for many reads over wide footprints.

use std::sync::Arc;

use glam::{Vec2, Vec4};

use super::{
    Filter, Image, ImageLevel, Sampler,
    lookup::{Encoded, Texels},
};

/// Texels of the largest level that is kept decoded. Bounced light reads footprints of a tenth of the radius and more, which
/// is this level or a smaller one for all but the closest hits; 64 × 64 texels are 64 KiB, all levels below another third.
const DECODED_TEXELS: usize = 64 * 64;

/// A texture whose coarse levels are decoded.
#[derive(Debug)]
pub(crate) struct PreparedTexture {
    image: Arc<Image>,
    sampler: Sampler,
    texels_across: f32,
    /// The coarse levels' texels, linear, level after level.
    texels: Vec<Vec4>,
    levels: Vec<Level>,
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

impl PreparedTexture {
    /// Makes `image` ready to be read by `sampler`.
    pub(crate) fn new(image: &Arc<Image>, sampler: Sampler) -> Self {
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
        Self { image: Arc::clone(image), sampler, texels_across: image.texels_across(), texels, levels }
    }

    /// The bits of [`Sampler::sample`].
    #[inline(always)]
    pub(crate) fn sample(&self, uv: Vec2, width: f32) -> Vec4 {
        let blend = self.sampler.blend(self.levels.len(), width * self.texels_across);
        let fine = self.read(blend.fine, blend.filter, uv);
        if blend.share == 0.0 {
            return fine;
        }
        fine.lerp(self.read(blend.coarse, blend.filter, uv), blend.share)
    }

    #[inline(always)]
    fn read(&self, level: usize, filter: Filter, uv: Vec2) -> Vec4 {
        let Level { size, start } = self.levels[level];
        if start == FINE {
            return self.read_fine(&self.image.levels[level], filter, uv);
        }
        let decoded = Decoded { size, texels: &self.texels[start as usize..] };
        self.sampler.between_texels(decoded, filter, uv)
    }

    /// Seldom needed, so its code is not among the rest.
    #[inline(never)]
    fn read_fine(&self, level: &ImageLevel, filter: Filter, uv: Vec2) -> Vec4 {
        self.sampler.between_texels(Encoded::<true>::of(level, self.image.decoder()), filter, uv)
    }
}

/// Decoded texels of a level, and of those after it.
struct Decoded<'a> {
    size: (u32, u32),
    texels: &'a [Vec4],
}

impl Texels for Decoded<'_> {
    #[inline(always)]
    fn size(&self) -> (u32, u32) {
        self.size
    }

    #[inline(always)]
    fn texel(&self, i: usize) -> Vec4 {
        self.texels[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Wrap;

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
                let prepared = PreparedTexture::new(&image, sampler);
                for i in 0..2000 {
                    let uv = Vec2::new(i as f32 * 0.0173 - 9.0, i as f32 * -0.0091 + 3.0);
                    let width = libm::exp2f((i % 23) as f32 * 0.5 - 10.0);
                    assert_eq!(prepared.sample(uv, width), sampler.sample(&image, uv, width));
                }
            }
        }
    }
}
