//! Sixteen rays at once through the trees in world space.
//!
//! Nodes are culled for the whole packet by interval arithmetic (Boulos et al. 2006), which stands on the same monotone
//! operations as the slab test and so never culls what the slab test of a single ray keeps. The boxes that are left are
//! tested against each ray at once, while their node is at hand: the tests of several boxes overlap in time, those of one
//! box when its turn comes would not. A ray that is left alone goes on alone. Answers are those of
//! [`single`](super::single), bit for bit: both test the same triangles in the same arithmetic, and the order of tests does
//! not matter.

use std::mem::MaybeUninit;

use ambray_core::trace::{Hit, Ray};

use super::best::Best;
use super::bundle::{Bundle, LANES, Packet};
use super::lanes::{Lanes, Rays};
use super::ray::Prepared;
use super::triangle;
use super::{Query, Scene, Trunk, leaf, single, slab};
use crate::bvh::layout::Child;

/// Subtree still to be visited.
#[derive(Clone, Copy)]
pub(crate) struct Pending {
    /// Bound on the near distance of its box.
    near: f32,
    /// The node that it is a child of, and in which slot.
    parent: Child,
    slot: u32,
    /// The rays that meet its box.
    live: u16,
    /// How many hits had shortened rays by then.
    hits: u16,
}

/// Scratch memory of a thread.
pub(crate) struct Scratch {
    pub(crate) packet: Vec<MaybeUninit<Pending>>,
    pub(crate) single: Vec<MaybeUninit<u64>>,
}

/// Answers the rays of a `group` of a bundle.
#[inline(always)]
pub(crate) fn trace<const W: usize, L: Lanes<W>, R: Rays, Q: Query>(
    scene: &Scene<'_, W>,
    bundle: &Bundle,
    group: u32,
    rays: &[Ray],
    answers: &mut [Q::Answer],
    scratch: &mut Scratch,
) {
    let mut best = Best::NONE;
    let mut packet = bundle.packet::<R>(group);
    let mut open = group;
    for trunk in scene.world_trees() {
        if open == 0 {
            break;
        }
        open = walk::<W, L, R, Q>(&trunk, rays, &mut packet, open, &mut best, scratch);
    }
    let mut lanes = group;
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize % LANES;
        lanes &= lanes - 1;
        let mut is_hit = best.found >> lane & 1 != 0;
        let mut hit = best.hit(lane, packet.limit.0[lane]);
        let ray = &rays[lane];
        let is_answered = Q::ANY && is_hit;
        if !is_answered
            && !scene.placed.nodes.is_empty()
            && let Some(prepared) = Prepared::new(ray.origin, ray.direction)
        {
            single::instances::<W, L, Q>(scene, ray, &prepared, &mut hit, &mut scratch.single);
            is_hit = hit.is_hit();
        }
        answers[lane] = Q::answer(is_hit, if is_hit { hit } else { Hit::MISS });
    }
}

/// Walks the `open` rays of a packet through a tree; they are those without an answer that nothing can change. Returns which
/// rays are so still.
#[inline(always)]
fn walk<const W: usize, L: Lanes<W>, R: Rays, Q: Query>(
    trunk: &Trunk<'_, W>,
    rays: &[Ray],
    packet: &mut Packet,
    mut open: u32,
    best: &mut Best,
    scratch: &mut Scratch,
) -> u32 {
    let tree = trunk.tree;
    let stack = &mut scratch.packet[..];
    let mut top = 0;
    let mut child = Child::ROOT;
    let mut live = open;
    loop {
        if child.is_leaf() {
            let block = &tree.blocks[child.index()];
            if live.count_ones() < block.count {
                let mut lanes = live;
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize % LANES;
                    lanes &= lanes - 1;
                    let ray = packet.ray(lane);
                    let mut hit = best.hit(lane, packet.limit.0[lane]);
                    if triangle::block::<L::Eight, Q>(block, &ray, &trunk.entry(rays[lane].seed), &mut hit) {
                        packet.settle::<Q>(lane, &hit, best);
                        open &= !(u32::from(Q::ANY) << lane);
                    }
                }
            } else {
                open &= !leaf::visit::<W, R, Q>(trunk, block, packet, rays, live, best);
            }
        } else if live & (live - 1) == 0 {
            let lane = live.trailing_zeros() as usize % LANES;
            let ray = packet.ray(lane);
            let mut hit = best.hit(lane, packet.limit.0[lane]);
            let entry = trunk.entry(rays[lane].seed);
            if single::blas::<W, L, Q>(tree, trunk.root, child, &ray, &entry, &mut hit, &mut scratch.single)
                || !Q::ANY
            {
                packet.settle::<Q>(lane, &hit, best);
                open &= !(u32::from(Q::ANY) << lane);
            }
        } else {
            let node = trunk.node(child);
            let (mut mask, near) = overlaps::<W, L>(&node.planes, packet);
            let near = near.to_array();
            let bottom = top;
            while mask != 0 {
                let slot = mask.trailing_zeros() as usize % W;
                mask &= mask - 1;
                let (met, _) = meets::<W, R>(&node.planes, slot, packet);
                let live = (met & live) as u16;
                if live == 0 {
                    continue;
                }
                let near = near[slot];
                let pending = Pending { near, parent: child, slot: slot as u32, live, hits: packet.hits };
                let mut at = top;
                // Where the closest hit is asked for, the nearest come first; the order of the others does not matter.
                while !Q::ANY && at > bottom {
                    // SAFETY: entries between `bottom` and `top` were written by this loop.
                    let below = unsafe { stack[at - 1].assume_init() };
                    if below.near >= near {
                        break;
                    }
                    stack[at] = MaybeUninit::new(below);
                    at -= 1;
                }
                stack[at] = MaybeUninit::new(pending);
                top += 1;
            }
        }
        loop {
            if top == 0 || open == 0 {
                return open;
            }
            top -= 1;
            // SAFETY: entries below `top` were written before `top` moved past them.
            let pending = unsafe { stack[top].assume_init() };
            live = u32::from(pending.live) & open;
            if live == 0 {
                continue;
            }
            let node = trunk.node(pending.parent);
            let slot = pending.slot as usize % W;
            // Rays that have become shorter may miss it now.
            if !Q::ANY && pending.hits != packet.hits {
                let (met, _) = meets::<W, R>(&node.planes, slot, packet);
                live &= met;
                if live == 0 {
                    continue;
                }
            }
            child = node.children[slot];
            break;
        }
    }
}

/// Those of `W` boxes that some ray of the packet may meet, and bounds on the near distances of all.
///
/// (plane − origin) · reciprocal is monotone in both factors. The near distance of a box counts only where it is positive:
/// there the origin nearest to the plane and the smallest reciprocal bound it from below. Where the far distance is
/// negative no ray meets the box; elsewhere the origin farthest from the plane and the largest reciprocal bound it from
/// above. (No product underflows to −0: reciprocals of unit directions are no smaller than 1.)
#[inline(always)]
pub(crate) fn overlaps<const W: usize, L: Lanes<W>>(planes: &[[f32; W]; 6], packet: &Packet) -> (u32, L) {
    let mut near = L::splat(0.0);
    let mut far = L::splat(packet.largest_limit);
    for axis in 0..3 {
        let [late, early] = packet.origins[axis];
        let [small, large] = packet.reciprocals[axis];
        let near_gap = L::load(&planes[packet.near[axis]]).sub(L::splat(late));
        let far_gap = L::load(&planes[packet.far[axis]]).sub(L::splat(early));
        near = near_gap.mul(L::splat(small)).max(near);
        far = far_gap.mul(L::splat(large)).min(far);
    }
    (near.le(far.mul(L::splat(slab::WIDEN))), near)
}

/// Rays that meet the box in `slot` within their limits, and the near distances of all.
#[inline(always)]
pub(crate) fn meets<const W: usize, R: Rays>(
    planes: &[[f32; W]; 6],
    slot: usize,
    packet: &Packet,
) -> (u32, R) {
    let mut near = R::splat(0.0);
    let mut far = R::splat(f32::INFINITY);
    for axis in 0..3 {
        let origin = packet.origin[axis].load::<R>();
        let reciprocal = packet.reciprocal[axis].load::<R>();
        near = R::splat(planes[packet.near[axis]][slot % W]).sub(origin).mul(reciprocal).max(near);
        far = R::splat(planes[packet.far[axis]][slot % W]).sub(origin).mul(reciprocal).min(far);
    }
    (near.le(far.mul(R::splat(slab::WIDEN)).min(packet.limit.load::<R>())), near)
}
