//! Binary trees: what the builder makes, and what is collapsed to wide nodes.

use glam::{Vec3, Vec3A, Vec3Swizzles};
use rayon::prelude::*;

use super::layout::{Bounds, Child};

/// Axis-aligned box in vector registers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aabb {
    pub(super) lo: Vec3A,
    pub(super) hi: Vec3A,
}

impl Aabb {
    pub(super) const EMPTY: Self = Self { lo: Vec3A::INFINITY, hi: Vec3A::NEG_INFINITY };

    #[inline]
    pub(super) fn of_points(points: &[Vec3; 3]) -> Self {
        let [a, b, c] = points.map(Vec3A::from);
        Self { lo: a.min(b).min(c), hi: a.max(b).max(c) }
    }

    #[inline]
    pub(super) fn union(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Half of the surface area. Coordinates that are traced cannot overflow it.
    #[inline]
    pub(super) fn half_area(self) -> f32 {
        let d = (self.hi - self.lo).max(Vec3A::ZERO);
        d.dot(d.yzx())
    }
}

impl From<Bounds> for Aabb {
    fn from(b: Bounds) -> Self {
        Self { lo: b.lo.into(), hi: b.hi.into() }
    }
}

impl From<Aabb> for Bounds {
    fn from(b: Aabb) -> Self {
        Self { lo: b.lo.into(), hi: b.hi.into() }
    }
}

/// Binary tree with one primitive a leaf. The root is node 0; siblings stand side by side, left ones at odd indices.
#[derive(Debug, Default)]
pub(super) struct Binary {
    pub(super) bounds: Vec<Aabb>,
    /// The left child of an inner node, or the primitive of a leaf.
    pub(super) links: Vec<Child>,
}

impl Binary {
    /// A tree with room for `nodes`, none of which means anything yet.
    pub(super) fn with_nodes(nodes: usize) -> Self {
        Self {
            bounds: rayon::iter::repeat_n(Aabb::EMPTY, nodes).collect(),
            links: rayon::iter::repeat_n(Child::ROOT, nodes).collect(),
        }
    }

    /// Children of an inner node.
    #[inline]
    pub(super) fn children(&self, node: usize) -> [usize; 2] {
        let left = self.links[node].index();
        [left, left + 1]
    }

    /// Puts `primitives` without boxes beside what is there, halved again and again in their order.
    pub(super) fn append(&mut self, primitives: &[u32]) {
        if primitives.is_empty() {
            return;
        }
        let slot = if self.links.is_empty() {
            self.push(Aabb::EMPTY, Child::ROOT)
        } else {
            let left = self.push(self.bounds[0], self.links[0]);
            self.links[0] = Child::node(left);
            self.push(Aabb::EMPTY, Child::ROOT)
        };
        let mut pending = vec![(slot, primitives)];
        while let Some((slot, primitives)) = pending.pop() {
            if let [primitive] = primitives {
                self.links[slot] = Child::leaf(*primitive as usize);
                continue;
            }
            let (left, right) = primitives.split_at(primitives.len() / 2);
            let slots = [(); 2].map(|()| self.push(Aabb::EMPTY, Child::ROOT));
            self.links[slot] = Child::node(slots[0]);
            pending.extend([(slots[0], left), (slots[1], right)]);
        }
    }

    fn push(&mut self, bounds: Aabb, link: Child) -> usize {
        self.bounds.push(bounds);
        self.links.push(link);
        self.links.len() - 1
    }

    /// Primitives below `node`, from left to right.
    pub(super) fn gather<'a>(&self, node: usize, scratch: &'a mut Scratch) -> &'a [u32] {
        let Scratch { pending, primitives } = scratch;
        primitives.clear();
        pending.push(node);
        while let Some(node) = pending.pop() {
            let link = self.links[node];
            if link.is_leaf() {
                primitives.push(link.index() as u32);
            } else {
                let [left, right] = self.children(node);
                pending.extend([right, left]);
            }
        }
        primitives
    }
}

/// Memory of [`Binary::gather`].
#[derive(Default)]
pub(super) struct Scratch {
    pending: Vec<usize>,
    primitives: Vec<u32>,
}
