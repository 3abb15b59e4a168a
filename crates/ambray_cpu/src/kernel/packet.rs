//! Sixteen rays at once through the tree of unshared triangles.
//!
//! Nodes are culled for the whole packet by interval arithmetic (Boulos et al. 2006), which stands on the same monotone
//! operations as the slab test and so never culls what the slab test of a single ray keeps. A child's box is tested against
//! each ray when its turn comes; few remaining rays go on alone. Answers are those of [`single`](super::single), bit for
//! bit: both test the same triangles in the same arithmetic, and the order of tests does not matter.

use std::mem::MaybeUninit;

use ambray_core::trace::{Hit, Ray};

use super::lanes::Lanes;
use super::ray::Prepared;
use super::triangle::{self, Entry};
use super::{Query, Scene, single, slab};
use crate::bvh::layout::{Block, Child, Node};

/// Rays of a packet.
pub(crate) const LANES: usize = 16;

/// Up to this many live rays go on one by one. Measured on Sponza.
const ALONE: u32 = 3;

/// Sixteen numbers, one a ray.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Numbers([f32; LANES]);

/// Rays that agree in the order of planes and in the longest axis.
struct Packet {
    origin: [Numbers; 3],
    reciprocal: [Numbers; 3],
    shear: [Numbers; 3],
    /// t of the best hits so far, or ends of the rays; negative for rays that are answered or absent.
    limit: Numbers,
    /// Smallest and largest of the live rays.
    origins: [[f32; 2]; 3],
    reciprocals: [[f32; 2]; 3],
}

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

/// Answers up to 16 rays.
#[inline(always)]
pub(crate) fn trace<const W: usize, L: Lanes<W>, R: Lanes<16>, Q: Query>(
    scene: &Scene<'_, W>,
    rays: &[Ray],
    answers: &mut [Q::Answer],
    scratch: &mut Scratch,
) {
    let mut prepared = [MaybeUninit::<Prepared>::uninit(); LANES];
    let mut best = [Hit::MISS; LANES];
    let mut waiting = 0_u32;
    for (lane, ray) in rays.iter().enumerate().take(LANES) {
        if ray.t_max > 0.0
            && let Some(ready) = Prepared::new(ray.origin, ray.direction)
        {
            prepared[lane].write(ready);
            best[lane].t = ray.t_max;
            waiting |= 1 << lane;
        }
    }
    let started = waiting;
    // Rays of one direction class a time; deinterleaved rays are mostly all of one.
    while waiting != 0 {
        let first = waiting.trailing_zeros() as usize % LANES;
        // SAFETY: lanes in `waiting` were written above.
        let leader = unsafe { prepared[first].assume_init_ref() };
        let mut group = 0_u32;
        let mut rest = waiting;
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize % LANES;
            rest &= rest - 1;
            // SAFETY: lanes in `waiting` were written above.
            let ray = unsafe { prepared[lane].assume_init_ref() };
            group |= u32::from(ray.near == leader.near && ray.axes == leader.axes) << lane;
        }
        waiting &= !group;
        if !scene.baked.nodes.is_empty() {
            walk::<W, L, R, Q>(scene, rays, &prepared, group, leader, &mut best, scratch);
        }
    }
    for (lane, (ray, answer)) in rays.iter().zip(answers).enumerate().take(LANES) {
        let best = &mut best[lane];
        if started >> lane & 1 != 0 && !scene.shared.nodes.is_empty() && !(Q::ANY && best.is_hit()) {
            // SAFETY: lanes in `started` were written above.
            let prepared = unsafe { prepared[lane].assume_init_ref() };
            single::instances::<W, L, Q>(scene, ray, prepared, best, &mut scratch.single);
        }
        *answer = Q::answer(if best.is_hit() { *best } else { Hit::MISS });
    }
}

/// Walks the rays of `group` through the tree of unshared triangles.
#[inline(always)]
fn walk<const W: usize, L: Lanes<W>, R: Lanes<16>, Q: Query>(
    scene: &Scene<'_, W>,
    rays: &[Ray],
    prepared: &[MaybeUninit<Prepared>; LANES],
    group: u32,
    leader: &Prepared,
    best: &mut [Hit; LANES],
    scratch: &mut Scratch,
) {
    let tree = scene.baked;
    let mut packet = gather(prepared, group, leader, best);
    let stack = &mut scratch.packet;
    let mut top = 0;
    let mut child = Child::ROOT;
    let mut live = group;
    loop {
        if live.count_ones() <= ALONE {
            while live != 0 {
                let lane = live.trailing_zeros() as usize % LANES;
                live &= live - 1;
                // SAFETY: lanes of the group are written.
                let ray = unsafe { prepared[lane].assume_init_ref() };
                let entry = Entry { instance: None, near: 0.0, seed: rays[lane].seed, alpha: scene.alpha };
                let done =
                    single::blas::<W, L, Q>(tree, child, ray, &entry, &mut best[lane], &mut scratch.single);
                packet.limit.0[lane] = if done && Q::ANY { -1.0 } else { best[lane].t };
            }
        } else if child.is_leaf() {
            let block = &tree.blocks[child.index()];
            if live.count_ones() < block.count {
                while live != 0 {
                    let lane = live.trailing_zeros() as usize % LANES;
                    live &= live - 1;
                    // SAFETY: lanes of the group are written.
                    let ray = unsafe { prepared[lane].assume_init_ref() };
                    let entry =
                        Entry { instance: None, near: 0.0, seed: rays[lane].seed, alpha: scene.alpha };
                    let done = triangle::block::<W, L, Q>(block, ray, &entry, &mut best[lane]);
                    packet.limit.0[lane] = if done && Q::ANY { -1.0 } else { best[lane].t };
                }
            } else {
                for triangle in 0..block.count as usize {
                    live = one_triangle::<W, R, Q>(
                        scene,
                        block,
                        triangle,
                        leader.axes,
                        &mut packet,
                        rays,
                        prepared,
                        live,
                        best,
                    );
                    if live == 0 {
                        break;
                    }
                }
            }
        } else {
            let node = &tree.nodes[child.index()];
            let limit = largest(&packet.limit, group);
            let (mut mask, near) = children::<W, L>(node, leader, &packet, limit);
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
            if top == 0 {
                return;
            }
            top -= 1;
            // SAFETY: entries below `top` were written before `top` moved past them.
            let pending = unsafe { stack[top].assume_init() };
            let node = &tree.nodes[pending.node as usize];
            live = group & meets::<W, R>(node, pending.slot as usize, leader, &packet);
            if live != 0 {
                child = pending.child;
                break;
            }
        }
    }
}

#[inline(always)]
fn gather(
    prepared: &[MaybeUninit<Prepared>; LANES],
    group: u32,
    leader: &Prepared,
    best: &[Hit; LANES],
) -> Packet {
    let zero = Numbers([0.0; LANES]);
    let mut packet = Packet {
        origin: [zero; 3],
        reciprocal: [zero; 3],
        shear: [zero; 3],
        limit: Numbers([-1.0; LANES]),
        origins: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
        reciprocals: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
    };
    for lane in 0..LANES {
        let ray = if group >> lane & 1 != 0 {
            packet.limit.0[lane] = best[lane].t;
            // SAFETY: lanes of the group are written.
            unsafe { prepared[lane].assume_init_ref() }
        } else {
            leader
        };
        for axis in 0..3 {
            packet.origin[axis].0[lane] = ray.origin[axis];
            packet.reciprocal[axis].0[lane] = ray.reciprocal[axis];
            packet.shear[axis].0[lane] = ray.shear[axis];
            let [lo, hi] = packet.origins[axis];
            packet.origins[axis] = [lo.min(ray.origin[axis]), hi.max(ray.origin[axis])];
            let [lo, hi] = packet.reciprocals[axis];
            packet.reciprocals[axis] = [lo.min(ray.reciprocal[axis]), hi.max(ray.reciprocal[axis])];
        }
    }
    packet
}

#[inline(always)]
fn largest(numbers: &Numbers, group: u32) -> f32 {
    let mut largest = -1.0;
    for lane in 0..LANES {
        let x = numbers.0[lane];
        if group >> lane & 1 != 0 && x > largest {
            largest = x;
        }
    }
    largest
}

/// Children of `node` that some ray of the packet may meet, and bounds on the near distances.
///
/// For an axis along which the rays point upwards, (plane − origin) · reciprocal lies between the products of
/// plane − largest origin, plane − smallest origin with the smallest and largest reciprocal; downwards the roles of the
/// origins swap.
#[inline(always)]
fn children<const W: usize, L: Lanes<W>>(
    node: &Node<W>,
    leader: &Prepared,
    packet: &Packet,
    limit: f32,
) -> (u32, L) {
    let mut near = L::splat(0.0);
    let mut far = L::splat(f32::INFINITY);
    for axis in 0..3 {
        let down = usize::from(leader.near[axis] >= 3);
        let [lo, hi] = packet.reciprocals[axis];
        let late = L::splat(packet.origins[axis][1 - down]);
        let early = L::splat(packet.origins[axis][down]);
        let near_gap = L::load(&node.planes[leader.near[axis]]).sub(late);
        let far_gap = L::load(&node.planes[leader.far[axis]]).sub(early);
        let (lo, hi) = (L::splat(lo), L::splat(hi));
        near = near_gap.mul(lo).min(near_gap.mul(hi)).max(near);
        far = far_gap.mul(lo).max(far_gap.mul(hi)).min(far);
    }
    let far = far.mul(L::splat(slab::WIDEN)).min(L::splat(limit));
    (near.le(far), near)
}

/// Rays that meet the box in `slot` of `node` within their limits.
#[inline(always)]
fn meets<const W: usize, R: Lanes<16>>(
    node: &Node<W>,
    slot: usize,
    leader: &Prepared,
    packet: &Packet,
) -> u32 {
    let mut near = R::splat(0.0);
    let mut far = R::splat(f32::INFINITY);
    for axis in 0..3 {
        let origin = R::load(&packet.origin[axis].0);
        let reciprocal = R::load(&packet.reciprocal[axis].0);
        near = R::splat(node.planes[leader.near[axis]][slot % W]).sub(origin).mul(reciprocal).max(near);
        far = R::splat(node.planes[leader.far[axis]][slot % W]).sub(origin).mul(reciprocal).min(far);
    }
    near.le(far.mul(R::splat(slab::WIDEN)).min(R::load(&packet.limit.0)))
}

/// Lets the `live` rays see one triangle; the arithmetic is that of [`triangle::block`]. Returns which rays still live.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "parts of one loop, split for reading")]
fn one_triangle<const W: usize, R: Lanes<16>, Q: Query>(
    scene: &Scene<'_, W>,
    block: &Block<W>,
    lane_of_triangle: usize,
    axes: [usize; 3],
    packet: &mut Packet,
    rays: &[Ray],
    prepared: &[MaybeUninit<Prepared>; LANES],
    mut live: u32,
    best: &mut [Hit; LANES],
) -> u32 {
    let (ax, ay, az) = corner::<W, R>(&block.corners[0], lane_of_triangle, axes, packet);
    let (bx, by, bz) = corner::<W, R>(&block.corners[1], lane_of_triangle, axes, packet);
    let (cx, cy, cz) = corner::<W, R>(&block.corners[2], lane_of_triangle, axes, packet);
    let u = cx.mul(by).sub(cy.mul(bx));
    let v = ax.mul(cy).sub(ay.mul(cx));
    let w = bx.mul(ay).sub(by.mul(ax));
    let zero = R::splat(0.0);
    let inside = zero.le(u.min(v).min(w)) | u.max(v).max(w).le(zero);
    if inside & live == 0 {
        return live;
    }
    let determinant = u.add(v).add(w);
    let shear = R::load(&packet.shear[2].0);
    let t = u.mul(az).add(v.mul(bz)).add(w.mul(cz)).div(determinant).mul(shear);
    let mut candidates = inside & live & zero.lt(t) & t.le(R::load(&packet.limit.0));
    if candidates == 0 {
        return live;
    }
    let (t, v, w, determinant) = (t.to_array(), v.to_array(), w.to_array(), determinant.to_array());
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize % LANES;
        candidates &= candidates - 1;
        // SAFETY: live lanes are written.
        let ray = unsafe { prepared[lane].assume_init_ref() };
        let entry = Entry { instance: None, near: 0.0, seed: rays[lane].seed, alpha: scene.alpha };
        let covered = [t[lane], v[lane], w[lane], determinant[lane]];
        if triangle::candidate(block, lane_of_triangle, ray, &entry, covered, &mut best[lane]) {
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
fn corner<const W: usize, R: Lanes<16>>(
    corner: &[[f32; W]; 3],
    lane: usize,
    [x, y, z]: [usize; 3],
    packet: &Packet,
) -> (R, R, R) {
    let lane = lane % W;
    let depth = R::splat(corner[z][lane]).sub(R::load(&packet.origin[z].0));
    let sx = R::load(&packet.shear[0].0);
    let sy = R::load(&packet.shear[1].0);
    (
        R::splat(corner[x][lane]).sub(R::load(&packet.origin[x].0)).sub(sx.mul(depth)),
        R::splat(corner[y][lane]).sub(R::load(&packet.origin[y].0)).sub(sy.mul(depth)),
        depth,
    )
}
