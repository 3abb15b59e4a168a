//! From a binary tree to a wide one of least surface-area cost, by dynamic programming (Ylitie et al. 2017, §3.1).

use std::collections::{BinaryHeap, HashMap};

use rayon::prelude::*;

use super::binary::Binary;
use super::forest::{Choices, Table};
use super::layout::{Child, Node};

/// What steps of the traversal cost, relative to each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Costs {
    /// Test of all children of a node.
    pub(crate) node: f32,
    /// Test of a leaf, whatever is in it: structure of arrays makes leaves fat.
    pub(crate) leaf: f32,
    /// What each primitive of a leaf adds.
    pub(crate) primitive: f32,
    /// What a node or leaf costs by being there, in the unit of the others for a box like that of the root, over the number of
    /// primitives.
    pub(crate) storage: f32,
}

impl Costs {
    pub(crate) const TRIANGLES: Self = Self { node: 1.0, leaf: 0.9, primitive: 0.03, storage: STORAGE };
    pub(crate) const INSTANCES: Self = Self { node: 1.0, leaf: 0.0, primitive: 4.0, storage: 0.0 };

    /// Of a leaf with a box of the given area.
    pub(super) const fn of_leaf(&self, area: f32, primitives: u32) -> f32 {
        area * (self.leaf + self.primitive * primitives as f32) + self.storage
    }

    /// Of a node with a box of the given area, without what is below.
    pub(super) const fn of_node(&self, area: f32) -> f32 {
        area * self.node + self.storage
    }
}

/// See [`Costs::storage`].
const STORAGE: f32 = 0.7;

/// Subtrees that threads take one at a time; enough that none of them is a bottleneck.
const SUBTREES: usize = 512;

/// Result of [`collapse`].
#[derive(Debug, Default)]
pub(super) struct Wide<const W: usize> {
    /// In the order of a depth-first walk. Children that are leaves are indices into `leaves`.
    pub(super) nodes: Vec<Node<W>>,
    /// Binary nodes that became leaves, in the same order.
    pub(super) leaves: Vec<u32>,
    pub(super) depth: usize,
    /// Nodes and leaves counted as 1, weighed by surface area relative to the root.
    pub(super) sah_cost: f32,
}

/// Collapses `tree` to nodes of up to `W` children and leaves of up to `fat` primitives.
pub(super) fn collapse<const W: usize>(tree: &Binary, costs: Costs, fat: u32) -> Wide<W> {
    if tree.links.is_empty() {
        return Wide::default();
    }
    let primitives = tree.links.len() / 2 + 1;
    let storage = costs.storage * tree.bounds[0].half_area() / primitives as f32;
    let choices = choices::<W>(tree, Costs { storage, ..costs }, fat);
    let scale = 1.0 / tree.bounds[0].half_area().max(f32::MIN_POSITIVE);
    let mut wide = Wide::default();
    let mut children = Vec::with_capacity(W);
    // Nodes to write: binary node, where the reference to it goes (node and slot), and depth.
    let mut pending = vec![(0, None::<(usize, usize)>, 1_usize)];
    while let Some((index, parent, depth)) = pending.pop() {
        wide.depth = wide.depth.max(depth);
        wide.sah_cost += tree.bounds[index].half_area() * scale;
        let child = if choices.of(index).is_leaf() && parent.is_some() {
            wide.leaves.push(index as u32);
            Child::leaf(wide.leaves.len() - 1)
        } else {
            gather_children::<W>(tree, &choices, index, &mut children);
            let mut node = Node::EMPTY;
            for (slot, &child) in children.iter().enumerate() {
                let bounds = tree.bounds[child];
                for axis in 0..3 {
                    node.planes[axis][slot] = bounds.lo[axis];
                    node.planes[axis + 3][slot] = bounds.hi[axis];
                }
            }
            wide.nodes.push(node);
            let written = wide.nodes.len() - 1;
            let below = children.iter().enumerate().rev();
            pending.extend(below.map(|(slot, &child)| (child, Some((written, slot)), depth + 1)));
            Child::node(written)
        };
        if let Some((node, slot)) = parent {
            wide.nodes[node].children[slot] = child;
        }
    }
    wide
}

/// Binary nodes that become the children of the wide node at `index`.
fn gather_children<const W: usize>(
    tree: &Binary,
    choices: &Choices,
    index: usize,
    children: &mut Vec<usize>,
) {
    children.clear();
    if choices.of(index).is_leaf() {
        children.push(index); // the root of a tree that is a single leaf
        return;
    }
    let split = |index: usize, roots: usize, left: usize| {
        let [l, r] = tree.children(index);
        [(r, roots - left), (l, left)]
    };
    let mut pending = Vec::with_capacity(W);
    let (roots, left) = choices.of(index).forest(W);
    pending.extend(split(index, roots, left));
    while let Some((index, roots)) = pending.pop() {
        match choices.of(index).forest(roots) {
            (1, _) => children.push(index),
            (roots, left) => pending.extend(split(index, roots, left)),
        }
    }
}

/// What the dynamic programming chooses at each node: subtrees first, several at a time, then what is above them.
fn choices<const W: usize>(tree: &Binary, costs: Costs, fat: u32) -> Choices {
    let choices = Choices::for_nodes(tree.links.len());
    let (trunk, subtrees) = split(tree);
    let table = |&root: &usize| (root, subtree::<W>(tree, root, costs, fat, &choices));
    let mut tables: HashMap<_, _> = subtrees.par_iter().map(table).collect();
    for node in trunk.into_iter().rev() {
        let below = tree.children(node).map(|child| tables.remove(&child).expect("children come first"));
        let [left, right] = &below;
        let (table, choice) = Table::above([left, right], tree.bounds[node].half_area(), costs, fat);
        choices.set(node, choice);
        tables.insert(node, table);
    }
    choices
}

/// Nodes near the root, each before its children, and the subtrees below them. Those with the largest boxes are taken apart.
fn split(tree: &Binary) -> (Vec<usize>, Vec<usize>) {
    let entry = |node: usize| (tree.bounds[node].half_area().to_bits(), node);
    let mut subtrees = BinaryHeap::from([entry(0)]);
    let (mut trunk, mut leaves) = (Vec::new(), Vec::new());
    while subtrees.len() + leaves.len() < SUBTREES
        && let Some((_, node)) = subtrees.pop()
    {
        if tree.links[node].is_leaf() {
            leaves.push(node);
        } else {
            trunk.push(node);
            subtrees.extend(tree.children(node).map(entry));
        }
    }
    leaves.extend(subtrees.into_iter().map(|(_, node)| node));
    (trunk, leaves)
}

/// The table of a subtree, whose choices are put among those of all. Nothing recurses: trees of strange meshes are deep.
fn subtree<const W: usize>(
    tree: &Binary,
    root: usize,
    costs: Costs,
    fat: u32,
    choices: &Choices,
) -> Table<W> {
    let mut finished: Vec<Table<W>> = Vec::new();
    // A node is visited again, after its children, with `expanded` set.
    let mut pending = vec![(root, false)];
    while let Some((node, expanded)) = pending.pop() {
        let area = tree.bounds[node].half_area();
        let (table, choice) = if tree.links[node].is_leaf() {
            Table::of_primitive(area, costs)
        } else if expanded {
            let [.., left, right] = &finished[..] else {
                unreachable!("both children are finished before their parent");
            };
            let above = Table::above([left, right], area, costs, fat);
            finished.truncate(finished.len() - 2);
            above
        } else {
            let [left, right] = tree.children(node);
            pending.extend([(node, true), (right, false), (left, false)]);
            continue;
        };
        choices.set(node, choice);
        finished.push(table);
    }
    finished.pop().expect("a subtree has a root")
}
