//! The table of the dynamic programming that collapses trees: what it costs to put a subtree below a node as one child, or
//! as several (Ylitie et al. 2017, eq. 3 to 6).

use std::sync::atomic::{AtomicU64, Ordering};

use super::collapse::Costs;

/// Least costs of a subtree as a forest of a few roots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Table<const W: usize> {
    /// With at most 1, 2 … roots, as far as `roots`.
    cost: [f32; W],
    /// Roots beyond this number are no use: there are no more primitives, or no more places in a node.
    roots: u32,
    primitives: u32,
}

impl<const W: usize> Table<W> {
    /// A single primitive in a box of the given area.
    pub(super) fn of_primitive(area: f32, costs: Costs) -> (Self, Choice) {
        let mut cost = [f32::INFINITY; W];
        cost[0] = costs.of_leaf(area, 1);
        (Self { cost, roots: 1, primitives: 1 }, Choice::LEAF)
    }

    /// A node of the given area above two subtrees; leaves have up to `fat` primitives.
    pub(super) fn above([left, right]: [&Self; 2], area: f32, costs: Costs, fat: u32) -> (Self, Choice) {
        let primitives = left.primitives + right.primitives;
        let roots = (left.roots + right.roots).min(W as u32);
        let mut cost = [f32::INFINITY; W];
        let mut of_left = [0_u8; W];
        // The cheapest forest of each size that splits between the children.
        for l in 0..(left.roots as usize).min(W - 1) {
            let rights = (right.roots as usize).min(W - 1 - l);
            let splits = cost[l + 1..].iter_mut().zip(&mut of_left[l + 1..]).zip(&right.cost[..rights]);
            for ((cost, of_left), right) in splits {
                let split = left.cost[l] + right;
                if split < *cost {
                    (*cost, *of_left) = (split, l as u8 + 1);
                }
            }
        }
        let as_leaf = if primitives <= fat { costs.of_leaf(area, primitives) } else { f32::INFINITY };
        let last = roots as usize - 1;
        let as_node = cost[last] + costs.of_node(area);
        let is_leaf = as_leaf <= as_node;
        cost[0] = as_leaf.min(as_node);
        let mut choice = Choice(u64::from(is_leaf));
        // A node has children even where they cost as much as itself: in boxes without area.
        let mut has_children = is_leaf;
        for roots in 1..=last {
            if cost[roots] < cost[roots - 1] || (roots == last && !has_children) {
                has_children = true;
                choice.0 |= u64::from(of_left[roots]) << (4 * roots);
            } else {
                cost[roots] = cost[roots - 1];
            }
        }
        (Self { cost, roots, primitives }, choice)
    }
}

/// What was chosen at a node: four bits for each number of roots. Those of one root say whether it is a leaf, the others
/// how many roots the left child provides; 0 if fewer roots are no worse.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice(u64);

impl Choice {
    const LEAF: Self = Self(1);

    /// Whether the node as a single root is a leaf.
    pub(super) const fn is_leaf(self) -> bool {
        self.0 & 15 == 1
    }

    /// The best forest of at most `roots` roots: how many it has, and how many of those the left child provides.
    pub(super) const fn forest(self, mut roots: usize) -> (usize, usize) {
        while roots > 1 {
            let left = (self.0 >> (4 * (roots - 1)) & 15) as usize;
            if left != 0 {
                return (roots, left);
            }
            roots -= 1;
        }
        (1, 0)
    }
}

/// Choices of all nodes. Each is written once, by one of several threads.
pub(super) struct Choices(Vec<AtomicU64>);

impl Choices {
    pub(super) fn for_nodes(count: usize) -> Self {
        Self((0..count).map(|_| AtomicU64::new(0)).collect())
    }

    pub(super) fn set(&self, node: usize, choice: Choice) {
        self.0[node].store(choice.0, Ordering::Relaxed);
    }

    pub(super) fn of(&self, node: usize) -> Choice {
        Choice(self.0[node].load(Ordering::Relaxed))
    }
}
