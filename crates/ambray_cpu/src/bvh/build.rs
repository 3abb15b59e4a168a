//! From triangles and instances to trees.

use ambray_scene::Mesh;
use glam::Vec3;
use rayon::prelude::*;

use super::binary::{Aabb, Binary};
use super::collapse::{self, Costs};
use super::layout::{Blas, Block, Bounds, Child, FAT, Number, Placed, Tlas};
use super::names::Names;
use super::{ploc, reinsert};
use crate::Quality;

/// Largest coordinate that is traced. Beyond it the triangle test's products could overflow, and so could the builder's
/// surface areas.
pub(crate) const LARGEST: f32 = 1e12;

/// Fewest triangles that are worth another thread.
const GRAIN: usize = 4096;

/// Triangle on its way into a tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) corners: [Vec3; 3],
    pub(crate) instance: u32,
    pub(crate) triangle: u32,
    pub(crate) masked: bool,
}

/// Whether rays can hit a triangle: all corners within [`LARGEST`], and not of zero area (in f64; coincident or collinear
/// corners).
#[inline]
pub(crate) fn is_hittable(corners: &[Vec3; 3]) -> bool {
    corners.iter().all(|&corner| is_within(corner)) && (has_much_area(corners) || has_area(corners))
}

/// Whether a triangle's area is not 0, in f64.
#[cold]
pub(super) fn has_area(&[a, b, c]: &[Vec3; 3]) -> bool {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    (b - a).cross(c - a).abs().max_element() > 0.0
}

/// Whether a triangle's area is so large that no rounding hides whether it is 0: a bound that most triangles pass, in f32.
#[inline]
pub(super) fn has_much_area(&[a, b, c]: &[Vec3; 3]) -> bool {
    let (p, q) = (b - a, c - a);
    let margin = |y: usize, z: usize| cross_margin(p[y] * q[z], p[z] * q[y]);
    margin(1, 2) > 0.0 || margin(2, 0) > 0.0 || margin(0, 1) > 0.0
}

/// Above 0 if the difference of two products is not 0, whatever the rounding of the products' factors.
///
/// These are differences themselves, so each product is off by 3 half-ulps. What is left is more than 16 half-ulps of both, and too
/// large for products to underflow.
#[inline]
pub(super) fn cross_margin(first: f32, second: f32) -> f32 {
    const ROUNDING: f32 = 16.0 / 16_777_216.0;
    (first - second).abs() - ((first.abs() + second.abs()) * ROUNDING + f32::MIN_POSITIVE)
}

/// Whether `p` is finite and within [`LARGEST`].
fn is_within(p: Vec3) -> bool {
    p.abs().max_element() <= LARGEST && p.is_finite()
}

/// Builds a binary tree with one primitive a leaf.
fn binary(boxes: Vec<Aabb>, quality: Quality) -> Binary {
    let (radius, share) = match quality {
        Quality::FastBuild => (6, 0.002),
        Quality::Balanced => (8, 0.01),
        Quality::BestTrace => (24, 1.0),
    };
    let mut tree = ploc::build(boxes, radius);
    reinsert::optimize(&mut tree, share);
    tree
}

/// Builds the tree of the triangles of a mesh, all of which must be hittable.
pub(crate) fn blas<const W: usize>(triangles: &[Triangle], quality: Quality) -> Blas<W> {
    numbered(triangles, quality, |place| triangles[place as usize].triangle)
}

/// Builds the tree of triangles of several instances, all of which must be hittable.
pub(crate) fn baked<const W: usize>(triangles: &[Triangle], quality: Quality) -> Blas<W> {
    Blas { names: Names::of(triangles), ..numbered(triangles, quality, |place| place) }
}

/// Builds the tree of `triangles`; `number` is told their places among these.
fn numbered<const W: usize>(
    triangles: &[Triangle],
    quality: Quality,
    number: impl Fn(u32) -> u32 + Sync,
) -> Blas<W> {
    let boxes = triangles.par_iter().with_min_len(GRAIN).map(|t| Aabb::of_points(&t.corners)).collect();
    wide(&binary(boxes, quality), triangles.len(), |primitives| block(triangles, primitives, &number))
}

/// Builds the tree of all triangles of a mesh that deforms, for the vertices that `mesh` has now. Its leaf blocks have no
/// corners yet: [`refit`](super::refit::refit) puts them there.
///
/// Triangles that cannot be hit now are kept apart, in the order of the mesh: without boxes there is no better one.
pub(crate) fn deforming<const W: usize>(mesh: &Mesh, masked: bool, quality: Quality) -> Blas<W> {
    let all = (0..mesh.triangles.len() as u32).into_par_iter().with_min_len(GRAIN);
    let (hittable, others): (Vec<_>, Vec<_>) = all.partition(|&t| is_hittable(&mesh.corners(t)));
    let boxes = hittable.par_iter().with_min_len(GRAIN).map(|&t| Aabb::of_points(&mesh.corners(t))).collect();
    let mut tree = binary(boxes, quality);
    if !others.is_empty() {
        for link in tree.links.iter_mut().filter(|link| link.is_leaf()) {
            *link = Child::leaf(hittable[link.index()] as usize);
        }
        tree.append(&others);
    }
    wide(&tree, mesh.triangles.len(), |primitives| {
        let mut block = Block::EMPTY;
        for (number, &triangle) in block.triangles.iter_mut().zip(primitives) {
            *number = Number::new(triangle, masked);
        }
        block
    })
}

/// Collapses `tree` over some triangles, which `block` puts into leaf blocks.
fn wide<const W: usize>(tree: &Binary, triangles: usize, block: impl Fn(&[u32]) -> Block + Sync) -> Blas<W> {
    let wide = collapse::collapse::<W>(tree, Costs::TRIANGLES, FAT as u32);
    let blocks = wide.leaves.par_iter().with_min_len(64).map_init(Default::default, |scratch, &leaf| {
        let primitives = tree.gather(leaf as usize, scratch);
        (block(primitives), primitives.len() as u8)
    });
    let (blocks, counts): (Vec<_>, Vec<u8>) = blocks.unzip();
    let mut nodes = wide.nodes;
    for child in nodes.iter_mut().flat_map(|node| &mut node.children).filter(|child| child.is_leaf()) {
        *child = Child::block(child.index(), usize::from(counts[child.index()]));
    }
    Blas {
        blocks,
        names: Names::default(),
        nodes,
        bounds: tree.bounds.first().map_or(Bounds::EMPTY, |&root| root.into()),
        triangles,
        depth: wide.depth,
        sah_cost: wide.sah_cost,
    }
}

fn block(triangles: &[Triangle], primitives: &[u32], number: impl Fn(u32) -> u32) -> Block {
    let mut block = Block::EMPTY;
    for (lane, &primitive) in primitives.iter().enumerate() {
        let triangle = &triangles[primitive as usize];
        for (corner, position) in block.corners.iter_mut().zip(triangle.corners) {
            for (axis, value) in corner.iter_mut().zip(position.to_array()) {
                axis[lane] = value;
            }
        }
        block.triangles[lane] = Number::new(number(primitive), triangle.masked);
    }
    block
}

/// Builds the tree over `instances` with world-space `boxes`.
pub(crate) fn tlas<const W: usize>(instances: Vec<Placed>, boxes: &[Bounds]) -> Tlas<W> {
    let tree = binary(boxes.iter().map(|&bounds| bounds.into()).collect(), Quality::Balanced);
    let wide = collapse::collapse::<W>(&tree, Costs::INSTANCES, 1);
    let mut nodes = wide.nodes;
    // A leaf is an instance.
    for child in nodes.iter_mut().flat_map(|node| &mut node.children).filter(|child| child.is_leaf()) {
        *child = tree.links[wide.leaves[child.index()] as usize];
    }
    Tlas { nodes, instances, depth: wide.depth }
}
