//! Second batch: chords that join the ends of the missed rays and find thin objects between them (spec §8).

use glam::Vec3;

use crate::{
    settings::Thin,
    trace::{Hit, Ray, World},
};

use super::{
    GatherParams, Gathered, ShadedPoint,
    radiance::RadianceScratch,
    samples::{Run, Sample, Samples},
};

/// Chords end a little before the second end point (spec §5).
const CHORD_END: f32 = 1.0 - 1e-4;

/// What the second batch says about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SecondBatch {
    /// Openness A2.
    pub(super) openness: f32,
    /// Σ w over the blocked chords: length over R (paper), or degree of blocking (sheet).
    pub(super) weight: f32,
    /// Σ w L_r over the blocked chords.
    pub(super) weighted_radiance: Vec3,
}

impl SecondBatch {
    /// Nothing thin was found.
    pub(super) const OPEN: Self = Self { openness: 1.0, weight: 0.0, weighted_radiance: Vec3::ZERO };
}

/// A chord between two missed rays of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    pub(super) point: u32,
    /// The samples whose ends it joins; there are at most 65536.
    pub(super) joins: [u16; 2],
    /// Length, scene units.
    pub(super) length: f32,
    /// Degree in [0, 1] to which the chord is blocked.
    pub(super) blocked: f32,
    /// Weight of its hit in the mean radiance.
    weight: f32,
}

/// The chords of a batch of points.
#[derive(Debug, Default)]
pub(super) struct Chords {
    pub(super) chords: Vec<Chord>,
    pub(super) rays: Vec<Ray>,
    pub(super) hits: Vec<Hit>,
    blocked: Vec<bool>,
    /// Missed rays of each point of a run, each list ended by the next one's start.
    missed: Vec<u32>,
    /// Samples in the order in which their missed rays are listed.
    order: Vec<u32>,
    starts: Vec<usize>,
    results: Vec<SecondBatch>,
    /// Σ blocked and Σ of all, of each point.
    sums: Vec<(f32, f32)>,
}

impl Chords {
    /// What the second batch says about each point.
    pub(super) fn results(&self) -> &[SecondBatch] {
        &self.results
    }

    /// No second batch for `points` points.
    #[inline(always)]
    pub(super) fn skip(&mut self, points: usize) {
        self.results.clear();
        self.results.resize(points, SecondBatch::OPEN);
    }

    /// Traces the chords of `points`, whose first batch is in `samples`: A2 and the radiance of the blocked chords.
    #[inline(always)]
    pub(super) fn trace(
        &mut self,
        world: &impl World,
        params: &GatherParams<'_>,
        points: &[ShadedPoint],
        samples: &Samples,
        radiance: &mut RadianceScratch,
        out: &mut [Gathered],
    ) {
        self.make_rays(params, points, samples);
        radiance.clear();
        if any_hit_will_do(params) {
            self.blocked.clear();
            self.blocked.resize(self.rays.len(), false);
            world.any_hits(&self.rays, &mut self.blocked);
            for (chord, &blocked) in self.chords.iter_mut().zip(&self.blocked) {
                chord.blocked = f32::from(u8::from(blocked));
            }
        } else {
            self.hits.clear();
            self.hits.resize(self.rays.len(), Hit::MISS);
            world.closest_hits(&self.rays, &mut self.hits);
            self.weigh_hits(world, params, points, radiance);
        }
        self.skip(points.len());
        self.sum_up(params, out);
        radiance.evaluate(world, params);
        for (chord, radiance, shadow_rays) in radiance.results(params) {
            let chord = &self.chords[chord as usize];
            let result = &mut self.results[chord.point as usize];
            result.weight += chord.weight;
            result.weighted_radiance += chord.weight * radiance;
            out[chord.point as usize].shadow_rays += shadow_rays;
        }
    }

    /// Degree of blocking and weight of each chord that hit something.
    #[inline(always)]
    fn weigh_hits(
        &mut self,
        world: &impl World,
        params: &GatherParams<'_>,
        points: &[ShadedPoint],
        radiance: &mut RadianceScratch,
    ) {
        let hits = self.chords.iter_mut().zip(&self.rays).zip(&self.hits).enumerate();
        for (i, ((chord, ray), hit)) in hits.filter(|(_, (_, hit))| hit.is_hit()) {
            let from_point = ray.origin + hit.t * ray.direction - points[chord.point as usize].position;
            let distance = from_point.length();
            (chord.blocked, chord.weight) = match params.thin {
                Thin::Paper => (1.0, chord.length / params.radius),
                Thin::Sheet | Thin::Off => (1.0 - params.openness.at(distance), 1.0),
            };
            if params.needs_radiance() || params.thin_edge {
                let normal = radiance.push(world, ray, hit, distance * params.cone_width(), i as u32);
                if params.thin == Thin::Sheet {
                    if params.thin_edge {
                        chord.blocked *= seen_edge_on(normal.dot(from_point).abs() / distance);
                    }
                    chord.weight = chord.blocked;
                }
            }
        }
    }

    /// A2 of each point (spec §8.1 and §8.3), and its counts of chords.
    #[inline(always)]
    fn sum_up(&mut self, params: &GatherParams<'_>, out: &mut [Gathered]) {
        let spp = params.samples.spp() as f32;
        self.sums.clear();
        self.sums.resize(out.len(), (0.0, 0.0));
        for chord in &self.chords {
            let gathered = &mut out[chord.point as usize];
            gathered.chord_rays += 1;
            gathered.chord_hits += u32::from(chord.blocked > 0.0);
            let (blocked, total) = &mut self.sums[chord.point as usize];
            match params.thin {
                Thin::Paper => {
                    *blocked += chord.length * chord.blocked;
                    *total += chord.length;
                }
                Thin::Sheet | Thin::Off => {
                    *blocked += chord.blocked;
                    *total = spp;
                }
            }
        }
        for (result, (blocked, total)) in self.results.iter_mut().zip(&self.sums) {
            if *total > 0.0 {
                result.openness = 1.0 - blocked / total;
            }
        }
    }

    /// One chord for each chosen pair of missed rays, run by run of equal class and pair by pair, so that
    /// neighbouring rays are nearly parallel.
    #[inline(always)]
    fn make_rays(&mut self, params: &GatherParams<'_>, points: &[ShadedPoint], samples: &Samples) {
        self.chords.clear();
        self.rays.clear();
        for run in &samples.runs {
            self.find_missed(params, points, samples, run);
            let most = self.starts.windows(2).map(|w| w[1] - w[0]).max().unwrap_or(0);
            let run = ChordRun { params, points, samples, run };
            match params.thin {
                Thin::Paper if params.samples.spp() <= u64::BITS => self.pair_by_samples(&run),
                Thin::Paper => {
                    for q in 0..most {
                        for partner in q + 1..most {
                            self.pair(&run, |m| (partner < m).then_some([q, partner]));
                        }
                    }
                }
                Thin::Sheet | Thin::Off => {
                    for q in 0..most / 2 {
                        self.pair(&run, |m| (q < m / 2).then_some([q, q + m / 2]));
                    }
                }
            }
        }
    }

    /// All pairs, those of the same two samples together: the points of a run share their samples, so these chords are
    /// parallel where the surface is flat. Pairs of the same ranks among the missed rays would be so only where the same
    /// rays are missed. The order of one point's chords is the same.
    #[inline(always)]
    fn pair_by_samples(&mut self, run: &ChordRun<'_>) {
        let missed_of = |i: usize| self.missed[self.starts[i]..self.starts[i + 1]].iter();
        let sets: Vec<u64> =
            run.run.range().enumerate().map(|(i, _)| missed_of(i).fold(0, |set, &j| set | 1 << j)).collect();
        let missed = sets.iter().fold(0, |all, set| all | set);
        for (a, b) in bits(missed).flat_map(|a| bits(missed & (!1 << a)).map(move |b| (a, b))) {
            let pair = 1 << a | 1 << b;
            for (i, &set) in sets.iter().enumerate().filter(|(_, set)| *set & pair == pair) {
                let rank = |j: u32| (set & ((1 << j) - 1)).count_ones() as usize;
                self.join(run, i, [rank(a), rank(b)]);
            }
        }
    }

    /// For each point a chord between two of its missed rays, which `ranks` chooses by their number.
    #[inline(always)]
    fn pair(&mut self, run: &ChordRun<'_>, ranks: impl Fn(usize) -> Option<[usize; 2]>) {
        for i in 0..run.run.points {
            if let Some(ranks) = ranks(self.starts[i + 1] - self.starts[i]) {
                self.join(run, i, ranks);
            }
        }
    }

    /// A chord of point `i` of a run between the ends of two of its missed rays.
    #[inline(always)]
    fn join(
        &mut self,
        ChordRun { params, points, samples, run }: &ChordRun<'_>,
        i: usize,
        ranks: [usize; 2],
    ) {
        let point = &points[run.first + i];
        // No `map`: it is not inlined.
        let sample = |rank: usize| self.missed[self.starts[i] + rank];
        let joins = [sample(ranks[0]), sample(ranks[1])];
        let end = |j: u32| end(params, point, &samples.get(run.slot(i, j as usize)));
        let ends = [end(joins[0]), end(joins[1])];
        let length = ends[0].distance(ends[1]);
        if length > 0.0 {
            let direction = (ends[1] - ends[0]) / length;
            let spp = params.samples.spp() as usize;
            let seed = point.key.ray_seed((spp + ranks[0] * spp + ranks[1]) as u32);
            self.rays.push(Ray { origin: ends[0], t_max: CHORD_END * length, direction, seed });
            let point = (run.first + i) as u32;
            let joins = [joins[0] as u16, joins[1] as u16];
            self.chords.push(Chord { point, joins, length, blocked: 0.0, weight: 0.0 });
        }
    }

    /// Lists the missed rays of each point: in the order of the samples (paper) or of their azimuth (sheet).
    #[inline(always)]
    fn find_missed(
        &mut self,
        params: &GatherParams<'_>,
        points: &[ShadedPoint],
        samples: &Samples,
        run: &Run,
    ) {
        let spp = params.samples.spp();
        self.missed.clear();
        self.starts.clear();
        self.starts.push(0);
        self.order.clear();
        self.order.extend(0..spp);
        // Points of a class may share their directions, and then the order of these.
        let class = points[run.first].key.class;
        let is_shared = params.samples.shared(class, 0).is_some();
        for point in 0..run.points {
            if params.thin == Thin::Sheet && (point == 0 || !is_shared) {
                let azimuth = |j: u32| samples.azimuth[run.slot(point, j as usize)];
                // Of equal ones the earlier sample comes first.
                self.order.sort_unstable_by(|&a, &b| azimuth(a).total_cmp(&azimuth(b)).then(a.cmp(&b)));
            }
            for &j in &self.order {
                if samples.distance[run.slot(point, j as usize)] >= params.radius {
                    self.missed.push(j);
                }
            }
            self.starts.push(self.missed.len());
        }
    }
}

/// A run of points whose chords are made.
struct ChordRun<'a> {
    params: &'a GatherParams<'a>,
    points: &'a [ShadedPoint],
    samples: &'a Samples,
    run: &'a Run,
}

/// Indices of the bits of `set`, lowest first.
fn bits(mut set: u64) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        let lowest = (set != 0).then(|| set.trailing_zeros())?;
        set &= set - 1;
        Some(lowest)
    })
}

/// Whether the visibility of chords is all that is asked for: any hit will do.
#[inline(always)]
pub(super) fn any_hit_will_do(params: &GatherParams<'_>) -> bool {
    params.thin == Thin::Paper && !params.needs_radiance()
}

/// End of the missed ray of `sample` at `point`, which chords join.
#[inline(always)]
pub(super) fn end(params: &GatherParams<'_>, point: &ShadedPoint, sample: &Sample) -> Vec3 {
    point.position + sample.direction * end_length(params)
}

/// Distance of the end points of missed rays: R (paper), R/2 (sheet: low sheets are found too).
#[inline(always)]
fn end_length(params: &GatherParams<'_>) -> f32 {
    if params.thin == Thin::Paper { params.radius } else { 0.5 * params.radius }
}

/// Edge factor S(e) = 1 - smoothstep(0.15, 0.5, e) of the cosine `e` between the hit's normal and the line of sight
/// from the shaded point: 1 for surfaces seen edge-on (spec §8.3).
#[inline(always)]
fn seen_edge_on(e: f32) -> f32 {
    let x = ((e - 0.15) / 0.35).clamp(0.0, 1.0);
    1.0 - x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edge_factor() {
        assert_eq!(seen_edge_on(0.0), 1.0);
        assert_eq!(seen_edge_on(0.15), 1.0);
        assert!((seen_edge_on(0.325) - 0.5).abs() < 1e-6);
        assert_eq!(seen_edge_on(0.5), 0.0);
        assert_eq!(seen_edge_on(1.0), 0.0);
    }
}
