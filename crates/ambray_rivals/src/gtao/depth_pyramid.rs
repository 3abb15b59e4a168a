//! Depth at five resolutions, so that distant samples see what lies around them (XeGTAO's depth MIPs).

use std::borrow::Cow;

use ambray_core::control::{Cancelled, Control};
use glam::IVec2;
use rayon::prelude::*;

use super::falloff::Falloff;
use crate::Screen;

/// Resolutions (`XE_GTAO_DEPTH_MIP_LEVELS`).
pub(super) const LEVELS: usize = 5;

/// Share of the radius within which depths are averaged; found by trying (`XeGTAO_DepthMIPFilter`).
const DEPTH_RANGE: f32 = 0.75;

/// View depths; each level has half the resolution of the one before.
#[derive(Debug)]
pub(crate) struct DepthPyramid<'a> {
    levels: Vec<Level<'a>>,
}

/// Sizes are rounded up, so that texel (x, y) covers pixels 2x and 2x + 1 also where a size is odd (XeGTAO drops the last one).
#[derive(Debug)]
struct Level<'a> {
    width: usize,
    height: usize,
    depths: Cow<'a, [f32]>,
}

impl<'a> DepthPyramid<'a> {
    /// The pyramid of `screen`, for samples with `falloff` (`XeGTAO_PrefilterDepths16x16`).
    pub(crate) fn new(
        screen: &'a Screen,
        falloff: Falloff,
        control: &Control<'_>,
    ) -> Result<Self, Cancelled> {
        let falloff = falloff.scaled(DEPTH_RANGE);
        let (width, height) = screen.size();
        let mut levels = vec![Level { width, height, depths: Cow::Borrowed(screen.depths()) }];
        while levels.len() < LEVELS {
            let coarser = levels[levels.len() - 1].halved(falloff, control)?;
            levels.push(coarser);
        }
        Ok(Self { levels })
    }

    /// Depth at `pixel`, or at the nearest one in the picture.
    pub(crate) fn at(&self, pixel: IVec2, level: usize) -> f32 {
        let Level { width, height, .. } = self.levels[0];
        let x = pixel.x.clamp(0, width as i32 - 1) as usize >> level;
        let y = pixel.y.clamp(0, height as i32 - 1) as usize >> level;
        self.levels[level].depths[y * self.levels[level].width + x]
    }
}

impl Level<'_> {
    fn halved(&self, falloff: Falloff, control: &Control<'_>) -> Result<Level<'static>, Cancelled> {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut depths = vec![0.0; width * height];
        depths.par_chunks_mut(width).enumerate().try_for_each(|(y, row)| {
            control.check()?;
            for (x, out) in row.iter_mut().enumerate() {
                let (right, below) = ((2 * x + 1).min(self.width - 1), (2 * y + 1).min(self.height - 1));
                let depth = |x: usize, y: usize| self.depths[y * self.width + x];
                *out = far_mean(
                    [depth(2 * x, 2 * y), depth(right, 2 * y), depth(2 * x, below), depth(right, below)],
                    falloff,
                );
            }
            Ok(())
        })?;
        Ok(Level { width, height, depths: Cow::Owned(depths) })
    }
}

/// Mean of the depths near the farthest one, which thin things in front of it do not change (`XeGTAO_DepthMIPFilter`).
fn far_mean(depths: [f32; 4], falloff: Falloff) -> f32 {
    let farthest = depths.into_iter().fold(f32::NEG_INFINITY, f32::max);
    if farthest.is_infinite() {
        return farthest;
    }
    let weights = depths.map(|depth| falloff.weight(farthest - depth));
    let sum: f32 = weights.iter().zip(depths).map(|(weight, depth)| weight * depth).sum();
    sum / weights.iter().sum::<f32>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FALLOFF: Falloff = Falloff { radius: 1.0, range: 0.5 };

    #[test]
    fn depths_are_averaged_unless_they_are_far_in_front() {
        assert_eq!(far_mean([2.0, 2.25, 2.5, 2.25], FALLOFF), 2.25);
        assert_eq!(far_mean([1.0, 3.0, 3.0, 3.0], FALLOFF), 3.0);
        // 0.75 in front of the farthest, half of the range into the fall: weight 0.5.
        assert_eq!(far_mean([2.25, 3.0, 3.0, 3.0], FALLOFF), (0.5 * 2.25 + 9.0) / 3.5);
        assert_eq!(far_mean([2.0, f32::INFINITY, 2.0, 2.0], FALLOFF), f32::INFINITY);
    }

    #[test]
    fn odd_sizes_are_rounded_up() {
        let finest = Level {
            width: 3,
            height: 3,
            depths: Cow::Owned((0..9).map(|i| 9.0 + 0.01 * i as f32).collect()),
        };
        let coarser = finest.halved(FALLOFF, &Control::default()).unwrap();
        assert_eq!((coarser.width, coarser.height), (2, 2));
        let expected = [9.02, 9.035, 9.065, 9.08];
        for (depth, expected) in coarser.depths.iter().zip(expected) {
            assert!((depth - expected).abs() < 1e-5, "{depth} for {expected}");
        }
    }
}
