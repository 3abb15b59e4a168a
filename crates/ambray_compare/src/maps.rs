//! Openness of frames as maps, and what filters make of maps.

use ambray::{
    Control, Frame, RenderError,
    filter::{Filter, Guide},
    settings::{Settings, Window},
};
use ambray_metrics::Map;
use ambray_rivals::{Screen, rival};
use glam::Vec4;

/// Openness of `frame` before its filter.
#[must_use]
pub fn raw(frame: &Frame) -> Map {
    openness(frame, &frame.ambient_raw)
}

/// Openness of `frame` before its filter, as far as it can be shown: GTAO leaves values above 1 to its denoiser.
#[must_use]
pub fn shown_raw(frame: &Frame) -> Map {
    let Map { width, values } = raw(frame);
    Map { width, values: values.into_iter().map(|openness| openness.min(1.0)).collect() }
}

/// Openness of `frame` after its filter.
#[must_use]
pub fn filtered(frame: &Frame) -> Map {
    openness(frame, &frame.ambient)
}

fn openness(frame: &Frame, ambient: &[Vec4]) -> Map {
    Map { width: frame.width as usize, values: ambient.iter().map(|value| value.x).collect() }
}

/// `map` after the filter of `settings` and their method, guided by what `frame` sees.
///
/// # Errors
/// If it is cancelled.
pub fn filter(
    map: &Map,
    frame: &Frame,
    settings: &Settings,
    control: Control<'_>,
) -> Result<Map, RenderError> {
    if settings.filter == Window::Off {
        return Ok(map.clone());
    }
    let values = if let Some(rival) = rival(settings) {
        let screen = Screen::new(&frame.gbuffer, &frame.view, settings);
        rival.filter(&screen, &map.values, &control).map_err(|_| RenderError::Cancelled)?
    } else {
        let guides: Vec<Guide> = frame.gbuffer.iter().map(|pixel| pixel.guide(&frame.view.camera)).collect();
        let input: Vec<Vec4> = map.values.iter().map(|&value| Vec4::X * value).collect();
        let mut output = vec![Vec4::ZERO; input.len()];
        let filter = Filter::from(settings);
        for (y, row) in output.chunks_mut(map.width).enumerate() {
            filter.filter_row(&guides, map.width, y, [&input], [row]);
        }
        output.iter().map(|value| value.x).collect()
    };
    Ok(Map { width: map.width, values })
}

/// Root mean square error of `estimate` after the line through it that fits `truth` best: what is wrong with its structure,
/// whatever its strength.
#[must_use]
pub fn fitted_rmse(estimate: &Map, truth: &Map) -> f64 {
    let count = truth.values.len() as f64;
    let pairs = || estimate.values.iter().zip(&truth.values).map(|(&e, &t)| (f64::from(e), f64::from(t)));
    let (e, t) = pairs().fold((0.0, 0.0), |(e, t), pair| (e + pair.0 / count, t + pair.1 / count));
    let (mut square, mut cross, mut rest) = (0.0, 0.0, 0.0);
    for (estimate, truth) in pairs() {
        square += (estimate - e).powi(2);
        cross += (estimate - e) * (truth - t);
        rest += (truth - t).powi(2);
    }
    let explained = if square > 0.0 { cross * cross / square } else { 0.0 };
    ((rest - explained).max(0.0) / count).sqrt()
}

#[cfg(test)]
mod tests {
    use ambray::{
        Renderer,
        scene::atrium::atrium,
        settings::{Method, Size},
    };

    use super::*;

    #[test]
    fn filtering_by_hand_is_what_the_frame_did() {
        let mut renderer = Renderer::new(atrium());
        for &method in Method::ALL {
            let settings =
                Settings { method, size: Size { width: 40, height: 24 }, spp: 2, ..Settings::default() };
            let frame = renderer.render(&settings, Control::default()).expect("renders");
            let by_hand = filter(&raw(&frame), &frame, &settings.by_method(), Control::default());
            assert_eq!(by_hand.expect("not cancelled"), filtered(&frame), "{method}");
        }
    }

    #[test]
    fn a_line_explains_scale_and_offset_but_no_noise() {
        let map = |f: &dyn Fn(usize) -> f32| Map { width: 10, values: (0..100).map(f).collect() };
        let truth = map(&|i| i as f32 / 100.0);
        assert!(fitted_rmse(&map(&|i| 0.2 + 0.3 * i as f32 / 100.0), &truth) < 1e-7);
        // Noise of ±0.1 that knows nothing of the truth: of the variance v of the truth, v / (v + 0.01) is explained.
        let noisy = map(&|i| i as f32 / 100.0 + if (i / 2) % 2 == 0 { 0.1 } else { -0.1 });
        let variance = (100.0_f64.powi(2) - 1.0) / 12.0 / 1e4;
        let expected = (variance * 0.01 / (variance + 0.01)).sqrt();
        assert!((fitted_rmse(&noisy, &truth) - expected).abs() < 0.005);
        // A constant explains nothing.
        assert!((fitted_rmse(&map(&|_| 0.5), &truth) - variance.sqrt()).abs() < 1e-6);
    }
}
