//! The rays of a frame, kept (see [`crate::rays`]).

use ambray_core::{
    control::{Cancelled, Control},
    frame::GBufferPixel,
    gather::{GatherParams, GatherScratch, Gathered, Recorded, Recording, ShadedPoint, record},
    sampling::{PixelKey, SampleSets, sample_class},
    settings::{NearRadiance, Settings, Temporal, Thin},
    trace::Ray,
    view::View,
};
use rayon::prelude::*;

use super::{BackendError, CpuBackend, TILE, pass1, planes::Planes};
use crate::rays::{FrameRays, RayBatch, RayKind};

impl CpuBackend {
    /// The rays that [`render`](Self::render) traces with the same arguments, shadow rays aside, in the order of the tiles.
    ///
    /// # Errors
    /// As [`render`](Self::render), and [`BackendError::TooManyRays`] if their tags would not be numbers of 32 bits.
    pub fn record_rays(
        &self,
        settings: &Settings,
        view: &View,
        control: Control<'_>,
    ) -> Result<FrameRays, BackendError> {
        let ((width, height), spp) = (view.camera.size(), settings.spp);
        let pairs = u64::from(spp) * u64::from(spp - 1) / 2;
        let most = u32::try_from(pairs).unwrap_or(u32::MAX).max(spp);
        if !RayBatch::has_tags(width, height, most) {
            return Err(BackendError::TooManyRays);
        }
        // Radiance decides on no ray of these batches.
        let settings = Settings {
            near_radiance: NearRadiance::Off,
            temporal: Temporal::Off,
            thin: Thin::Off,
            ..settings.clone()
        };
        self.pool(control.threads)?.install(|| {
            let samples = SampleSets::of(&settings);
            let params = GatherParams::new(&settings, view, &samples);
            let planes = &mut Planes::default();
            let seen = pass1::run(&self.world, &settings, view, &params, None, planes, control)?.gbuffer;
            let batch = |kind, per_pixel: u32, rays: Vec<(Ray, u32)>| {
                let (rays, tags) = rays.into_iter().unzip();
                RayBatch { kind, width, height, per_pixel: per_pixel.max(1), rays, tags }
            };
            let gathered = |thin, of: fn(Recording) -> Vec<Recorded>, per_pixel| {
                let params = GatherParams { thin, ..params };
                self.gather_rays(&params, &seen, width, &settings, per_pixel, of, control)
            };
            let pairs = pairs as u32;
            Ok(FrameRays {
                primary: batch(RayKind::Closest, 1, primary_rays(&settings, view)),
                ambient: batch(RayKind::Closest, spp, gathered(Thin::Off, |all| all.ambient, spp)?),
                paper_chords: batch(RayKind::Any, pairs, gathered(Thin::Paper, |all| all.chords, pairs)?),
                sheet_chords: batch(RayKind::Closest, pairs, gathered(Thin::Sheet, |all| all.chords, pairs)?),
            })
        })
    }

    /// Those rays `of` the gather at all points of the G-buffer that are wanted, with their tags.
    #[expect(clippy::too_many_arguments, reason = "what a frame consists of")]
    fn gather_rays(
        &self,
        params: &GatherParams<'_>,
        seen: &[GBufferPixel],
        width: u32,
        settings: &Settings,
        per_pixel: u32,
        of: fn(Recording) -> Vec<Recorded>,
        control: Control<'_>,
    ) -> Result<Vec<(Ray, u32)>, Cancelled> {
        let height = seen.len() as u32 / width;
        let tiles: Vec<_> = tiles(width, height).collect();
        let rays = tiles.into_par_iter().map_init(GatherScratch::default, |scratch, tile| {
            control.check()?;
            // As pass 1 orders the points of a tile.
            let mut pixels: Vec<(u32, u32)> =
                tile.filter(|&(x, y)| seen[(y * width + x) as usize].is_surface()).collect();
            pixels.sort_by_key(|&(x, y)| sample_class(x, y));
            let points: Vec<ShadedPoint> = pixels
                .iter()
                .map(|&(x, y)| {
                    let key = PixelKey::new(x, y, settings.frame, settings.seed);
                    seen[(y * width + x) as usize].shaded_point(key)
                })
                .collect();
            let mut recording = Recording::default();
            let mut results = vec![Gathered::default(); points.len()];
            record(&self.world, params, &points, scratch, &mut results, &mut recording);
            let tagged = |recorded: Recorded| {
                let (x, y) = pixels[recorded.point as usize];
                (recorded.ray, (y * width + x) * per_pixel + recorded.number)
            };
            Ok(of(recording).into_iter().map(tagged).collect::<Vec<_>>())
        });
        let rays: Vec<Vec<_>> = rays.collect::<Result<_, Cancelled>>()?;
        Ok(rays.concat())
    }
}

/// The rays of the camera with their tags.
fn primary_rays(settings: &Settings, view: &View) -> Vec<(Ray, u32)> {
    let (width, height) = view.camera.size();
    let ray = |(x, y): (u32, u32)| {
        (view.camera.primary_ray(x, y, PixelKey::primary_seed(x, y, settings.frame)), y * width + x)
    };
    tiles(width, height).flatten().map(ray).collect()
}

/// The pixels of each tile, row by row.
fn tiles(width: u32, height: u32) -> impl Iterator<Item = impl Iterator<Item = (u32, u32)> + Clone + Send> {
    let side = TILE as u32;
    (0..height).step_by(TILE).flat_map(move |y0| {
        (0..width).step_by(TILE).map(move |x0| {
            let columns = x0..(x0 + side).min(width);
            (y0..(y0 + side).min(height)).flat_map(move |y| columns.clone().map(move |x| (x, y)))
        })
    })
}
