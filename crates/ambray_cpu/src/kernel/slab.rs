//! Rays against boxes, in two ways.
//!
//! **The exact test** ([`one`], [`triangles`](super::triangle)) decides: a triangle counts as hit only if the ray also meets
//! the triangle's own box by it, and its t is at least the near distance found there. It takes (plane − origin) ·
//! reciprocal for the distance to a plane, operation by operation, so all instruction sets agree.
//!
//! **The weak test** ([`children`] and those of packets) decides which nodes are visited. It takes plane · reciprocal −
//! origin · reciprocal, one fused operation where there are such, and passes wherever the exact test of a box within does.
//! So no answer depends on it, nor on the tree: a node with a hit below is never culled.
//!
//! Why the weak test is weaker. Let ε = 2⁻²⁴, N and F the distances of the nearest near and far planes without rounding. Where
//! it matters both are positive (a near distance below 0 counts as 0). The exact test finds near ≥ N(1 − 2ε) and far ≤
//! F(1 + 2ε), and passes if near ≤ far · [`WIDEN`] (1 + 32ε), up to ε for each product. The weak test subtracts origin ·
//! reciprocal, made larger for near planes and smaller for far ones by [`PAD`] (8ε) of itself: more than the ε that this
//! product is rounded by, and another ε of plane · reciprocal where that is rounded too. So it finds near ≤ N(1 + 2ε) and
//! far ≥ F(1 − 2ε), and passes if near ≤ min(far, limit) · [`SLACK`] (1 + 64ε). Each step is monotone in the plane, also
//! after rounding; the planes of a box around are no nearer and no less far. Where numbers are so small that they lose bits,
//! the smallest normal number, which the pad has on top, is more than all that is lost.
//!
//! Why no hole opens: rounding moves the planes' distances by at most 3 half-ulps each (Ize 2013), and the triangle test
//! sees the ray displaced by a few half-ulps of the distance; [`WIDEN`] covers both, so the exact test of a triangle's own box
//! passes wherever the triangle test does.
//!
//! No NaN: rays are finite, so are reciprocals and their products with origins ([`ray`](super::ray)), and planes are finite
//! or, in empty slots, infinite.

use super::lanes::Lanes;
use super::ray::Prepared;
use crate::bvh::layout::Node;

/// Factor on the far distance of the exact test, 32 half-ulps (Ize 2013 needs 6 for exact triangle tests).
pub(crate) const WIDEN: f32 = 1.0 + 32.0 / 16_777_216.0;

/// Factor on the far distance of the weak test.
pub(crate) const SLACK: f32 = 1.0 + 64.0 / 16_777_216.0;

/// By how much of itself origin · reciprocal is moved for the weak test.
pub(crate) const PAD: f32 = 8.0 / 16_777_216.0;

/// One axis of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slab {
    pub(crate) reciprocal: f32,
    /// origin · reciprocal, a little more.
    pub(crate) enter: f32,
    /// origin · reciprocal, a little less.
    pub(crate) leave: f32,
}

impl Slab {
    pub(crate) const NONE: Self = Self { reciprocal: 1.0, enter: 0.0, leave: 0.0 };

    #[inline(always)]
    pub(crate) fn new(origin: f32, reciprocal: f32) -> Self {
        let (enter, leave) = padded(origin, reciprocal);
        Self { reciprocal, enter, leave }
    }
}

/// origin · reciprocal for near planes and for far ones.
#[inline(always)]
pub(crate) fn padded(origin: f32, reciprocal: f32) -> (f32, f32) {
    let at = origin * reciprocal;
    let pad = at.abs() * PAD + f32::MIN_POSITIVE;
    (at + pad, at - pad)
}

/// Children of `node` that the ray may meet for t in [0, `limit`], and bounds on the near distances of all.
#[inline(always)]
pub(crate) fn children<const W: usize, L: Lanes<W>>(node: &Node<W>, ray: &Prepared, limit: f32) -> (u32, L) {
    let mut near = L::splat(0.0);
    let mut far = L::splat(limit);
    for axis in 0..3 {
        let slab = &ray.slab[axis];
        let reciprocal = L::splat(slab.reciprocal);
        let first = L::load(&node.planes[ray.order.near(axis)]);
        let last = L::load(&node.planes[ray.order.far(axis)]);
        near = first.mul_sub(reciprocal, L::splat(slab.enter)).max(near);
        far = last.mul_sub(reciprocal, L::splat(slab.leave)).min(far);
    }
    (near.le(far.mul(L::splat(SLACK))), near)
}

/// Near distance of the box with planes `planes` (lower x, y, z, upper x, y, z), if the ray meets it at t ≥ 0.
#[inline(always)]
pub(crate) fn one(planes: &[f32; 6], ray: &Prepared) -> Option<f32> {
    let at = |plane: usize, axis: usize| (planes[plane] - ray.origin[axis]) * ray.slab[axis].reciprocal;
    let order = ray.order;
    let near = at(order.near(0), 0).max(at(order.near(1), 1)).max(at(order.near(2), 2)).max(0.0);
    let far = at(order.far(0), 0).min(at(order.far(1), 1)).min(at(order.far(2), 2)) * WIDEN;
    (near <= far).then_some(near)
}
