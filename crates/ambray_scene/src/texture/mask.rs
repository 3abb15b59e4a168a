//! The alpha of an image, apart from its colours: rays that ask where something is read less memory.

use std::sync::Arc;

use glam::Vec2;

use super::{
    Image, Sampler,
    taps::{Axis, Taps},
};
use crate::srgb;

/// The alpha of the full image, row by row from the top. Clones share it.
#[derive(Clone, Debug)]
pub(crate) struct AlphaPlane {
    size: [i32; 2],
    alphas: Arc<[u8]>,
}

/// An alpha plane with a way to read it.
#[derive(Clone, Debug)]
pub(crate) struct Mask {
    plane: AlphaPlane,
    axes: [Axis; 2],
    /// Whether it repeats along both axes.
    is_tiled: bool,
    /// See [`Axis::taps`].
    half: f32,
}

impl AlphaPlane {
    /// That of `image`.
    pub(crate) fn of(image: &Image) -> Self {
        let full = &image.levels[0];
        let alphas = full.texels.iter().map(|texel| texel[3]).collect();
        Self { size: [full.width as i32, full.height as i32], alphas }
    }
}

impl Mask {
    pub(crate) fn new(plane: &AlphaPlane, sampler: &Sampler) -> Self {
        let axes = sampler.wrap.map(Axis::of);
        let is_tiled = axes == [Axis::REPEAT; 2];
        Self { plane: plane.clone(), axes, is_tiled, half: sampler.mag.half() }
    }

    /// The bits of [`Sampler::alpha_at`].
    #[inline(always)]
    pub(crate) fn at(&self, uv: Vec2) -> f32 {
        let AlphaPlane { size, alphas } = &self.plane;
        let read = |axes: [Axis; 2]| interpolated(*size, axes, self.half, uv, |texel| alphas[texel]);
        // Nearly all are tiled, and with constants most of the arithmetic is gone.
        if self.is_tiled { read([Axis::REPEAT; 2]) } else { read(self.axes) }
    }
}

/// The alpha at `uv` of an image, whose texels' `alpha` is given.
#[inline(always)]
pub(super) fn interpolated(
    size: [i32; 2],
    axes: [Axis; 2],
    half: f32,
    uv: Vec2,
    alpha: impl Fn(usize) -> u8,
) -> f32 {
    let taps = |axis: usize| axes[axis].taps(axes[axis].reduced(uv[axis]), size[axis], half);
    let [u, v]: [Taps; 2] = [taps(0), taps(1)];
    let row = |row: i32| {
        let start = row as usize * size[0] as usize;
        let alpha = |column: i32| srgb::UNIT[usize::from(alpha(start + column as usize))];
        lerp(alpha(u.first), alpha(u.second), u.share)
    };
    lerp(row(v.first), row(v.second), v.share)
}

#[inline(always)]
fn lerp(a: f32, b: f32, share: f32) -> f32 {
    a + (b - a) * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Filter, Wrap};

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
