//! The trees of a scene's triangles, and the tree over those that are placed.

use std::time::{Duration, Instant};

use ambray_core::frame::PoseStats;
use ambray_scene::{Scene, animation::Updates};
use glam::{Affine3A, Vec3};
use rayon::prelude::*;

use crate::bvh::build;
use crate::bvh::layout::{Blas, Bounds, Placed, Tlas};
use crate::kernel::{self, Direct};
use crate::motion::{Deforming, Fate};
use crate::parts::{Parts, Placement};
use crate::{AlphaTest, BuildOptions, Isa, Quality, Stats, Width};

/// Most instances that rays try one by one, in packets, instead of finding them in the tree over all. The hits are the same.
const MOST_DIRECT: usize = 16;

/// The trees of a scene's triangles, and what leads to them.
#[derive(Debug)]
pub(crate) struct Levels<const W: usize> {
    /// What is in world space, and never moves.
    baked: Blas<W>,
    /// What is placed, but for the instances in `direct`.
    placed: Tlas<W>,
    /// What is placed where it is: deforming meshes whose vertices are in world space, as those of skinned ones are.
    direct: Vec<Direct>,
    /// Trees that are placed: those of meshes that deform first, as in `deforming`.
    meshes: Vec<Blas<W>>,
    deforming: Vec<Deforming<W>>,
    /// All that may be placed, whether or not it can be in this pose.
    placements: Vec<Placement>,
    dropped: usize,
    baked_instances: usize,
    instance_stack: usize,
    stack: usize,
}

impl<const W: usize> Levels<W> {
    pub(crate) fn build(scene: &Scene, alpha: &dyn AlphaTest, options: &BuildOptions) -> Self {
        let parts = Parts::of(scene, alpha, options.bake_budget);
        let baked: Blas<W> = build::baked(&parts.baked, options.quality);
        let deforming = parts.deforming.par_iter().map(|part| {
            Deforming::build(part, &scene.meshes[part.mesh as usize], options.updates, options.quality)
        });
        let (deforming, mut meshes): (Vec<_>, Vec<Blas<W>>) = deforming.unzip();
        meshes.par_extend(parts.rigid.par_iter().map(|triangles| build::blas(triangles, options.quality)));
        let mut levels = Self {
            baked,
            placed: Tlas::default(),
            direct: Vec::new(),
            meshes,
            deforming,
            placements: parts.placements,
            dropped: parts.dropped,
            baked_instances: parts.baked_instances,
            instance_stack: 0,
            stack: 0,
        };
        levels.place(scene);
        levels
    }

    /// Moves everything to where `scene` has it: the scene that this was built for, in another pose.
    pub(crate) fn update(&mut self, scene: &Scene, options: &BuildOptions) -> PoseStats {
        let start = Instant::now();
        let fates = self.deform(scene, options.updates, options.quality.at_a_pose());
        let bottom_level = start.elapsed();
        let moved = self.placements.iter().any(|placement| placement.moves);
        if moved {
            self.place(scene);
        }
        let decays = fates.iter().filter_map(|fate| match fate {
            Fate::Refitted { decay } => Some(*decay as f32),
            Fate::Rebuilt => None,
        });
        let rebuilt = fates.iter().filter(|&&fate| fate == Fate::Rebuilt).count() as u32;
        let others: usize = self.deforming.iter().map(|deforming| deforming.others().count()).sum();
        PoseStats {
            bottom_level,
            top_level: if moved { start.elapsed() - bottom_level } else { Duration::ZERO },
            total: start.elapsed(),
            refitted: fates.len() as u32 - rebuilt,
            rebuilt,
            kept: (fates.len() + others) as u32,
            decay: decays.reduce(f32::max).unwrap_or(1.0),
            ..PoseStats::default()
        }
    }

    /// Bends the trees of all meshes that deform, several at a time.
    fn deform(&mut self, scene: &Scene, updates: Updates, quality: Quality) -> Vec<Fate> {
        let trees = self.deforming.par_iter_mut().zip(&mut self.meshes);
        let fates = trees.map(|(deforming, tree)| {
            let mesh = &scene.meshes[deforming.mesh() as usize];
            deforming.update(tree, mesh, updates, quality)
        });
        fates.collect()
    }

    /// Builds the tree over what is placed.
    fn place(&mut self, scene: &Scene) {
        let (mut instances, mut boxes) = (Vec::new(), Vec::new());
        self.direct.clear();
        for &Placement { tree, instance, .. } in &self.placements {
            let world_from_object = scene.instances[instance as usize].world_from_object;
            let bounds = self.meshes[tree as usize].bounds;
            let Some((placed, world)) = place(tree, instance, world_from_object, bounds) else { continue };
            let deforms = (tree as usize) < self.deforming.len();
            if deforms && world_from_object == Affine3A::IDENTITY && self.direct.len() < MOST_DIRECT {
                self.direct.push(Direct { tree, instance });
            } else {
                instances.push(placed);
                boxes.push(world);
            }
        }
        self.placed = build::tlas(instances, &boxes);
        let deepest = self.in_use().map(|tree| tree.depth).max().unwrap_or(0);
        self.instance_stack = kernel::stack_for(self.placed.depth, W);
        self.stack = self.instance_stack + kernel::stack_for(deepest, W);
    }

    /// All that the kernels read.
    pub(crate) fn view<'a>(&'a self, alpha: &'a dyn AlphaTest, packets: bool) -> kernel::Scene<'a, W> {
        kernel::Scene {
            baked: &self.baked,
            entry: None,
            placed: &self.placed,
            meshes: &self.meshes,
            direct: &self.direct,
            alpha,
            instance_stack: self.instance_stack,
            stack: self.stack,
            packets,
        }
    }

    /// Trees of triangles that rays go through.
    fn in_use(&self) -> impl Iterator<Item = &Blas<W>> {
        std::iter::once(&self.baked).chain(&self.meshes)
    }

    /// All but the shapes; time, instruction set and width are left open.
    pub(crate) fn stats(&self) -> Stats {
        let bytes = |tree: &Blas<W>| {
            size_of_val(&tree.nodes[..]) + size_of_val(&tree.blocks[..]) + tree.names.bytes()
        };
        let kept = self.deforming.iter().flat_map(Deforming::others).map(bytes).sum::<usize>();
        Stats {
            triangles: self.in_use().map(|tree| tree.triangles).sum(),
            dropped: self.dropped,
            baked_instances: self.baked_instances,
            placed_instances: self.placed.instances.len() + self.direct.len(),
            shapes: 0,
            nodes: self.in_use().map(|tree| tree.nodes.len()).sum::<usize>() + self.placed.nodes.len(),
            leaf_blocks: self.in_use().map(|tree| tree.blocks.len()).sum(),
            bytes: self.in_use().map(bytes).sum::<usize>()
                + kept
                + size_of_val(&self.placed.nodes[..])
                + size_of_val(&self.placed.instances[..]),
            sah_cost: self.baked.sah_cost,
            depth: self.in_use().map(|tree| tree.depth).max().unwrap_or(0) + self.placed.depth,
            build_time: Duration::ZERO,
            isa: Isa::Portable,
            width: Width::Eight,
        }
    }
}

/// Places a tree or a shape with object-space `bounds`; `None` if no ray can hit it there.
pub(crate) fn place(
    blas: u32,
    instance: u32,
    world_from_object: Affine3A,
    bounds: Bounds,
) -> Option<(Placed, Bounds)> {
    let object_from_world = world_from_object.inverse();
    if bounds == Bounds::EMPTY || !object_from_world.is_finite() || !world_from_object.is_finite() {
        return None;
    }
    let corners: [Vec3; 8] = std::array::from_fn(|i| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { bounds.lo[axis] } else { bounds.hi[axis] };
        world_from_object.transform_point3(Vec3::new(pick(0), pick(1), pick(2)))
    });
    let tight = Bounds::of_points(&corners);
    // Rays are tested in object space; this covers the rounding of their transform, 2⁻¹⁷ of the coordinates.
    let reach = tight.lo.abs().max(tight.hi.abs()).max_element() + (tight.hi - tight.lo).max_element();
    let pad = Vec3::splat(reach * (1.0 / 131_072.0));
    let world = Bounds { lo: tight.lo - pad, hi: tight.hi + pad };
    (reach.is_finite() && reach <= build::LARGEST)
        .then_some((Placed { object_from_world, blas, instance }, world))
}
