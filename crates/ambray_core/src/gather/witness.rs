//! What the gather left behind, for [`inspect`](crate::inspect): nothing is computed here that decided the result.

use std::collections::HashMap;

use crate::{
    inspect::{AmbientRay, Chord, Meeting, ShadowSource},
    settings::Thin,
    trace::{Hit, Ray, World},
};

use super::{
    GatherParams, GatherScratch, ShadedPoint,
    radiance::shadow_seed,
    thin::{any_hit_will_do, end},
};

use glam::Vec3;

impl Meeting {
    fn of(ray: &Ray, hit: &Hit, radiance: Vec3) -> Self {
        let position = ray.origin + hit.t * ray.direction;
        Self { distance: hit.t, position, instance: hit.instance, triangle: hit.triangle, radiance }
    }
}

impl GatherScratch {
    /// The N rays of `point`, which was the only one of the last call of [`gather`](super::gather).
    pub(crate) fn rays(&self, params: &GatherParams<'_>, point: &ShadedPoint) -> Vec<AmbientRay> {
        let samples = self.first.samples();
        debug_assert_eq!(samples.len(), params.samples.spp() as usize);
        let origin = params.offset.apply(point.position, point.geometric_normal, point.reach);
        let (t_max, is_traced, hit) = (params.openness.reach(), false, None);
        let mut rays: Vec<_> = samples
            .iter()
            .map(|sample| {
                let (direction, openness) = (sample.direction, params.openness.at(sample.distance));
                AmbientRay { origin, direction, t_max, is_traced, hit, openness }
            })
            .collect();
        for ((ray, hit), &slot) in self.first.rays.iter().zip(&self.first.hits).zip(&self.first.slots) {
            let radiance = samples[slot as usize].radiance;
            rays[slot as usize].is_traced = true;
            rays[slot as usize].hit = hit.is_hit().then(|| Meeting::of(ray, hit, radiance));
        }
        rays
    }

    /// The chords of `point`, which was the only one of the last call of [`gather`](super::gather).
    pub(crate) fn chords(
        &self,
        world: &impl World,
        params: &GatherParams<'_>,
        point: &ShadedPoint,
    ) -> Vec<Chord> {
        if params.thin == Thin::Off {
            return Vec::new();
        }
        let (samples, traced) = (self.first.samples(), &self.chords);
        // Where any hit was enough for the method, the nearest is still the one to show.
        let mut nearest = Vec::new();
        let hits = if any_hit_will_do(params) {
            nearest.resize(traced.rays.len(), Hit::MISS);
            world.closest_hits(&traced.rays, &mut nearest);
            &nearest
        } else {
            &traced.hits
        };
        let share_of = |length: f32| if params.thin == Thin::Paper { length } else { 1.0 };
        let total = match params.thin {
            Thin::Paper => traced.chords.iter().map(|chord| chord.length).sum(),
            Thin::Sheet | Thin::Off => params.samples.spp() as f32,
        };
        let mut chords: Vec<_> = traced
            .chords
            .iter()
            .zip(&traced.rays)
            .zip(hits)
            .map(|((chord, ray), hit)| {
                let joins = chord.joins.map(usize::from);
                let [from, to] = joins.map(|j| end(params, point, &samples[j]));
                let hit = hit.is_hit().then(|| Meeting::of(ray, hit, Vec3::ZERO));
                Chord { joins, from, to, hit, blocked: chord.blocked, weight: share_of(chord.length) / total }
            })
            .collect();
        if params.needs_radiance() {
            for (i, radiance, _) in self.radiance.results(params) {
                if let Some(hit) = &mut chords[i as usize].hit {
                    hit.radiance = radiance;
                }
            }
        }
        chords
    }

    /// Which ray or chord each seed of a shadow ray belongs to, of the last call of [`gather`](super::gather) with a single
    /// point.
    pub(crate) fn sources(&self, params: &GatherParams<'_>) -> HashMap<u32, ShadowSource> {
        let rays = self.first.rays.iter().zip(&self.first.slots);
        let rays = rays.map(|(ray, &slot)| (shadow_seed(ray), ShadowSource::Ray(slot as usize)));
        let chords = if params.thin == Thin::Off { &[][..] } else { &self.chords.rays[..] };
        let chords = chords.iter().enumerate();
        rays.chain(chords.map(|(i, ray)| (shadow_seed(ray), ShadowSource::Chord(i)))).collect()
    }
}
