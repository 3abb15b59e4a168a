//! The tracer: trees of a scene behind [`Trace`].

use std::time::Instant;

use ambray_core::frame::PoseStats;
use ambray_core::trace::{Hit, Ray, Trace};
use ambray_scene::Scene;

use crate::kernel::{self, Any, Closest, Query};
use crate::levels::Levels;
use crate::shapes::Shapes;
use crate::speeds::{Parts, Speeds, Way};
use crate::{AlphaTest, BuildOptions, Isa, Opaque, Packets, Stats, Width};

/// Traces batches of rays through a scene.
///
/// Two levels: meshes with a single instance are baked to world space and merged into one tree. Their rays need no transform,
/// and one tree over all of a scene is better than a tree of overlapping trees (Sponza has 103 primitives in one
/// place). Meshes with more instances are baked too if [`BuildOptions::bake_budget`] allows; else they have one tree each
/// in object space, and a tree over their instances leads there.
///
/// Where the scene has a rig, what it moves is never baked: moving meshes have trees of their own too, which follow their
/// vertices if they deform ([`BuildOptions::updates`]), and [`update`](Self::update) places them anew at each pose. Rays go
/// in packets and without a transform through deforming meshes that are in world space, as skinned ones are.
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
    options: BuildOptions,
    stats: Stats,
    /// Of closest hits.
    closest: Speeds,
    /// Of any hits.
    any: Speeds,
}

#[derive(Debug)]
enum Trees {
    Eight(Levels<8>),
    Sixteen(Levels<16>),
}

impl<A: AlphaTest> Tracer<A> {
    /// Builds the trees of `scene`.
    ///
    /// Triangles of zero area or with corners beyond 10¹² units are dropped, and so are instances of shared meshes whose
    /// placement cannot be inverted. Of what moves they are missing only as long as they are so.
    ///
    /// # Panics
    /// If an index in the scene is out of range, or if `options` ask for an instruction set that this machine lacks.
    #[must_use]
    pub fn build(scene: &Scene, alpha: A, options: BuildOptions) -> Self {
        Self { core: Core::build(scene, &alpha, options), alpha }
    }

    /// Moves everything to where `scene` has it: the scene that this was built for, at another pose, with `alpha` for it.
    /// Hits are then those of a tracer built for that pose. Runs on the threads of the current pool.
    ///
    /// Returns what it took; deformation is none of it.
    ///
    /// # Panics
    /// If it is another scene, with fewer instances, meshes, triangles or vertices.
    pub fn update(&mut self, scene: &Scene, alpha: A) -> PoseStats {
        self.alpha = alpha;
        self.core.update(scene)
    }

    /// What was built, in numbers; sizes follow the pose.
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
        let width = options.width.unwrap_or_default();
        let trees = match width {
            Width::Eight => Trees::Eight(Levels::build(scene, alpha, &options)),
            Width::Sixteen => Trees::Sixteen(Levels::build(scene, alpha, &options)),
        };
        let shapes = Shapes::build(scene);
        let stats = Self::measure(&trees, shapes.as_ref());
        let stats = Stats { isa, width, build_time: start.elapsed(), ..stats };
        log::debug!("{}: {stats:?}", scene.name);
        Self { trees, shapes, isa, options, stats, closest: Speeds::default(), any: Speeds::default() }
    }

    fn update(&mut self, scene: &Scene) -> PoseStats {
        let start = Instant::now();
        let mut moved = match &mut self.trees {
            Trees::Eight(levels) => levels.update(scene, &self.options),
            Trees::Sixteen(levels) => levels.update(scene, &self.options),
        };
        if let Some(shapes) = &mut self.shapes {
            let start = Instant::now();
            shapes.update(scene);
            moved.top_level += start.elapsed();
        }
        let Stats { build_time, isa, width, .. } = self.stats;
        let stats = Self::measure(&self.trees, self.shapes.as_ref());
        self.stats = Stats { build_time, isa, width, ..stats };
        moved.total = start.elapsed();
        moved
    }

    /// Sizes of everything.
    fn measure(trees: &Trees, shapes: Option<&Shapes>) -> Stats {
        let mut stats = match trees {
            Trees::Eight(levels) => levels.stats(),
            Trees::Sixteen(levels) => levels.stats(),
        };
        if let Some(shapes) = shapes {
            let (instances, nodes, depth, bytes) = shapes.size();
            stats.shapes = instances;
            stats.nodes += nodes;
            stats.depth = stats.depth.max(depth);
            stats.bytes += bytes;
        }
        stats
    }

    fn closest_hits(&self, alpha: &dyn AlphaTest, rays: &[Ray], hits: &mut [Hit]) {
        self.batch::<Closest>(&self.closest, alpha, rays, hits);
        if let Some(shapes) = &self.shapes {
            shapes.closest_hits(alpha, rays, hits);
        }
    }

    fn any_hits(&self, alpha: &dyn AlphaTest, rays: &[Ray], blocked: &mut [bool]) {
        self.batch::<Any>(&self.any, alpha, rays, blocked);
        if let Some(shapes) = &self.shapes {
            shapes.any_hits(alpha, rays, blocked);
        }
    }

    fn batch<Q: Query>(
        &self,
        speeds: &Speeds,
        alpha: &dyn AlphaTest,
        rays: &[Ray],
        answers: &mut [Q::Answer],
    ) {
        let sort = match self.options.packets {
            Packets::Measured => speeds.sort(rays),
            Packets::Always => return self.trace::<Q>(alpha, true, rays, answers),
            Packets::Never => return self.trace::<Q>(alpha, false, rays, answers),
        };
        let Some(sort) = sort else { return self.trace::<Q>(alpha, true, rays, answers) };
        match sort.next(rays.len()) {
            Way::Packets => self.trace::<Q>(alpha, true, rays, answers),
            Way::Single => self.trace::<Q>(alpha, false, rays, answers),
            Way::Compare(Parts { starts: [first, second], packets }) => {
                let parts = [0..first, first..second, second..rays.len()];
                let [_, first, second] = [0, 1, 2].map(|i| {
                    let (part, start) = (parts[i].clone(), Instant::now());
                    self.trace::<Q>(alpha, packets[i], &rays[part.clone()], &mut answers[part.clone()]);
                    (start.elapsed(), part.len())
                });
                if packets[1] { sort.learn(first, second) } else { sort.learn(second, first) }
            }
        }
    }

    fn trace<Q: Query>(&self, alpha: &dyn AlphaTest, packets: bool, rays: &[Ray], answers: &mut [Q::Answer]) {
        match &self.trees {
            Trees::Eight(levels) => {
                kernel::batch::<8, Q>(self.isa, &levels.view(alpha, packets), rays, answers);
            }
            Trees::Sixteen(levels) => {
                kernel::batch::<16, Q>(self.isa, &levels.view(alpha, packets), rays, answers);
            }
        }
    }
}
