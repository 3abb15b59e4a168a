//! Radiance L_r that leaves a hit (spec §3).

use glam::Vec3;

use crate::{
    compose::reflected,
    direct::{DirectLighting, DirectScratch, Received, Receiver, direct_irradiance},
    sampling::pcg,
    settings::RadianceSource,
    trace::{Hit, Ray, World},
};

use super::GatherParams;

/// Seed of the shadow rays from the hit of `ray`. No two rays of a point share it: hashes of 32 bits to 32 bits are
/// permutations.
pub(super) const fn shadow_seed(ray: &Ray) -> u32 {
    pcg(ray.seed)
}

/// A batch of hits whose radiance is wanted. Each carries a tag of the caller's.
#[derive(Debug, Default)]
pub(super) struct RadianceScratch {
    receivers: Vec<Receiver>,
    albedo: Vec<Vec3>,
    tags: Vec<u32>,
    received: Vec<Received>,
    direct: DirectScratch,
}

impl RadianceScratch {
    pub(super) fn clear(&mut self) {
        self.receivers.clear();
        self.albedo.clear();
        self.tags.clear();
    }

    /// Adds the `hit` of `ray` with a footprint of `width` scene units; returns the geometric normal there.
    pub(super) fn push(&mut self, world: &impl World, ray: &Ray, hit: &Hit, width: f32, tag: u32) -> Vec3 {
        let surface = world.diffuse_at(ray, hit, width);
        self.receivers.push(Receiver {
            position: surface.position,
            geometric_normal: surface.geometric_normal,
            normal: surface.geometric_normal,
            reach: surface.reach,
            seed: shadow_seed(ray),
        });
        self.albedo.push(surface.albedo);
        self.tags.push(tag);
        surface.geometric_normal
    }

    /// Computes what [`results`](Self::results) returns, for all hits added since [`clear`](Self::clear).
    pub(super) fn evaluate(&mut self, world: &impl World, params: &GatherParams<'_>) {
        self.received.clear();
        self.received.resize(self.albedo.len(), Received::default());
        let shadows = params.source == RadianceSource::Lit;
        if shadows || params.source == RadianceSource::LitUnshadowed {
            let lighting = DirectLighting { lights: params.lights, offset: params.offset, shadows };
            direct_irradiance(world, lighting, &self.receivers, &mut self.direct, &mut self.received);
        }
    }

    /// Tag, radiance L_r and shadow rays of each hit.
    pub(super) fn results(&self, params: &GatherParams<'_>) -> impl Iterator<Item = (u32, Vec3, u32)> {
        self.tags.iter().zip(&self.albedo).zip(&self.received).map(move |((&tag, &albedo), received)| {
            let radiance = match params.albedo_factor() {
                Some(factor) => albedo * factor,
                None => albedo * params.ambient + reflected(albedo, received.irradiance),
            };
            (tag, radiance, received.shadow_rays)
        })
    }
}
