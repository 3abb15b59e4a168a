//! Ray-traced ambient occlusion that asks the depth buffer first: rays are traced only where it cannot know.
//!
//! The idea is that of the hybrid of screen-space and ray-traced ambient occlusion by Bavoil et al. 2018; no published
//! text of theirs gives the details, so what follows is our reading. The estimator is Ambray's own – the same points,
//! directions and measure μ – and each ray is first followed through the picture:
//!
//! - It starts where surfaces meet or one hides another within a pixel: not known.
//! - It goes through the plane that a pixel shows, near the point that is seen or where the pixels around show the same
//!   plane: a hit at that distance. Elsewhere the plane may have ended: not known.
//! - It passes behind the edge of something: a hit there if it is no more than the thickness behind, and by more than the
//!   depth changes within a pixel; else not known.
//! - It stays in front of everything seen, to its end: a miss, since that space is empty.
//! - It leaves the picture: not known.
//!
//! In front of an edge that sticks out means in front of either side, else in front of all four pixels around the ray.
//!
//! The thickness is 0 unless it is set, so that guesses are left to those who want them: what is not known is then asked of
//! the nearest pixels alone. What is still not known is traced, from the start of the ray. So the depth buffer saves rays, and
//! errs only where the steps of a ray pass over something, where something narrower than a pixel is not in the picture, or
//! where a guess is wrong.

mod facets;
mod march;

use ambray_core::{
    basis::Basis,
    control::{Cancelled, Control},
    frame::GBufferPixel,
    gather::{GatherParams, ShadedPoint},
    sampling::PixelKey,
    settings::{ScreenQuality, Settings},
    trace::{Hit, Ray, World},
};
use rayon::prelude::*;

use crate::Screen;
use march::{DepthBuffer, Verdict};

/// Rays that are traced at once, at most.
const BATCH_RAYS: usize = 8192;

/// Ray-traced ambient occlusion that asks the depth buffer first.
#[derive(Clone, Debug, PartialEq)]
pub struct Hybrid {
    /// Steps of a ray through the picture, at most.
    pub steps: u32,
    /// Thickness of what is seen where rays pass behind its edges, scene units; 0 traces all rays that do.
    pub thickness: f32,
}

/// What [`Hybrid`] finds.
#[derive(Clone, Debug, PartialEq)]
pub struct HybridEstimate {
    /// Openness of every pixel, in [0, 1]; 1 where nothing is seen.
    pub openness: Vec<f32>,
    /// Rays traced for every pixel.
    pub rays: Vec<u32>,
}

impl Hybrid {
    /// The method with the steps and the thickness that `settings` ask for.
    #[must_use]
    pub fn of(settings: &Settings) -> Self {
        let steps = match settings.screen_quality {
            ScreenQuality::Low => 8,
            ScreenQuality::Medium => 16,
            ScreenQuality::High => 32,
            ScreenQuality::Ultra => 128,
        };
        Self { steps, thickness: settings.thickness.unwrap_or(0.0) }
    }

    /// Openness of every pixel of `gbuffer`, which is the one of `screen`, by the rays of `params` in `world`. The chords of
    /// thin-object detection and colour bleeding are left out.
    ///
    /// # Errors
    /// If the caller stops it.
    pub fn estimate<W: World>(
        &self,
        screen: &Screen,
        gbuffer: &[GBufferPixel],
        world: &W,
        params: &GatherParams<'_>,
        control: &Control<'_>,
    ) -> Result<HybridEstimate, Cancelled> {
        let depths = DepthBuffer::new(screen.camera(), gbuffer, self.steps, self.thickness);
        let (width, _) = screen.size();
        let (mut openness, mut rays) = (vec![1.0; gbuffer.len()], vec![0; gbuffer.len()]);
        let rows = openness.par_chunks_mut(width).zip(rays.par_chunks_mut(width)).enumerate();
        rows.try_for_each_init(Batch::default, |batch, (y, (openness, rays))| {
            control.check()?;
            let points = points_of_row(screen, &gbuffer[y * width..][..width], y);
            for points in points.chunks((BATCH_RAYS / params.samples.spp() as usize).max(1)) {
                batch.follow(&depths, params, points, rays);
                batch.trace(world);
                batch.combine(params, points, openness);
            }
            Ok(())
        })?;
        Ok(HybridEstimate { openness, rays })
    }
}

/// Columns and points of the pixels of a row that see a surface, by sample class, so that runs of rays are parallel on flat
/// surfaces as those of Ambray's gather.
fn points_of_row(screen: &Screen, row: &[GBufferPixel], y: usize) -> Vec<(usize, ShadedPoint)> {
    let seen = row.iter().enumerate().filter(|(_, pixel)| pixel.is_surface());
    let mut points: Vec<_> = seen
        .map(|(x, pixel)| {
            (x, pixel.shaded_point(PixelKey::new(x as u32, y as u32, screen.frame, screen.seed)))
        })
        .collect();
    points.sort_by_key(|(_, point)| point.key.class);
    points
}

/// Rays of some points.
#[derive(Debug, Default)]
struct Batch {
    /// Distances d_i of the N samples of each point, point after point; infinite on a miss.
    distances: Vec<f32>,
    /// Rays that the depth buffer does not know, and the sample that each belongs to.
    rays: Vec<Ray>,
    slots: Vec<usize>,
    hits: Vec<Hit>,
}

impl Batch {
    /// Follows the rays of `points` through the picture, keeps those to trace, and counts them in `rays`.
    fn follow(
        &mut self,
        depths: &DepthBuffer<'_>,
        params: &GatherParams<'_>,
        points: &[(usize, ShadedPoint)],
        rays: &mut [u32],
    ) {
        let spp = params.samples.spp() as usize;
        self.distances.clear();
        self.distances.resize(points.len() * spp, f32::INFINITY);
        self.rays.clear();
        self.slots.clear();
        for j in 0..spp {
            for (i, (x, point)) in points.iter().enumerate() {
                let slot = i * spp + j;
                // Directions below the geometric horizon are blocked at once (spec §5).
                let Some(ray) = ray(params, point, j as u32) else {
                    self.distances[slot] = 0.0;
                    continue;
                };
                match depths.march(&ray) {
                    Verdict::Hit(distance) => self.distances[slot] = distance,
                    Verdict::Miss => {}
                    Verdict::Unknown => {
                        rays[*x] += 1;
                        self.rays.push(ray);
                        self.slots.push(slot);
                    }
                }
            }
        }
    }

    /// Traces what was kept.
    fn trace(&mut self, world: &impl World) {
        self.hits.clear();
        self.hits.resize(self.rays.len(), Hit::MISS);
        world.closest_hits(&self.rays, &mut self.hits);
        for (hit, slot) in self.hits.iter().zip(&self.slots) {
            self.distances[*slot] = hit.t;
        }
    }

    /// O = (1/N) Σ μ(d_i) of each point (spec §3), in double precision as in Ambray's gather.
    fn combine(&self, params: &GatherParams<'_>, points: &[(usize, ShadedPoint)], openness: &mut [f32]) {
        let spp = params.samples.spp() as usize;
        for ((x, _), distances) in points.iter().zip(self.distances.chunks(spp)) {
            let sum: f64 = distances.iter().map(|d| f64::from(params.openness.at(*d))).sum();
            openness[*x] = (sum / spp as f64) as f32;
        }
    }
}

/// Ray number `j` of `point`, as Ambray's gather makes it; `None` below the geometric horizon.
fn ray(params: &GatherParams<'_>, point: &ShadedPoint, j: u32) -> Option<Ray> {
    let local = params.samples.direction(point.key, j).local;
    let direction = Basis::from_normal(point.normal).to_world(local);
    let above_horizon = direction.dot(point.geometric_normal) > 0.0;
    above_horizon.then(|| {
        let origin = params.offset.apply(point.position, point.geometric_normal, point.reach);
        Ray { origin, t_max: params.openness.reach(), direction, seed: point.key.ray_seed(j) }
    })
}
