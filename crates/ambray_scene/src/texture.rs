//! Images, samplers and texture lookups.

mod looks;
mod lookup;
mod mask;
mod prepared;
mod taps;

use crate::{mip, srgb};

pub(crate) use looks::Looks;
pub(crate) use mask::{AlphaPlane, Mask};
pub(crate) use prepared::{PreparedImage, PreparedTexture};

/// A decoded image with its mip chain, RGBA with 8 bits a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Name or URI in the file, may be empty.
    pub name: String,
    /// Mip levels, the full image first, each half the size of the one before, down to 1×1.
    pub levels: Vec<ImageLevel>,
    /// Whether the colour channels are sRGB-encoded (base colour, emission) or linear (normal maps).
    pub srgb: bool,
}

/// One level of an [`Image`].
#[derive(Clone, Debug, PartialEq)]
pub struct ImageLevel {
    /// Width in texels, at least 1 and below 2²³.
    pub width: u32,
    /// Height in texels, at least 1 and below 2²³.
    pub height: u32,
    /// Texels row by row from the top, RGBA.
    pub texels: Vec<[u8; 4]>,
}

/// An image with a way to read it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Index into [`Scene::images`](crate::Scene::images).
    pub image: u32,
    /// How it is read.
    pub sampler: Sampler,
}

/// glTF sampler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampler {
    /// Wrapping of u and v.
    pub wrap: [Wrap; 2],
    /// Filter between texels where the texture is magnified.
    pub mag: Filter,
    /// Filter between texels where the texture is minified.
    pub min: Filter,
    /// Filter between mip levels; `None` reads level 0 alone.
    pub mip: Option<Filter>,
}

impl Default for Sampler {
    fn default() -> Self {
        Self { wrap: [Wrap::Repeat; 2], mag: Filter::Linear, min: Filter::Linear, mip: Some(Filter::Linear) }
    }
}

/// Linear value in `[0, 1]` of each sRGB byte (IEC 61966-2-1): for backends that decode texels themselves.
#[must_use]
pub fn srgb_values() -> &'static [f32; 256] {
    srgb::decoded()
}

/// What happens outside `[0, 1]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// Tiles the plane.
    #[default]
    Repeat,
    /// Tiles the plane, every second tile mirrored.
    Mirror,
    /// Repeats the texels of the edge.
    Clamp,
}

/// Nearest or (bi)linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The closest texel or level.
    Nearest,
    /// Linear interpolation.
    #[default]
    Linear,
}

impl Image {
    /// Builds the mip chain over `texels` (row by row from the top) of a `width` × `height` image.
    ///
    /// Levels of sRGB images are averaged in linear light and weighted by alpha, others as they are.
    ///
    /// # Panics
    /// If `texels` does not hold `width` × `height` entries, or if a side is zero or has 2²³ texels or more.
    #[must_use]
    pub fn new(name: String, width: u32, height: u32, texels: Vec<[u8; 4]>, srgb: bool) -> Self {
        let is_side = |side: u32| (1..1 << 23).contains(&side);
        let count = width as usize * height as usize;
        assert!(is_side(width) && is_side(height) && texels.len() == count, "image size");
        let mut levels = vec![ImageLevel { width, height, texels }];
        while let Some(last) = levels.last().filter(|last| last.width.max(last.height) > 1) {
            let next = mip::half(last, srgb);
            levels.push(next);
        }
        Self { name, levels, srgb }
    }

    /// Smallest alpha of the full image, in [0, 1]: 1 for opaque images.
    #[must_use]
    pub fn least_alpha(&self) -> f32 {
        let least = self.levels[0].texels.iter().map(|texel| texel[3]).min();
        f32::from(least.unwrap_or(255)) / 255.0
    }

    /// Root of the number of texels of the full image: footprints are roots of areas.
    fn texels_across(&self) -> f32 {
        let full = &self.levels[0];
        (full.width as f32 * full.height as f32).sqrt()
    }

    /// What the bytes of the colour channels mean.
    fn decoder(&self) -> &'static [f32; 256] {
        if self.srgb { srgb::decoded() } else { &srgb::UNIT }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec4};

    /// A row of linear greys in red; the other channels are 0 and alpha 255.
    fn row(reds: &[u8]) -> Image {
        let texels = reds.iter().map(|&r| [r, 0, 0, 255]).collect();
        Image::new(String::new(), reds.len() as u32, 1, texels, false)
    }

    #[track_caller]
    fn check(wrap: Wrap, filter: Filter, u: f32, expected: f32) {
        let sampler = Sampler { wrap: [wrap; 2], mag: filter, min: filter, mip: None };
        let red = sampler.sample(&row(&[0, 51, 102, 255]), Vec2::new(u, 0.5), 0.0).x;
        assert!((red - expected).abs() < 1e-5, "{red} where {expected} was expected");
    }

    #[test]
    fn texel_centres_and_borders() {
        use {Filter::*, Wrap::*};
        // Texels 0, 0.2, 0.4, 1 with centres at 1/8, 3/8, 5/8, 7/8.
        check(Repeat, Linear, 0.125, 0.0);
        check(Repeat, Linear, 0.25, 0.1);
        check(Repeat, Linear, 0.625, 0.4);
        check(Repeat, Linear, 0.0, 0.5); // halfway between the last and the first
        check(Repeat, Linear, 1.0, 0.5);
        check(Repeat, Linear, -0.125, 1.0);
        check(Repeat, Linear, 1000.375, 0.2);
        check(Mirror, Linear, 1.0, 1.0); // the last and its own reflection
        check(Mirror, Linear, 1.25, 0.7);
        check(Mirror, Linear, 0.0, 0.0);
        check(Mirror, Linear, -0.25, 0.1);
        check(Clamp, Linear, -5.0, 0.0);
        check(Clamp, Linear, 1.0, 1.0);
        check(Clamp, Linear, 0.75, 0.7);
        check(Repeat, Nearest, 0.0, 0.0);
        check(Repeat, Nearest, 0.249, 0.0);
        check(Repeat, Nearest, 0.25, 0.2);
        check(Repeat, Nearest, 1.0, 0.0);
        check(Repeat, Nearest, -1e-9, 0.0); // 1 - 1e-9 rounds to 1, the next tile
        check(Clamp, Nearest, 1.0, 1.0);
        check(Mirror, Nearest, 1.1, 1.0);
        check(Mirror, Nearest, 2.0, 0.0);
    }

    #[test]
    fn odd_coordinates_are_harmless() {
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            let sampler = Sampler { wrap: [wrap; 2], ..Sampler::default() };
            for u in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e-40, -1e-40] {
                for width in [0.0, f32::NAN, f32::INFINITY, -1.0, 1e-40, 0.3] {
                    let image = row(&[1, 2, 3]);
                    assert!(sampler.sample(&image, Vec2::new(u, u), width).is_finite());
                    assert_eq!(sampler.alpha_at(&image, Vec2::new(u, u)), 1.0);
                }
            }
        }
    }

    #[test]
    fn footprint_chooses_the_level() {
        // A square image whose rows are alike, so that levels along u are those of the row.
        let grey = |i: u8| if i % 8 < 4 { 0 } else { 200 };
        let texels = (0..64).map(|i| [grey(i), grey(i), grey(i), 255]).collect();
        let image = Image::new(String::new(), 8, 8, texels, false);
        assert_eq!(image.levels.len(), 4);
        let uv = Vec2::new(0.0625, 0.5); // centre of the first texel of a row
        let red = |mip, width: f32| {
            let sampler = Sampler { wrap: [Wrap::Clamp; 2], mip, ..Sampler::default() };
            sampler.sample(&image, uv, width).x * 255.0
        };
        let linear = Some(Filter::Linear);
        assert!(red(linear, 0.125).abs() < 1e-3);
        assert!((red(linear, 1.0) - 100.0).abs() < 1e-3, "the whole image");
        assert!((red(linear, f32::INFINITY) - 100.0).abs() < 1e-3);
        // Level 2.5: halfway between level 2 (0, 200; clamped to 0 at this place) and level 3 (100).
        assert!((red(linear, 2f32.powf(2.5) / 8.0) - 50.0).abs() < 1e-2);
        assert_eq!(red(Some(Filter::Nearest), 2f32.powf(2.4) / 8.0), 0.0);
        assert!((red(Some(Filter::Nearest), 2f32.powf(2.6) / 8.0) - 100.0).abs() < 1e-3);
        assert_eq!(red(None, 1.0), 0.0);
    }

    /// Whatever the aspect of the image, a footprint of one texel reads one texel.
    #[test]
    fn a_footprint_of_one_texel_is_not_blurred() {
        for (width, height) in [(16_u32, 16_u32), (256, 16), (16, 256)] {
            let stripe = |i: u32| [if (i % width).is_multiple_of(2) { 255 } else { 0 }, 0, 0, 255];
            let image =
                Image::new(String::new(), width, height, (0..width * height).map(stripe).collect(), false);
            let uv = Vec2::new(2.5 / width as f32, 2.5 / height as f32);
            let texel = 1.0 / (width as f32 * height as f32).sqrt();
            let red = Sampler::default().sample(&image, uv, texel).x;
            assert!((red - 1.0).abs() < 1e-3, "{width} × {height}: {red}");
        }
    }

    #[test]
    fn srgb_is_decoded_before_filtering() {
        let texels = vec![[0, 0, 0, 255], [255, 255, 255, 0]];
        let image = Image::new(String::new(), 2, 1, texels, true);
        let middle = Sampler::default().sample(&image, Vec2::splat(0.5), 0.0);
        assert!(middle.abs_diff_eq(Vec4::splat(0.5), 1e-6));
        assert!((Sampler::default().alpha_at(&image, Vec2::splat(0.5)) - 0.5).abs() < 1e-6);
        let nearest = Sampler { mag: Filter::Nearest, ..Sampler::default() };
        assert_eq!(nearest.alpha_at(&image, Vec2::new(0.9, 0.5)), 0.0);
    }
}
