//! A packet against the triangles of a leaf block, one after the other. The arithmetic is that of
//! [`triangle`](super::triangle), lane by lane.

use super::best::Best;
use super::bundle::{Bundle, LANES, Packet};
use super::lanes::Rays;
use super::triangle::{self, Plane};
use super::{Query, Trunk, slab};
use crate::bvh::layout::{Block, FAT};
use ambray_core::trace::Ray;

/// Lets the `live` rays see the `count` triangles of `block`. Returns those that are answered.
#[inline(always)]
pub(crate) fn visit<const W: usize, R: Rays, Q: Query>(
    trunk: &Trunk<'_, W>,
    (block, count): (&Block, u32),
    packet: &mut Packet<'_>,
    rays: &[Ray],
    live: u32,
    best: &mut Best,
) -> u32 {
    let mut answered = 0;
    for slot in 0..count as usize {
        answered |= triangle::<W, R, Q>(trunk, block, slot, packet, rays, live & !answered, best);
        if answered == live {
            break;
        }
    }
    answered
}

/// Lets the `live` rays see one triangle. Returns those that are answered.
#[inline(always)]
fn triangle<const W: usize, R: Rays, Q: Query>(
    trunk: &Trunk<'_, W>,
    block: &Block,
    slot: usize,
    packet: &mut Packet<'_>,
    rays: &[Ray],
    live: u32,
    best: &mut Best,
) -> u32 {
    let (ax, ay) = corner::<R>(&block.corners[0], slot, packet);
    let (bx, by) = corner::<R>(&block.corners[1], slot, packet);
    let (cx, cy) = corner::<R>(&block.corners[2], slot, packet);
    let u = cx.mul(by).sub(cy.mul(bx));
    let v = ax.mul(cy).sub(ay.mul(cx));
    let w = bx.mul(ay).sub(by.mul(ax));
    let zero = R::splat(0.0);
    let inside = (zero.le(u.min(v).min(w)) | u.max(v).max(w).le(zero)) & live;
    if inside == 0 {
        return 0;
    }
    let (met, near) = meets::<R>(&triangle::planes(block, slot % FAT), packet);
    let inside = inside & met;
    if inside == 0 {
        return 0;
    }
    let determinant = u.add(v).add(w);
    let t = distances::<R>(block, slot, packet);
    let limit = packet.limit.load::<R>();
    // Written so that what is not a number fails; a determinant of 0 is a triangle seen edge-on.
    let seen = inside & zero.lt(t) & t.le(limit) & (zero.lt(determinant) | determinant.lt(zero));
    if seen == 0 {
        return 0;
    }
    let t = t.max(near);
    let (instance, number) = (trunk.instance, block.triangles[slot % FAT]);
    let triangle = number.index();
    let mut closer = seen & t.lt(limit);
    let mut equal = seen & t.le(limit) & !closer & t.lt(R::splat(f32::INFINITY));
    while equal != 0 {
        let lane = equal.trailing_zeros() as usize % LANES;
        equal &= equal - 1;
        let before = triangle::is_before(trunk.names, (instance, triangle), best.order(lane));
        closer |= u32::from(before) << lane;
    }
    let (u, v) = (v.div(determinant), w.div(determinant));
    if number.is_masked() {
        let (instance, triangle) = triangle::name(trunk.names, instance, triangle);
        let (u, v) = (u.to_array(), v.to_array());
        let mut asked = closer;
        while asked != 0 {
            let lane = asked.trailing_zeros() as usize % LANES;
            asked &= asked - 1;
            let accepted = trunk.alpha.accepts(instance, triangle, u[lane], v[lane], rays[lane].seed);
            closer &= !(u32::from(!accepted) << lane);
        }
    }
    best.found |= closer;
    if Q::ANY {
        return closer;
    }
    packet.shorten::<R>(closer, t);
    best.set(closer, u, v, instance, triangle);
    0
}

/// Rays that meet the box with `planes` within their limits by the exact test, and the near distances of all.
#[inline(always)]
fn meets<R: Rays>(planes: &[f32; 6], packet: &Packet<'_>) -> (u32, R) {
    let mut near = R::splat(0.0);
    let mut far = R::splat(f32::INFINITY);
    for axis in 0..3 {
        let origin = packet.bundle.origin[axis].load::<R>();
        let reciprocal = packet.bundle.reciprocal[axis].load::<R>();
        near = R::splat(planes[packet.order.near(axis)]).sub(origin).mul(reciprocal).max(near);
        far = R::splat(planes[packet.order.far(axis)]).sub(origin).mul(reciprocal).min(far);
    }
    (near.le(far.mul(R::splat(slab::WIDEN)).min(packet.limit.load::<R>())), near)
}

/// One corner as each ray sees it.
#[inline(always)]
fn corner<R: Rays>(corner: &[[f32; FAT]; 3], slot: usize, packet: &Packet<'_>) -> (R, R) {
    let (slot, [x, y, z]) = (slot % FAT, packet.axes.map(|axis| axis as usize));
    let Bundle { origin, shear, .. } = packet.bundle;
    let depth = R::splat(corner[z][slot]).sub(origin[z].load::<R>());
    let sx = shear[0].load::<R>();
    let sy = shear[1].load::<R>();
    (
        R::splat(corner[x][slot]).sub(origin[x].load::<R>()).sub(sx.mul(depth)),
        R::splat(corner[y][slot]).sub(origin[y].load::<R>()).sub(sy.mul(depth)),
    )
}

/// Distances at which the rays meet the plane of one triangle.
#[inline(always)]
fn distances<R: Rays>(block: &Block, slot: usize, packet: &Packet<'_>) -> R {
    let [x, y, z] = packet.axes.map(|axis| axis as usize);
    let Bundle { origin, shear, .. } = packet.bundle;
    let origin = [origin[x].load(), origin[y].load(), origin[z].load()];
    let shear = [shear[0].load(), shear[1].load(), shear[2].load()];
    R::plane_distances(&Plane::of(block, slot, packet.axes), origin, shear)
}
