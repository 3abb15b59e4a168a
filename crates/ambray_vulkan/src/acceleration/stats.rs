//! What was built, in numbers.

use std::time::Duration;

/// Size and cost of the acceleration structures of a scene. Sizes are in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AccelerationStats {
    /// Number of bottom-level structures.
    pub structures: usize,
    /// Of these, with opaque triangles, with triangles that rays may pass, and with shapes.
    pub by_kind: [usize; 3],
    /// Of these, in world space: made of several instances or placed once.
    pub in_world: usize,
    /// Number of entries of the top-level structure if nothing is culled.
    pub placements: usize,
    /// Number of triangles in bottom-level structures, copies counted.
    pub triangles: u64,
    /// Number of boxes of shapes.
    pub boxes: u64,
    /// Number of triangles that no ray can hit, or that lie in the place of others.
    pub dropped: u64,
    /// Bottom-level structures as they were built.
    pub bytes_before: u64,
    /// Bottom-level structures as they are kept.
    pub bytes: u64,
    /// Top-level structure.
    pub top_bytes: u64,
    /// Scratch memory of the largest batch of builds; freed since.
    pub scratch_bytes: u64,
    /// From the scene to structures that can be traced, wall-clock time.
    pub build_time: Duration,
    /// Overlap of the boxes if each instance had a structure of its own: Σ over pairs of the surface area they have in
    /// common, over that of the scene's box.
    pub overlap_before: f64,
    /// The same of the structures as they are placed.
    pub overlap: f64,
}
