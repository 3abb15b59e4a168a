//! From triangles and instances to trees.

use ambray_scene::Mesh;
use glam::Vec3;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::collapse::{self, Costs};
use super::layout::{Blas, Block, Bounds, Child, Node, Placed, Tlas};
use super::places::Places;
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

/// Whether rays can hit a triangle: all corners within [`LARGEST`], and not of zero area (in f64; coincident or collinear
/// corners).
pub(crate) fn is_hittable(&[a, b, c]: &[Vec3; 3]) -> bool {
    let area = || {
        let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
        (b - a).cross(c - a).abs().max_element()
    };
    is_within(a) && is_within(b) && is_within(c) && area() > 0.0
}

/// Whether `p` is finite and within [`LARGEST`].
fn is_within(p: Vec3) -> bool {
    p.abs().max_element() <= LARGEST && p.is_finite()
}

/// Binary tree in post-order: children stand before their parent, the root is last.
pub(crate) struct Binary {
    pub(crate) nodes: Vec<BinaryNode>,
}

impl Binary {
    /// Puts `primitives` without boxes beside what is there, halved again and again in their order.
    fn append(&mut self, primitives: &[u32]) {
        if primitives.is_empty() {
            return;
        }
        let before = self.nodes.len();
        self.halve(primitives, Bounds::EMPTY);
        if before > 0 {
            self.join(before - 1, self.nodes.len() - 1);
        }
    }

    /// Adds a tree of `primitives`, at least one, all of which have the box `bounds`.
    fn halve(&mut self, primitives: &[u32], bounds: Bounds) {
        if let [primitive] = primitives {
            self.nodes.push(BinaryNode { bounds, leaves: 1, children: [BinaryNode::LEAF, *primitive] });
            return;
        }
        let (left, right) = primitives.split_at(primitives.len() / 2);
        self.halve(left, bounds);
        let middle = self.nodes.len() - 1;
        self.halve(right, bounds);
        self.join(middle, self.nodes.len() - 1);
    }

    /// Puts a parent above two nodes.
    fn join(&mut self, left: usize, right: usize) {
        let (l, r) = (self.nodes[left], self.nodes[right]);
        self.nodes.push(BinaryNode {
            bounds: l.bounds.union(r.bounds),
            leaves: l.leaves + r.leaves,
            children: [left as u32, right as u32],
        });
    }
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
    // One box for all that are in one place.
    let places = Places::of(boxes);
    let aabb = |b: &Bounds| obvhs::aabb::Aabb::new(b.lo.to_vec3a(), b.hi.to_vec3a());
    let aabbs: Vec<_> =
        (0..places.count()).map(|place| aabb(&boxes[places.primitives(place)[0] as usize])).collect();
    let indices = (0..u32::try_from(aabbs.len()).expect("fewer than 2^32 primitives")).collect();
    let mut tree =
        PlocBuilder::with_capacity(aabbs.len()).build(distance, &aabbs, indices, precision, threshold);
    ReinsertionOptimizer::default().run(&mut tree, ratio, None);

    // Post-order without recursion: a node is visited again, after its children, with `expanded` set.
    let mut binary = Binary { nodes: Vec::with_capacity(tree.nodes.len()) };
    let mut finished: Vec<usize> = Vec::new();
    let mut pending = vec![(0_u32, false)];
    while let Some((index, expanded)) = pending.pop() {
        let node = &tree.nodes[index as usize];
        if node.is_leaf() {
            let primitives = places.primitives(tree.primitive_indices[node.first_index as usize] as usize);
            binary.halve(primitives, boxes[primitives[0] as usize]);
            finished.push(binary.nodes.len() - 1);
        } else if expanded {
            let right = finished.pop().expect("both children are finished before their parent");
            let left = finished.pop().expect("both children are finished before their parent");
            finished.push(binary.nodes.len());
            binary.join(left, right);
        } else {
            pending.extend([(index, true), (node.first_index + 1, false), (node.first_index, false)]);
        }
    }
    binary
}

/// Builds the tree of `triangles`, all of which must be hittable.
pub(crate) fn blas<const W: usize>(triangles: &[Triangle], quality: Quality) -> Blas<W> {
    let boxes: Vec<_> = triangles.iter().map(|t| Bounds::of_points(&t.corners)).collect();
    wide(&binary(&boxes, quality), &|primitives| block(triangles, primitives))
}

/// Builds the tree of all triangles of a mesh that deforms, for the vertices that `mesh` has now. Its leaf blocks have no
/// corners yet: [`refit`](super::refit::refit) puts them there.
///
/// Triangles that cannot be hit now are kept apart, in the order of the mesh: without boxes there is no better one, and the
/// builder takes quadratic time where many boxes are equal.
pub(crate) fn deforming<const W: usize>(mesh: &Mesh, masked: bool, quality: Quality) -> Blas<W> {
    let all = 0..mesh.triangles.len() as u32;
    let (hittable, others): (Vec<_>, Vec<_>) = all.partition(|&t| is_hittable(&mesh.corners(t)));
    let boxes: Vec<_> = hittable.iter().map(|&t| Bounds::of_points(&mesh.corners(t))).collect();
    let mut tree = binary(&boxes, quality);
    for leaf in tree.nodes.iter_mut().filter(|node| node.is_leaf()) {
        leaf.children[1] = hittable[leaf.children[1] as usize];
    }
    tree.append(&others);
    wide(&tree, &|primitives| {
        let mut block = Block::EMPTY;
        block.triangles[..primitives.len()].copy_from_slice(primitives);
        block.count = primitives.len() as u32;
        block.masked = if masked { u32::MAX >> (32 - block.count) } else { 0 };
        block
    })
}

/// Collapses `tree` over triangles, which `block` puts into leaf blocks.
fn wide<const W: usize>(tree: &Binary, block: &dyn Fn(&[u32]) -> Block<W>) -> Blas<W> {
    let mut blocks = Vec::new();
    let wide = collapse::collapse::<W>(tree, Costs::TRIANGLES, W as u32, &mut |primitives| {
        blocks.push(block(primitives));
        Child::leaf(blocks.len() - 1)
    });
    let root = tree.nodes.last();
    Blas {
        nodes: wide.nodes,
        blocks,
        bounds: root.map_or(Bounds::EMPTY, |root| root.bounds),
        triangles: root.map_or(0, |root| root.leaves as usize),
        depth: wide.depth,
        sah_cost: wide.sah_cost,
    }
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
