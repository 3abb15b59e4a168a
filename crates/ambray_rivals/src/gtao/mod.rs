//! GTAO: ground-truth ambient occlusion as XeGTAO has it.
//!
//! J. Jimenez, X. Wu, A. Pesce, A. Jarabo, *Practical Real-Time Strategies for Accurate Indirect Occlusion* (SIGGRAPH 2016
//! course notes), in the version of F. Strugar and S. McCalla, *XeGTAO* 1.30 (Intel, 2021), whose function names stand beside
//! ours. The hemisphere is cut into slices through the viewing ray. In each, the depth buffer is searched on both sides for the
//! highest horizon, and what is open between the two is integrated in closed form, with its cosine.
//!
//! What differs from XeGTAO: inverse cosines are exact where it has polynomials, values are floats where it stores 8 bits, nothing
//! (the sky) is skipped where it is far away, and pyramids of odd sizes are rounded up.

pub(crate) mod denoise;
mod depth_pyramid;
pub(crate) mod falloff;
pub(crate) mod march;
mod noise;
pub(crate) mod slice;

use ambray_core::{
    control::{Cancelled, Control},
    settings::{ScreenQuality, Settings},
};
use glam::Vec3;

use crate::Screen;
use falloff::Falloff;
pub use march::SliceSampling;
use march::{Border, March, Receiver};
use slice::{Slice, visible_arc};

/// Least openness: what is seen is not closed (`XeGTAO_MainPass`).
const LEAST: f32 = 0.03;

/// Greatest openness before the denoiser (`XE_GTAO_OCCLUSION_TERM_SCALE`).
const GREATEST: f32 = 1.5;

/// Outer share of the radius over which samples lose their weight (`XE_GTAO_DEFAULT_FALLOFF_RANGE`).
pub(crate) const FALLOFF_RANGE: f32 = 0.615;

/// Ground-truth ambient occlusion; the defaults are XeGTAO's, tuned by its authors to match rays on their scenes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gtao {
    /// Slices and steps.
    pub sampling: SliceSampling,
    /// Radius of the method over that of rays, to make up for what the depth buffer does not show.
    pub radius_multiplier: f32,
    /// Outer share of the radius over which samples lose their weight.
    pub falloff_range: f32,
    /// By how much more depth counts in the distance that makes samples lose weight: against thin blockers taken as thick.
    pub thin_occluder_compensation: f32,
    /// How far slices are weighted evenly rather than by the length of the projected normal: against darkening of steep slopes.
    pub slope_correction: f32,
    /// Exponent of the result.
    pub final_power: f32,
    /// Passes of the denoiser: 1 is "sharp", 3 is "soft".
    pub denoise_passes: u32,
}

impl Gtao {
    /// XeGTAO's quality levels and defaults (`GTAOSettings`, `CSGTAOLow` to `CSGTAOUltra`).
    #[must_use]
    pub const fn of(settings: &Settings) -> Self {
        let (slices, steps) = match settings.screen_quality {
            ScreenQuality::Low => (1, 2),
            ScreenQuality::Medium => (2, 2),
            ScreenQuality::High => (3, 3),
            ScreenQuality::Ultra => (9, 3),
        };
        Self {
            sampling: SliceSampling::new(slices, steps),
            radius_multiplier: 1.457,
            falloff_range: FALLOFF_RANGE,
            thin_occluder_compensation: 0.0,
            slope_correction: 0.05,
            final_power: 2.2,
            denoise_passes: 1,
        }
    }

    /// Openness of every pixel before the denoiser, 1 = open; 1 where nothing is seen.
    ///
    /// As few slices do not weigh every normal right, single pixels may be above 1, up to 1.5: the denoiser averages that away.
    pub fn estimate(&self, screen: &Screen, control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
        let radius = self.radius_multiplier * screen.radius;
        let falloff = Falloff { radius, range: self.falloff_range * radius };
        let march = March::new(screen, self.sampling, Border::Extended, falloff, control)?;
        screen.map(control, |x, y| self.openness(&march, falloff, march.receiver(x, y)))
    }

    /// `raw` after XeGTAO's denoiser, at most 1.
    pub fn filter(&self, screen: &Screen, raw: &[f32], control: &Control<'_>) -> Result<Vec<f32>, Cancelled> {
        denoise::denoise(screen, raw, self.denoise_passes, control)
    }

    fn openness(&self, march: &March<'_>, falloff: Falloff, receiver: Receiver) -> f32 {
        let open: f32 = march
            .slices(receiver)
            .map(|(index, slice)| {
                let horizons = self.horizons(march.steps(receiver, index, slice), slice, receiver, falloff);
                let weight = slice.normal_length + self.slope_correction * (1.0 - slice.normal_length);
                weight * visible_arc(horizons, slice.normal_angle)
            })
            .sum();
        // Where the radius is a few pixels there is not much to find: fades towards open.
        let fade = 0.5 * ((10.0 - receiver.radius_pixels) / 100.0).clamp(0.0, 1.0);
        let visibility = (open + fade) / self.sampling.slices as f32;
        libm::powf(visibility.max(0.0), self.final_power).clamp(LEAST, GREATEST)
    }

    /// The horizons h1 ≤ 0 ≤ h2 of a slice among `samples` (Jimenez et al. 2016, Algorithm 1, lines 17 to 27).
    fn horizons(
        &self,
        samples: impl Iterator<Item = [Option<Vec3>; 2]>,
        slice: Slice,
        receiver: Receiver,
        falloff: Falloff,
    ) -> [f32; 2] {
        // Where the hemisphere of the normal ends: cos(γ ± π/2), in place of the paper's −1.
        let sin = libm::sinf(slice.normal_angle);
        let lowest = [-sin, sin];
        let mut highest = lowest;
        for pair in samples {
            for side in 0..2 {
                let Some(to_sample) = pair[side] else { continue };
                let cosine = to_sample.dot(receiver.viewer) / to_sample.length();
                // Lowered with the weight of the sample; XeGTAO does so with cosines, as angles would cost more.
                let weight = falloff.weight(self.falloff_distance(to_sample));
                let cosine = lowest[side] + weight * (cosine - lowest[side]);
                highest[side] = highest[side].max(cosine);
            }
        }
        let [ahead, behind] = highest.map(|cosine| libm::acosf(cosine.clamp(-1.0, 1.0)));
        [-behind, ahead]
    }

    /// Distance of a sample as the falloff sees it: in depth more than across.
    fn falloff_distance(&self, to_sample: Vec3) -> f32 {
        (to_sample * Vec3::new(1.0, 1.0, 1.0 + self.thin_occluder_compensation)).length()
    }
}
