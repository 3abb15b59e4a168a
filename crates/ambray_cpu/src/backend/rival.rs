//! Openness by a method that works in screen space, in the place of the gather.

use std::time::{Duration, Instant};

use ambray_core::{
    control::{Cancelled, Control},
    gather::GatherParams,
    settings::{Method, Settings, Window},
    view::View,
};
use ambray_rivals::{Hybrid, Screen, rival};
use glam::Vec4;
use rayon::prelude::*;

use super::{pass1::Pass1, world::CpuWorld};

/// What a method made of a picture.
pub(super) struct Rivalled {
    /// Openness before the filter (x), without near radiance.
    pub(super) raw: Vec<Vec4>,
    /// The settings for pass 2, whose filter must not change what is filtered already.
    pub(super) settings: Settings,
    /// Time of the method, and of its filter.
    pub(super) elapsed: [Duration; 2],
}

/// Finds openness from what `pass1` saw, and leaves it in `pass1.ambient`, filtered unless the filter is Ambray's.
pub(super) fn run(
    world: &CpuWorld,
    settings: &Settings,
    view: &View,
    params: &GatherParams<'_>,
    pass1: &mut Pass1,
    control: Control<'_>,
) -> Result<Rivalled, Cancelled> {
    let start = Instant::now();
    let screen = Screen::new(&pass1.gbuffer, view, settings);
    let Some(rival) = rival(settings) else {
        debug_assert_eq!(settings.method, Method::Hybrid, "traced methods are Ambray by other settings");
        let hybrid = Hybrid::of(settings);
        let estimate = hybrid.estimate(&screen, &pass1.gbuffer, world, params, &control)?;
        pass1.ambient = plane(&estimate.openness);
        for (pixel, rays) in pass1.gbuffer.iter_mut().zip(&estimate.rays) {
            pixel.rays += rays;
            pass1.rays.ambient += u64::from(*rays);
        }
        let (raw, settings) = (pass1.ambient.clone(), settings.clone());
        return Ok(Rivalled { raw, settings, elapsed: [start.elapsed(), Duration::ZERO] });
    };
    let raw = rival.estimate(&screen, &control)?;
    let estimated = Instant::now();
    if settings.filter == Window::Off {
        // GTAO leaves values above 1 to its denoiser.
        pass1.ambient = plane(&raw.iter().map(|openness| openness.min(1.0)).collect::<Vec<_>>());
    } else {
        pass1.ambient = plane(&rival.filter(&screen, &raw, &control)?);
    }
    let settings = Settings { filter: Window::Off, ..settings.clone() };
    Ok(Rivalled { raw: plane(&raw), settings, elapsed: [estimated - start, estimated.elapsed()] })
}

fn plane(openness: &[f32]) -> Vec<Vec4> {
    openness.par_iter().map(|&openness| Vec4::X * openness).collect()
}
