//! What the gather left behind, for [`inspect`](crate::inspect) and for benchmarks of rays: nothing is computed here that
//! decided the result.

use std::collections::HashMap;

use crate::{
    inspect::{AmbientRay, Chord, Meeting, ShadowSource},
    settings::Thin,
    trace::{Hit, Ray, World},
};

use super::{
    GatherParams, GatherScratch, Gathered, ShadedPoint, gather_batch,
    radiance::shadow_seed,
    thin::{any_hit_will_do, end},
};

use glam::Vec3;

/// A ray that was traced, and where it belongs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recorded {
    /// The ray.
    pub ray: Ray,
    /// Which of the points it is of.
    pub point: u32,
    /// Of the first batch, which sample: below N. Of the second, which pair of samples its chord joins: below N (N − 1) / 2,
    /// pairs (0, 1), (0, 2) and so on. At points of one class, rays of one number are parallel on flat surfaces.
    pub number: u32,
}

/// The rays of both batches, in the order in which they were traced.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// First batch.
    pub ambient: Vec<Recorded>,
    /// Second batch.
    pub chords: Vec<Recorded>,
}

/// [`gather`](super::gather) that also adds the rays it traces to `recording`.
pub fn record(
    world: &impl World,
    params: &GatherParams<'_>,
    points: &[ShadedPoint],
    scratch: &mut GatherScratch,
    out: &mut [Gathered],
    recording: &mut Recording,
) {
    let (batch, spp) = (params.batch_points(), params.samples.spp());
    let mut before = 0;
    for (points, out) in points.chunks(batch).zip(out.chunks_mut(batch)) {
        gather_batch(world, params, points, scratch, out);
        let rays = scratch.first.rays.iter().zip(&scratch.first.slots);
        let rays = rays.map(|(&ray, &slot)| {
            let (point, number) = scratch.first.samples.place(slot as usize);
            Recorded { ray, point: before + point as u32, number: number as u32 }
        });
        recording.ambient.extend(rays);
        if params.thin != Thin::Off {
            let rays = scratch.chords.rays.iter().zip(&scratch.chords.chords);
            let rays = rays.map(|(&ray, chord)| {
                let number = pair_number(chord.joins.map(u32::from), spp);
                Recorded { ray, point: before + chord.point, number }
            });
            recording.chords.extend(rays);
        }
        before += points.len() as u32;
    }
}

/// Number of the pair of two of `n` samples, in any order: those before it are the pairs whose smaller sample is smaller.
fn pair_number(joins: [u32; 2], n: u32) -> u32 {
    let [a, b] = [joins[0].min(joins[1]), joins[0].max(joins[1])];
    // Samples 0 to a - 1 are the smaller ones of n - 1, n - 2, ... pairs. At most 65536 samples: a product fits in 64 bits.
    let before = u64::from(a) * u64::from(2 * n - a - 1) / 2;
    before as u32 + (b - a - 1)
}

impl Meeting {
    fn of(ray: &Ray, hit: &Hit, radiance: Vec3) -> Self {
        let position = ray.origin + hit.t * ray.direction;
        Self { distance: hit.t, position, instance: hit.instance, triangle: hit.triangle, radiance }
    }
}

impl GatherScratch {
    /// The N rays of `point`, which was the only one of the last call of [`gather`](super::gather).
    pub(crate) fn rays(&self, params: &GatherParams<'_>, point: &ShadedPoint) -> Vec<AmbientRay> {
        let samples = &self.first.samples;
        debug_assert_eq!(samples.distance.len(), params.samples.spp() as usize);
        let origin = params.offset.apply(point.position, point.geometric_normal, point.reach);
        let (t_max, is_traced, hit) = (params.openness.reach(), false, None);
        let mut rays: Vec<_> = (0..params.samples.spp() as usize)
            .map(|slot| {
                let sample = samples.get(slot);
                let (direction, openness) = (sample.direction, params.openness.at(sample.distance));
                AmbientRay { origin, direction, t_max, is_traced, hit, openness }
            })
            .collect();
        for ((ray, hit), &slot) in self.first.rays.iter().zip(self.first.hits()).zip(&self.first.slots) {
            let radiance = samples.get(slot as usize).radiance;
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
        let (samples, traced) = (&self.first.samples, &self.chords);
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
                let [from, to] = joins.map(|j| end(params, point, &samples.get(j)));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_counted_one_after_another() {
        for n in [2, 3, 8, 33] {
            let pairs = (0..n).flat_map(|a| (a + 1..n).map(move |b| [a, b]));
            for (expected, [a, b]) in (0..).zip(pairs) {
                assert_eq!(pair_number([a, b], n), expected, "{a}, {b} of {n}");
                assert_eq!(pair_number([b, a], n), expected, "{b}, {a} of {n}");
            }
        }
        // The last of 65536 · 65535 / 2 pairs.
        assert_eq!(pair_number([65534, 65535], 65536), 2_147_450_879);
    }
}
