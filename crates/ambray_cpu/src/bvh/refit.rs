//! A tree follows its triangles: new corners in the leaf blocks, new boxes above them, the same structure.
//!
//! Nodes and leaf blocks lie in the order of a depth-first walk, so a subtree is a range of both. Small subtrees are fitted
//! by one thread each, from the last node to the first: children stand behind their parents, and what they hand up lies on a
//! stack. The few nodes above them follow in the same way. Nothing recurses: trees of strange meshes are deep.

use ambray_scene::Mesh;
use glam::Vec3;
use rayon::prelude::*;

use super::build::{LARGEST, cross_margin, is_hittable};
use super::collapse::Costs;
use super::layout::{Blas, Block, Bounds, Child, FAT, Node};

/// Most leaf blocks that a thread fits at a time. Trees are split by size alone, so costs are summed in the same order
/// whatever the number of threads.
const GRAIN: u32 = 512;

/// Fits `tree`, which was built over all triangles of a mesh, to the vertices that `mesh` has now. Triangles that cannot be
/// hit stay in their lanes without corners and without a share in the boxes: they may come back.
///
/// Returns the surface-area cost of the tree: what a ray that meets the box of the root is expected to cost, in the unit of
/// [`Costs::TRIANGLES`]; where that box has no area, the cost of the root alone.
pub(crate) fn refit<const W: usize>(tree: &mut Blas<W>, mesh: &Mesh) -> f64 {
    let (parts, order) = split(&mut tree.nodes, &mut tree.blocks);
    let fitted: Vec<_> = parts.into_par_iter().map(|part| part.fit(mesh)).collect();
    let mut finished = Vec::new();
    for step in order.into_iter().rev() {
        match step {
            Step::Part(part) => finished.push(fitted[part]),
            Step::Node(index) => {
                let block = |block: usize, count| fit_block(&mut tree.blocks[block], count, mesh);
                close(&mut tree.nodes[index], &mut finished, block);
            }
        }
    }
    let root = finished.pop().unwrap_or(Fitted { bounds: Bounds::EMPTY, cost: 0.0 });
    tree.bounds = root.bounds;
    let area = root.bounds.half_area();
    if area > 0.0 { root.cost / area } else { f64::from(Costs::TRIANGLES.node) }
}

/// A small subtree.
struct Part<'a, const W: usize> {
    nodes: &'a mut [Node<W>],
    blocks: &'a mut [Block],
    /// Index of the first of `blocks` in the tree.
    first_block: usize,
}

/// The tree in the order of its nodes: small subtrees, and single nodes above them.
enum Step {
    Part(usize),
    Node(usize),
}

/// What the node above needs.
#[derive(Clone, Copy)]
struct Fitted {
    bounds: Bounds,
    /// Costs of the steps below and of this one, each times half of the area of its box.
    cost: f64,
}

impl<const W: usize> Part<'_, W> {
    fn fit(self, mesh: &Mesh) -> Fitted {
        let Self { nodes, blocks, first_block } = self;
        let mut finished = Vec::new();
        for node in nodes.iter_mut().rev() {
            close(node, &mut finished, |block, count| {
                fit_block(&mut blocks[block - first_block], count, mesh)
            });
        }
        finished.pop().expect("a subtree has a root")
    }
}

/// Cuts the largest subtrees of no more than [`GRAIN`] blocks out of a tree.
fn split<'a, const W: usize>(
    mut nodes: &'a mut [Node<W>],
    mut blocks: &'a mut [Block],
) -> (Vec<Part<'a, W>>, Vec<Step>) {
    let (sizes, total) = (sizes(nodes), nodes.len());
    let (mut parts, mut order) = (Vec::new(), Vec::new());
    let mut passed_blocks = 0;
    let mut index = 0;
    while index < total {
        let Size { nodes: count, blocks: block_count } = sizes[index];
        if block_count > GRAIN {
            order.push(Step::Node(index));
            nodes = &mut nodes[1..];
            index += 1;
            continue;
        }
        let mine;
        (mine, nodes) = nodes.split_at_mut(count as usize);
        let mut first = mine[0].children[0];
        while !first.is_leaf() {
            first = mine[first.index() - index].children[0];
        }
        let (first_block, _) = first.in_block();
        let my_blocks;
        (my_blocks, blocks) = blocks[first_block - passed_blocks..].split_at_mut(block_count as usize);
        passed_blocks = first_block + block_count as usize;
        order.push(Step::Part(parts.len()));
        parts.push(Part { nodes: mine, blocks: my_blocks, first_block });
        index += count as usize;
    }
    (parts, order)
}

/// What is in the subtree of a node, itself included.
#[derive(Clone, Copy)]
struct Size {
    nodes: u32,
    blocks: u32,
}

fn sizes<const W: usize>(nodes: &[Node<W>]) -> Vec<Size> {
    let mut sizes = vec![Size { nodes: 1, blocks: 0 }; nodes.len()];
    for (index, node) in nodes.iter().enumerate().rev() {
        for child in children(node) {
            let below = if child.is_leaf() { Size { nodes: 0, blocks: 1 } } else { sizes[child.index()] };
            sizes[index].nodes += below.nodes;
            sizes[index].blocks += below.blocks;
        }
    }
    sizes
}

/// Children in the order of their slots. The root is nobody's child: it marks empty slots.
fn children<const W: usize>(node: &Node<W>) -> impl Iterator<Item = Child> + use<W> {
    node.children.into_iter().take_while(|&child| child != Child::ROOT)
}

/// Puts new boxes into `node`: those of leaf blocks by `block`, those of nodes from the top of `finished`, where its own
/// takes their place.
fn close<const W: usize>(
    node: &mut Node<W>,
    finished: &mut Vec<Fitted>,
    mut block: impl FnMut(usize, u32) -> Fitted,
) {
    let mut all = Fitted { bounds: Bounds::EMPTY, cost: 0.0 };
    for (slot, child) in children(node).enumerate() {
        let fitted = if child.is_leaf() {
            let (index, count) = child.in_block();
            block(index, count)
        } else {
            finished.pop().expect("children are fitted before their parent")
        };
        for axis in 0..3 {
            node.planes[axis][slot] = fitted.bounds.lo[axis];
            node.planes[axis + 3][slot] = fitted.bounds.hi[axis];
        }
        all.bounds = all.bounds.union(fitted.bounds);
        all.cost += fitted.cost;
    }
    all.cost += all.bounds.half_area() * f64::from(Costs::TRIANGLES.node);
    finished.push(all);
}

/// Puts new corners into a leaf block.
///
/// Waiting for memory is most of it, so everything is fetched that can be before anything is done with it: first what the
/// triangles are, then where their vertices are. The rest looks at several lanes at once.
fn fit_block(block: &mut Block, count: u32, mesh: &Mesh) -> Fitted {
    let count = (count as usize).min(FAT);
    let mut indices = [[0; 3]; FAT];
    for (indices, number) in indices.iter_mut().zip(&block.triangles[..count]) {
        *indices = mesh.triangles[number.index() as usize];
    }
    for (lane, indices) in indices[..count].iter().enumerate() {
        for (rows, &index) in block.corners.iter_mut().zip(indices) {
            let position = mesh.positions[index as usize];
            rows[0][lane] = position.x;
            rows[1][lane] = position.y;
            rows[2][lane] = position.z;
        }
    }
    for lane in doubtful(&block.corners).take_while(|&lane| lane < count) {
        let corners = block.corners.map(|rows| Vec3::from_array(rows.map(|row| row[lane])));
        if !is_hittable(&corners) {
            block.corners.as_flattened_mut().iter_mut().for_each(|row| row[lane] = f32::NAN);
        }
    }
    let bounds = bounds(&block.corners);
    let step = Costs::TRIANGLES.leaf + Costs::TRIANGLES.primitive * count as f32;
    Fitted { bounds, cost: bounds.half_area() * f64::from(step) }
}

/// Lanes whose triangles may be such that no ray can hit them, in ascending order; the others can be hit.
fn doubtful([a, b, c]: &[[[f32; FAT]; 3]; 3]) -> impl Iterator<Item = usize> + use<> {
    let mut certain = [false; FAT];
    for (lane, certain) in certain.iter_mut().enumerate() {
        // Plain loops over lanes, which compilers make vectors of.
        let mut reach = 0.0;
        for rows in [a, b, c] {
            reach += rows[0][lane].abs() + rows[1][lane].abs() + rows[2][lane].abs();
        }
        let p: [f32; 3] = std::array::from_fn(|axis| b[axis][lane] - a[axis][lane]);
        let q: [f32; 3] = std::array::from_fn(|axis| c[axis][lane] - a[axis][lane]);
        let margin = |y: usize, z: usize| cross_margin(p[y] * q[z], p[z] * q[y]);
        let much = (margin(1, 2) > 0.0) | (margin(2, 0) > 0.0) | (margin(0, 1) > 0.0);
        *certain = (reach <= LARGEST) & much;
    }
    (0..FAT).filter(move |&lane| !certain[lane])
}

/// Box of all corners; lanes that are not a number do not count.
fn bounds(corners: &[[[f32; FAT]; 3]; 3]) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    for axis in 0..3 {
        let (mut lo, mut hi) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
        for rows in corners {
            for lanes in rows[axis].as_chunks::<4>().0 {
                for i in 0..4 {
                    lo[i] = if lanes[i] < lo[i] { lanes[i] } else { lo[i] };
                    hi[i] = if lanes[i] > hi[i] { lanes[i] } else { hi[i] };
                }
            }
        }
        bounds.lo[axis] = lo.into_iter().fold(f32::INFINITY, f32::min);
        bounds.hi[axis] = hi.into_iter().fold(f32::NEG_INFINITY, f32::max);
    }
    bounds
}
