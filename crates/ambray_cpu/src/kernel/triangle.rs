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
use super::ray::{Axis, OneRay, Order};
use super::slab;
use crate::bvh::layout::{Block, FAT};
use crate::bvh::names::Names;

/// Lets `ray` see all triangles of a block. Returns whether it has a new best hit, with which an any-hit query is answered.
#[inline(always)]
pub(crate) fn block<L: Lanes<FAT>, Q: Query>(
    block: &Block,
    ray: &impl OneRay,
    entry: &Entry<'_>,
    best: &mut Hit,
) -> bool {
    let (ax, ay) = corner::<L>(&block.corners[0], ray);
    let (bx, by) = corner::<L>(&block.corners[1], ray);
    let (cx, cy) = corner::<L>(&block.corners[2], ray);
    let u = cx.mul(by).sub(cy.mul(bx));
    let v = ax.mul(cy).sub(ay.mul(cx));
    let w = bx.mul(ay).sub(by.mul(ax));
    let zero = L::splat(0.0);
    // Two-sided: all edge functions of one sign, zeros included.
    let inside = zero.le(u.min(v).min(w)) | u.max(v).max(w).le(zero);
    if inside == 0 {
        return false;
    }
    // Most triangles on the line of the ray are behind it or too far.
    let (met, near) = boxes::<L>(block, ray, best.t);
    let mut candidates = inside & met;
    if candidates == 0 {
        return false;
    }
    let determinant = u.add(v).add(w);
    let (v, w, determinant, near) = (v.to_array(), w.to_array(), determinant.to_array(), near.to_array());
    let mut found = false;
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize % FAT;
        candidates &= candidates - 1;
        let covered = Covered { v: v[lane], w: w[lane], determinant: determinant[lane], near: near[lane] };
        found |= candidate(block, lane, ray, entry, covered, best);
        if found && Q::ANY {
            return true;
        }
    }
    found
}

/// Triangles whose boxes `ray` meets for t in [0, `limit`], and the near distances of all.
#[inline(always)]
fn boxes<L: Lanes<FAT>>(block: &Block, ray: &impl OneRay, limit: f32) -> (u32, L) {
    let order: Order = ray.order();
    let mut near = L::splat(0.0);
    let mut far = L::splat(f32::INFINITY);
    for axis in 0..3 {
        let a = L::load(&block.corners[0][axis]);
        let b = L::load(&block.corners[1][axis]);
        let c = L::load(&block.corners[2][axis]);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let (first, last) = if order.down[axis] { (high, low) } else { (low, high) };
        let (origin, reciprocal) = (L::splat(ray.origin(axis)), L::splat(ray.reciprocal(axis)));
        near = first.sub(origin).mul(reciprocal).max(near);
        far = last.sub(origin).mul(reciprocal).min(far);
    }
    (near.le(far.mul(L::splat(slab::WIDEN)).min(L::splat(limit))), near)
}

/// One corner of all triangles, translated and sheared.
#[inline(always)]
fn corner<L: Lanes<FAT>>(axes: &[[f32; FAT]; 3], ray: &impl OneRay) -> (L, L) {
    let [x, y, z] = ray.axes().map(|axis| axis as usize);
    let depth = L::load(&axes[z]).sub(L::splat(ray.origin(z)));
    (
        L::load(&axes[x]).sub(L::splat(ray.origin(x))).sub(L::splat(ray.shear(0)).mul(depth)),
        L::load(&axes[y]).sub(L::splat(ray.origin(y))).sub(L::splat(ray.shear(1)).mul(depth)),
    )
}

/// What all triangles below an instance share.
#[derive(Clone, Copy)]
pub(crate) struct Entry<'a> {
    /// Index of the instance; [`BAKED`] in the tree of baked triangles.
    pub(crate) instance: u32,
    /// Near distance of the instance's box.
    pub(crate) near: f32,
    pub(crate) seed: u32,
    pub(crate) alpha: &'a dyn crate::AlphaTest,
    /// Of the baked triangles.
    pub(crate) names: &'a Names,
}

/// In place of an instance: the triangle is the number of a baked one.
pub(crate) const BAKED: u32 = Hit::NONE - 1;

/// Instance and triangle of a hit, which may be a baked triangle's.
#[inline(always)]
pub(crate) fn name(names: &Names, instance: u32, triangle: u32) -> (u32, u32) {
    if instance == BAKED { names.of_number(triangle) } else { (instance, triangle) }
}

/// Of two hits at the same distance: whether the first goes before the second. Numbers of baked triangles may not be in the
/// order of their names.
#[inline(never)]
pub(crate) fn is_before(names: &Names, first: (u32, u32), second: (u32, u32)) -> bool {
    name(names, first.0, first.1) < name(names, second.0, second.1)
}

/// A hit under the name of its triangle.
#[inline(always)]
pub(crate) fn named(names: &Names, mut hit: Hit) -> Hit {
    (hit.instance, hit.triangle) = name(names, hit.instance, hit.triangle);
    hit
}

/// Plane of a triangle in double precision, with axes permuted as its rays have them.
#[derive(Clone, Copy)]
pub(crate) struct Plane {
    pub(crate) corner: [f64; 3],
    pub(crate) normal: [f64; 3],
}

/// A corner of a triangle with axes permuted.
#[inline(always)]
fn at(block: &Block, corner: usize, lane: usize, [x, y, z]: [Axis; 3]) -> [f64; 3] {
    let axes = &block.corners[corner];
    let of = |axis: Axis| f64::from(axes[axis as usize][lane % FAT]);
    [of(x), of(y), of(z)]
}

impl Plane {
    #[inline(always)]
    pub(crate) fn of(block: &Block, lane: usize, axes: [Axis; 3]) -> Self {
        let (a, b, c) = (at(block, 0, lane, axes), at(block, 1, lane, axes), at(block, 2, lane, axes));
        let e1 = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let e2 = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
        let normal =
            [e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]];
        Self { corner: a, normal }
    }

    /// Distance at which a ray meets the plane; not above 0 or not a number if it does not. Both are given in permuted axes.
    ///
    /// Differences of the corners are exact in double precision, or nearly, so the sign is right however thin the triangle.
    #[inline(always)]
    pub(crate) fn distance(&self, origin: [f32; 3], shear: [f32; 3]) -> f32 {
        let [x, y, z] = self.normal;
        let a = [0, 1, 2].map(|axis| self.corner[axis] - f64::from(origin[axis]));
        let [sx, sy, per_depth] = shear.map(f64::from);
        let depth = (x * a[0] + y * a[1] + z * a[2]) / (x * sx + y * sy + z);
        (depth * per_depth) as f32
    }
}

/// Edge functions of a triangle that covers the ray, and the near distance of its box, which the ray meets.
#[derive(Clone, Copy)]
struct Covered {
    v: f32,
    w: f32,
    determinant: f32,
    near: f32,
}

/// Decides on a triangle that covers the ray: distance, order among equal t, alpha. Returns whether it became the best hit.
#[inline(always)]
fn candidate(
    block: &Block,
    lane: usize,
    ray: &impl OneRay,
    entry: &Entry<'_>,
    Covered { v, w, determinant, near }: Covered,
    best: &mut Hit,
) -> bool {
    let lane = lane % FAT;
    let axes = ray.axes();
    let origin = axes.map(|axis| ray.origin(axis as usize));
    let t = Plane::of(block, lane, axes).distance(origin, [ray.shear(0), ray.shear(1), ray.shear(2)]);
    // Written so that what is not a number fails; a determinant of 0 is a triangle seen edge-on.
    if !(t > 0.0 && t <= best.t && determinant.abs() > 0.0) {
        return false;
    }
    let t = t.max(near).max(entry.near);
    let (instance, number) = (entry.instance, block.triangles[lane]);
    let triangle = number.index();
    let before = || is_before(entry.names, (instance, triangle), (best.instance, best.triangle));
    let closer = t < best.t || (t == best.t && before());
    if !closer || t == f32::INFINITY {
        return false;
    }
    let (u, v) = (v / determinant, w / determinant);
    if number.is_masked() {
        let (instance, triangle) = name(entry.names, instance, triangle);
        if !entry.alpha.accepts(instance, triangle, u, v, entry.seed) {
            return false;
        }
    }
    *best = Hit { t, u, v, instance, triangle };
    true
}

/// Box of one triangle of a block.
#[inline(always)]
pub(crate) fn planes(block: &Block, lane: usize) -> [f32; 6] {
    let mut planes = [0.0; 6];
    for axis in 0..3 {
        let corners = &block.corners;
        let (a, b, c) = (corners[0][axis][lane], corners[1][axis][lane], corners[2][axis][lane]);
        // As the vectors do it: no more than one instruction each.
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        planes[axis] = if low < c { low } else { c };
        planes[axis + 3] = if high > c { high } else { c };
    }
    planes
}
