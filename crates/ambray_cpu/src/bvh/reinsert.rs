//! Parallel reinsertion (Meister and Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization"): large
//! nodes are taken out and put beside the node where they add the least surface area.
//!
//! As in the paper all nodes of a batch look for their places at once, and those that gain most are moved first, unless a
//! move before touched the same nodes. Every order is total, so trees do not depend on the number of threads.

use rayon::prelude::*;

use super::binary::{Aabb, Binary};

/// Batches take 1, 1/3, 1/5 … of the share: nodes near the root are worth most, and are tried most often.
const BATCHES: usize = 16;
/// Nodes from which those of a batch are chosen, per node of the batch. The first nodes of a tree are those that were made last, near
/// the root; among them the largest are soon found.
const CHOICE: usize = 2;

/// Moves nodes of `tree`, of the largest `share` of them.
pub(super) fn optimize(tree: &mut Binary, share: f32) {
    let nodes = tree.links.len();
    if nodes < 4 || share <= 0.0 {
        return;
    }
    let mut parents = Parents::of(tree);
    let mut touched = vec![0; nodes];
    for batch in 0..BATCHES {
        let size = ((nodes as f32 * share) as usize / (2 * batch + 1)).clamp(1, nodes - 1);
        let largest = largest(tree, size);
        let mut moves: Vec<_> = largest
            .par_iter()
            .with_min_len(16)
            .map_init(Vec::new, |stack, &node| best_move(tree, &parents, node, stack))
            .flatten_iter()
            .collect();
        moves.par_sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        for Move { from, to, .. } in moves {
            let mine = [from, sibling(from), parents.of_node(from), to, parents.of_node(to)];
            let batch = batch as u8 + 1;
            if mine.iter().all(|&node| touched[node] != batch) && !parents.is_below(to, from) {
                for node in mine {
                    touched[node] = batch;
                }
                reinsert(tree, &mut parents, from, to);
            }
        }
    }
}

/// The other child of a node's parent.
const fn sibling(node: usize) -> usize {
    ((node - 1) ^ 1) + 1
}

/// Parents of all nodes but the root, one for both siblings.
struct Parents(Vec<u32>);

impl Parents {
    fn of(tree: &Binary) -> Self {
        let mut parents = Self(vec![0; tree.links.len() / 2]);
        for node in 0..tree.links.len() {
            parents.adopt(tree, node);
        }
        parents
    }

    fn of_node(&self, node: usize) -> usize {
        self.0[(node - 1) / 2] as usize
    }

    /// Tells the children of `node`, if it has any, that they are its own.
    fn adopt(&mut self, tree: &Binary, node: usize) {
        let link = tree.links[node];
        if !link.is_leaf() {
            self.0[(link.index() - 1) / 2] = node as u32;
        }
    }

    /// Whether `node` is in the subtree of `above`. Nodes that prefer each other's subtrees cannot be unless rounding makes
    /// them, but then the tree would fall apart.
    fn is_below(&self, mut node: usize, above: usize) -> bool {
        while node != above && node != 0 {
            node = self.of_node(node);
        }
        node == above
    }
}

/// Nodes of the largest area, about `count`.
fn largest(tree: &Binary, count: usize) -> Vec<usize> {
    let among = tree.links.len().min(CHOICE * count + 1);
    let key = |node: usize| !u64::from(tree.bounds[node].half_area().to_bits()) << 32 | node as u64;
    let mut keys: Vec<_> = (1..among).into_par_iter().with_min_len(1024).map(key).collect();
    if count < keys.len() {
        keys.select_nth_unstable(count);
        keys.truncate(count);
    }
    keys.into_iter().map(|key| key as u32 as usize).collect()
}

/// A node that comes to stand beside another.
struct Move {
    from: usize,
    to: usize,
    /// By how much the sum of all areas shrinks.
    gain: f32,
}

/// Nodes that one search looks at, at most. Few searches see a hundred; but of something small inside a crowd of equal boxes
/// each sees all of them, and would make the whole quadratic.
const LONGEST_SEARCH: usize = 4096;

/// The move of `from` that gains most, of those found: algorithm 2 of the paper, depth first. `stack` is scratch memory.
fn best_move(tree: &Binary, parents: &Parents, from: usize, stack: &mut Vec<(f32, usize)>) -> Option<Move> {
    let bounds = tree.bounds[from];
    let own = bounds.half_area();
    let parent = parents.of_node(from);
    let mut best = Move { from, to: from, gain: 0.0 };
    // What is gained by taking `from` out, in the part of the tree below `pivot`; that part without it.
    let mut gain = tree.bounds[parent].half_area();
    let (mut pivot, mut beside) = (parent, sibling(from));
    let mut rest = Aabb::EMPTY;
    let mut left = LONGEST_SEARCH;
    loop {
        stack.push((gain, beside));
        while let Some((gain, node)) = stack.pop() {
            left = left.saturating_sub(1);
            if left == 0 || gain - own <= best.gain {
                continue;
            }
            let here = tree.bounds[node];
            let with = gain - here.union(bounds).half_area();
            // Beside the sibling or the parent is where it is.
            if with > best.gain && node != sibling(from) {
                best = Move { from, to: node, gain: with };
            }
            if !tree.links[node].is_leaf() {
                let below = with + here.half_area();
                let [left, right] = tree.children(node);
                stack.extend([(below, left), (below, right)]);
            }
        }
        rest = rest.union(tree.bounds[beside]);
        if pivot != parent {
            gain += tree.bounds[pivot].half_area() - rest.half_area();
        }
        if pivot == 0 || left == 0 {
            break;
        }
        beside = sibling(pivot);
        pivot = parents.of_node(pivot);
    }
    (best.to != from).then_some(best)
}

/// Takes `from` out and puts it beside `to`. Its sibling goes up to the place of its parent, and what was at `to` to
/// that of the sibling, so that the two are side by side.
fn reinsert(tree: &mut Binary, parents: &mut Parents, from: usize, to: usize) {
    let (beside, parent) = (sibling(from), parents.of_node(from));
    let (up, aside) = ((tree.bounds[beside], tree.links[beside]), (tree.bounds[to], tree.links[to]));
    tree.links[to] = tree.links[parent];
    (tree.bounds[beside], tree.links[beside]) = aside;
    (tree.bounds[parent], tree.links[parent]) = up;
    for node in [beside, parent, to] {
        parents.adopt(tree, node);
    }
    refit(tree, parents, to);
    if parent != 0 {
        refit(tree, parents, parents.of_node(parent));
    }
}

/// Fits the boxes of the inner node `node` and of those above to what is in them, as far as they change.
fn refit(tree: &mut Binary, parents: &Parents, mut node: usize) {
    loop {
        let [left, right] = tree.children(node).map(|child| tree.bounds[child]);
        let fitted = left.union(right);
        if fitted == tree.bounds[node] {
            break;
        }
        tree.bounds[node] = fitted;
        if node == 0 {
            break;
        }
        node = parents.of_node(node);
    }
}
