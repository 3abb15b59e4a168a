//! The march along slices through the depth buffer, which GTAO and the visibility bitmask share.

use std::f32::consts::PI;

use ambray_core::{
    camera::{Camera, Projection},
    control::{Cancelled, Control},
};
use glam::{IVec2, Vec2, Vec3};

use super::{
    depth_pyramid::{DepthPyramid, LEVELS},
    falloff::Falloff,
    noise::spatio_temporal_noise,
    slice::Slice,
};
use crate::Screen;

/// How slices are placed, and samples along them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceSampling {
    /// Slices a pixel, at least 1.
    pub slices: u32,
    /// Samples to either side of a slice, at least 1.
    pub steps: u32,
    /// Exponent of the places along a slice: 1 is even, more gathers them near the pixel.
    pub distribution_power: f32,
    /// Binary logarithm of the distance, in pixels, up to which samples read the depth buffer at full resolution.
    pub depth_mip_offset: f32,
}

impl SliceSampling {
    /// XeGTAO's defaults with so many slices and steps (`XE_GTAO_DEFAULT_SAMPLE_DISTRIBUTION_POWER`,
    /// `XE_GTAO_DEFAULT_DEPTH_MIP_SAMPLING_OFFSET`).
    pub(crate) const fn new(slices: u32, steps: u32) -> Self {
        Self { slices, steps, distribution_power: 2.0, depth_mip_offset: 3.3 }
    }
}

/// What is beside the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Border {
    /// The depth of the nearest pixel in it, as XeGTAO's sampler clamps.
    Extended,
    /// Nothing.
    Open,
}

/// The point that is shaded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receiver {
    pixel: IVec2,
    position: Vec3,
    /// Unit vector to the viewer, view space.
    pub(crate) viewer: Vec3,
    normal: Vec3,
    /// The radius at its depth, pixels.
    pub(crate) radius_pixels: f32,
    noise: Vec2,
}

/// A screen made ready for marching.
#[derive(Debug)]
pub(crate) struct March<'a> {
    screen: &'a Screen,
    depths: DepthPyramid<'a>,
    sampling: SliceSampling,
    border: Border,
    /// Where samples end, scene units.
    radius: f32,
}

impl<'a> March<'a> {
    /// Samples up to the radius of `falloff`.
    pub(crate) fn new(
        screen: &'a Screen,
        sampling: SliceSampling,
        border: Border,
        falloff: Falloff,
        control: &Control<'_>,
    ) -> Result<Self, Cancelled> {
        let depths = DepthPyramid::new(screen, falloff, control)?;
        Ok(Self { screen, depths, sampling, border, radius: falloff.radius })
    }

    /// The point seen at pixel (x, y), which sees something.
    pub(crate) fn receiver(&self, x: usize, y: usize) -> Receiver {
        // Towards the viewer by what the depth may be wrong, so that a surface does not block itself
        // (`XeGTAO_MainPass`: this factor is for depths of 32 bits).
        const BIAS: f32 = 1e-5;
        let camera = self.screen.camera();
        let depth = self.screen.depths()[y * self.screen.size().0 + x];
        let depth = depth - BIAS * view_distance(camera, depth);
        let position = self.screen.unproject(Vec2::new(x as f32, y as f32), depth);
        Receiver {
            pixel: IVec2::new(x as i32, y as i32),
            position,
            viewer: self.screen.towards_viewer(position),
            normal: self.screen.normal(x, y),
            radius_pixels: self.radius / camera.footprint(depth),
            noise: spatio_temporal_noise(x as u32, y as u32, self.screen.frame, self.screen.seed),
        }
    }

    /// The slices of `receiver` with their numbers, evenly over half a turn (Jimenez et al. 2016, Algorithm 1, lines 5 and 6).
    pub(crate) fn slices(&self, receiver: Receiver) -> impl Iterator<Item = (u32, Slice)> {
        let count = self.sampling.slices;
        (0..count).map(move |i| {
            let azimuth = (i as f32 + receiver.noise.x) / count as f32 * PI;
            (i, Slice::new(azimuth, receiver.viewer, receiver.normal))
        })
    }

    /// From `receiver` to the samples on both sides of its slice number `index`: first the one in the slice's direction, then
    /// the one opposite. `None` where nothing is seen.
    pub(crate) fn steps(
        &self,
        receiver: Receiver,
        index: u32,
        slice: Slice,
    ) -> impl Iterator<Item = [Option<Vec3>; 2]> {
        (0..self.sampling.steps).map(move |step| {
            let offset = self.distance(receiver, index, step) * slice.direction;
            // Not beyond the coarsest level, though XeGTAO clamps to one more, which its sampler does not have.
            let level = libm::log2f(offset.length()) - self.sampling.depth_mip_offset;
            let level = level.round_ties_even().clamp(0.0, (LEVELS - 1) as f32) as usize;
            // To the centre of a pixel, whose depth is known. It is a little beside the slice then: an oblique plane is darkened
            // by about a hundredth.
            let offset = Vec2::new(offset.x.round_ties_even(), offset.y.round_ties_even()).as_ivec2();
            [offset, -offset].map(|offset| self.sample(receiver, offset, level))
        })
    }

    /// Distance of a sample from its pixel, pixels (Algorithm 1, line 20, with noise).
    fn distance(&self, receiver: Receiver, slice: u32, step: u32) -> f32 {
        /// Distance below which a sample could be the pixel itself, pixels (`pixelTooCloseThreshold`).
        const NEAREST: f32 = 1.3;
        /// Step of the R1 sequence (Roberts 2018): the inverse of the golden ratio.
        const GOLDEN: f32 = 0.618_034;
        let SliceSampling { steps, distribution_power, .. } = self.sampling;
        let shift = (receiver.noise.y + (slice + step * steps) as f32 * GOLDEN).fract();
        let share = (step as f32 + shift) / steps as f32;
        NEAREST + power(share, distribution_power) * receiver.radius_pixels
    }

    fn sample(&self, receiver: Receiver, offset: IVec2, level: usize) -> Option<Vec3> {
        let pixel =
            IVec2::new(receiver.pixel.x.saturating_add(offset.x), receiver.pixel.y.saturating_add(offset.y));
        let depth = self.depths.at(pixel, level);
        let is_seen = depth.is_finite()
            && (matches!(self.border, Border::Extended) || self.screen.depth_at(pixel.x, pixel.y).is_some());
        is_seen.then(|| self.screen.unproject(pixel.as_vec2(), depth) - receiver.position)
    }
}

/// x^exponent; the usual square without a call.
fn power(x: f32, exponent: f32) -> f32 {
    if exponent == 2.0 { x * x } else { libm::powf(x, exponent) }
}

/// What XeGTAO's thresholds relative to depth are relative to. In parallel projection, which it does not know: the depth at which
/// a camera with an angle of view of 60° would show as much.
pub(super) fn view_distance(camera: &Camera, depth: f32) -> f32 {
    match camera.projection() {
        Projection::Perspective { .. } => depth,
        Projection::Orthographic { .. } => camera.half_height() * 1.732_050_8,
    }
}
