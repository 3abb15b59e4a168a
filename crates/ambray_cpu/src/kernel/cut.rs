//! Where the rays of a batch enter the tree.
//!
//! The rays of a batch start near each other and end within a radius, so most of the tree is out of their reach. A node is
//! made for the batch that takes the place of the root: its children are the subtrees that the box of all rays overlaps,
//! opened as far as they fit (an entry point as of Reshetov et al. 2005, but a cut of the tree instead of one node). Their
//! boxes are those of the tree, so no answer changes.

use ambray_core::trace::Ray;
use glam::Vec3A;

use super::lanes::Rays;

use crate::bvh::layout::{Bounds, Child, Node};

/// Fewer rays do not pay for a cut.
const WORTHWHILE: usize = 64;

/// Most subtrees that are opened.
const MOST_OPENED: usize = 32;

/// Box around all points that the rays may reach, grown by more than what rounding can move a point of the slab test; `None`
/// if there is no end to it.
///
/// Rays that are not finite, and so hit nothing, do not count: where a new value is not a number, minimum and maximum
/// return the old one.
#[inline(always)]
fn reach<R: Rays>(rays: &[Ray]) -> Option<Bounds> {
    let mut lows = [R::splat(f32::INFINITY); 3];
    let mut highs = [R::splat(f32::NEG_INFINITY); 3];
    let mut longest = R::splat(0.0);
    // The last sixteen are seen twice rather than fewer at a time.
    let (sixteens, _) = rays.as_chunks();
    for sixteen in sixteens.iter().chain(rays.last_chunk()) {
        let [ox, oy, oz, t_max, dx, dy, dz, _] = R::transposed(sixteen);
        for (axis, (origin, direction)) in [(ox, dx), (oy, dy), (oz, dz)].into_iter().enumerate() {
            let end = origin.add(direction.mul(t_max));
            lows[axis] = end.min(origin.min(lows[axis]));
            highs[axis] = end.max(origin.max(highs[axis]));
        }
        longest = t_max.max(longest);
    }
    let low = glam::Vec3::new(lows[0].smallest(), lows[1].smallest(), lows[2].smallest());
    let high = glam::Vec3::new(highs[0].largest(), highs[1].largest(), highs[2].largest());
    let longest = longest.largest();
    let pad = (low.abs().max(high.abs()).max_element() + (high - low).max_element()) * (1.0 / 65_536.0);
    let is_bounded = longest.is_finite() && low.is_finite() && high.is_finite() && pad.is_finite();
    is_bounded.then(|| Bounds { lo: low - pad, hi: high + pad })
}

/// A subtree.
#[derive(Clone, Copy)]
struct Part {
    child: Child,
    bounds: Bounds,
    /// Half of the surface area of what the rays may reach of it: how likely a ray meets it.
    weight: f32,
}

/// The node that takes the place of the root of the tree with `nodes`, at least one, for `rays`.
#[inline(always)]
pub(crate) fn root<const W: usize, R: Rays>(nodes: &[Node<W>], rays: &[Ray]) -> Node<W> {
    let all = &nodes[0];
    let Some(reach) = Some(rays).filter(|rays| rays.len() >= WORTHWHILE).and_then(reach::<R>) else {
        return all.clone();
    };
    let mut parts = [Part { child: Child::ROOT, bounds: Bounds::EMPTY, weight: 0.0 }; W];
    let mut count = overlapping(all, &reach, &mut parts, 0);
    let mut opened = [Part { child: Child::ROOT, bounds: Bounds::EMPTY, weight: 0.0 }; W];
    // Subtrees that are not opened any more: leaves, and those whose children do not fit.
    let mut closed = [false; W];
    for _ in 0..MOST_OPENED {
        let largest = (0..count)
            .filter(|&i| !closed[i] && !parts[i].child.is_leaf())
            .max_by(|&a, &b| parts[a].weight.total_cmp(&parts[b].weight));
        let Some(largest) = largest else { break };
        let inner = overlapping(&nodes[parts[largest].child.index()], &reach, &mut opened, 0);
        if count - 1 + inner > W {
            closed[largest] = true;
            continue;
        }
        // The last takes its place.
        parts[largest] = parts[count - 1];
        closed[largest] = closed[count - 1];
        parts[count - 1..count - 1 + inner].copy_from_slice(&opened[..inner]);
        closed[count - 1..count - 1 + inner].fill(false);
        count = count - 1 + inner;
    }
    let mut node = Node::EMPTY;
    for (slot, part) in parts[..count].iter().enumerate() {
        for axis in 0..3 {
            node.planes[axis][slot] = part.bounds.lo[axis];
            node.planes[axis + 3][slot] = part.bounds.hi[axis];
        }
        node.children[slot] = part.child;
    }
    node
}

/// Writes the children of `node` that overlap `reach` to `parts` from `count` on; returns where they end.
#[inline(always)]
fn overlapping<const W: usize>(
    node: &Node<W>,
    reach: &Bounds,
    parts: &mut [Part; W],
    mut count: usize,
) -> usize {
    for slot in 0..W {
        let plane = |axis: usize| node.planes[axis][slot];
        let bounds = Bounds {
            lo: glam::Vec3::new(plane(0), plane(1), plane(2)),
            hi: glam::Vec3::new(plane(3), plane(4), plane(5)),
        };
        let (low, high) = (Vec3A::from(bounds.lo.max(reach.lo)), Vec3A::from(bounds.hi.min(reach.hi)));
        if low.cmple(high).all() {
            let d = high - low;
            let weight = d.x * d.y + d.y * d.z + d.z * d.x;
            parts[count] = Part { child: node.children[slot], bounds, weight };
            count += 1;
        }
    }
    count
}
