//! One ray through the trees.

use std::marker::PhantomData;
use std::mem::MaybeUninit;

use ambray_core::trace::{Hit, Ray};

use super::lanes::Lanes;
use super::ray::Prepared;
use super::triangle::{self, Entry};
use super::{Query, Scene, slab};
use crate::bvh::layout::{Blas, Child, Node};

/// Node or leaf still to be visited: near distance in the upper half (not negative, so its bits sort like the number),
/// child in the lower.
type Pending = u64;

/// Closest hit of `ray`, or any hit if the query is content with that; its triangle may be a baked one's
/// [number](triangle::BAKED).
#[inline(always)]
pub(crate) fn trace<const W: usize, L: Lanes<W>, Q: Query>(
    scene: &Scene<'_, W>,
    ray: &Ray,
    prepared: &Prepared,
    stack: &mut [MaybeUninit<Pending>],
) -> Hit {
    let mut best = Hit { t: ray.t_max, ..Hit::MISS };
    let mut answered = false;
    for trunk in scene.world_trees() {
        let entry = trunk.entry(ray.seed);
        answered = blas::<W, L, Q>(trunk.tree, trunk.root, Child::ROOT, prepared, &entry, &mut best, stack)
            && Q::ANY;
        if answered {
            break;
        }
    }
    if !answered && !scene.placed.nodes.is_empty() {
        instances::<W, L, Q>(scene, ray, prepared, &mut best, stack);
    }
    best
}

/// Visits the instances of meshes with trees of their own. Returns whether the query is answered.
#[inline(always)]
pub(crate) fn instances<const W: usize, L: Lanes<W>, Q: Query>(
    scene: &Scene<'_, W>,
    ray: &Ray,
    prepared: &Prepared,
    best: &mut Hit,
    stack: &mut [MaybeUninit<Pending>],
) -> bool {
    let (above, below) = stack.split_at_mut(scene.instance_stack);
    let limit = best.t;
    let visitor = Instances::<W, L, Q> { scene, ray, best, stack: below, lanes: PhantomData };
    let nodes = &scene.placed.nodes[..];
    let Some(root) = nodes.first() else { return false };
    walk::<W, L, _>(nodes, root, Child::ROOT, prepared, limit, above, visitor)
}

/// Leaves of the tree over instances.
struct Instances<'a, const W: usize, L, Q> {
    scene: &'a Scene<'a, W>,
    ray: &'a Ray,
    best: &'a mut Hit,
    stack: &'a mut [MaybeUninit<Pending>],
    lanes: PhantomData<(L, Q)>,
}

impl<const W: usize, L: Lanes<W>, Q: Query> Leaves for Instances<'_, W, L, Q> {
    const EXACT: bool = true;

    #[inline(always)]
    fn visit(&mut self, leaf: Child, near: f32) -> Option<f32> {
        let placed = &self.scene.placed.instances[leaf.index()];
        let ray = self.ray;
        if let Some(object) = Prepared::transformed(&placed.object_from_world, ray.origin, ray.direction) {
            let tree = &self.scene.meshes[placed.blas as usize];
            let Scene { alpha, baked, .. } = *self.scene;
            let entry = Entry { instance: placed.instance, near, seed: ray.seed, alpha, names: &baked.names };
            if let Some(root) = tree.nodes.first()
                && blas::<W, L, Q>(tree, root, Child::ROOT, &object, &entry, self.best, self.stack)
            {
                return None;
            }
        }
        Some(self.best.t)
    }
}

/// Visits a tree of triangles below `start`; `root` stands for its node 0. Returns whether the query is answered.
#[inline(always)]
pub(crate) fn blas<const W: usize, L: Lanes<W>, Q: Query>(
    tree: &Blas<W>,
    root: &Node<W>,
    start: Child,
    ray: &Prepared,
    entry: &Entry<'_>,
    best: &mut Hit,
    stack: &mut [MaybeUninit<Pending>],
) -> bool {
    let limit = best.t;
    let visitor = Blocks::<W, L, Q> { tree, ray, entry, best, lanes: PhantomData };
    walk::<W, L, _>(&tree.nodes, root, start, ray, limit, stack, visitor)
}

/// Leaves of a tree of triangles.
struct Blocks<'a, const W: usize, L, Q> {
    tree: &'a Blas<W>,
    ray: &'a Prepared,
    entry: &'a Entry<'a>,
    best: &'a mut Hit,
    lanes: PhantomData<(L, Q)>,
}

impl<const W: usize, L: Lanes<W>, Q: Query> Leaves for Blocks<'_, W, L, Q> {
    const EXACT: bool = false;

    #[inline(always)]
    fn visit(&mut self, leaf: Child, _near: f32) -> Option<f32> {
        let block = &self.tree.blocks[leaf.in_block().0];
        let found = triangle::block::<L::Eight, Q>(block, self.ray, self.entry, self.best);
        if found && Q::ANY { None } else { Some(self.best.t) }
    }
}

/// What happens at leaves. A trait because closures cannot be forced inline, and a kernel's parts must be: only what is
/// inlined is compiled for the kernel's instruction set.
trait Leaves {
    /// Whether leaves are told the exact near distance of their box, and only those that the exact test keeps.
    const EXACT: bool;
    /// Visits a leaf whose box is met at `near`. Returns the new limit of t, or `None` to stop.
    fn visit(&mut self, leaf: Child, near: f32) -> Option<f32>;
}

/// Walks the tree front to back through all that the ray meets within `limit`; `root` stands for node 0. Returns whether a leaf
/// stopped it.
#[inline(always)]
fn walk<const W: usize, L: Lanes<W>, V: Leaves>(
    nodes: &[Node<W>],
    root: &Node<W>,
    start: Child,
    ray: &Prepared,
    mut limit: f32,
    stack: &mut [MaybeUninit<Pending>],
    mut leaves: V,
) -> bool {
    let mut top = 0;
    let mut child = start;
    let mut child_near = 0.0;
    loop {
        if child.is_leaf() {
            match leaves.visit(child, child_near) {
                Some(new) => limit = new,
                None => return true,
            }
        } else {
            let node = if child == Child::ROOT { root } else { &nodes[child.index()] };
            let (mut mask, near) = slab::children::<W, L>(node, ray, limit);
            if !V::EXACT && mask != 0 && mask & (mask - 1) == 0 {
                child = node.children[mask.trailing_zeros() as usize % W];
                continue;
            }
            let near = near.to_array();
            let bottom = top;
            while mask != 0 {
                let slot = mask.trailing_zeros() as usize % W;
                mask &= mask - 1;
                let mut near = near[slot];
                if V::EXACT && node.children[slot].is_leaf() {
                    match slab::one(&node.planes.map(|plane| plane[slot]), ray) {
                        Some(exact) => near = exact,
                        None => continue,
                    }
                }
                let pending = u64::from(near.to_bits()) << 32 | u64::from(node.children[slot].0);
                // Insertion keeps the new entries sorted, the nearest on top; most nodes add one to three.
                let mut at = top;
                while at > bottom {
                    // SAFETY: entries between `bottom` and `top` were written by this loop.
                    let below = unsafe { stack[at - 1].assume_init() };
                    if below >= pending {
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
                return false;
            }
            top -= 1;
            // SAFETY: entries below `top` were written before `top` moved past them.
            let pending = unsafe { stack[top].assume_init() };
            child_near = f32::from_bits((pending >> 32) as u32);
            child = Child(pending as u32);
            if child_near <= limit * slab::SLACK {
                break;
            }
        }
    }
}
