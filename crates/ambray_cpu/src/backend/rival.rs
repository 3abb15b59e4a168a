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

use super::{
    pass1::Pass1,
    world::{CpuWorld, Timed},
};

/// What a method made of a picture.
pub(super) struct Rivalled {
    /// Openness before the filter (x), without near radiance.
    pub(super) raw: Vec<Vec4>,
    /// The settings for pass 2, whose filter must not change what is filtered already.
    pub(super) settings: Settings,
    /// Time of the method, and of its filter.
    pub(super) elapsed: [Duration; 2],
    /// Time of tracing rays, part of the first, mean over the threads.
    pub(super) tracing: Duration,
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
        let world = Timed::new(world);
        let estimate = hybrid.estimate(&screen, &pass1.gbuffer, &world, params, &control)?;
        let tracing = Duration::from_nanos(world.tracing() / rayon::current_num_threads() as u64);
        pass1.ambient = plane(&estimate.openness);
        for (pixel, rays) in pass1.gbuffer.iter_mut().zip(&estimate.rays) {
            pixel.rays += rays;
            pass1.rays.ambient += u64::from(*rays);
        }
        let (raw, settings) = (pass1.ambient.clone(), settings.clone());
        return Ok(Rivalled { raw, settings, elapsed: [start.elapsed(), Duration::ZERO], tracing });
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
    let (raw, elapsed) = (plane(&raw), [estimated - start, estimated.elapsed()]);
    Ok(Rivalled { raw, settings, elapsed, tracing: Duration::ZERO })
}

fn plane(openness: &[f32]) -> Vec<Vec4> {
    openness.par_iter().map(|&openness| Vec4::X * openness).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ambray_core::{camera::Camera, sampling::SampleSets, settings::Size};
    use ambray_scene::atrium::atrium;

    use super::*;
    use crate::{
        BuildOptions, CpuBackend,
        backend::{pass1, planes::Planes},
    };

    #[test]
    fn rays_of_a_method_are_booked() {
        let (size, scene) = (Size { width: 20, height: 12 }, atrium());
        let seen = &scene.cameras[0];
        let (width, height) = (size.width, size.height);
        let camera = Camera::new(seen.position, seen.forward, seen.up, seen.projection, width, height);
        let view = View::new(camera, 1.0);
        let backend = CpuBackend::new(Arc::new(scene), BuildOptions::default());
        for method in [Method::Hybrid, Method::Gtao] {
            let settings = Settings { size, method, ..Settings::default() };
            let (samples, control) = (SampleSets::of(&settings), Control::default());
            let params = GatherParams::new(&settings, &view, &samples);
            let (world, mut planes) = (backend.world(), Planes::default());
            let pass1 = pass1::run(world, &settings, &view, &params, None, &mut planes, control);
            let mut pass1 = pass1.unwrap();
            let rivalled = run(world, &settings, &view, &params, &mut pass1, control).unwrap();
            let traces = method == Method::Hybrid;
            assert_eq!(pass1.rays.ambient > 0, traces);
            assert_eq!(rivalled.tracing > Duration::ZERO, traces);
            assert!(rivalled.tracing <= rivalled.elapsed[0]);
        }
    }
}
