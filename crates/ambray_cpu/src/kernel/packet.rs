//! Sixteen rays at once through the trees in world space.
//!
//! Nodes are culled for the whole packet by interval arithmetic (Boulos et al. 2006), which stands on the same monotone
//! operations as the slab test and so never culls what the slab test of a single ray keeps. A child's box is tested against
//! each ray when its turn comes; few remaining rays go on alone. Answers are those of [`single`](super::single), bit for
//! bit: both test the same triangles in the same arithmetic, and the order of tests does not matter.

use std::mem::MaybeUninit;

use ambray_core::trace::{Hit, Ray};

use super::bundle::{Bundle, LANES, Packet};
use super::lanes::Lanes;
use super::ray::Prepared;
use super::triangle::{self, Entry};
use super::{Query, Scene, single, slab};
use crate::bvh::layout::{Blas, Block, Child, Node};

/// Up to this many live rays go on one by one. Measured on Sponza.
const ALONE: u32 = 3;

/// Subtree still to be visited, with the place of its box.
#[derive(Clone, Copy)]
pub(crate) struct Pending {
    near: f32,
    child: Child,
    node: u32,
    slot: u32,
}

/// Scratch memory of a thread.
pub(crate) struct Scratch {
    pub(crate) packet: Vec<MaybeUninit<Pending>>,
    pub(crate) single: Vec<MaybeUninit<u64>>,
}

/// Answers the rays of a bundle.
#[inline(always)]
pub(crate) fn trace<const W: usize, L: Lanes<W>, R: Lanes<16>, Q: Query>(
    scene: &Scene<'_, W>,
    bundle: &Bundle,
    rays: &[Ray],
    answers: &mut [Q::Answer],
    scratch: &mut Scratch,
) {
    let mut best = [Hit::MISS; LANES];
    for (best, &t_max) in best.iter_mut().zip(&bundle.t_max.0) {
        best.t = t_max;
    }
    // Rays of one direction class a time; deinterleaved rays are mostly all of one.
    let nothing = scene.baked.nodes.is_empty() && scene.direct.is_empty();
    let mut waiting = if nothing { 0 } else { bundle.able };
    while waiting != 0 {
        let group = bundle.group(waiting);
        waiting &= !group;
        let mut packet = bundle.packet::<R>(group);
        let mut open = group;
        for (tree, instance) in scene.world_trees() {
            if open == 0 {
                break;
            }
            let trunk = Trunk { tree, instance, alpha: scene.alpha };
            open = walk::<W, L, R, Q>(&trunk, rays, &mut packet, open, &mut best, scratch);
        }
    }
    for (lane, (ray, answer)) in rays.iter().zip(answers).enumerate().take(LANES) {
        let best = &mut best[lane];
        let able = bundle.able >> lane & 1 != 0;
        if able
            && !scene.placed.nodes.is_empty()
            && !(Q::ANY && best.is_hit())
            && let Some(prepared) = Prepared::new(ray.origin, ray.direction)
        {
            single::instances::<W, L, Q>(scene, ray, &prepared, best, &mut scratch.single);
        }
        *answer = Q::answer(if best.is_hit() { *best } else { Hit::MISS });
    }
}

/// A tree in world space.
struct Trunk<'a, const W: usize> {
    tree: &'a Blas<W>,
    /// As in [`Entry`].
    instance: Option<u32>,
    alpha: &'a dyn crate::AlphaTest,
}

impl<'a, const W: usize> Trunk<'a, W> {
    #[inline(always)]
    fn entry(&self, ray: &Ray) -> Entry<'a> {
        Entry { instance: self.instance, near: 0.0, seed: ray.seed, alpha: self.alpha }
    }
}

/// Walks the `open` rays of a packet through a tree; they are those without an answer that nothing can change. Returns which
/// rays are so still.
#[inline(always)]
fn walk<const W: usize, L: Lanes<W>, R: Lanes<16>, Q: Query>(
    trunk: &Trunk<'_, W>,
    rays: &[Ray],
    packet: &mut Packet,
    mut open: u32,
    best: &mut [Hit; LANES],
    scratch: &mut Scratch,
) -> u32 {
    let tree = trunk.tree;
    if tree.nodes.is_empty() {
        return open;
    }
    let stack = &mut scratch.packet;
    let mut top = 0;
    let mut child = Child::ROOT;
    let mut live = open;
    loop {
        let block = child.is_leaf().then(|| &tree.blocks[child.index()]);
        if live.count_ones() <= block.map_or(ALONE, |block| block.count.max(ALONE + 1) - 1) {
            while live != 0 {
                let lane = live.trailing_zeros() as usize % LANES;
                live &= live - 1;
                let ray = packet.ray(lane);
                let entry = trunk.entry(&rays[lane]);
                let best = &mut best[lane];
                let done = match block {
                    Some(block) => triangle::block::<W, L, Q>(block, &ray, &entry, best),
                    None => single::blas::<W, L, Q>(tree, child, &ray, &entry, best, &mut scratch.single),
                };
                packet.limit.0[lane] = if done && Q::ANY { -1.0 } else { best.t };
                open &= !(u32::from(done && Q::ANY) << lane);
            }
        } else if let Some(block) = block {
            let before = live;
            for triangle in 0..block.count as usize {
                live = one_triangle::<W, R, Q>(trunk, block, triangle, packet, rays, live, best);
                if live == 0 {
                    break;
                }
            }
            open &= live | !before;
        } else {
            let node = &tree.nodes[child.index()];
            let limit = packet.limit.load::<R>().largest();
            let (mut mask, near) = children::<W, L>(node, packet, limit);
            let near = near.to_array();
            let bottom = top;
            while mask != 0 {
                let slot = mask.trailing_zeros() as usize % W;
                mask &= mask - 1;
                let pending = Pending {
                    near: near[slot],
                    child: node.children[slot],
                    node: child.index() as u32,
                    slot: slot as u32,
                };
                let mut at = top;
                while at > bottom {
                    // SAFETY: entries between `bottom` and `top` were written by this loop.
                    let below = unsafe { stack[at - 1].assume_init() };
                    if below.near >= pending.near {
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
            let node = &tree.nodes[pending.node as usize];
            live = meets::<W, R>(node, pending.slot as usize, packet);
            if live != 0 {
                child = pending.child;
                break;
            }
        }
    }
}

/// Children of `node` that some ray of the packet may meet, and bounds on the near distances.
///
/// For an axis along which the rays point upwards, (plane − origin) · reciprocal lies between the products of
/// plane − largest origin, plane − smallest origin with the smallest and largest reciprocal; downwards the roles of the
/// origins swap.
#[inline(always)]
fn children<const W: usize, L: Lanes<W>>(node: &Node<W>, packet: &Packet, limit: f32) -> (u32, L) {
    let mut near = L::splat(0.0);
    let mut far = L::splat(f32::INFINITY);
    for axis in 0..3 {
        let down = usize::from(packet.near[axis] >= 3);
        let [lo, hi] = packet.reciprocals[axis];
        let late = L::splat(packet.origins[axis][1 - down]);
        let early = L::splat(packet.origins[axis][down]);
        let near_gap = L::load(&node.planes[packet.near[axis]]).sub(late);
        let far_gap = L::load(&node.planes[packet.far[axis]]).sub(early);
        let (lo, hi) = (L::splat(lo), L::splat(hi));
        near = near_gap.mul(lo).min(near_gap.mul(hi)).max(near);
        far = far_gap.mul(lo).max(far_gap.mul(hi)).min(far);
    }
    let far = far.mul(L::splat(slab::WIDEN)).min(L::splat(limit));
    (near.le(far), near)
}

/// Rays that meet the box in `slot` of `node` within their limits.
#[inline(always)]
fn meets<const W: usize, R: Lanes<16>>(node: &Node<W>, slot: usize, packet: &Packet) -> u32 {
    let mut near = R::splat(0.0);
    let mut far = R::splat(f32::INFINITY);
    for axis in 0..3 {
        let origin = packet.origin[axis].load::<R>();
        let reciprocal = packet.reciprocal[axis].load::<R>();
        near = R::splat(node.planes[packet.near[axis]][slot % W]).sub(origin).mul(reciprocal).max(near);
        far = R::splat(node.planes[packet.far[axis]][slot % W]).sub(origin).mul(reciprocal).min(far);
    }
    near.le(far.mul(R::splat(slab::WIDEN)).min(packet.limit.load::<R>()))
}

/// Lets the `live` rays see one triangle; the arithmetic is that of [`triangle::block`]. Returns which rays still live.
#[inline(always)]
fn one_triangle<const W: usize, R: Lanes<16>, Q: Query>(
    trunk: &Trunk<'_, W>,
    block: &Block<W>,
    lane_of_triangle: usize,
    packet: &mut Packet,
    rays: &[Ray],
    mut live: u32,
    best: &mut [Hit; LANES],
) -> u32 {
    let (ax, ay) = corner::<W, R>(&block.corners[0], lane_of_triangle, packet);
    let (bx, by) = corner::<W, R>(&block.corners[1], lane_of_triangle, packet);
    let (cx, cy) = corner::<W, R>(&block.corners[2], lane_of_triangle, packet);
    let u = cx.mul(by).sub(cy.mul(bx));
    let v = ax.mul(cy).sub(ay.mul(cx));
    let w = bx.mul(ay).sub(by.mul(ax));
    let zero = R::splat(0.0);
    let inside = zero.le(u.min(v).min(w)) | u.max(v).max(w).le(zero);
    if inside & live == 0 {
        return live;
    }
    let determinant = u.add(v).add(w);
    let mut candidates = inside & live;
    let (v, w, determinant) = (v.to_array(), w.to_array(), determinant.to_array());
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize % LANES;
        candidates &= candidates - 1;
        let ray = packet.ray(lane);
        let entry = trunk.entry(&rays[lane]);
        let covered = [v[lane], w[lane], determinant[lane]];
        if triangle::candidate(block, lane_of_triangle, &ray, &entry, covered, &mut best[lane]) {
            if Q::ANY {
                packet.limit.0[lane] = -1.0;
                live &= !(1 << lane);
            } else {
                packet.limit.0[lane] = best[lane].t;
            }
        }
    }
    live
}

/// One corner as each ray sees it.
#[inline(always)]
fn corner<const W: usize, R: Lanes<16>>(corner: &[[f32; W]; 3], lane: usize, packet: &Packet) -> (R, R) {
    let (lane, [x, y, z]) = (lane % W, packet.axes);
    let depth = R::splat(corner[z][lane]).sub(packet.origin[z].load::<R>());
    let sx = packet.shear[0].load::<R>();
    let sy = packet.shear[1].load::<R>();
    (
        R::splat(corner[x][lane]).sub(packet.origin[x].load::<R>()).sub(sx.mul(depth)),
        R::splat(corner[y][lane]).sub(packet.origin[y].load::<R>()).sub(sy.mul(depth)),
    )
}
