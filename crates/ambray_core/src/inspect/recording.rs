//! A world that remembers which shadow rays were traced in it.

use std::sync::{Mutex, PoisonError};

use crate::trace::{Diffuse, Hit, Motion, Ray, Trace, World};

use super::{ShadowRay, ShadowSource};

/// Passes everything on to another world, and keeps the batches of [`any_hits`](Trace::any_hits) with their answers.
pub(super) struct Recording<'a, W> {
    world: &'a W,
    batches: Mutex<Vec<Vec<(Ray, bool)>>>,
}

impl<'a, W: World> Recording<'a, W> {
    pub(super) fn new(world: &'a W) -> Self {
        Self { world, batches: Mutex::default() }
    }

    /// The shadow rays, where the batches were all of [`direct_irradiance`](crate::direct::direct_irradiance), which traces
    /// one for each of its `lights`. `source` tells by the seed where a ray comes from.
    pub(super) fn shadows(
        self,
        lights: usize,
        source: impl Fn(u32) -> Option<ShadowSource>,
    ) -> Vec<ShadowRay> {
        let batches = self.batches.into_inner().unwrap_or_else(PoisonError::into_inner);
        let batches = batches.iter().enumerate();
        let rays = batches.flat_map(|(i, batch)| batch.iter().map(move |ray| (i % lights.max(1), ray)));
        rays.filter_map(|(light, &(ray, blocked))| {
            let Ray { origin, direction, t_max, seed } = ray;
            Some(ShadowRay { origin, direction, t_max, light, source: source(seed)?, blocked })
        })
        .collect()
    }
}

impl<W: World> Trace for Recording<'_, W> {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.world.closest_hits(rays, hits);
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
        self.world.any_hits(rays, blocked);
        let batch = rays.iter().copied().zip(blocked.iter().copied()).collect();
        self.batches.lock().unwrap_or_else(PoisonError::into_inner).push(batch);
    }
}

impl<W: World> World for Recording<'_, W> {
    fn motion(&self, instance: u32) -> Motion {
        self.world.motion(instance)
    }

    fn diffuse_at(&self, ray: &Ray, hit: &Hit, width: f32) -> Diffuse {
        self.world.diffuse_at(ray, hit, width)
    }
}
