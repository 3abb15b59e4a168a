//! Ambient occlusion by a visibility bitmask: what is behind a thin thing is open.
//!
//! O. Therrien, Y. Levesque, G. Gilet, *Screen Space Indirect Lighting with Visibility Bitmask* (The Visual Computer 2023), §3.1
//! and Algorithm 1. Slices are searched as by [`Gtao`](crate::Gtao), but instead of two horizons each has 32 sectors of
//! even angle around the normal. Every sample is taken for the front of something of constant thickness, and closes the
//! sectors between its front and its back.
//!
//! As published, there is no falloff, and open sectors are counted (line 26): neither the cosine nor the crowding of slices at the
//! viewing ray is weighed, as GTAO does in its integral. So values are those of rays only where everything is open or closed.
//! A sector at the horizon counts as much as any other, so samples that are a little wrong darken oblique surfaces by some
//! hundredths.

use std::f32::consts::PI;

use ambray_core::{
    control::{Cancelled, Control},
    settings::{Auto, ScreenQuality, Settings},
};
use glam::Vec3;

use crate::{
    Screen, SliceSampling,
    gtao::{
        FALLOFF_RANGE,
        denoise::denoise,
        falloff::Falloff,
        march::{Border, March, Receiver},
        slice::Slice,
    },
};

/// Sectors of a slice (§3.3: "32 sectors gave good quality").
const SECTORS: u32 = u32::BITS;

/// Ambient occlusion by a visibility bitmask.
#[derive(Clone, Debug, PartialEq)]
pub struct Bitmask {
    /// Slices and steps.
    pub sampling: SliceSampling,
    /// Thickness t of everything that is seen, scene units, or auto: a quarter of the radius.
    pub thickness: Auto<f32>,
    /// Passes of GTAO's denoiser.
    pub denoise_passes: u32,
}

impl Bitmask {
    /// The numbers of samples that were published: one slice with 16 samples on each side (figure 10, table 1); the other
    /// qualities have fewer samples, or the most slices that the authors' SSRT3 offers.
    ///
    /// Steps are even (Algorithm 1, line 6) and jittered (§5). They end at the border of the picture, as SSRT3's do; noise and
    /// depth pyramid are GTAO's.
    #[must_use]
    pub fn of(settings: &Settings) -> Self {
        let (slices, steps) = match settings.screen_quality {
            ScreenQuality::Low => (1, 4),
            ScreenQuality::Medium => (1, 8),
            ScreenQuality::High => (1, 16),
            ScreenQuality::Ultra => (4, 16),
        };
        Self {
            sampling: SliceSampling { distribution_power: 1.0, ..SliceSampling::new(slices, steps) },
            thickness: settings.thickness.clone(),
            denoise_passes: 1,
        }
    }

    /// Openness of every pixel before the denoiser, 1 = open; 1 where nothing is seen.
    pub fn estimate(&self, screen: &Screen, control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
        let thickness = self.thickness.unwrap_or(0.25 * screen.radius);
        // Thickness takes the place of a falloff: this one is for the depth pyramid alone.
        let falloff = Falloff { radius: screen.radius, range: FALLOFF_RANGE * screen.radius };
        let march = March::new(screen, self.sampling, Border::Open, falloff, control)?;
        screen.map(control, |x, y| self.openness(&march, thickness, march.receiver(x, y)))
    }

    /// `raw` after GTAO's denoiser, as the authors filter it (§4.1).
    pub fn filter(&self, screen: &Screen, raw: &[f32], control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
        denoise(screen, raw, self.denoise_passes, control)
    }

    /// Share of open sectors (Algorithm 1, lines 9 to 28).
    fn openness(&self, march: &March<'_>, thickness: f32, receiver: Receiver) -> f32 {
        let open: u32 = march
            .slices(receiver)
            .map(|(index, slice)| {
                let samples = march.steps(receiver, index, slice);
                closed_sectors(samples, slice, receiver.viewer, thickness).count_zeros()
            })
            .sum();
        open as f32 / (self.sampling.slices * SECTORS) as f32
    }
}

/// The sectors of a slice that `samples` close (Algorithm 1, lines 13 to 25).
fn closed_sectors(
    samples: impl Iterator<Item = [Option<Vec3>; 2]>,
    slice: Slice,
    viewer: Vec3,
    thickness: f32,
) -> u32 {
    let mut closed = 0;
    for pair in samples {
        for (to_sample, side) in pair.into_iter().zip([1.0, -1.0]) {
            let Some(front) = to_sample else { continue };
            let back = front - thickness * viewer;
            let [front, back] = [front, back].map(|point| {
                let cosine = (point.dot(viewer) / point.length()).clamp(-1.0, 1.0);
                let angle = side * libm::acosf(cosine) - slice.normal_angle;
                (angle / PI + 0.5).clamp(0.0, 1.0) * SECTORS as f32
            });
            closed |= sectors_between(front.min(back), front.max(back));
        }
    }
    closed
}

/// The sectors of which at least half is between two places, in sectors from the first one's start (§3.1, the "round" criterion).
///
/// So a sample narrower than half a sector, thin or far away, closes nothing. The authors' shader rounds up instead, which closes
/// sectors that are only touched.
fn sectors_between(from: f32, to: f32) -> u32 {
    if to - from < 0.5 {
        return 0;
    }
    let (first, end) = ((from - 0.5).ceil() as u32, (to + 0.5).floor() as u32);
    ((1_u64 << end) - (1_u64 << first)) as u32
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_4;

    use super::*;

    #[test]
    fn a_sector_is_closed_from_half_of_it_on() {
        let cases = [
            ((0.0, 32.0), u32::MAX),
            ((3.0, 5.0), 0b11 << 3),
            ((3.4, 5.6), 0b111 << 3),
            ((3.6, 5.4), 0b1 << 4),
            // Within one sector, less than half of it and more; across a border.
            ((3.3, 3.7), 0),
            ((3.2, 3.8), 0b1 << 3),
            ((3.7, 4.3), 0),
            ((31.5, 32.0), 1 << 31),
            ((31.6, 32.0), 0),
            ((7.0, 7.0), 0),
        ];
        for ((from, to), expected) in cases {
            assert_eq!(sectors_between(from, to), expected, "{from} to {to}");
        }
        // Of many random places, against the criterion word for word.
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..10_000 {
            let (a, b) = (32.0 * random.f32(), 32.0 * random.f32());
            let (from, to) = (a.min(b), a.max(b));
            let covered = |i: f32| to.min(i + 1.0) - from.max(i);
            let expected = (0..32).filter(|i| covered(*i as f32) >= 0.5).fold(0, |bits, i| bits | 1 << i);
            assert_eq!(sectors_between(from, to), expected, "{from} to {to}");
        }
    }

    #[test]
    fn a_sample_closes_what_is_between_its_front_and_its_back() {
        // Straight on: the front at 45° ahead, the back, √½ deeper, at 90°, the horizon. A quarter of the sectors at the end.
        let slice = Slice { direction: glam::Vec2::X, normal_angle: 0.0, normal_length: 1.0 };
        let front = Vec3::new(1.0, 0.0, -1.0) * 0.5_f32.sqrt();
        let closed = |pair, slice| closed_sectors(std::iter::once(pair), slice, Vec3::NEG_Z, 0.5_f32.sqrt());
        assert_eq!(closed([Some(front), None], slice), 0xff00_0000);
        // The same on the other side.
        assert_eq!(closed([None, Some(front * Vec3::new(-1.0, 1.0, 1.0))], slice), 0x0000_00ff);
        // With the normal turned towards the sample, both are eight sectors nearer to the middle.
        let turned = Slice { normal_angle: FRAC_PI_4, ..slice };
        assert_eq!(closed([Some(front), None], turned), 0x00ff_0000);
        assert_eq!(closed([None, None], slice), 0);
    }
}
