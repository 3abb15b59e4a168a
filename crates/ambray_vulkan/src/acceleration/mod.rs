//! Acceleration structures of a scene: what rays are traced through.
//!
//! Triangles go into bottom-level structures once ([`Acceleration`]); a top-level structure places them for each frame
//! ([`TopLevel`]). Each bottom-level structure has one geometry, all of it opaque or not, so that the entry's offset into
//! the shader binding table is [`GeometryKind`] × `RAY_TYPES`, and a primitive's number leads straight to its triangle.

mod blas;
mod bounds;
mod build;
mod cull;
mod duplicates;
mod geometry;
mod grouping;
mod input;
mod motion;
mod overlap;
mod plan;
mod rays;
mod size_queries;
mod slot;
mod sort;
mod stats;
mod structure;
mod tlas;

use std::sync::Arc;
use std::time::Instant;

use ambray_core::control::Control;
use ambray_scene::{Scene, animation::Updates};
use glam::Affine3A;

use self::blas::Builder;
pub use self::bounds::Bounds;
use self::build::Manner;
pub use self::cull::Culling;
use self::input::{Input, Primitives};
pub(crate) use self::motion::{Follower, Job, Mode};
use self::plan::Content;
use self::slot::Slot;
pub use self::stats::AccelerationStats;
pub(crate) use self::structure::Scratch;
pub use self::tlas::TopLevel;
use crate::Context;
use crate::error::{Result, VulkanError};
use crate::layout::{GEOMETRY_MASKED, GEOMETRY_OPAQUE, GEOMETRY_SHAPE, NONE};

/// Most entries of a top-level structure: their numbers have 24 bits.
const PLACEMENTS: u64 = 1 << 24;

/// How acceleration structures are built. Pictures agree for all choices up to rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccelerationOptions {
    /// What shares a structure.
    pub grouping: Grouping,
    /// Triangles that may be copied for meshes with several instances to lie in world space, all copies counted. By
    /// default what the CPU backend copies.
    pub copy_budget: u64,
    /// Whether structures are copied to the size they need, which takes a moment. By default they are.
    pub compact: bool,
    /// Input of the structures that are built at once, and scratch memory for them, bytes each; a structure that needs more
    /// is built alone. By default 64 MiB.
    pub batch: u64,
    /// How structures follow what deforms.
    pub updates: Updates,
}

impl Default for AccelerationOptions {
    fn default() -> Self {
        Self {
            grouping: Grouping::Auto,
            copy_budget: 2_000_000,
            compact: true,
            batch: 64 << 20,
            updates: Updates::default(),
        }
    }
}

/// Which meshes share a structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Grouping {
    /// As tracing is expected to be fastest.
    #[default]
    Auto,
    /// None: a structure for each mesh. For measurements.
    PerMesh,
    /// All that is static, of a kind. For measurements.
    Single,
}

/// What a structure consists of: which hit groups its rays run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum GeometryKind {
    /// Triangles that stop every ray.
    Opaque = GEOMETRY_OPAQUE,
    /// Triangles whose alpha decides.
    Masked = GEOMETRY_MASKED,
    /// Boxes of shapes.
    Shape = GEOMETRY_SHAPE,
}

/// What an entry of the top-level structure is; its number is the entry's custom index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// First of its entries in [`Acceleration::refs`].
    pub first_ref: u32,
    /// Instance of all its primitives, shapes numbered after all meshes; `u32::MAX` where the refs tell.
    pub instance: u32,
    /// What it consists of.
    pub kind: GeometryKind,
}

/// A placement as the top-level structure needs it.
#[derive(Clone, Copy, Debug)]
struct Placed {
    /// Index of the bottom-level structure.
    structure: usize,
    kind: GeometryKind,
    transform: Affine3A,
    /// World space; `None` while no ray can hit it.
    bounds: Option<Bounds>,
}

/// The bottom-level structures of a scene, and where they are. The device must be done with them when they are dropped.
#[derive(Debug)]
pub struct Acceleration {
    structures: Vec<Slot>,
    /// Meshes whose vertices move.
    followers: Vec<Follower>,
    /// How builds are batched and followed up.
    options: AccelerationOptions,
    /// Of each structure, in its own space.
    bounds: Vec<Bounds>,
    placements: Vec<Placement>,
    /// One a placement.
    placed: Vec<Placed>,
    refs: Vec<[u32; 2]>,
    stats: AccelerationStats,
}

impl Acceleration {
    /// Builds the structures of `scene`, and waits for them. `opaque` says of each mesh whether every ray sees all of it.
    ///
    /// Triangles and placements that no ray can hit are dropped, as the CPU backend does; of meshes that
    /// deform, all that may show at another pose are kept.
    ///
    /// # Panics
    /// If an index in the scene is out of range.
    pub fn build(
        context: &Arc<Context>,
        scene: &Scene,
        opaque: &[bool],
        options: &AccelerationOptions,
        control: &Control<'_>,
    ) -> Result<Self> {
        let start = Instant::now();
        control.check()?;
        let plan = plan::plan(scene, opaque, options);
        let mut builder = Builder::new(context, options.compact, options.batch);
        let mut all = Self {
            structures: Vec::new(),
            followers: Vec::new(),
            options: *options,
            bounds: Vec::new(),
            placements: Vec::new(),
            placed: Vec::new(),
            refs: Vec::new(),
            stats: AccelerationStats { overlap_before: plan.overlap, ..AccelerationStats::default() },
        };
        let count = plan.groups.len();
        for (index, group) in plan.groups.into_iter().enumerate() {
            control.check()?;
            let input = Input::of(scene, &group);
            let follows = group.deforms.then_some(options.updates.policy);
            let manner = Manner { opaque: group.opaque, follows };
            all.add(scene, &group, &input, manner)?;
            builder.push(input, manner)?;
            (control.progress)((index + 1) as f32 / count as f32);
        }
        all.structures = builder.finish()?.into_iter().map(Slot::new).collect();
        all.followers.iter_mut().for_each(|follower| follower.ask_scratch(context));
        all.sort();
        all.check_limits(context)?;
        all.stats.structures = all.structures.len();
        all.stats.placements = all.placements.len();
        all.stats.bytes_before = builder.bytes_before;
        all.stats.bytes = all.structures.iter().map(Slot::size).sum();
        all.stats.scratch_bytes = builder.largest_scratch;
        let boxes: Vec<_> = all.placed.iter().filter_map(|p| p.bounds).collect();
        all.stats.overlap = overlap::overlap(&boxes);
        all.stats.top_bytes = TopLevel::new(context, &all)?.bytes();
        all.stats.build_time = start.elapsed();
        log::debug!("{}: {:?}", scene.name, all.stats);
        Ok(all)
    }

    /// What each entry of the top-level structure is, by its custom index.
    #[must_use]
    pub fn placements(&self) -> &[Placement] {
        &self.placements
    }

    /// Instance and triangle of each primitive: those of a placement begin at its `first_ref`. The instance is `u32::MAX`
    /// where the placement has it; shapes are numbered after all meshes and have triangle 0.
    #[must_use]
    pub fn refs(&self) -> &[[u32; 2]] {
        &self.refs
    }

    /// What was built, in numbers.
    #[must_use]
    pub const fn stats(&self) -> &AccelerationStats {
        &self.stats
    }

    /// World-space box of each placement; `None` while no ray can hit it.
    pub fn boxes(&self) -> impl Iterator<Item = Option<Bounds>> {
        self.placed.iter().map(|p| p.bounds)
    }

    fn placed(&self) -> &[Placed] {
        &self.placed
    }

    fn structure_address(&self, index: usize) -> u64 {
        self.structures[index].shown().address()
    }

    /// Largest coordinate of all that is placed.
    fn extent(&self) -> f32 {
        self.boxes().flatten().map(Bounds::extent).fold(0.0, f32::max)
    }

    /// Adds the next structure's refs and placements.
    fn add(&mut self, scene: &Scene, group: &plan::Group, input: &Input, manner: Manner) -> Result<()> {
        let structure = self.bounds.len();
        let end = self.refs.len() as u64 + input.refs.len() as u64;
        let Ok(first_ref) = u32::try_from(self.refs.len()) else {
            let what = "primitives in all acceleration structures".into();
            return Err(VulkanError::Limit { what, asked: end, limit: u64::from(u32::MAX) });
        };
        self.refs.extend_from_slice(&input.refs);
        self.bounds.push(input.bounds);
        let kind = group.kind;
        let mut place = |instance: u32, transform: Affine3A, bounds: Option<Bounds>| {
            self.placements.push(Placement { first_ref, instance, kind });
            self.placed.push(Placed { structure, kind, transform, bounds });
        };
        match &group.content {
            Content::World(_) => place(NONE, Affine3A::IDENTITY, Some(input.bounds)),
            Content::Object(users) => {
                if manner.follows.is_some() {
                    let mesh = scene.instances[users[0] as usize].mesh;
                    let vertices = scene.meshes[mesh as usize].positions.len() as u32;
                    let counts = [vertices, input.refs.len() as u32];
                    self.followers.push(Follower::new(mesh, counts, first_ref, structure, manner));
                }
                for &user in users {
                    let transform = transform_of(scene, user);
                    place(user, transform, geometry::place(input.bounds, &transform));
                }
            }
        }
        let stats = &mut self.stats;
        stats.by_kind[kind as usize] += 1;
        stats.in_world += usize::from(matches!(group.content, Content::World(_)));
        stats.dropped += input.dropped;
        match input.primitives {
            Primitives::Triangles { ref triangles, .. } => stats.triangles += triangles.len() as u64,
            Primitives::Boxes(ref boxes) => stats.boxes += boxes.len() as u64,
        }
        Ok(())
    }

    /// Puts the placements into spatial order, for drivers that build top-level structures in the order given.
    fn sort(&mut self) {
        let centres: Vec<_> =
            self.placed.iter().map(|p| p.bounds.map_or(glam::Vec3::ZERO, Bounds::centre)).collect();
        let order = sort::spatial_order(&centres);
        self.placements = order.iter().map(|&i| self.placements[i as usize]).collect();
        self.placed = order.iter().map(|&i| self.placed[i as usize]).collect();
    }

    fn check_limits(&self, context: &Context) -> Result<()> {
        let limit = context.limits().instances.min(PLACEMENTS);
        let asked = self.placements.len() as u64;
        if asked <= limit {
            return Ok(());
        }
        Err(VulkanError::Limit { what: "placed acceleration structures".into(), asked, limit })
    }
}

/// Placement of an instance by its number in hits.
fn transform_of(scene: &Scene, instance: u32) -> Affine3A {
    match scene.shape_instance(instance) {
        Some(shape) => shape.world_from_object,
        None => scene.instances[instance as usize].world_from_object,
    }
}
