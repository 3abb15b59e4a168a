//! From triangles and instances to trees.

use glam::Vec3;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::collapse::{self, Costs};
use super::layout::{Blas, Block, Bounds, Child, Node, Placed, Tlas};
use crate::Quality;

/// Largest coordinate that is traced. Beyond it the triangle test's products could overflow, and so could the builder's
/// surface areas.
pub(crate) const LARGEST: f32 = 1e12;

/// Triangle on its way into a tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) corners: [Vec3; 3],
    pub(crate) instance: u32,
    pub(crate) triangle: u32,
    pub(crate) masked: bool,
}

impl Triangle {
    /// Whether rays can hit it: all corners within [`LARGEST`], and not of zero area (in f64; coincident or collinear
    /// corners). Triangles that cannot be hit are dropped.
    pub(crate) fn is_hittable(&self) -> bool {
        let [a, b, c] = self.corners;
        let within = |p: Vec3| p.abs().max_element() <= LARGEST && p.is_finite();
        let area = || {
            let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
            (b - a).cross(c - a).abs().max_element()
        };
        within(a) && within(b) && within(c) && area() > 0.0
    }
}

/// Binary tree in post-order: children stand before their parent, the root is last.
pub(crate) struct Binary {
    pub(crate) nodes: Vec<BinaryNode>,
}

/// Node of a [`Binary`] tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    pub(crate) bounds: Bounds,
    /// Leaves below, itself included.
    pub(crate) leaves: u32,
    /// Indices of the children, or [`BinaryNode::LEAF`] and the index of the primitive.
    pub(crate) children: [u32; 2],
}

impl BinaryNode {
    pub(crate) const LEAF: u32 = u32::MAX;

    pub(crate) const fn is_leaf(&self) -> bool {
        self.children[0] == Self::LEAF
    }
}

/// Builds a binary tree with one primitive a leaf: locally-ordered clustering (Meister and Bittner 2018), improved by
/// reinsertion (Meister and Bittner 2018, "Parallel Reinsertion").
fn binary(boxes: &[Bounds], quality: Quality) -> Binary {
    if boxes.is_empty() {
        return Binary { nodes: Vec::new() };
    }
    let (distance, precision, threshold, ratio) = match quality {
        Quality::FastBuild => (PlocSearchDistance::Low, SortPrecision::U64, 2, 0.01),
        Quality::Balanced => (PlocSearchDistance::Medium, SortPrecision::U64, 3, 0.05),
        Quality::BestTrace => (PlocSearchDistance::Medium, SortPrecision::U128, 1, 1.0),
    };
    let aabbs: Vec<_> =
        boxes.iter().map(|b| obvhs::aabb::Aabb::new(b.lo.to_vec3a(), b.hi.to_vec3a())).collect();
    let indices = (0..u32::try_from(boxes.len()).expect("fewer than 2^32 primitives")).collect();
    let mut tree =
        PlocBuilder::with_capacity(boxes.len()).build(distance, &aabbs, indices, precision, threshold);
    ReinsertionOptimizer::default().run(&mut tree, ratio, None);

    // Post-order without recursion: a node is visited again, after its children, with `expanded` set.
    let mut nodes: Vec<BinaryNode> = Vec::with_capacity(tree.nodes.len());
    let mut finished: Vec<u32> = Vec::new();
    let mut pending = vec![(0_u32, false)];
    while let Some((index, expanded)) = pending.pop() {
        let node = &tree.nodes[index as usize];
        if node.is_leaf() {
            let primitive = tree.primitive_indices[node.first_index as usize];
            finished.push(nodes.len() as u32);
            nodes.push(BinaryNode {
                bounds: boxes[primitive as usize],
                leaves: 1,
                children: [BinaryNode::LEAF, primitive],
            });
        } else if expanded {
            let right = finished.pop().expect("both children are finished before their parent");
            let left = finished.pop().expect("both children are finished before their parent");
            let (l, r) = (nodes[left as usize], nodes[right as usize]);
            finished.push(nodes.len() as u32);
            nodes.push(BinaryNode {
                bounds: l.bounds.union(r.bounds),
                leaves: l.leaves + r.leaves,
                children: [left, right],
            });
        } else {
            pending.extend([(index, true), (node.first_index + 1, false), (node.first_index, false)]);
        }
    }
    Binary { nodes }
}

/// Builds the tree of `triangles`, all of which must be hittable.
pub(crate) fn blas<const W: usize>(triangles: &[Triangle], quality: Quality) -> Blas<W> {
    let boxes: Vec<_> = triangles.iter().map(|t| Bounds::of_points(&t.corners)).collect();
    let tree = binary(&boxes, quality);
    let mut blocks = Vec::new();
    let wide = collapse::collapse::<W>(&tree, Costs::TRIANGLES, W as u32, &mut |primitives| {
        blocks.push(block(triangles, primitives));
        Child::leaf(blocks.len() - 1)
    });
    let bounds = tree.nodes.last().map_or(Bounds::EMPTY, |n| n.bounds);
    Blas { nodes: wide.nodes, blocks, bounds, depth: wide.depth, sah_cost: wide.sah_cost }
}

fn block<const W: usize>(triangles: &[Triangle], primitives: &[u32]) -> Block<W> {
    let mut block = Block::EMPTY;
    for (lane, &primitive) in primitives.iter().enumerate() {
        let triangle = &triangles[primitive as usize];
        for (corner, position) in block.corners.iter_mut().zip(triangle.corners) {
            for (axis, value) in corner.iter_mut().zip(position.to_array()) {
                axis[lane] = value;
            }
        }
        block.instances[lane] = triangle.instance;
        block.triangles[lane] = triangle.triangle;
        block.masked |= u32::from(triangle.masked) << lane;
    }
    block.count = primitives.len() as u32;
    block
}

/// Builds the tree over `instances` with world-space `boxes`.
pub(crate) fn tlas<const W: usize>(instances: Vec<Placed>, boxes: &[Bounds]) -> Tlas<W> {
    let tree = binary(boxes, Quality::Balanced);
    let wide = collapse::collapse::<W>(&tree, Costs::INSTANCES, 1, &mut |one| Child::leaf(one[0] as usize));
    let nodes: Vec<Node<W>> = wide.nodes;
    Tlas { nodes, instances, depth: wide.depth }
}
