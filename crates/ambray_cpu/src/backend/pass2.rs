//! Pass 2: the geometry-aware filter, accumulation over frames, then composition (spec §§4, 7, 12), row by row.

use std::time::{Duration, Instant};

use ambray_core::{
    compose::{compose, finished, smaller_batch},
    control::{Cancelled, Control},
    filter::Filter,
    settings::{RadianceSource, Settings},
    temporal::Mean,
    view::View,
};
use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::{pass1::Pass1, temporal::Sequel};

/// The finished planes, row by row from the top.
#[derive(Debug)]
pub(super) struct Pass2 {
    pub(super) beauty: Vec<Vec3>,
    pub(super) ambient: Vec<Vec4>,
    pub(super) bent: Vec<Vec3>,
    /// What is kept for the next frame; empty unless light is accumulated.
    pub(super) means: Vec<Mean>,
    pub(super) elapsed: Duration,
}

impl Pass2 {
    /// Frames whose mean each pixel is.
    pub(super) fn history(&self) -> Vec<f32> {
        if self.means.is_empty() {
            return vec![1.0; self.beauty.len()];
        }
        self.means.iter().map(|mean| mean.frames).collect()
    }
}

/// Filters what `pass1` gathered, accumulates it with the frames before and composes the picture. Leaves finished raw values
/// in `pass1.ambient`.
pub(super) fn run(
    pass1: &mut Pass1,
    settings: &Settings,
    view: &View,
    sequel: Option<&Sequel<'_>>,
    control: Control<'_>,
) -> Result<Pass2, Cancelled> {
    let start = Instant::now();
    let width = view.camera.size().0 as usize;
    let pixels = pass1.gbuffer.len();
    let filter = Filter::from(settings);
    let finish = |v: Vec4| finished(settings.radiance_source, view.ambient, v);

    let mut beauty = vec![Vec3::ZERO; pixels];
    let mut ambient = vec![Vec4::ZERO; pixels];
    let mut bent = vec![Vec3::ZERO; pixels];
    let mut means = vec![Mean::default(); if sequel.is_some() { pixels } else { 0 }];
    let rows =
        beauty.par_chunks_mut(width).zip(ambient.par_chunks_mut(width)).zip(bent.par_chunks_mut(width));
    let mut kept: Vec<Option<&mut [Mean]>> = means.chunks_mut(width).map(Some).collect();
    kept.resize_with(pixels / width, || None);
    rows.zip(kept).enumerate().try_for_each_init(
        Rows::default,
        |buffers, (y, (((beauty, ambient), bent), means))| {
            control.check()?;
            buffers.filter(&filter, pass1, width, y, ambient);
            if let (Some(sequel), Some(means)) = (sequel, means) {
                sequel.accumulate((settings, view), pass1, y, [ambient, &mut buffers.bent], means);
            }
            for x in 0..width {
                let pixel = &pass1.gbuffer[y * width + x];
                ambient[x] = finish(ambient[x]);
                bent[x] = buffers.bent[x].xyz();
                beauty[x] = if pixel.is_surface() {
                    let (openness, near) = (ambient[x].x, ambient[x].yzw());
                    compose(pixel.emission, pixel.albedo, view.ambient, openness, near, pixel.direct)
                } else {
                    pixel.emission
                };
            }
            Ok(())
        },
    )?;

    let second = &pass1.second;
    let raw_is_final = second.is_empty() && settings.radiance_source != RadianceSource::SelfSimilar;
    if !raw_is_final {
        pass1.ambient.par_iter_mut().enumerate().for_each(|(i, raw)| {
            *raw = finish(second.get(i).map_or(*raw, |&second| smaller_batch(*raw, second)));
        });
    }
    Ok(Pass2 { beauty, ambient, bent, means, elapsed: start.elapsed() })
}

/// Filtered rows of one thread.
#[derive(Debug, Default)]
struct Rows {
    bent: Vec<Vec4>,
    second: Vec<Vec4>,
}

impl Rows {
    /// Filters row `y` of all planes; the smaller of both batches goes to `ambient`.
    fn filter(&mut self, filter: &Filter, pass1: &Pass1, width: usize, y: usize, ambient: &mut [Vec4]) {
        self.bent.resize(width, Vec4::ZERO);
        self.second.resize(width, Vec4::ZERO);
        let (guides, bent) = (&pass1.guides, &mut self.bent[..]);
        if pass1.second.is_empty() {
            filter.filter_row(guides, width, y, [&pass1.ambient, &pass1.bent], [ambient, bent]);
        } else {
            let inputs: [&[Vec4]; 3] = [&pass1.ambient, &pass1.bent, &pass1.second];
            filter.filter_row(guides, width, y, inputs, [ambient, bent, &mut self.second]);
            for (first, &second) in ambient.iter_mut().zip(&self.second) {
                *first = smaller_batch(*first, second);
            }
        }
    }
}
