//! From a binary tree to a wide one of least surface-area cost, by dynamic programming (Ylitie et al. 2017, §3.1).

use super::build::{Binary, BinaryNode};
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
}

impl Costs {
    pub(crate) const TRIANGLES: Self = Self { node: 1.0, leaf: 0.9, primitive: 0.03 };
    pub(crate) const INSTANCES: Self = Self { node: 1.0, leaf: 0.0, primitive: 4.0 };
}

/// Result of [`collapse`].
#[derive(Debug, Default)]
pub(crate) struct Wide<const W: usize> {
    pub(crate) nodes: Vec<Node<W>>,
    pub(crate) depth: usize,
    /// Nodes and leaves counted as 1, weighed by surface area relative to the root.
    pub(crate) sah_cost: f32,
}

/// The forest of the `i` roots that [`Table::cost`] speaks of costs no less than the one of `i - 1`.
const SAME: u8 = 0x80;

/// Least costs of a binary node's subtree, for 1 to `W` roots at entries 0 to `W - 1`.
#[derive(Clone, Copy)]
struct Table<const W: usize> {
    cost: [f32; W],
    /// How many roots the left child provides, for forests of 2 to `W` roots; with [`SAME`] fewer roots are no worse.
    left: [u8; W],
    /// Whether a single root is a leaf.
    leaf: bool,
}

/// Collapses `tree` to nodes of up to `W` children and leaves of up to `fat` primitives. `leaf` stores the primitives of
/// a leaf and returns the reference to it; it is called in the order of a depth-first walk.
pub(crate) fn collapse<const W: usize>(
    tree: &Binary,
    costs: Costs,
    fat: u32,
    leaf: &mut dyn FnMut(&[u32]) -> Child,
) -> Wide<W> {
    let Some(root) = tree.nodes.len().checked_sub(1) else {
        return Wide::default();
    };
    let scale = 1.0 / tree.nodes[root].bounds.half_area().max(f64::MIN_POSITIVE);
    let area = |node: &BinaryNode| (node.bounds.half_area() * scale) as f32;
    let tables = tables::<W>(tree, costs, fat, &area);

    let mut wide = Wide::default();
    let mut primitives = Vec::new();
    // Nodes to write: binary node, where the reference to it goes (node and slot), and depth.
    let mut pending = vec![(root, None::<(usize, usize)>, 1_usize)];
    while let Some((index, parent, depth)) = pending.pop() {
        let binary = &tree.nodes[index];
        wide.depth = wide.depth.max(depth);
        wide.sah_cost += area(binary);
        let child = if tables[index].leaf && parent.is_some() {
            gather_primitives(tree, index, &mut primitives);
            leaf(&primitives)
        } else {
            let mut node = Node::EMPTY;
            let slots = gather_children(tree, &tables, index);
            for (slot, &child) in slots.iter().enumerate() {
                let bounds = tree.nodes[child].bounds;
                for axis in 0..3 {
                    node.planes[axis][slot] = bounds.lo[axis];
                    node.planes[axis + 3][slot] = bounds.hi[axis];
                }
            }
            wide.nodes.push(node);
            let written = wide.nodes.len() - 1;
            let below = slots.iter().enumerate().rev();
            pending.extend(below.map(|(slot, &child)| (child, Some((written, slot)), depth + 1)));
            Child::node(written)
        };
        if let Some((node, slot)) = parent {
            wide.nodes[node].children[slot] = child;
        }
    }
    wide
}

#[allow(clippy::needless_range_loop, reason = "several tables are indexed by the number of roots")]
fn tables<const W: usize>(
    tree: &Binary,
    costs: Costs,
    fat: u32,
    area: &dyn Fn(&BinaryNode) -> f32,
) -> Vec<Table<W>> {
    let mut tables: Vec<Table<W>> = Vec::with_capacity(tree.nodes.len());
    for node in &tree.nodes {
        let as_leaf = if node.leaves <= fat {
            area(node) * (costs.leaf + costs.primitive * node.leaves as f32)
        } else {
            f32::INFINITY
        };
        let mut table = Table { cost: [as_leaf; W], left: [SAME; W], leaf: true };
        if !node.is_leaf() {
            let [l, r] = node.children.map(|child| &tables[child as usize]);
            // The cheapest forest of each size that splits between the children.
            let mut split = [f32::INFINITY; W];
            for roots in 1..W {
                for left in 0..roots {
                    let cost = l.cost[left] + r.cost[roots - 1 - left];
                    if cost < split[roots] {
                        split[roots] = cost;
                        table.left[roots] = left as u8 + 1;
                    }
                }
            }
            let as_node = split[W - 1] + area(node) * costs.node;
            table.leaf = as_leaf <= as_node;
            table.cost[0] = as_leaf.min(as_node);
            for roots in 1..W {
                if split[roots] < table.cost[roots - 1] {
                    table.cost[roots] = split[roots];
                } else {
                    table.cost[roots] = table.cost[roots - 1];
                    table.left[roots] |= SAME;
                }
            }
        }
        tables.push(table);
    }
    tables
}

/// Binary nodes that become the children of the wide node at `index`.
fn gather_children<const W: usize>(tree: &Binary, tables: &[Table<W>], index: usize) -> Vec<usize> {
    let mut children = Vec::with_capacity(W);
    if tree.nodes[index].is_leaf() {
        return vec![index]; // a root with a single primitive
    }
    let mut pending = Vec::with_capacity(W);
    let split = |pending: &mut Vec<(usize, usize)>, index: usize, roots: usize, left: usize| {
        let [l, r] = tree.nodes[index].children;
        pending.extend([(r as usize, roots - left), (l as usize, left)]);
    };
    split(&mut pending, index, W, usize::from(tables[index].left[W - 1] & !SAME));
    while let Some((index, mut roots)) = pending.pop() {
        let table = &tables[index];
        while roots > 1 && table.left[roots - 1] & SAME != 0 {
            roots -= 1;
        }
        if roots == 1 {
            children.push(index);
        } else {
            split(&mut pending, index, roots, usize::from(table.left[roots - 1]));
        }
    }
    children
}

/// Primitives below the binary node `index`.
fn gather_primitives(tree: &Binary, index: usize, primitives: &mut Vec<u32>) {
    primitives.clear();
    let mut pending = vec![index];
    while let Some(index) = pending.pop() {
        let node = &tree.nodes[index];
        if node.is_leaf() {
            primitives.push(node.children[1]);
        } else {
            pending.extend(node.children.iter().rev().map(|&child| child as usize));
        }
    }
}
