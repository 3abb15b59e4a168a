//! Pass 1: primary visibility, direct light, openness and near radiance (spec §4), tile by tile.

use std::{
    sync::atomic::{AtomicUsize, Ordering},
    time::{Duration, Instant},
};

use ambray_core::{
    compose::{albedo_and_emission, reflected},
    control::{Cancelled, Control},
    direct::{DirectLighting, DirectScratch, Received, Receiver, direct_irradiance},
    filter::Guide,
    frame::{GBufferPixel, RayCounts},
    gather::{GatherParams, GatherScratch, Gathered, ShadedPoint, gather},
    sampling::PixelKey,
    settings::{Normals, Settings},
    trace::{Hit, Ray, Trace},
    view::View,
};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::{
    planes::Planes,
    stages::{Clock, Stage},
    temporal::Sequel,
    vectors::{self, Work},
    world::CpuWorld,
};

/// Pixels a side of a tile: 16 pixels of each class, a packet of parallel rays.
pub(crate) const TILE: usize = 16;

/// What pass 1 leaves for pass 2, row by row from the top.
#[derive(Debug)]
pub(super) struct Pass1 {
    pub(super) gbuffer: Vec<GBufferPixel>,
    pub(super) guides: Vec<Guide>,
    /// The same points in the last frame; empty unless light is accumulated.
    pub(super) then: Vec<Guide>,
    /// Openness and near radiance; of the first batch where the minimum is taken after the filter.
    pub(super) ambient: Vec<Vec4>,
    /// Openness and near radiance of the second batch; empty where the minimum is taken before the filter.
    pub(super) second: Vec<Vec4>,
    /// Bent normals, and in w the share of 1 - O that may change.
    pub(super) bent: Vec<Vec4>,
    pub(super) rays: RayCounts,
    pub(super) clock: Clock,
    pub(super) elapsed: Duration,
}

/// Rows of a band of tiles, one slice for each plane.
struct Band<'a> {
    gbuffer: &'a mut [GBufferPixel],
    guides: &'a mut [Guide],
    then: &'a mut [Guide],
    ambient: &'a mut [Vec4],
    second: &'a mut [Vec4],
    bent: &'a mut [Vec4],
}

impl Band<'_> {
    /// Pixel `i` sees no surface: its planes are those of an open place before the `background`.
    fn see_nothing(&mut self, i: usize, background: Vec3) {
        self.gbuffer[i] = GBufferPixel { emission: background, rays: 1, ..GBufferPixel::NOTHING };
        self.guides[i] = Guide::NOTHING;
        if let Some(then) = self.then.get_mut(i) {
            *then = Guide::NOTHING;
        }
        self.leave_open(i);
    }

    /// Nothing is gathered at pixel `i`.
    fn leave_open(&mut self, i: usize) {
        self.ambient[i] = Vec4::X;
        self.bent[i] = Vec4::ZERO;
        if let Some(second) = self.second.get_mut(i) {
            *second = Vec4::X;
        }
    }
}

/// What is the same for all tiles.
struct Job<'a> {
    world: &'a CpuWorld,
    settings: &'a Settings,
    view: &'a View,
    params: &'a GatherParams<'a>,
    sequel: Option<&'a Sequel<'a>>,
    clock: &'a Clock,
}

/// A tile to be rendered: its first pixel is (`x0`, `y0`), which is the row where `band` starts.
struct Tile<'t, 'a> {
    job: &'t Job<'a>,
    scratch: &'t mut Scratch,
    band: &'t mut Band<'a>,
    x0: usize,
    y0: usize,
    counts: &'t mut RayCounts,
}

impl Work for Tile<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.job.tile(self.scratch, self.band, self.x0, self.y0, self.counts);
    }
}

/// Buffers of one thread, reused from tile to tile.
#[derive(Default)]
struct Scratch {
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    /// Pixels of the tile that see a surface, as index into the band, with their picture coordinates.
    seen: Vec<(usize, u32, u32)>,
    receivers: Vec<Receiver>,
    received: Vec<Received>,
    direct: DirectScratch,
    points: Vec<ShadedPoint>,
    gathered: Vec<Gathered>,
    gather: GatherScratch,
}

pub(super) fn run(
    world: &CpuWorld,
    settings: &Settings,
    view: &View,
    params: &GatherParams<'_>,
    sequel: Option<&Sequel<'_>>,
    planes: &mut Planes,
    control: Control<'_>,
) -> Result<Pass1, Cancelled> {
    let start = Instant::now();
    let (width, height) = view.camera.size();
    let pixels = width as usize * height as usize;
    let after_filter = settings.takes_minimum_after_filter();
    let mut pass = Pass1 {
        gbuffer: planes.take(pixels),
        guides: planes.take(pixels),
        then: if sequel.is_some() { planes.take(pixels) } else { Vec::new() },
        ambient: planes.take(pixels),
        second: if after_filter { planes.take(pixels) } else { Vec::new() },
        bent: planes.take(pixels),
        rays: RayCounts::default(),
        clock: Clock::default(),
        elapsed: Duration::ZERO,
    };
    let rows = TILE * width as usize;
    let bands =
        pass.gbuffer.chunks_mut(rows).zip(pass.guides.chunks_mut(rows)).zip(pass.ambient.chunks_mut(rows));
    let second = pass.second.chunks_mut(rows).map(Some).chain(std::iter::repeat_with(|| None));
    let then = pass.then.chunks_mut(rows).map(Some).chain(std::iter::repeat_with(|| None));
    let bands: Vec<Band<'_>> = bands
        .zip(second.zip(then).zip(pass.bent.chunks_mut(rows)))
        .map(|(((gbuffer, guides), ambient), ((second, then), bent))| Band {
            gbuffer,
            guides,
            then: then.unwrap_or_default(),
            ambient,
            second: second.unwrap_or_default(),
            bent,
        })
        .collect();

    let job = Job { world, settings, view, params, sequel, clock: &pass.clock };
    let (count, done) = (bands.len(), AtomicUsize::new(0));
    let counts = bands.into_par_iter().enumerate().map_init(Scratch::default, |scratch, (i, mut band)| {
        let mut counts = RayCounts::default();
        for tile in 0..(width as usize).div_ceil(TILE) {
            control.check()?;
            let (job, band, counts) = (&job, &mut band, &mut counts);
            let tile = Tile { job, scratch, band, x0: tile * TILE, y0: i * TILE, counts };
            vectors::run(world.isa(), tile);
        }
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        (control.progress)(done as f32 / count as f32);
        Ok(counts)
    });
    pass.rays = counts.try_reduce(RayCounts::default, |a, b| Ok(a + b))?;
    pass.elapsed = start.elapsed();
    Ok(pass)
}

impl Job<'_> {
    /// All stages of a [`Tile`].
    #[inline(always)]
    fn tile(&self, scratch: &mut Scratch, band: &mut Band<'_>, x0: usize, y0: usize, counts: &mut RayCounts) {
        let start = Instant::now();
        self.primary(scratch, band, x0, y0);
        counts.primary += scratch.rays.len() as u64;
        let start = self.clock.book(Stage::Primary, start);
        counts.shadow += self.direct(scratch, band);
        let start = self.clock.book(Stage::Direct, start);
        // Methods in screen space need the whole G-buffer first.
        if self.settings.method.is_screen_space() {
            scratch.seen.iter().for_each(|&(i, ..)| band.leave_open(i));
        } else {
            self.ambient(scratch, band, counts);
            self.clock.book(Stage::Ambient, start);
        }
    }

    /// What each pixel sees.
    #[inline(always)]
    fn primary(&self, scratch: &mut Scratch, band: &mut Band<'_>, x0: usize, y0: usize) {
        let width = self.view.camera.size().0 as usize;
        let (columns, rows) = (TILE.min(width - x0), band.gbuffer.len() / width);
        let pixels =
            (0..rows).flat_map(|row| (x0..x0 + columns).map(move |x| (row * width + x, x, y0 + row)));
        let frame = self.settings.frame;
        scratch.rays.clear();
        scratch.rays.extend(pixels.clone().map(|(_, x, y)| {
            let (x, y) = (x as u32, y as u32);
            self.view.camera.primary_ray(x, y, PixelKey::primary_seed(x, y, frame))
        }));
        scratch.hits.resize(scratch.rays.len(), Hit::MISS);
        self.world.closest_hits(&scratch.rays, &mut scratch.hits);

        scratch.seen.clear();
        for ((i, x, y), (ray, hit)) in pixels.zip(scratch.rays.iter().zip(&scratch.hits)) {
            if hit.is_hit() {
                let pixel = &mut band.gbuffer[i];
                (*pixel, band.guides[i]) = self.surface(ray, hit);
                if let Some(sequel) = self.sequel {
                    let then = sequel.then(self.world.surfaces(), self.settings, &band.guides[i], ray, hit);
                    band.then[i] = then;
                    pixel.motion = sequel.motion((x, y), &then);
                }
                scratch.seen.push((i, x as u32, y as u32));
            } else {
                band.see_nothing(i, self.view.background);
            }
        }
    }

    /// Attributes of the surface that a primary ray hit.
    #[inline(always)]
    fn surface(&self, ray: &Ray, hit: &Hit) -> (GBufferPixel, Guide) {
        let camera = &self.view.camera;
        let footprint_there = camera.footprint(camera.depth(ray.origin + hit.t * ray.direction));
        let point = self.world.surfaces().surface_at(ray, hit, footprint_there).facing(ray.direction);
        let depth = camera.depth(point.position);
        let shading_normal = match self.settings.normals {
            Normals::Shading => point.shading_normal,
            Normals::Smooth => point.smooth_normal,
            Normals::Geometric => point.geometric_normal,
        };
        let smooth_normal = match self.settings.normals {
            Normals::Geometric => point.geometric_normal,
            Normals::Shading | Normals::Smooth => point.smooth_normal,
        };
        let (albedo, emission) = albedo_and_emission(point.albedo, point.emission, point.unlit);
        let pixel = GBufferPixel {
            position: point.position,
            depth,
            geometric_normal: point.geometric_normal,
            reach: point.reach,
            shading_normal,
            smooth_normal,
            albedo,
            emission,
            direct: Vec3::ZERO,
            material: point.material,
            instance: hit.instance,
            rays: 1,
            motion: Vec2::ZERO,
        };
        (pixel, pixel.guide(camera))
    }

    /// Direct light; returns the shadow rays traced.
    fn direct(&self, scratch: &mut Scratch, band: &mut Band<'_>) -> u64 {
        let (frame, seed) = (self.settings.frame, self.settings.seed);
        scratch.receivers.clear();
        let receiver =
            |&(i, x, y): &(usize, u32, u32)| band.gbuffer[i].receiver(PixelKey::new(x, y, frame, seed));
        scratch.receivers.extend(scratch.seen.iter().map(receiver));
        scratch.received.clear();
        scratch.received.resize(scratch.receivers.len(), Received::default());
        let lighting = DirectLighting { lights: &self.view.lights, offset: self.view.offset, shadows: true };
        let (receivers, received) = (&scratch.receivers, &mut scratch.received);
        direct_irradiance(self.world, lighting, receivers, &mut scratch.direct, received);
        for (&(i, ..), received) in scratch.seen.iter().zip(&scratch.received) {
            let pixel = &mut band.gbuffer[i];
            pixel.direct = reflected(pixel.albedo, received.irradiance);
            pixel.rays += received.shadow_rays;
        }
        scratch.received.iter().map(|received| u64::from(received.shadow_rays)).sum()
    }

    /// Openness, near radiance and bent normal.
    #[inline(always)]
    fn ambient(&self, scratch: &mut Scratch, band: &mut Band<'_>, counts: &mut RayCounts) {
        let (frame, seed) = (self.settings.frame, self.settings.seed);
        // Class by class, so that the rays of a run share their directions on flat surfaces.
        scratch.seen.sort_by_key(|&(i, x, y)| (ambray_core::sampling::sample_class(x, y), i));
        scratch.points.clear();
        let point =
            |&(i, x, y): &(usize, u32, u32)| band.gbuffer[i].shaded_point(PixelKey::new(x, y, frame, seed));
        scratch.points.extend(scratch.seen.iter().map(point));
        scratch.gathered.clear();
        scratch.gathered.resize(scratch.points.len(), Gathered::default());
        gather(self.world, self.params, &scratch.points, &mut scratch.gather, &mut scratch.gathered);

        for (&(i, ..), gathered) in scratch.seen.iter().zip(&scratch.gathered) {
            let (ambient, second) = gathered.before_filter(!band.second.is_empty());
            band.ambient[i] = ambient;
            if let Some(second) = second {
                band.second[i] = second;
            }
            band.bent[i] = gathered.bent.extend(gathered.changing);
            band.gbuffer[i].rays += gathered.ambient_rays + gathered.chord_rays + gathered.shadow_rays;
            counts.ambient += u64::from(gathered.ambient_rays);
            counts.chord += u64::from(gathered.chord_rays);
            counts.shadow += u64::from(gathered.shadow_rays);
        }
    }
}
