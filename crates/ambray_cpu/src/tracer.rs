//! The tracer: trees of a scene behind [`Trace`].

use std::time::Instant;

use ambray_core::trace::{Hit, Ray, Trace};
use ambray_scene::Scene;
use glam::{Affine3A, Vec3};

use crate::bvh::build::{self, Triangle};
use crate::bvh::layout::{Blas, Bounds, Placed, Tlas};
use crate::kernel::{self, Any, Closest, Query};
use crate::shapes::Shapes;
use crate::{AlphaTest, BuildOptions, Isa, Opaque, Stats, Width};

/// Traces batches of rays through a scene.
///
/// Two levels: meshes with a single instance are baked to world space and merged into one tree. Their rays need no transform,
/// and one tree over all of a scene is better than a tree of overlapping trees (Sponza has 103 primitives in one
/// place). Meshes with more instances are baked too if [`BuildOptions::bake_budget`] allows; else they have one tree each
/// in object space, and a tree over their instances leads there.
///
/// Shapes given by formulas have a tree of their own, and are traced after the triangles.
///
/// A batch is traced by the thread that calls; let several threads trace batches of their own. Results are bit-identical for
/// all [`BuildOptions`] that bake the same meshes.
#[derive(Debug)]
pub struct Tracer<A = Opaque> {
    core: Core,
    alpha: A,
}

/// All but the alpha test, so that the kernels are compiled once, in this crate.
#[derive(Debug)]
struct Core {
    trees: Trees,
    /// `None` in scenes without.
    shapes: Option<Shapes>,
    isa: Isa,
    packets: bool,
    stats: Stats,
}

#[derive(Debug)]
enum Trees {
    Eight(Levels<8>),
    Sixteen(Levels<16>),
}

#[derive(Debug)]
struct Levels<const W: usize> {
    baked: Blas<W>,
    shared: Tlas<W>,
    meshes: Vec<Blas<W>>,
    instance_stack: usize,
    stack: usize,
}

impl<A: AlphaTest> Tracer<A> {
    /// Builds the trees of `scene`.
    ///
    /// Triangles of zero area or with corners beyond 10¹² units are dropped, and so are instances of shared meshes whose
    /// placement cannot be inverted.
    ///
    /// # Panics
    /// If an index in the scene is out of range, or if `options` ask for an instruction set that this machine lacks.
    #[must_use]
    pub fn build(scene: &Scene, alpha: A, options: BuildOptions) -> Self {
        Self { core: Core::build(scene, &alpha, options), alpha }
    }

    /// What was built, in numbers.
    #[must_use]
    pub const fn stats(&self) -> &Stats {
        &self.core.stats
    }
}

impl<A: AlphaTest> Trace for Tracer<A> {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.core.closest_hits(&self.alpha, rays, hits);
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
        self.core.any_hits(&self.alpha, rays, blocked);
    }
}

impl Core {
    fn build(scene: &Scene, alpha: &dyn AlphaTest, options: BuildOptions) -> Self {
        let start = Instant::now();
        let isa = options.isa.unwrap_or_else(Isa::detect);
        assert!(isa.is_available(), "this machine lacks {}", isa.name());
        let width = options.width.unwrap_or(match isa {
            Isa::Avx512 => Width::Sixteen,
            _ => Width::Eight,
        });
        let parts = Parts::of(scene, alpha, options.bake_budget);
        let (trees, mut stats) = match width {
            Width::Eight => {
                let (levels, stats) = Levels::build(&parts, options);
                (Trees::Eight(levels), stats)
            }
            Width::Sixteen => {
                let (levels, stats) = Levels::build(&parts, options);
                (Trees::Sixteen(levels), stats)
            }
        };
        let shapes = Shapes::build(scene);
        if let Some(shapes) = &shapes {
            let (instances, nodes, depth, bytes) = shapes.size();
            stats.shapes = instances;
            stats.nodes += nodes;
            stats.depth = stats.depth.max(depth);
            stats.bytes += bytes;
        }
        (stats.isa, stats.width, stats.build_time) = (isa, width, start.elapsed());
        log::debug!("{}: {stats:?}", scene.name);
        Self { trees, shapes, isa, packets: options.packets, stats }
    }

    fn closest_hits(&self, alpha: &dyn AlphaTest, rays: &[Ray], hits: &mut [Hit]) {
        self.batch::<Closest>(alpha, rays, hits);
        if let Some(shapes) = &self.shapes {
            shapes.closest_hits(alpha, rays, hits);
        }
    }

    fn any_hits(&self, alpha: &dyn AlphaTest, rays: &[Ray], blocked: &mut [bool]) {
        self.batch::<Any>(alpha, rays, blocked);
        if let Some(shapes) = &self.shapes {
            shapes.any_hits(alpha, rays, blocked);
        }
    }

    fn batch<Q: Query>(&self, alpha: &dyn AlphaTest, rays: &[Ray], answers: &mut [Q::Answer]) {
        match &self.trees {
            Trees::Eight(levels) => {
                kernel::batch::<8, Q>(self.isa, &self.view(levels, alpha), rays, answers);
            }
            Trees::Sixteen(levels) => {
                kernel::batch::<16, Q>(self.isa, &self.view(levels, alpha), rays, answers);
            }
        }
    }

    fn view<'a, const W: usize>(
        &self,
        levels: &'a Levels<W>,
        alpha: &'a dyn AlphaTest,
    ) -> kernel::Scene<'a, W> {
        kernel::Scene {
            baked: &levels.baked,
            shared: &levels.shared,
            meshes: &levels.meshes,
            alpha,
            instance_stack: levels.instance_stack,
            stack: levels.stack,
            packets: self.packets,
        }
    }
}

/// A scene's triangles, sorted by the trees they go into.
struct Parts {
    baked: Vec<Triangle>,
    meshes: Vec<Vec<Triangle>>,
    instances: Vec<(u32, u32, Affine3A)>,
    dropped: usize,
    baked_instances: usize,
}

/// Whether each mesh is shared by its instances, and how many instances each has.
fn shared_meshes(scene: &Scene, bake_budget: u64) -> (Vec<bool>, Vec<u64>) {
    let mut uses = vec![0_u64; scene.meshes.len()];
    for instance in &scene.instances {
        uses[instance.mesh as usize] += 1;
    }
    let cost = |mesh: usize| uses[mesh].saturating_mul(scene.meshes[mesh].triangles.len() as u64);
    let mut candidates: Vec<_> = (0..uses.len()).filter(|&mesh| uses[mesh] > 1).collect();
    candidates.sort_by_key(|&mesh| (cost(mesh), mesh));
    let mut shared = vec![false; uses.len()];
    let mut spent = 0_u64;
    for mesh in candidates {
        spent = spent.saturating_add(cost(mesh));
        shared[mesh] = spent > bake_budget;
    }
    (shared, uses)
}

impl Parts {
    fn of(scene: &Scene, alpha: &dyn AlphaTest, bake_budget: u64) -> Self {
        let (is_shared, uses) = shared_meshes(scene, bake_budget);
        let mut parts = Self {
            baked: Vec::new(),
            meshes: Vec::new(),
            instances: Vec::new(),
            dropped: 0,
            baked_instances: 0,
        };
        let mut shared = vec![None; scene.meshes.len()];
        for (index, instance) in (0_u32..).zip(&scene.instances) {
            let mesh = instance.mesh as usize;
            if !is_shared[mesh] {
                parts.baked_instances += usize::from(uses[mesh] > 1);
                let baked = parts.triangles(scene, instance.mesh, index, &instance.world_from_object, alpha);
                parts.baked.extend(baked);
            } else {
                let blas = match shared[mesh] {
                    Some(blas) => blas,
                    None => {
                        let triangles = parts.triangles(scene, instance.mesh, 0, &Affine3A::IDENTITY, alpha);
                        parts.meshes.push(triangles);
                        *shared[mesh].insert(parts.meshes.len() as u32 - 1)
                    }
                };
                parts.instances.push((blas, index, instance.world_from_object));
            }
        }
        parts
    }

    fn triangles(
        &mut self,
        scene: &Scene,
        mesh: u32,
        instance: u32,
        to_tree: &Affine3A,
        alpha: &dyn AlphaTest,
    ) -> Vec<Triangle> {
        let masked = !alpha.is_opaque(mesh);
        let mesh = &scene.meshes[mesh as usize];
        let positions: Vec<_> = mesh.positions.iter().map(|&p| to_tree.transform_point3(p)).collect();
        let all = (0_u32..).zip(&mesh.triangles).map(|(triangle, corners)| Triangle {
            corners: corners.map(|i| positions[i as usize]),
            instance,
            triangle,
            masked,
        });
        let hittable: Vec<_> = all.filter(Triangle::is_hittable).collect();
        self.dropped += mesh.triangles.len() - hittable.len();
        hittable
    }
}

impl<const W: usize> Levels<W> {
    fn build(parts: &Parts, options: BuildOptions) -> (Self, Stats) {
        let baked: Blas<W> = build::blas(&parts.baked, options.quality);
        let meshes: Vec<Blas<W>> = parts.meshes.iter().map(|m| build::blas(m, options.quality)).collect();
        let mut instances = Vec::new();
        let mut boxes = Vec::new();
        for &(blas, instance, world_from_object) in &parts.instances {
            let bounds = meshes[blas as usize].bounds;
            if let Some((placed, world)) = place(blas, instance, world_from_object, bounds) {
                instances.push(placed);
                boxes.push(world);
            }
        }
        let shared: Tlas<W> = build::tlas(instances, &boxes);

        let trees = || std::iter::once(&baked).chain(&meshes);
        let deepest = trees().map(|tree| tree.depth).max().unwrap_or(0);
        let instance_stack = kernel::stack_for(shared.depth, W);
        let stats = Stats {
            triangles: trees().flat_map(|t| &t.blocks).map(|b| b.count as usize).sum(),
            dropped: parts.dropped,
            baked_instances: parts.baked_instances,
            shared_instances: shared.instances.len(),
            shapes: 0,
            nodes: trees().map(|t| t.nodes.len()).sum::<usize>() + shared.nodes.len(),
            leaf_blocks: trees().map(|t| t.blocks.len()).sum(),
            bytes: trees().map(|t| size_of_val(&t.nodes[..]) + size_of_val(&t.blocks[..])).sum::<usize>()
                + size_of_val(&shared.nodes[..])
                + size_of_val(&shared.instances[..]),
            sah_cost: baked.sah_cost,
            depth: deepest + shared.depth,
            build_time: std::time::Duration::ZERO,
            isa: Isa::Portable,
            width: Width::Eight,
        };
        let stack = instance_stack + kernel::stack_for(deepest, W);
        (Self { baked, shared, meshes, instance_stack, stack }, stats)
    }
}

/// Places a shared mesh or a shape with object-space `bounds`; `None` if no ray can hit it there.
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
