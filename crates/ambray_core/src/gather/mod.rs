//! The estimator: points and sample directions go in, openness O and near-field radiance I come out (spec §§3, 5, 8).
//!
//! Work is done in batches of points. The rays of a batch are ordered by sample class, then by direction, then by
//! point: on a flat surface such a run of rays is parallel, which tracers of packets profit from.

mod combine;
mod first;
mod radiance;
mod samples;
mod thin;
mod witness;

use std::f32::consts::PI;

use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::{
    light::Light,
    offset::RayOffset,
    openness::Openness,
    sampling::{PixelKey, SampleSets},
    settings::{NearRadiance, RadianceSource, Settings, Temporal, Thin},
    trace::World,
    view::View,
};

use combine::combine;
use first::FirstBatch;
use radiance::RadianceScratch;
use thin::Chords;

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
    #[inline(always)]
    pub fn before_filter(&self, after_filter: bool) -> (Vec4, Option<Vec4>) {
        let join = |openness: f32, near: Vec3| near.extend(openness).wxyz();
        if after_filter {
            (join(self.first, self.near_first), Some(join(self.second, self.near_second)))
        } else {
            (join(self.openness, self.near), None)
        }
    }
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
///
/// Inlined, so that its loops over neighbouring points are compiled for the instruction set of the caller. The bits do not
/// depend on it.
#[inline(always)]
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

#[inline(always)]
fn gather_batch(
    world: &impl World,
    params: &GatherParams<'_>,
    points: &[ShadedPoint],
    scratch: &mut GatherScratch,
    out: &mut [Gathered],
) {
    out.fill(Gathered::default());
    scratch.first.trace(world, params, points, &mut scratch.radiance, out);
    let samples = &scratch.first.samples;
    if params.thin == Thin::Off {
        scratch.chords.skip(points.len());
    } else {
        scratch.chords.trace(world, params, points, samples, &mut scratch.radiance, out);
    }
    combine(params, samples, scratch.chords.results(), out);
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
    #[inline(always)]
    fn needs_radiance(&self) -> bool {
        self.near_radiance != NearRadiance::Off
    }

    /// Width of the footprint of a hit at distance 1, of `spp` rays: a ray stands for the share 1/N of the
    /// cosine-weighted hemisphere, whose area is π.
    #[must_use]
    #[inline(always)]
    pub fn cone_width_of(spp: u32) -> f32 {
        (PI / spp as f32).sqrt()
    }

    /// What the radiance of a hit is over its albedo, where that is the same for all hits.
    #[inline(always)]
    fn albedo_factor(&self) -> Option<Vec3> {
        match self.source {
            // The factor of the self-similar bounce needs the final openness: see `compose::near_radiance`.
            RadianceSource::Albedo | RadianceSource::SelfSimilar => Some(Vec3::ONE),
            RadianceSource::Ambient => Some(self.ambient),
            RadianceSource::Lit | RadianceSource::LitUnshadowed => None,
        }
    }

    #[inline(always)]
    fn cone_width(&self) -> f32 {
        Self::cone_width_of(self.samples.spp())
    }
}
