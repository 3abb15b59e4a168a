//! The scene as the method sees it: the tracer for hits, the scene's surfaces for what is there.

use std::{
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::Instant,
};

use ambray_core::frame::PoseStats;
use ambray_core::trace::{Diffuse, Hit, Motion, Ray, Trace, World};
use ambray_scene::{Scene, surface::Surfaces};
use glam::Vec3;

use super::vectors::Vectors;
use crate::{BuildOptions, Tracer};

/// Tracer and surfaces of a scene.
#[derive(Debug)]
pub struct CpuWorld {
    tracer: Tracer<Arc<Surfaces>>,
    surfaces: Arc<Surfaces>,
    vectors: Vectors,
}

impl CpuWorld {
    pub(super) fn new(scene: Arc<Scene>, options: BuildOptions) -> Self {
        let surfaces = Arc::new(Surfaces::new(Arc::clone(&scene)));
        // Now, so that the first frame need not.
        surfaces.prepare_albedos();
        let tracer = Tracer::build(&scene, Arc::clone(&surfaces), options);
        let vectors = Vectors::of(tracer.stats().isa);
        Self { tracer, surfaces, vectors }
    }

    /// Moves everything to where `scene` has it: the same scene at another pose.
    pub(super) fn update(&mut self, scene: Arc<Scene>) -> PoseStats {
        self.surfaces = Arc::new(self.surfaces.moved_to(scene));
        self.tracer.update(self.surfaces.scene(), Arc::clone(&self.surfaces))
    }

    /// The trees.
    #[must_use]
    pub const fn tracer(&self) -> &Tracer<Arc<Surfaces>> {
        &self.tracer
    }

    /// The vectors that everything is computed with.
    pub(super) const fn vectors(&self) -> Vectors {
        self.vectors
    }

    /// Attributes of surfaces.
    #[must_use]
    pub const fn surfaces(&self) -> &Arc<Surfaces> {
        &self.surfaces
    }
}

impl Trace for CpuWorld {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.tracer.closest_hits(rays, hits);
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
        self.tracer.any_hits(rays, blocked);
    }
}

impl World for CpuWorld {
    fn motion(&self, instance: u32) -> Motion {
        self.surfaces.motion(instance)
    }

    fn diffuse_at(&self, ray: &Ray, hit: &Hit, width: f32) -> Diffuse {
        self.surfaces.diffuse_at(ray, hit, width).facing(ray.direction).into()
    }

    #[inline(always)]
    fn albedos_at(&self, rays: &[Ray], hits: &[Hit], cone: f32, albedos: &mut [Vec3]) {
        self.surfaces.albedos_at(rays, hits, cone, albedos);
    }
}

/// A world that measures the time for which it traces rays.
#[derive(Debug)]
pub(super) struct Timed<'w> {
    world: &'w CpuWorld,
    nanoseconds: AtomicU64,
}

impl<'w> Timed<'w> {
    pub(super) const fn new(world: &'w CpuWorld) -> Self {
        Self { world, nanoseconds: AtomicU64::new(0) }
    }

    /// Nanoseconds spent tracing so far.
    pub(super) fn tracing(&self) -> u64 {
        self.nanoseconds.load(Ordering::Relaxed)
    }

    /// Batches are thousands of rays, for which two looks at a clock are nothing.
    fn timed(&self, trace: impl FnOnce(&CpuWorld)) {
        let start = Instant::now();
        trace(self.world);
        let elapsed = u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.nanoseconds.fetch_add(elapsed, Ordering::Relaxed);
    }
}

impl Trace for Timed<'_> {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.timed(|world| world.closest_hits(rays, hits));
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
        self.timed(|world| world.any_hits(rays, blocked));
    }
}

impl World for Timed<'_> {
    fn motion(&self, instance: u32) -> Motion {
        self.world.motion(instance)
    }

    fn diffuse_at(&self, ray: &Ray, hit: &Hit, width: f32) -> Diffuse {
        self.world.diffuse_at(ray, hit, width)
    }

    #[inline(always)]
    fn albedos_at(&self, rays: &[Ray], hits: &[Hit], cone: f32, albedos: &mut [Vec3]) {
        self.world.albedos_at(rays, hits, cone, albedos);
    }
}
