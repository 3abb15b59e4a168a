//! Ambient light at arbitrary points instead of pixels.

use glam::Vec3;

use crate::{
    gather::ShadedPoint,
    sampling::{PixelKey, pcg},
    settings::Settings,
    trace::Hit,
};

/// A point of a surface to evaluate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QueryPoint {
    /// Position, world space.
    pub position: Vec3,
    /// Normal on the side to be lit, world space; any length but zero.
    pub normal: Vec3,
    /// Sample class, 0 to 15.
    pub class: u8,
}

impl QueryPoint {
    /// The point as the estimator sees it.
    #[must_use]
    pub fn shaded(&self, settings: &Settings) -> ShadedPoint {
        let normal = self.normal.normalize();
        // A point has no pixel: its position takes that part, so that the result does not depend on its place in a list.
        let [x, y, z] = self.position.to_array().map(f32::to_bits);
        let hash = PixelKey::new(x, y.wrapping_add(pcg(z)), settings.frame, settings.seed).hash;
        let key = PixelKey { class: self.class, hash };
        // The triangle is not known; the point itself is rounded to its own coordinates at least.
        let reach = self.position.abs().max_element();
        ShadedPoint {
            position: self.position,
            geometric_normal: normal,
            reach,
            normal,
            instance: Hit::NONE,
            key,
        }
    }
}

/// Ambient light at a [`QueryPoint`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct QueryResult {
    /// Openness O.
    pub openness: f32,
    /// Near-field radiance I, linear RGB.
    pub near_radiance: Vec3,
    /// Unit mean open direction, or 0 where nothing is open.
    pub bent_normal: Vec3,
    /// Openness by the first batch, O1.
    pub first_batch: f32,
    /// Openness by the second batch, A2; 1 with thin detection off.
    pub second_batch: f32,
    /// Ambient rays of the first batch.
    pub ambient_rays: u32,
    /// How many of them hit something.
    pub ambient_hits: u32,
    /// Chords of the second batch.
    pub chord_rays: u32,
    /// How many of them were blocked.
    pub chord_hits: u32,
    /// Shadow rays for the radiance of hits.
    pub shadow_rays: u32,
}
