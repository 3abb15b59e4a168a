//! First batch: N rays from each point over the hemisphere.

use crate::{
    basis::Basis,
    trace::{Hit, Motion, Ray, World},
};

use super::{GatherParams, Gathered, Sample, ShadedPoint, radiance::RadianceScratch};

use glam::Vec3;

/// Whether a hit on the instance `occluder` may move against a point on the instance `receiver`.
fn may_change(world: &impl World, receiver: u32, occluder: u32) -> bool {
    let motion = world.motion(occluder);
    if receiver == occluder {
        return motion == Motion::Deforming;
    }
    motion != Motion::Static || world.motion(receiver) != Motion::Static
}

/// The rays of a batch of points and what became of them.
#[derive(Debug, Default)]
pub(super) struct FirstBatch {
    /// N samples of each point, point after point.
    samples: Vec<Sample>,
    pub(super) rays: Vec<Ray>,
    pub(super) hits: Vec<Hit>,
    /// Sample that each ray belongs to.
    pub(super) slots: Vec<u32>,
    /// Basis and ray origin of each point of a run.
    starts: Vec<(Basis, Vec3)>,
}

impl FirstBatch {
    /// The N samples of each point, point after point.
    pub(super) fn samples(&self) -> &[Sample] {
        &self.samples
    }

    pub(super) fn trace(
        &mut self,
        world: &impl World,
        params: &GatherParams<'_>,
        points: &[ShadedPoint],
        radiance: &mut RadianceScratch,
        out: &mut [Gathered],
    ) {
        self.make_rays(params, points, out);
        self.hits.clear();
        self.hits.resize(self.rays.len(), Hit::MISS);
        world.closest_hits(&self.rays, &mut self.hits);

        let spp = params.samples.spp() as usize;
        radiance.clear();
        for ((ray, hit), &slot) in self.rays.iter().zip(&self.hits).zip(&self.slots) {
            let gathered = &mut out[slot as usize / spp];
            gathered.ambient_rays += 1;
            if hit.is_hit() {
                gathered.ambient_hits += 1;
                let sample = &mut self.samples[slot as usize];
                sample.distance = hit.t;
                if params.temporal {
                    sample.changing = may_change(world, points[slot as usize / spp].instance, hit.instance);
                }
                if params.needs_radiance() {
                    radiance.push(world, ray, hit, hit.t * params.cone_width(), slot);
                }
            }
        }
        radiance.evaluate(world, params);
        for (slot, radiance, shadow_rays) in radiance.results(params) {
            self.samples[slot as usize].radiance = radiance;
            out[slot as usize / spp].shadow_rays += shadow_rays;
        }
    }

    /// Samples of all points, and rays for those above the geometric horizon.
    fn make_rays(&mut self, params: &GatherParams<'_>, points: &[ShadedPoint], out: &[Gathered]) {
        debug_assert_eq!(points.len(), out.len());
        let spp = params.samples.spp() as usize;
        let miss = Sample {
            direction: Vec3::ZERO,
            distance: f32::INFINITY,
            radiance: Vec3::ZERO,
            azimuth: 0.0,
            changing: false,
        };
        self.samples.clear();
        self.samples.resize(points.len() * spp, miss);
        self.rays.clear();
        self.slots.clear();
        let t_max = params.openness.reach();
        let mut first = 0;
        for run in points.chunk_by(|a, b| a.key.class == b.key.class) {
            self.starts.clear();
            self.starts.extend(run.iter().map(|point| {
                let origin = params.offset.apply(point.position, point.geometric_normal, point.reach);
                (Basis::from_normal(point.normal), origin)
            }));
            for j in 0..spp {
                for (i, (point, (basis, origin))) in run.iter().zip(&self.starts).enumerate() {
                    let slot = (first + i) * spp + j;
                    let sample = params.samples.direction(point.key, j as u32);
                    let direction = basis.to_world(sample.local);
                    // A direction below the geometric horizon is blocked at once, without a ray (spec §5).
                    let above_horizon = direction.dot(point.geometric_normal) > 0.0;
                    let distance = if above_horizon { f32::INFINITY } else { 0.0 };
                    self.samples[slot] = Sample { direction, distance, azimuth: sample.azimuth, ..miss };
                    if above_horizon {
                        let seed = point.key.ray_seed(j as u32);
                        self.rays.push(Ray { origin: *origin, t_max, direction, seed });
                        self.slots.push(slot as u32);
                    }
                }
            }
            first += run.len();
        }
    }
}
