//! What was built, in numbers.

use std::time::Duration;

use crate::{Isa, Width};

/// Size and quality of a [`Tracer`](crate::Tracer)'s trees, all of them together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stats {
    /// Triangles in leaves; those of meshes with trees of their own count once. Dropped triangles are not among them.
    pub triangles: usize,
    /// Triangles that no ray can hit: of zero area, not finite, or beyond 10¹² units. Those of meshes that deform are never
    /// dropped, since another pose may change that.
    pub dropped: usize,
    /// Instances of meshes with several instances that were baked.
    pub baked_instances: usize,
    /// Instances of meshes with trees of their own that rays can hit: those that share a tree, and those that move.
    pub placed_instances: usize,
    /// Placed shapes that rays can hit.
    pub shapes: usize,
    /// Inner nodes.
    pub nodes: usize,
    /// Leaf blocks; triangles per leaf are `triangles / leaf_blocks`.
    pub leaf_blocks: usize,
    /// Memory of nodes, leaf blocks and shapes; trees kept for other poses count too.
    pub bytes: usize,
    /// Surface-area cost of the tree of baked triangles: expected nodes plus blocks that a long random ray which meets
    /// the scene's box visits (MacDonald and Booth 1990), both counted as 1.
    pub sah_cost: f32,
    /// Largest number of nodes on a way from a root to a leaf block, instance level included.
    pub depth: usize,
    /// Wall-clock time of the build; moving the scene does not count.
    pub build_time: Duration,
    /// Instruction set in use.
    pub isa: Isa,
    /// Width in use.
    pub width: Width,
}
