//! Rays against triangles.
//!
//! The test of Woop, Benthin and Wald 2013: corners are translated and sheared so that the ray runs along +z from
//! 0, then the signs of three edge functions say whether the triangle covers the origin of the x-y plane.
//!
//! Why it is watertight, at edges and at corners: the sheared corner is a function of the corner and the ray alone, so all
//! triangles around it see the same point of the plane. The edge function of corners p, q is fl(q_x p_y) − fl(q_y p_x);
//! rounding is monotone, so its sign may become 0 but never wrong. Zero counts as inside, so the triangles' covered
//! regions contain the exact triangles between the sheared corners, which leave no gap. (The paper falls back to doubles
//! for zeros to choose one side; here the tie rule does.) Neighbours see exactly negated values along a shared edge.

use ambray_core::trace::Hit;

use super::Query;
use super::lanes::Lanes;
use super::ray::Prepared;
use super::slab;
use crate::bvh::layout::Block;

/// Lets `ray` see all triangles of a block. Returns whether the query is answered.
#[inline(always)]
pub(crate) fn block<const W: usize, L: Lanes<W>, Q: Query>(
    block: &Block<W>,
    ray: &Prepared,
    entry: &Entry<'_>,
    best: &mut Hit,
) -> bool {
    let (ax, ay, az) = corner::<W, L>(&block.corners[0], ray);
    let (bx, by, bz) = corner::<W, L>(&block.corners[1], ray);
    let (cx, cy, cz) = corner::<W, L>(&block.corners[2], ray);
    let u = cx.mul(by).sub(cy.mul(bx));
    let v = ax.mul(cy).sub(ay.mul(cx));
    let w = bx.mul(ay).sub(by.mul(ax));
    let zero = L::splat(0.0);
    // Two-sided: all edge functions of one sign, zeros included.
    let inside = zero.le(u.min(v).min(w)) | u.max(v).max(w).le(zero);
    if inside == 0 {
        return false;
    }
    // A determinant of 0 gives infinities or NaN, which fail the comparisons.
    let determinant = u.add(v).add(w);
    let t = u.mul(az).add(v.mul(bz)).add(w.mul(cz)).div(determinant).mul(L::splat(ray.shear[2]));
    let mut candidates = inside & zero.lt(t) & t.le(L::splat(best.t));
    if candidates == 0 {
        return false;
    }
    let (t, v, w, determinant) = (t.to_array(), v.to_array(), w.to_array(), determinant.to_array());
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize;
        candidates &= candidates - 1;
        let covered = [t[lane % W], v[lane % W], w[lane % W], determinant[lane % W]];
        if candidate(block, lane, ray, entry, covered, best) && Q::ANY {
            return true;
        }
    }
    false
}

/// One corner of all triangles, translated and sheared.
#[inline(always)]
fn corner<const W: usize, L: Lanes<W>>(axes: &[[f32; W]; 3], ray: &Prepared) -> (L, L, L) {
    let [x, y, z] = ray.axes;
    let depth = L::load(&axes[z]).sub(L::splat(ray.origin[z]));
    (
        L::load(&axes[x]).sub(L::splat(ray.origin[x])).sub(L::splat(ray.shear[0]).mul(depth)),
        L::load(&axes[y]).sub(L::splat(ray.origin[y])).sub(L::splat(ray.shear[1]).mul(depth)),
        depth,
    )
}

/// What all triangles below an instance share.
#[derive(Clone, Copy)]
pub(crate) struct Entry<'a> {
    /// Index of the instance; `None` in the tree of unshared triangles, whose blocks know.
    pub(crate) instance: Option<u32>,
    /// Near distance of the instance's box.
    pub(crate) near: f32,
    pub(crate) seed: u32,
    pub(crate) alpha: &'a dyn crate::AlphaTest,
}

/// Decides on a triangle that covers the ray: box of the triangle, order among equal t, alpha. Returns whether it
/// became the best hit.
#[inline(always)]
pub(crate) fn candidate<const W: usize>(
    block: &Block<W>,
    lane: usize,
    ray: &Prepared,
    entry: &Entry<'_>,
    [t, v, w, determinant]: [f32; 4],
    best: &mut Hit,
) -> bool {
    let lane = lane % W;
    let planes = planes(block, lane);
    let Some(near) = slab::one(&planes, ray) else {
        return false;
    };
    let t = t.max(near).max(entry.near);
    let instance = entry.instance.unwrap_or(block.instances[lane]);
    let triangle = block.triangles[lane];
    let closer = t < best.t || (t == best.t && (instance, triangle) < (best.instance, best.triangle));
    if !closer || t == f32::INFINITY {
        return false;
    }
    let (u, v) = (v / determinant, w / determinant);
    if block.masked >> lane & 1 != 0 && !entry.alpha.accepts(instance, triangle, u, v, entry.seed) {
        return false;
    }
    *best = Hit { t, u, v, instance, triangle };
    true
}

/// Box of one triangle of a block.
#[inline(always)]
pub(crate) fn planes<const W: usize>(block: &Block<W>, lane: usize) -> [f32; 6] {
    let mut planes = [0.0; 6];
    for axis in 0..3 {
        let [a, b, c] = [0, 1, 2].map(|corner| block.corners[corner][axis][lane]);
        planes[axis] = a.min(b).min(c);
        planes[axis + 3] = a.max(b).max(c);
    }
    planes
}
