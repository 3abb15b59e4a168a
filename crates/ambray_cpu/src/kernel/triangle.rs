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
//!
//! Where the plane is met is not interpolated from the edge functions as in the paper: on a sliver of 20 units that is off by
//! 3·10⁻⁴, so that rays which have left it by its offset would hit it again. It comes from the corners in double precision.

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
    let (ax, ay) = corner::<W, L>(&block.corners[0], ray);
    let (bx, by) = corner::<W, L>(&block.corners[1], ray);
    let (cx, cy) = corner::<W, L>(&block.corners[2], ray);
    let u = cx.mul(by).sub(cy.mul(bx));
    let v = ax.mul(cy).sub(ay.mul(cx));
    let w = bx.mul(ay).sub(by.mul(ax));
    let zero = L::splat(0.0);
    // Two-sided: all edge functions of one sign, zeros included.
    let inside = zero.le(u.min(v).min(w)) | u.max(v).max(w).le(zero);
    if inside == 0 {
        return false;
    }
    let determinant = u.add(v).add(w);
    let (v, w, determinant) = (v.to_array(), w.to_array(), determinant.to_array());
    let mut candidates = inside;
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize;
        candidates &= candidates - 1;
        let covered = [v[lane % W], w[lane % W], determinant[lane % W]];
        if candidate(block, lane, ray, entry, covered, best) && Q::ANY {
            return true;
        }
    }
    false
}

/// One corner of all triangles, translated and sheared.
#[inline(always)]
fn corner<const W: usize, L: Lanes<W>>(axes: &[[f32; W]; 3], ray: &Prepared) -> (L, L) {
    let [x, y, z] = ray.axes;
    let depth = L::load(&axes[z]).sub(L::splat(ray.origin[z]));
    (
        L::load(&axes[x]).sub(L::splat(ray.origin[x])).sub(L::splat(ray.shear[0]).mul(depth)),
        L::load(&axes[y]).sub(L::splat(ray.origin[y])).sub(L::splat(ray.shear[1]).mul(depth)),
    )
}

/// What all triangles below an instance share.
#[derive(Clone, Copy)]
pub(crate) struct Entry<'a> {
    /// Index of the instance; `None` in the tree of baked triangles, whose blocks know.
    pub(crate) instance: Option<u32>,
    /// Near distance of the instance's box.
    pub(crate) near: f32,
    pub(crate) seed: u32,
    pub(crate) alpha: &'a dyn crate::AlphaTest,
}

/// Distance at which `ray` meets the plane of a triangle; not above 0 or not a number if it does not.
///
/// Differences of the corners are exact in double precision, or nearly, so the sign is right however thin the triangle.
#[inline(always)]
fn plane_distance<const W: usize>(block: &Block<W>, lane: usize, ray: &Prepared) -> f32 {
    let [x, y, z] = ray.axes;
    let corner = |i: usize| {
        [x, y, z].map(|axis| f64::from(block.corners[i][axis][lane]) - f64::from(ray.origin[axis]))
    };
    let (a, b, c) = (corner(0), corner(1), corner(2));
    let e1 = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let e2 = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let normal =
        [e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]];
    let [sx, sy, per_depth] = ray.shear.map(f64::from);
    let depth = (normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2])
        / (normal[0] * sx + normal[1] * sy + normal[2]);
    (depth * per_depth) as f32
}

/// Decides on a triangle that covers the ray: distance, box of the triangle, order among equal t, alpha. Returns whether it
/// became the best hit.
#[inline(always)]
pub(crate) fn candidate<const W: usize>(
    block: &Block<W>,
    lane: usize,
    ray: &Prepared,
    entry: &Entry<'_>,
    [v, w, determinant]: [f32; 3],
    best: &mut Hit,
) -> bool {
    let lane = lane % W;
    // The box first: it is cheaper, and most triangles on the line of the ray are behind it or too far.
    let Some(near) = slab::one(&planes(block, lane), ray) else {
        return false;
    };
    if near > best.t {
        return false;
    }
    let t = plane_distance(block, lane, ray);
    // Written so that what is not a number fails; a determinant of 0 is a triangle seen edge-on.
    if !(t > 0.0 && t <= best.t) || determinant == 0.0 {
        return false;
    }
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
