//! The estimator: points and sample directions go in, openness O and near-field radiance I come out (spec §§3, 5, 8).
//!
//! Work is done in batches of points. The rays of a batch are ordered by sample class, then by direction, then by
//! point: on a flat surface such a run of rays is parallel, which tracers of packets profit from.

mod first;
mod radiance;
mod thin;
mod witness;

use std::f32::consts::PI;

use glam::{DVec3, Vec3, Vec4, Vec4Swizzles};

use crate::{
    light::Light,
    offset::RayOffset,
    openness::Openness,
    sampling::{PixelKey, SampleSets},
    settings::{NearRadiance, RadianceSource, Settings, Temporal, Thin},
    trace::World,
    view::View,
};

use first::FirstBatch;
use radiance::RadianceScratch;
use thin::{Chords, SecondBatch};

pub use witness::{Recorded, Recording, record};

/// Rays of one batch: large enough to amortise calls, small enough for the cache.
const BATCH_RAYS: usize = 8192;

/// A surface point at which ambient light is gathered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadedPoint {
    /// Position s from barycentric coordinates, world space.
    pub position: Vec3,
    /// Unit geometric normal on the lit side.
    pub geometric_normal: Vec3,
    /// Reach of its triangle (see [`RayOffset::apply`]), scene units.
    pub reach: f32,
    /// Unit normal n about which directions are sampled.
    pub normal: Vec3,
    /// Instance that it is on, [`Hit::NONE`](crate::trace::Hit::NONE) if that is not known.
    pub instance: u32,
    /// Which samples the point uses.
    pub key: PixelKey,
}

/// What decides the estimate, with every `auto` replaced.
#[derive(Clone, Copy, Debug)]
pub struct GatherParams<'a> {
    /// Fuzzy measure μ.
    pub openness: Openness,
    /// Near-field radius R: rays without a hit below it are the missed rays of the second batch.
    pub radius: f32,
    /// How I is estimated.
    pub near_radiance: NearRadiance,
    /// Distance R_c below which hits enter the average.
    pub near_limit: f32,
    /// Radiance of a hit.
    pub source: RadianceSource,
    /// Second batch.
    pub thin: Thin,
    /// Edge factor of the sheet mode.
    pub thin_edge: bool,
    /// Ambient radiance L_a.
    pub ambient: Vec3,
    /// Lights for [`RadianceSource::Lit`].
    pub lights: &'a [Light],
    /// How rays leave their surface.
    pub offset: RayOffset,
    /// Directions.
    pub samples: &'a SampleSets,
    /// Whether [`Gathered::changing`] is wanted.
    pub temporal: bool,
}

/// Ambient light gathered at a point.
///
/// For [`RadianceSource::SelfSimilar`] the near radiances are still without the factor L_a F:
/// [`near_radiance`](crate::compose::near_radiance) applies it after the filter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gathered {
    /// Openness O = min(O1, A2).
    pub openness: f32,
    /// Near-field radiance I that belongs to O.
    pub near: Vec3,
    /// Openness O1 of the first batch.
    pub first: f32,
    /// Near-field radiance that belongs to O1.
    pub near_first: Vec3,
    /// Openness A2 of the second batch, 1 without one.
    pub second: f32,
    /// Near-field radiance that belongs to A2.
    pub near_second: Vec3,
    /// Bent normal b = (1/N) Σ μ_i w_i, not normalised.
    pub bent: Vec3,
    /// How much of 1 - O1 is due to what may move against the point: (1/N) Σ (1 - μ_i) over those hits (see
    /// [`crate::temporal`]). 0 unless [`GatherParams::temporal`].
    pub changing: f32,
    /// Rays of the first batch that were traced.
    pub ambient_rays: u32,
    /// Rays of the first batch that hit something.
    pub ambient_hits: u32,
    /// Chords of the second batch.
    pub chord_rays: u32,
    /// Chords that were blocked.
    pub chord_hits: u32,
    /// Shadow rays for the radiance of hits.
    pub shadow_rays: u32,
}

impl Gathered {
    /// Openness (x) and near radiance (yzw) as the filter takes them: of both batches if the minimum is taken
    /// `after_filter`, else of the smaller one.
    #[must_use]
    pub fn before_filter(&self, after_filter: bool) -> (Vec4, Option<Vec4>) {
        let join = |openness: f32, near: Vec3| near.extend(openness).wxyz();
        if after_filter {
            (join(self.first, self.near_first), Some(join(self.second, self.near_second)))
        } else {
            (join(self.openness, self.near), None)
        }
    }
}

/// One ray of the first batch, after tracing.
#[derive(Clone, Copy, Debug)]
struct Sample {
    /// World direction w_i.
    direction: Vec3,
    /// Distance d_i of the hit; infinite on a miss, 0 below the geometric horizon.
    distance: f32,
    /// Radiance L_r of the hit, 0 on a miss.
    radiance: Vec3,
    /// Azimuth v of the direction.
    azimuth: f32,
    /// Whether what it hit may move against the point.
    changing: bool,
}

/// Buffers that are reused from batch to batch.
#[derive(Debug, Default)]
pub struct GatherScratch {
    first: FirstBatch,
    chords: Chords,
    radiance: RadianceScratch,
}

/// Gathers ambient light at `points` and writes it to `out`, which has the same length.
///
/// Points should be ordered by sample class. The result of a point does not depend on its neighbours in the list.
pub fn gather(
    world: &impl World,
    params: &GatherParams<'_>,
    points: &[ShadedPoint],
    scratch: &mut GatherScratch,
    out: &mut [Gathered],
) {
    let batch = params.batch_points();
    for (points, out) in points.chunks(batch).zip(out.chunks_mut(batch)) {
        gather_batch(world, params, points, scratch, out);
    }
}

fn gather_batch(
    world: &impl World,
    params: &GatherParams<'_>,
    points: &[ShadedPoint],
    scratch: &mut GatherScratch,
    out: &mut [Gathered],
) {
    out.fill(Gathered::default());
    scratch.first.trace(world, params, points, &mut scratch.radiance, out);
    let spp = params.samples.spp() as usize;
    let samples = scratch.first.samples();
    if params.thin == Thin::Off {
        scratch.chords.skip(points.len());
    } else {
        scratch.chords.trace(world, params, points, samples, &mut scratch.radiance, out);
    }
    for (i, gathered) in out.iter_mut().enumerate() {
        combine(params, &samples[i * spp..][..spp], &scratch.chords.results()[i], gathered);
    }
}

/// Openness, near radiance and bent normal of one point from its traced rays (spec §§3, 8).
fn combine(params: &GatherParams<'_>, samples: &[Sample], second: &SecondBatch, gathered: &mut Gathered) {
    // Sums in double precision: adding 65536 rays in single precision errs by 1e-3.
    let (mut open, mut changing) = (0.0, 0.0);
    let mut bent = DVec3::ZERO;
    // Σ (1 - μ) L_r, and the sums of the average: weights and weighted radiances.
    let (mut per_hit, mut weight, mut weighted) = (DVec3::ZERO, 0.0, DVec3::ZERO);
    for sample in samples {
        let mu = f64::from(params.openness.at(sample.distance));
        let radiance = sample.radiance.as_dvec3();
        open += mu;
        bent += mu * sample.direction.as_dvec3();
        per_hit += (1.0 - mu) * radiance;
        changing += if sample.changing { 1.0 - mu } else { 0.0 };
        if sample.distance < params.near_limit {
            let w = if params.near_radiance == NearRadiance::AveragedPlain { 1.0 } else { 1.0 - mu };
            weight += w;
            weighted += w * radiance;
        }
    }
    let count = samples.len() as f64;
    let (first, per_hit) = ((open / count) as f32, (per_hit / count).as_vec3());
    let (chord_weight, chord_weighted) = (f64::from(second.weight), second.weighted_radiance.as_dvec3());
    let mean =
        |weighted: DVec3, weight: f64| if weight > 0.0 { (weighted / weight).as_vec3() } else { Vec3::ZERO };
    // Near radiance that is consistent with an openness o (spec §8.1).
    let near = |o: f32| match params.near_radiance {
        NearRadiance::Off => Vec3::ZERO,
        NearRadiance::PerHit if first < 1.0 => per_hit * ((1.0 - o) / (1.0 - first)),
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
    gathered.bent = (bent / count).as_vec3();
    gathered.changing = (changing / count) as f32;
}

impl<'a> GatherParams<'a> {
    /// What `settings` and `view` ask for, with their `samples`.
    #[must_use]
    pub fn new(settings: &Settings, view: &'a View, samples: &'a SampleSets) -> Self {
        Self {
            openness: view.openness,
            radius: view.radius,
            near_radiance: settings.near_radiance,
            near_limit: view.near_limit,
            source: settings.radiance_source,
            thin: settings.thin,
            thin_edge: settings.thin_edge,
            ambient: view.ambient,
            lights: &view.lights,
            offset: view.offset,
            samples,
            temporal: settings.temporal == Temporal::On,
        }
    }

    /// Points of one batch.
    fn batch_points(&self) -> usize {
        let spp = self.samples.spp() as usize;
        let rays_per_point = match self.thin {
            Thin::Paper => spp.max(spp * (spp - 1) / 2),
            Thin::Sheet | Thin::Off => spp,
        };
        (BATCH_RAYS / rays_per_point).max(1)
    }

    /// Whether hits need their radiance.
    fn needs_radiance(&self) -> bool {
        self.near_radiance != NearRadiance::Off
    }

    /// Width of the footprint of a hit at distance 1, of `spp` rays: a ray stands for the share 1/N of the
    /// cosine-weighted hemisphere, whose area is π.
    #[must_use]
    pub fn cone_width_of(spp: u32) -> f32 {
        (PI / spp as f32).sqrt()
    }

    fn cone_width(&self) -> f32 {
        Self::cone_width_of(self.samples.spp())
    }
}
