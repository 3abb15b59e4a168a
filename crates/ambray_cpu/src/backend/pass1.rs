//! Pass 1: primary visibility, direct light, openness and near radiance (spec §4), tile by tile.

use std::{
    ops::Range,
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    time::{Duration, Instant},
};

use ambray_core::{
    compose::{albedo_and_emission, reflected},
    control::{Cancelled, Control},
    direct::{DirectLighting, DirectScratch, Received, Receiver, direct_irradiance},
    filter::Guide,
    frame::{GBufferPixel, RayCounts},
    gather::{GatherParams, GatherScratch, Gathered, ShadedPoint, gather},
    sampling::{CLASS_COUNT, PixelKey, sample_class},
    settings::{Normals, Settings},
    trace::{Hit, Ray, Trace},
    view::View,
};
use ambray_scene::surface::SurfaceReader;
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::{
    planes::Planes,
    segment::{Place, SEGMENT, Segment, TILE},
    stages::{Clock, Stage},
    temporal::Sequel,
    vectors::Work,
    world::{CpuWorld, Timed},
};

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

/// What is the same for all tiles.
struct Job<'a> {
    world: &'a CpuWorld,
    settings: &'a Settings,
    view: &'a View,
    params: &'a GatherParams<'a>,
    sequel: Option<&'a Sequel<'a>>,
    clock: &'a Clock,
}

/// A tile to be rendered: `columns` of a segment.
struct Tile<'t, 'a> {
    job: &'t Job<'a>,
    scratch: &'t mut Scratch,
    segment: &'t mut Segment<'a>,
    columns: Range<usize>,
    counts: &'t mut RayCounts,
}

impl Work for Tile<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.job.tile(self.scratch, self.segment, self.columns, self.counts);
    }
}

/// Buffers of one thread, reused from tile to tile.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    /// Pixels of the tile that see a surface.
    seen: Vec<Place>,
    /// They before they were ordered.
    ordered: Vec<Place>,
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
    let (width, clock) = (width as usize, Clock::default());
    let job = Job { world, settings, view, params, sequel, clock: &clock };
    let (segments, scratches) = (Segment::all(&mut pass, width), &planes.scratches);
    let (count, done, in_a_row) = (segments.len(), AtomicUsize::new(0), width.div_ceil(SEGMENT));
    let counts = segments.into_par_iter().with_max_len(1).map(|mut segment| {
        let (mut counts, mut scratch) = (RayCounts::default(), scratches.take());
        let columns = segment.gbuffer[0].len();
        for first in (0..columns).step_by(TILE) {
            control.check()?;
            let (scratch, segment, counts) = (&mut scratch, &mut segment, &mut counts);
            let columns = first..columns.min(first + TILE);
            world.vectors().run(Tile { job: &job, scratch, segment, columns, counts });
        }
        scratches.give(scratch);
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if done % in_a_row == 0 {
            (control.progress)(done as f32 / count as f32);
        }
        Ok(counts)
    });
    let rays = counts.try_reduce(RayCounts::default, |a, b| Ok(a + b))?;
    pass.rays = rays;
    pass.clock = clock;
    pass.elapsed = start.elapsed();
    Ok(pass)
}

impl Job<'_> {
    /// All stages of a [`Tile`].
    #[inline(always)]
    fn tile(
        &self,
        scratch: &mut Scratch,
        segment: &mut Segment<'_>,
        columns: Range<usize>,
        counts: &mut RayCounts,
    ) {
        let world = Timed::new(self.world);
        let start = Instant::now();
        self.primary(&world, scratch, segment, columns);
        counts.primary += scratch.rays.len() as u64;
        let start = self.clock.book(Stage::Primary, start);
        counts.shadow += self.direct(&world, scratch, segment);
        let start = self.clock.book(Stage::Direct, start);
        // Methods in screen space need the whole G-buffer first.
        if self.settings.method.is_screen_space() {
            scratch.seen.iter().for_each(|&place| segment.leave_open(place));
        } else {
            self.ambient(&world, scratch, segment, counts);
            self.clock.book(Stage::Ambient, start);
        }
        self.clock.book_tracing(world.tracing());
    }

    /// What each pixel sees.
    #[inline(always)]
    fn primary(
        &self,
        world: &Timed<'_>,
        scratch: &mut Scratch,
        segment: &mut Segment<'_>,
        columns: Range<usize>,
    ) {
        let (x0, y0, rows) = (segment.x0, segment.y0, segment.gbuffer.len());
        let places = (0..rows).flat_map(|row| columns.clone().map(move |column| (row, column)));
        let frame = self.settings.frame;
        // Loops and no iterators that extend: these are not compiled for the vectors.
        scratch.rays.clear();
        for row in 0..rows {
            for column in columns.clone() {
                let (x, y) = ((x0 + column) as u32, (y0 + row) as u32);
                let seed = PixelKey::primary_seed(x, y, frame);
                scratch.rays.push(self.view.camera.primary_ray(x, y, seed));
            }
        }
        scratch.hits.resize(scratch.rays.len(), Hit::MISS);
        world.closest_hits(&scratch.rays, &mut scratch.hits);

        scratch.seen.clear();
        let mut reader = self.world.surfaces().reader();
        for ((row, column), (ray, hit)) in places.zip(scratch.rays.iter().zip(&scratch.hits)) {
            if !hit.is_hit() {
                segment.see_nothing((row, column), self.view.background);
                continue;
            }
            let pixel = &mut segment.gbuffer[row][column];
            let guide = &mut segment.guides[row][column];
            (*pixel, *guide) = self.surface(&mut reader, ray, hit);
            if let Some(sequel) = self.sequel {
                let then = sequel.then(self.world.surfaces(), self.settings, guide, ray, hit);
                segment.then[row][column] = then;
                pixel.motion = sequel.motion((x0 + column, y0 + row), &then);
            }
            scratch.seen.push((row, column));
        }
    }

    /// Key of a pixel of a segment whose first one is at (`x0`, `y0`).
    #[inline(always)]
    fn key(&self, (x0, y0): (usize, usize), (row, column): Place) -> PixelKey {
        let (x, y) = ((x0 + column) as u32, (y0 + row) as u32);
        PixelKey::new(x, y, self.settings.frame, self.settings.seed)
    }

    /// Attributes of the surface that a primary ray hit.
    #[inline(always)]
    fn surface(&self, reader: &mut SurfaceReader<'_>, ray: &Ray, hit: &Hit) -> (GBufferPixel, Guide) {
        let camera = &self.view.camera;
        let footprint_there = camera.footprint(camera.depth(ray.origin + hit.t * ray.direction));
        let point = reader.surface_at(ray, hit, footprint_there).facing(ray.direction);
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
    #[inline(always)]
    fn direct(&self, world: &Timed<'_>, scratch: &mut Scratch, segment: &mut Segment<'_>) -> u64 {
        if self.view.lights.is_empty() {
            for &(row, column) in &scratch.seen {
                segment.gbuffer[row][column].direct = Vec3::ZERO;
            }
            return 0;
        }
        let origin = (segment.x0, segment.y0);
        scratch.receivers.clear();
        for &place in &scratch.seen {
            scratch.receivers.push(segment.gbuffer[place.0][place.1].receiver(self.key(origin, place)));
        }
        scratch.received.resize(scratch.receivers.len(), Received::default());
        let lighting = DirectLighting { lights: &self.view.lights, offset: self.view.offset, shadows: true };
        let (receivers, received) = (&scratch.receivers, &mut scratch.received);
        direct_irradiance(world, lighting, receivers, &mut scratch.direct, received);
        for (&(row, column), received) in scratch.seen.iter().zip(&scratch.received) {
            let pixel = &mut segment.gbuffer[row][column];
            pixel.direct = reflected(pixel.albedo, received.irradiance);
            pixel.rays += received.shadow_rays;
        }
        scratch.received.iter().map(|received| u64::from(received.shadow_rays)).sum()
    }

    /// Openness, near radiance and bent normal.
    #[inline(always)]
    fn ambient(
        &self,
        world: &Timed<'_>,
        scratch: &mut Scratch,
        segment: &mut Segment<'_>,
        counts: &mut RayCounts,
    ) {
        let origin = (segment.x0, segment.y0);
        scratch.points.clear();
        scratch.order_by_class(origin);
        for &place in &scratch.seen {
            scratch.points.push(segment.gbuffer[place.0][place.1].shaded_point(self.key(origin, place)));
        }
        scratch.gathered.resize(scratch.points.len(), Gathered::default());
        gather(world, self.params, &scratch.points, &mut scratch.gather, &mut scratch.gathered);

        for (&(row, column), gathered) in scratch.seen.iter().zip(&scratch.gathered) {
            let (ambient, second) = gathered.before_filter(!segment.second.is_empty());
            segment.ambient[row][column] = ambient;
            if let Some(second) = second {
                segment.second[row][column] = second;
            }
            segment.bent[row][column] = gathered.bent.extend(gathered.changing);
            segment.gbuffer[row][column].rays +=
                gathered.ambient_rays + gathered.chord_rays + gathered.shadow_rays;
            counts.ambient += u64::from(gathered.ambient_rays);
            counts.chord += u64::from(gathered.chord_rays);
            counts.shadow += u64::from(gathered.shadow_rays);
        }
    }
}

impl Scratch {
    /// Orders the pixels that see a surface class by class, so that the rays of a run share their directions on flat
    /// surfaces. The first pixel of the segment is at (`x0`, `y0`).
    #[inline(always)]
    fn order_by_class(&mut self, (x0, y0): (usize, usize)) {
        let class = |(row, column): Place| usize::from(sample_class((x0 + column) as u32, (y0 + row) as u32));
        // Where each class begins.
        let mut places = [0; CLASS_COUNT as usize + 1];
        self.seen.iter().for_each(|&place| places[class(place) + 1] += 1);
        (0..CLASS_COUNT as usize).for_each(|k| places[k + 1] += places[k]);
        self.ordered.resize(self.seen.len(), (0, 0));
        for &place in &self.seen {
            let at = &mut places[class(place)];
            self.ordered[*at] = place;
            *at += 1;
        }
        std::mem::swap(&mut self.seen, &mut self.ordered);
    }
}

/// Buffers of threads, kept from task to task and from frame to frame.
#[derive(Debug, Default)]
pub(super) struct Scratches(Mutex<Vec<Scratch>>);

impl Scratches {
    fn take(&self) -> Scratch {
        self.lock().pop().unwrap_or_default()
    }

    fn give(&self, scratch: Scratch) {
        self.lock().push(scratch);
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Scratch>> {
        // Whole at any time, so a panic of another thread does not matter.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
