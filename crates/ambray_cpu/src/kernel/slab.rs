//! Rays against boxes.
//!
//! Why no hit is lost: a triangle counts as hit only if the ray also meets the triangle's own box by this very test, and
//! its t is at least the near distance found there ([`candidate`](super::triangle)). Every step of the test –
//! subtraction, product with a fixed factor, minimum, maximum – is monotone even after rounding. A node's box contains the
//! triangle's box, so its near distance is no larger and its far distance no smaller, bit for bit: a node with a hit below is
//! never culled, whatever the rounding, and results do not depend on the tree.
//!
//! Why no hole opens: rounding moves the planes' distances by at most 3 half-ulps each (Ize 2013), and the triangle test
//! sees the ray displaced by a few half-ulps of the distance; [`WIDEN`] covers both, so the test of a triangle's own box
//! passes wherever the triangle test does.
//!
//! No NaN: rays are finite, reciprocals are finite and not 0, and planes are finite or, in empty slots, infinite.

use super::lanes::Lanes;
use super::ray::Prepared;
use crate::bvh::layout::Node;

/// Factor on the far distance, 32 half-ulps (Ize 2013 needs 6 for exact triangle tests).
pub(crate) const WIDEN: f32 = 1.0 + 32.0 / 16_777_216.0;

/// Children of `node` that the ray meets for t in [0, `limit`], and the near distances of all.
#[inline(always)]
pub(crate) fn children<const W: usize, L: Lanes<W>>(node: &Node<W>, ray: &Prepared, limit: f32) -> (u32, L) {
    let [nx, ny, nz] = [
        distances::<W, L>(node, ray, ray.near[0], 0),
        distances::<W, L>(node, ray, ray.near[1], 1),
        distances::<W, L>(node, ray, ray.near[2], 2),
    ];
    let [fx, fy, fz] = [
        distances::<W, L>(node, ray, ray.far[0], 0),
        distances::<W, L>(node, ray, ray.far[1], 1),
        distances::<W, L>(node, ray, ray.far[2], 2),
    ];
    let near = nx.max(ny).max(nz.max(L::splat(0.0)));
    let far = fx.min(fy).min(fz);
    let far = far.mul(L::splat(WIDEN)).min(L::splat(limit));
    (near.le(far), near)
}

/// Distances to one plane of each child.
#[inline(always)]
fn distances<const W: usize, L: Lanes<W>>(node: &Node<W>, ray: &Prepared, plane: usize, axis: usize) -> L {
    L::load(&node.planes[plane]).sub(L::splat(ray.origin[axis])).mul(L::splat(ray.reciprocal[axis]))
}

/// Near distance of the box with planes `planes` (lower x, y, z, upper x, y, z), if the ray meets it at t ≥ 0.
#[inline(always)]
pub(crate) fn one(planes: &[f32; 6], ray: &Prepared) -> Option<f32> {
    let at = |plane: usize, axis: usize| (planes[plane] - ray.origin[axis]) * ray.reciprocal[axis];
    let near = at(ray.near[0], 0).max(at(ray.near[1], 1)).max(at(ray.near[2], 2)).max(0.0);
    let far = at(ray.far[0], 0).min(at(ray.far[1], 1)).min(at(ray.far[2], 2)) * WIDEN;
    (near <= far).then_some(near)
}
