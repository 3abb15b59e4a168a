//! Pass 2: the geometry-aware filter, accumulation over frames, then composition (spec §§4, 7, 12), in bands of
//! rows.

use std::time::{Duration, Instant};

use ambray_core::{
    compose::{compose, finished, smaller_batch},
    control::{Cancelled, Control},
    filter::{BandScratch, Filter},
    settings::{RadianceSource, Settings},
    temporal::Mean,
    view::View,
};
use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::{
    pass1::Pass1,
    planes::Planes,
    stages::Stage,
    temporal::Sequel,
    vectors::{Vectors, Work},
};

/// Rows that are filtered together.
const ROWS: usize = 16;

/// The finished planes, row by row from the top.
#[derive(Debug)]
pub(super) struct Pass2 {
    pub(super) beauty: Vec<Vec3>,
    pub(super) ambient: Vec<Vec4>,
    pub(super) bent: Vec<Vec3>,
    /// Frames whose mean each pixel is.
    pub(super) history: Vec<f32>,
    /// What is kept for the next frame; empty unless light is accumulated.
    pub(super) means: Vec<Mean>,
    pub(super) elapsed: Duration,
}

/// Filters what `pass1` gathered, accumulates it with the frames before and composes the picture. Leaves finished raw values
/// in `pass1.ambient`.
pub(super) fn run(
    pass1: &mut Pass1,
    settings: &Settings,
    view: &View,
    sequel: Option<&Sequel<'_>>,
    vectors: Vectors,
    planes: &mut Planes,
    control: Control<'_>,
) -> Result<Pass2, Cancelled> {
    let start = Instant::now();
    let width = view.camera.size().0 as usize;
    let pixels = pass1.gbuffer.len();
    let mut beauty: Vec<Vec3> = planes.take(pixels);
    let mut ambient: Vec<Vec4> = planes.take(pixels);
    let mut bent: Vec<Vec3> = planes.take(pixels);
    let mut history: Vec<f32> = planes.take(pixels);
    let mut means = vec![Mean::default(); if sequel.is_some() { pixels } else { 0 }];
    let band = ROWS * width;
    let mut kept: Vec<&mut [Mean]> = means.chunks_mut(band).collect();
    kept.resize_with(pixels.div_ceil(band), Default::default);
    let pictures = beauty.par_chunks_mut(band).zip(ambient.par_chunks_mut(band));
    let others = bent.par_chunks_mut(band).zip(history.par_chunks_mut(band)).zip(kept);
    let job = Job { filter: Filter::from(settings), settings, view, sequel, pass1, width };
    pictures.zip(others).enumerate().try_for_each_init(
        Rows::default,
        |rows, (i, ((beauty, ambient), ((bent, history), means)))| {
            control.check()?;
            let (first, start) = (i * ROWS, Instant::now());
            vectors.run(Band { job: &job, rows, first, beauty, ambient, bent, history, means });
            pass1.clock.book(Stage::Filter, start);
            Ok(())
        },
    )?;

    let finish = |v: Vec4| finished(settings.radiance_source, view.ambient, v);
    let Pass1 { ambient: raw, second, clock, .. } = pass1;
    let raw_is_final = second.is_empty() && settings.radiance_source != RadianceSource::SelfSimilar;
    if !raw_is_final {
        raw.par_chunks_mut(band).enumerate().for_each(|(i, raw)| {
            let start = Instant::now();
            for (raw, pixel) in raw.iter_mut().zip(i * band..) {
                *raw = finish(second.get(pixel).map_or(*raw, |&second| smaller_batch(*raw, second)));
            }
            clock.book(Stage::Filter, start);
        });
    }
    Ok(Pass2 { beauty, ambient, bent, history, means, elapsed: start.elapsed() })
}

/// Filtered rows of one thread.
#[derive(Debug, Default)]
struct Rows {
    bent: Vec<Vec4>,
    second: Vec<Vec4>,
    scratch: BandScratch,
}

/// What is the same for all bands.
struct Job<'a> {
    filter: Filter,
    settings: &'a Settings,
    view: &'a View,
    sequel: Option<&'a Sequel<'a>>,
    pass1: &'a Pass1,
    width: usize,
}

/// A band of rows from `first` on, to be filtered, accumulated and composed.
struct Band<'j, 'a> {
    job: &'j Job<'a>,
    rows: &'j mut Rows,
    first: usize,
    beauty: &'j mut [Vec3],
    ambient: &'j mut [Vec4],
    bent: &'j mut [Vec3],
    history: &'j mut [f32],
    /// Empty unless light is accumulated.
    means: &'j mut [Mean],
}

impl Work for Band<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        self.filter();
        match self.job.sequel {
            Some(sequel) => self.accumulate(sequel),
            None => self.history.fill(1.0),
        }
        self.compose();
    }
}

impl Band<'_, '_> {
    /// Filters all planes; the smaller of both batches goes to `ambient`.
    #[inline(always)]
    fn filter(&mut self) {
        let Job { filter, pass1, width, .. } = self.job;
        let (guides, pixels) = (&pass1.guides, self.ambient.len());
        let Rows { bent, second, scratch } = &mut *self.rows;
        bent.resize(pixels, Vec4::ZERO);
        let rows = self.first..self.first + pixels / width;
        if pass1.second.is_empty() {
            let inputs: [&[Vec4]; 2] = [&pass1.ambient, &pass1.bent];
            filter.filter_band(guides, *width, rows, inputs, [self.ambient, bent], scratch);
        } else {
            second.resize(pixels, Vec4::ZERO);
            let inputs: [&[Vec4]; 3] = [&pass1.ambient, &pass1.bent, &pass1.second];
            filter.filter_band(guides, *width, rows, inputs, [self.ambient, bent, second], scratch);
            for (first, &second) in self.ambient.iter_mut().zip(&*second) {
                *first = smaller_batch(*first, second);
            }
        }
    }

    /// Takes the mean with the frames before, row by row.
    fn accumulate(&mut self, sequel: &Sequel<'_>) {
        let Job { settings, view, pass1, width, .. } = *self.job;
        let rows = self.ambient.chunks_mut(width).zip(self.rows.bent.chunks_mut(width));
        for (i, ((ambient, bent), means)) in rows.zip(self.means.chunks_mut(width)).enumerate() {
            sequel.accumulate((settings, view), pass1, self.first + i, [ambient, bent], means);
        }
        for (frames, mean) in self.history.iter_mut().zip(&*self.means) {
            *frames = mean.frames;
        }
    }

    #[inline(always)]
    fn compose(self) {
        let Job { settings, view, pass1, width, .. } = *self.job;
        let pixels = &pass1.gbuffer[self.first * width..][..self.ambient.len()];
        let filtered = self.ambient.iter_mut().zip(self.bent).zip(&self.rows.bent);
        for ((((ambient, bent), mean), pixel), beauty) in filtered.zip(pixels).zip(self.beauty) {
            *ambient = finished(settings.radiance_source, view.ambient, *ambient);
            *bent = mean.xyz();
            *beauty = if pixel.is_surface() {
                let (openness, near) = (ambient.x, ambient.yzw());
                compose(pixel.emission, pixel.albedo, view.ambient, openness, near, pixel.direct)
            } else {
                pixel.emission
            };
        }
    }
}
