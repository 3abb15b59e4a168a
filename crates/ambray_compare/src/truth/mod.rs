//! The truth: converged openness and near radiance of a view, without any filter.

mod cache;
mod content;

use std::{path::PathBuf, time::Instant};

use ambray::{
    Control, Frame, RenderError, Renderer,
    settings::{Method, Sampling, Sequence, Settings, Temporal, Thin, Window},
};
use ambray_metrics::Map;
use glam::{DVec4, Vec3, Vec4, Vec4Swizzles};
use serde::Serialize;

pub use content::Content;

/// Rays of a batch. Batches are independent estimates, so their differences tell the standard error of their mean.
const BATCH: u32 = 512;
/// Batches that there are at least: 1024 rays a pixel, as spec §10 asks.
const LEAST: u32 = 2;
/// Of the way truths are found: another number makes kept ones worthless. To be raised with every change of what converged
/// light is: of tracing, offsets, surfaces, textures.
const VERSION: u32 = 2;

/// How good a truth must be, and where truths are kept.
#[derive(Clone, Debug)]
pub struct TruthOptions {
    /// Standard error of openness below which it is good enough, root mean square over the pixels that see a surface.
    pub bound: f64,
    /// Rays a pixel after which it has to do.
    pub most: u32,
    /// Folder of the truths that were found before; `None` keeps none.
    pub cache: Option<PathBuf>,
}

impl Default for TruthOptions {
    fn default() -> Self {
        Self { bound: 0.002, most: 16_384, cache: None }
    }
}

/// Converged ambient light of a view.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Openness of each pixel.
    pub openness: Map,
    /// Near radiance of each pixel.
    pub near: Vec<Vec3>,
    /// How it was found.
    pub about: AboutTruth,
}

/// How a truth was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct AboutTruth {
    /// Rays a pixel.
    pub spp: u32,
    /// Standard error of openness, root mean square over the pixels that see a surface.
    pub standard_error: f64,
    /// What it had to be below.
    pub bound: f64,
    /// Whether it was found before, and read from the cache.
    pub cached: bool,
    /// What finding it took, seconds; of reading it, if it was found before.
    pub seconds: f64,
}

impl AboutTruth {
    /// Of several truths the one whose standard error is largest.
    #[must_use]
    pub fn worst(of: &[Self]) -> Option<Self> {
        of.iter().copied().max_by(|a, b| a.standard_error.total_cmp(&b.standard_error))
    }

    /// Whether the standard error is below the bound.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        self.standard_error <= self.bound
    }
}

impl Truth {
    /// The truth of what `renderer` shows with `settings`, whose quality does not count. `content` is of its scene.
    ///
    /// # Errors
    /// As [`Renderer::render`]. A cache that cannot be read or written is only warned of.
    pub fn find(
        renderer: &mut Renderer,
        content: &Content,
        settings: &Settings,
        options: &TruthOptions,
        control: Control<'_>,
    ) -> Result<Self, RenderError> {
        let start = Instant::now();
        // A step is the falloff of one of the methods, so its truth is asked for by that method.
        let settings = settings.by_method();
        let key = content.key(&settings, options.bound, options.most, &renderer.machine());
        let size = (settings.size.width, settings.size.height);
        let kept = options.cache.as_deref().and_then(|folder| cache::read(folder, &key, size));
        if let Some(mut truth) = kept {
            truth.about.cached = true;
            truth.about.seconds = start.elapsed().as_secs_f64();
            return Ok(truth);
        }
        let mut truth = converge(renderer, &settings, options, control)?;
        truth.about.seconds = start.elapsed().as_secs_f64();
        if let Some(folder) = &options.cache
            && let Err(error) = cache::write(folder, &key, &truth)
        {
            log::warn!("{}: the truth cannot be kept there: {error:#}", folder.display());
        }
        Ok(truth)
    }

    /// `frame` with this light in the place of its own, composed as it is.
    #[must_use]
    pub fn lit(&self, frame: &Frame) -> Frame {
        let ambient = self.openness.values.iter().zip(&self.near).map(|(&o, near)| near.extend(o).wxyz());
        with_ambient(frame, ambient.collect())
    }
}

/// `frame` with other ambient light: openness (x) and near radiance (yzw) of each pixel.
#[must_use]
pub fn with_ambient(frame: &Frame, ambient: Vec<Vec4>) -> Frame {
    let light = |(pixel, light): (&ambray::GBufferPixel, &Vec4)| {
        if !pixel.is_surface() {
            return pixel.emission;
        }
        let (openness, near) = (light.x, light.yzw());
        ambray::compose(pixel.emission, pixel.albedo, frame.view.ambient, openness, near, pixel.direct)
    };
    let beauty = frame.gbuffer.iter().zip(&ambient).map(light).collect();
    Frame { beauty, ambient, ..frame.clone() }
}

/// Averages independent batches until their mean is good enough.
fn converge(
    renderer: &mut Renderer,
    settings: &Settings,
    options: &TruthOptions,
    control: Control<'_>,
) -> Result<Truth, RenderError> {
    let mut sums = Vec::<DVec4>::new();
    let mut squares = Vec::<f64>::new();
    let mut batches = 0;
    loop {
        let frame = renderer.render(&batch(settings, batches), control)?;
        sums.resize(frame.ambient.len(), DVec4::ZERO);
        squares.resize(frame.ambient.len(), 0.0);
        for (value, (sum, square)) in frame.ambient.iter().zip(sums.iter_mut().zip(&mut squares)) {
            *sum += value.as_dvec4();
            *square += f64::from(value.x) * f64::from(value.x);
        }
        batches += 1;
        let standard_error = standard_error(&frame, &sums, &squares, batches);
        let is_done = standard_error <= options.bound || (batches + 1) * BATCH > options.most;
        if batches >= LEAST && is_done {
            let means = || sums.iter().map(|sum| (*sum / f64::from(batches)).as_vec4());
            return Ok(Truth {
                openness: Map { width: frame.width as usize, values: means().map(|mean| mean.x).collect() },
                near: means().map(Vec4::yzw).collect(),
                about: AboutTruth {
                    spp: batches * BATCH,
                    standard_error,
                    bound: options.bound,
                    cached: false,
                    seconds: 0.0,
                },
            });
        }
    }
}

/// Settings of the batch with this number: an independent scramble in every pixel and every batch.
fn batch(settings: &Settings, number: u32) -> Settings {
    Settings {
        method: Method::Ambray,
        spp: BATCH,
        sampling: Sampling::Random,
        filter: Window::Off,
        thin: Thin::Off,
        temporal: Temporal::Off,
        sequence: Sequence::Auto,
        // The primary rays of all batches and of what is compared are the same: the seed does not count for them. Away from the
        // seeds that people choose.
        seed: settings.seed.wrapping_add(0x7121_0000).wrapping_add(number),
        ..settings.clone()
    }
}

/// Standard error of the mean of the batches, root mean square over the pixels that see a surface. One batch tells none.
fn standard_error(frame: &Frame, sums: &[DVec4], squares: &[f64], batches: u32) -> f64 {
    let n = f64::from(batches);
    let variance = |i: usize| (squares[i] - sums[i].x * sums[i].x / n).max(0.0) / (n - 1.0) / n;
    let seen = (0..sums.len()).filter(|&i| frame.gbuffer[i].is_surface());
    let (sum, count) = seen.fold((0.0, 0_u64), |(sum, count), i| (sum + variance(i), count + 1));
    if batches < 2 { f64::INFINITY } else { (sum / count.max(1) as f64).sqrt() }
}

#[cfg(test)]
mod tests;
