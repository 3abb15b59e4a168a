//! From traced rays to openness, near radiance and bent normal (spec §§3, 8).

use glam::{DVec3, Vec3};

use super::{
    GatherParams, Gathered,
    samples::{Run, Samples, group, in_groups},
    thin::SecondBatch,
};
use crate::settings::NearRadiance;

/// What `samples` and the `second` batch say about each point.
#[inline(always)]
pub(super) fn combine(
    params: &GatherParams<'_>,
    samples: &Samples,
    second: &[SecondBatch],
    gathered: &mut [Gathered],
) {
    for run in &samples.runs {
        let (second, gathered) = (&second[run.range()], &mut gathered[run.range()]);
        in_groups!(run.points, combine_group(params, samples, run, second, gathered));
    }
}

/// Sums over the samples of `L` points, one lane a point.
///
/// In double precision: adding 65536 rays in single precision errs by 1e-3.
struct Sums<const L: usize> {
    /// Σ μ.
    open: [f64; L],
    /// Σ μ w.
    bent: [[f64; L]; 3],
    /// Σ (1 - μ) over what may change.
    changing: [f64; L],
    /// Σ of the weights of hits: all of them where near radiance is per hit, else those within the near limit.
    weight: [f64; L],
    /// Σ of their weighted radiances.
    weighted: [[f64; L]; 3],
    rays: [u32; L],
    hits: [u32; L],
}

#[inline(always)]
fn combine_group<const L: usize>(
    at: usize,
    params: &GatherParams<'_>,
    samples: &Samples,
    run: &Run,
    second: &[SecondBatch],
    gathered: &mut [Gathered],
) {
    let sums = Sums::<L>::over(params, samples, run, at);
    let count = f64::from(params.samples.spp());
    for lane in 0..L {
        sums.finish(lane, count, params, &second[at + lane], &mut gathered[at + lane]);
    }
}

impl<const L: usize> Sums<L> {
    #[inline(always)]
    fn over(params: &GatherParams<'_>, samples: &Samples, run: &Run, at: usize) -> Self {
        let zero = [0.0; L];
        let mut sums = Self {
            open: zero,
            bent: [zero; 3],
            changing: zero,
            weight: zero,
            weighted: [zero; 3],
            rays: [0; L],
            hits: [0; L],
        };
        for j in 0..params.samples.spp() as usize {
            sums.add(params, samples, run.slot(at, j));
        }
        sums
    }

    /// Adds the sample at `slot` and its neighbours.
    #[inline(always)]
    fn add(&mut self, params: &GatherParams<'_>, samples: &Samples, slot: usize) {
        let distance: &[f32; L] = group(&samples.distance, slot);
        let mu = params.openness.at_each(distance);
        // Where radiance is added with other weights, it is the share of the hit that is not open.
        let (mut wide, mut weight) = ([0.0; L], [0.0; L]);
        for lane in 0..L {
            wide[lane] = f64::from(mu[lane]);
            let is_near = distance[lane] < params.near_limit;
            weight[lane] = match params.near_radiance {
                NearRadiance::Off | NearRadiance::PerHit => 1.0 - wide[lane],
                NearRadiance::Averaged => {
                    if is_near {
                        1.0 - wide[lane]
                    } else {
                        0.0
                    }
                }
                NearRadiance::AveragedPlain => {
                    if is_near {
                        1.0
                    } else {
                        0.0
                    }
                }
            };
        }
        let mu = wide;
        for lane in 0..L {
            self.open[lane] += mu[lane];
            self.weight[lane] += weight[lane];
            self.rays[lane] += u32::from(distance[lane] > 0.0);
            self.hits[lane] += u32::from(distance[lane] > 0.0 && distance[lane] < f32::INFINITY);
        }
        for axis in 0..3 {
            let direction: &[f32; L] = group(&samples.direction[axis], slot);
            let radiance: &[f32; L] = group(&samples.radiance[axis], slot);
            for lane in 0..L {
                self.bent[axis][lane] += mu[lane] * f64::from(direction[lane]);
                // A hit without weight adds nothing, however bright: zero times infinity is not a number.
                let counts = weight[lane] != 0.0;
                self.weighted[axis][lane] +=
                    if counts { weight[lane] * f64::from(radiance[lane]) } else { 0.0 };
            }
        }
        if params.temporal {
            let changing: &[f32; L] = group(&samples.changing, slot);
            for lane in 0..L {
                self.changing[lane] += f64::from(changing[lane]) * (1.0 - mu[lane]);
            }
        }
    }

    /// The estimate of one point, of `count` samples.
    #[inline(always)]
    fn finish(
        &self,
        lane: usize,
        count: f64,
        params: &GatherParams<'_>,
        second: &SecondBatch,
        gathered: &mut Gathered,
    ) {
        let of = |sums: &[[f64; L]; 3]| DVec3::new(sums[0][lane], sums[1][lane], sums[2][lane]);
        let (weight, weighted) = (self.weight[lane], of(&self.weighted));
        let first = (self.open[lane] / count) as f32;
        let (chord_weight, chord_weighted) = (f64::from(second.weight), second.weighted_radiance.as_dvec3());
        let mean = |weighted: DVec3, weight: f64| {
            if weight > 0.0 { (weighted / weight).as_vec3() } else { Vec3::ZERO }
        };
        // Near radiance that is consistent with an openness o (spec §8.1).
        let near = |o: f32| match params.near_radiance {
            NearRadiance::Off => Vec3::ZERO,
            NearRadiance::PerHit if first < 1.0 => (weighted / count).as_vec3() * ((1.0 - o) / (1.0 - first)),
            NearRadiance::PerHit => mean(chord_weighted, chord_weight) * (1.0 - o),
            NearRadiance::Averaged | NearRadiance::AveragedPlain => {
                mean(weighted + chord_weighted, weight + chord_weight) * (1.0 - o)
            }
        };
        let openness = first.min(second.openness);
        gathered.openness = openness;
        gathered.near = near(openness);
        gathered.first = first;
        gathered.near_first = near(first);
        gathered.second = second.openness;
        gathered.near_second = near(second.openness);
        gathered.bent = (of(&self.bent) / count).as_vec3();
        gathered.changing = (self.changing[lane] / count) as f32;
        gathered.ambient_rays = self.rays[lane];
        gathered.ambient_hits = self.hits[lane];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        gather::{ShadedPoint, samples::LANES, thin::Chords},
        offset::RayOffset,
        openness::Openness,
        sampling::{PixelKey, SampleSets},
        settings::{RadianceSource, Settings, Thin},
        trace::Hit,
    };

    /// Two hits of each point, whose measure is 1 - 1/d: one of grey 0.5 at 0.5 R, and a `bright` one at `far`.
    fn gathered(near_radiance: NearRadiance, near_limit: f32, far: f32, bright: f32) -> Vec<Gathered> {
        let sets = SampleSets::of(&Settings { spp: 2, ..Settings::default() });
        let params = GatherParams {
            openness: Openness::Power { radius: 1.0, exponent: 1.0 },
            radius: 1.0,
            near_radiance,
            near_limit,
            source: RadianceSource::Lit,
            thin: Thin::Off,
            thin_edge: false,
            ambient: Vec3::ONE,
            lights: &[],
            offset: RayOffset::UNIT,
            samples: &sets,
            temporal: false,
        };
        let point = ShadedPoint {
            position: Vec3::ZERO,
            geometric_normal: Vec3::Z,
            reach: 0.0,
            normal: Vec3::Z,
            instance: Hit::NONE,
            key: PixelKey::default(),
        };
        // A group of many lanes, and one of a single lane.
        let points = [point; LANES + 1];
        let (mut samples, mut chords) = (Samples::default(), Chords::default());
        samples.begin(&params, &points);
        chords.skip(points.len());
        let first = points.len();
        samples.distance[..first].fill(0.5);
        samples.distance[first..].fill(far);
        for plane in &mut samples.radiance {
            plane[..first].fill(0.5);
            plane[first..].fill(bright);
        }
        let mut gathered = vec![Gathered::default(); points.len()];
        combine(&params, &samples, chords.results(), &mut gathered);
        gathered
    }

    #[test]
    fn hits_that_do_not_count_may_be_infinitely_bright() {
        use NearRadiance::{Averaged, AveragedPlain, Off, PerHit};
        // Beyond the near limit, and where the measure says open.
        for (near_radiance, near_limit, far) in
            [(Averaged, 0.6, 0.75), (AveragedPlain, 0.6, 0.75), (Averaged, 2.0, 1.0), (PerHit, 0.6, 1.0)]
        {
            let bright = gathered(near_radiance, near_limit, far, f32::INFINITY);
            let dark = gathered(near_radiance, near_limit, far, 0.0);
            assert!(dark[0].near.is_finite() && dark[0].near != Vec3::ZERO, "{near_radiance}");
            assert_eq!(bright, dark, "{near_radiance}");
        }
        assert_eq!(gathered(Off, 0.6, 1.0, 0.0)[0].near, Vec3::ZERO);
        // One that counts is seen.
        assert_eq!(gathered(Averaged, 0.8, 0.75, f32::INFINITY)[LANES].near, Vec3::INFINITY);
    }
}
