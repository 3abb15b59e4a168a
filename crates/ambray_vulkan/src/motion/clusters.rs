//! How well a structure still fits its mesh.
//!
//! The tree of a driver cannot be read. Clusters of triangles stand for its inner nodes: those whose boxes were centred in one
//! cell of a grid over the mesh when the structure was built, which any builder would have put below one node. Their
//! surface-area cost at a pose is Σ surface of the cluster's box × its triangles, over the surface of the box around all. The
//! decay is that of the clusters of the build over that of clusters made for the pose: what building anew would gain. To
//! compare with the cost at the build instead would call a mesh poor that no build makes better, and a tree good that was
//! built for a tangle which has come undone.

use std::sync::Arc;

use ash::vk::BufferUsageFlags;
use glam::Vec3;

use crate::{Buffer, Context, Location, Result};

/// Triangles of a cluster if they filled the grid; surfaces leave most of it empty, so really there are some times more.
const FILL: f64 = 4.0;
/// Most clusters along an axis: they need 28 bytes each while a pose is measured.
const MOST: u32 = 16;

/// Clusters along each axis for a mesh of so many triangles.
pub(super) fn side(triangles: u32) -> u32 {
    ((f64::from(triangles) / FILL).cbrt().ceil() as u32).clamp(2, MOST)
}

/// What is known of a structure of a mesh.
#[derive(Debug)]
pub(super) struct Built {
    /// Cluster of each triangle.
    pub(super) clusters: Buffer,
    /// Some vertices at the pose of the build, if poses are compared; none before it is built.
    pub(super) sample: Option<Vec<Vec3>>,
    /// Which pose last ended up with it, counted from 1.
    pub(super) used: u64,
}

impl Built {
    /// Room for the clusters of `triangles`.
    pub(super) fn new(context: &Arc<Context>, triangles: u32) -> Result<Self> {
        Ok(Self { clusters: buffer(context, triangles)?, sample: None, used: 0 })
    }
}

/// Room for the cluster of each of so many triangles.
pub(super) fn buffer(context: &Arc<Context>, triangles: u32) -> Result<Buffer> {
    let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    context.buffer("clusters", 4 * u64::from(triangles), usage, Location::Device)
}

/// Cost of the clusters of a build over that of clusters made for the pose: 1 is as good as new.
pub(super) fn decay(cost: f32, fresh: f32) -> f32 {
    // Nothing, where all is in one place.
    if fresh > 0.0 { (cost / fresh).min(f32::MAX) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_follow_the_number_of_triangles() {
        assert_eq!([0, 1, 60, 500, 4000, 100_000_000].map(side), [2, 2, 3, 5, 10, 16]);
    }
}
