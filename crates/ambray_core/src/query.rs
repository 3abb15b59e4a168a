//! Ambient light at arbitrary points instead of pixels.

use glam::Vec3;

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
