//! Sixteen rays at once through the trees in world space.
//!
//! Nodes are culled for the whole packet by interval arithmetic (Boulos et al. 2006), which never culls what the
//! [exact test](slab) of a ray of it keeps. The boxes that are left are
//! tested against each ray at once, while their node is at hand: the tests of several boxes overlap in time, those of one
//! box when its turn comes would not. A ray that is left alone goes on alone. Answers are those of
//! [`single`](super::single), bit for bit: both test the same triangles in the same arithmetic, and the order of tests does
//! not matter.

use std::mem::MaybeUninit;

use ambray_core::trace::Ray;

use super::best::Best;
use super::bundle::{Bundle, LANES, Packet};
use super::lanes::{Lanes, Rays};
use super::{Query, Scene, Trunk, leaf, single, slab, triangle};
use crate::bvh::layout::{Child, Node};

/// Subtree still to be visited.
#[derive(Clone, Copy)]
pub(crate) struct Pending<'a, const W: usize> {
    /// The node that it is a child of, and in which slot.
    parent: &'a Node<W>,
    slot: u32,
    /// Bound on the near distance of its box.
    near: f32,
    /// The rays that meet its box.
    live: u16,
    /// How often limits had changed by then.
    changes: u16,
}

/// Scratch memory of a thread.
pub(crate) struct Scratch<'a, const W: usize> {
    pub(crate) packet: Vec<MaybeUninit<Pending<'a, W>>>,
    pub(crate) single: Vec<MaybeUninit<u64>>,
}

/// Answers the rays of a `group` of a bundle that have hits; `places` says where the answer of each lane goes.
#[inline(always)]
pub(crate) fn trace<'a, const W: usize, L: Lanes<W>, R: Rays, Q: Query>(
    scene: &Scene<'a, W>,
    bundle: &Bundle,
    group: u32,
    rays: &[Ray],
    (answers, places): (&mut [Q::Answer], &[u32; LANES]),
    scratch: &mut Scratch<'a, W>,
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
    let has_placed = !scene.placed.nodes.is_empty();
    let mut lanes = if has_placed { group } else { best.found };
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize % LANES;
        lanes &= lanes - 1;
        let mut is_hit = best.found >> lane & 1 != 0;
        let mut hit = best.hit(lane, packet.limit.0[lane]);
        if has_placed && !(Q::ANY && is_hit) {
            let prepared = bundle.ray(lane);
            single::instances::<W, L, Q>(scene, &rays[lane], &prepared, &mut hit, &mut scratch.single);
            is_hit = hit.is_hit();
        }
        answers[places[lane] as usize] = Q::answer(is_hit, || triangle::named(&scene.baked.names, hit));
    }
}

/// Walks the `open` rays of a packet through a tree; they are those without an answer that nothing can change. Returns which
/// rays are so still.
#[inline(always)]
fn walk<'a, const W: usize, L: Lanes<W>, R: Rays, Q: Query>(
    trunk: &Trunk<'a, W>,
    rays: &[Ray],
    packet: &mut Packet<'_>,
    mut open: u32,
    best: &mut Best,
    scratch: &mut Scratch<'a, W>,
) -> u32 {
    let tree = trunk.tree;
    let stack = &mut scratch.packet[..];
    let mut top = 0;
    let mut child = Child::ROOT;
    let mut live = open;
    loop {
        if child.is_leaf() {
            let (index, count) = child.in_block();
            let block = &tree.blocks[index];
            if live.count_ones() < count {
                let mut lanes = live;
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize % LANES;
                    lanes &= lanes - 1;
                    let ray = packet.ray(lane);
                    let mut hit = best.hit(lane, packet.limit.0[lane]);
                    if triangle::block::<L::Eight, Q>(block, &ray, &trunk.entry(rays[lane].seed), &mut hit) {
                        packet.shorten_one(lane, hit.t);
                        best.replace(lane, &hit);
                        open &= !(u32::from(Q::ANY) << lane);
                    }
                }
            } else {
                open &= !leaf::visit::<W, R, Q>(trunk, (block, count), packet, rays, live, best);
            }
        } else if live & (live - 1) == 0 {
            let lane = live.trailing_zeros() as usize % LANES;
            let ray = packet.ray(lane).prepared();
            let mut hit = best.hit(lane, packet.limit.0[lane]);
            let entry = trunk.entry(rays[lane].seed);
            if single::blas::<W, L, Q>(tree, trunk.root, child, &ray, &entry, &mut hit, &mut scratch.single)
                || !Q::ANY
            {
                packet.shorten_one(lane, hit.t);
                best.replace(lane, &hit);
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
                let met = meets::<W, R>(&node.planes, slot, packet);
                let live = (met & live) as u16;
                if live == 0 {
                    continue;
                }
                let near = near[slot];
                let pending =
                    Pending { near, parent: node, slot: slot as u32, live, changes: packet.changes };
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
            let node = pending.parent;
            let slot = pending.slot as usize % W;
            // Rays that have become shorter may miss it now.
            if !Q::ANY && pending.changes != packet.changes {
                let met = meets::<W, R>(&node.planes, slot, packet);
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
/// Where the near plane is ahead of all origins, the origin nearest to it and the smallest reciprocal bound its distance from
/// below; elsewhere the distance does not count. Where the far plane is behind all origins no ray meets the box; elsewhere
/// the origin farthest from it and the largest reciprocal bound its distance from above. Their product may be too large for a
/// number, so even empty slots may be let through, but not by [`meets`], which has to follow.
#[inline(always)]
pub(crate) fn overlaps<const W: usize, L: Lanes<W>>(planes: &[[f32; W]; 6], packet: &Packet<'_>) -> (u32, L) {
    let mut near = L::splat(0.0);
    let mut far = L::splat(packet.largest_limit);
    for axis in 0..3 {
        let (enter, leave) = (packet.enter[axis], packet.leave[axis]);
        let first = L::load(&planes[packet.order.near(axis)]);
        let last = L::load(&planes[packet.order.far(axis)]);
        near = first.mul_sub(L::splat(enter[0]), L::splat(enter[1])).max(near);
        far = last.mul_sub(L::splat(leave[0]), L::splat(leave[1])).min(far);
    }
    (near.le(far.mul(L::splat(slab::SLACK))), near)
}

/// Rays that may meet the box in `slot` within their limits.
#[inline(always)]
pub(super) fn meets<const W: usize, R: Rays>(
    planes: &[[f32; W]; 6],
    slot: usize,
    packet: &Packet<'_>,
) -> u32 {
    let mut near = R::splat(0.0);
    let mut far = packet.limit.load::<R>();
    for axis in 0..3 {
        let reciprocal = packet.bundle.reciprocal[axis].load::<R>();
        let first = R::splat(planes[packet.order.near(axis)][slot % W]);
        let last = R::splat(planes[packet.order.far(axis)][slot % W]);
        near = first.mul_sub(reciprocal, packet.bundle.enter[axis].load()).max(near);
        far = last.mul_sub(reciprocal, packet.bundle.leave[axis].load()).min(far);
    }
    near.le(far.mul(R::splat(slab::SLACK)))
}
