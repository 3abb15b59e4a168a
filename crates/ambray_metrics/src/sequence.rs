//! Measures of sequences, whose truth may move.

use crate::{Map, errors::root_mean_square};

/// Flicker: root mean square of how much the error changes between two frames that follow each other, in the unit of the
/// map; 0 is best. `truth` are those that they should be; the truth may move, and a constant error does not flicker.
#[must_use]
pub fn flicker(frames: [&Map; 2], truth: [&Map; 2]) -> f64 {
    root_mean_square(changes(frames, truth))
}

/// Flicker of a whole sequence: the root mean square over all pairs of frames that follow each other. `None` with fewer
/// than two frames.
///
/// # Panics
/// If there are not as many frames as truths.
#[must_use]
pub fn flicker_of(frames: &[Map], truth: &[Map]) -> Option<f64> {
    assert_eq!(frames.len(), truth.len(), "each frame has its truth");
    if frames.len() < 2 {
        return None;
    }
    let pairs = frames.windows(2).zip(truth.windows(2));
    Some(root_mean_square(pairs.flat_map(|(e, t)| changes([&e[0], &e[1]], [&t[0], &t[1]]))))
}

/// How much the error of each pixel changes from the first frame to the second.
fn changes<'a>(frames: [&'a Map; 2], truth: [&'a Map; 2]) -> impl Iterator<Item = f64> + 'a {
    frames[0].check_size(frames[1]);
    let before = frames[0].minus(truth[0]);
    frames[1].minus(truth[1]).zip(before).map(|(now, before)| now - before)
}

/// How far a sequence lags behind its truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ghosting {
    /// Share of the last change of the truth that is not followed yet: 0 follows at once, 1 is one frame late, more is
    /// later still, and below 0 is ahead of the truth.
    pub lag: f64,
    /// Root mean square error where the truth changed, in the unit of the map.
    pub rmse: f64,
    /// Pixels of all frames at which the truth changed.
    pub pixels: usize,
}

/// Ghosting of `frames` against `truth`, over the pixels of all frames but the first at which the truth changed by more
/// than `least` since the frame before. `None` if it changed nowhere.
///
/// Estimates that keep old frames are late: E_t = T_t + g (T_{t-1} - T_t) with some g > 0. So `lag` is the coefficient g
/// of the error E_t - T_t on the step back T_{t-1} - T_t by least squares, Σ (E_t - T_t)(T_{t-1} - T_t) / Σ (T_{t-1} - T_t)²:
/// noise that knows nothing of the step averages out. There is no constant term, since all pixels may step alike, where
/// lag and bias could not be told apart.
///
/// # Panics
/// If there are not as many frames as truths.
#[must_use]
pub fn ghosting(frames: &[Map], truth: &[Map], least: f32) -> Option<Ghosting> {
    assert_eq!(frames.len(), truth.len(), "each frame has its truth");
    let (mut product, mut step_power, mut error_power, mut pixels) = (0.0, 0.0, 0.0, 0);
    for t in 1..frames.len() {
        let errors = frames[t].minus(&truth[t]);
        for (error, back) in errors.zip(truth[t - 1].minus(&truth[t])) {
            if back.abs() > f64::from(least) {
                product += error * back;
                step_power += back * back;
                error_power += error * error;
                pixels += 1;
            }
        }
    }
    (pixels > 0).then(|| Ghosting {
        lag: product / step_power,
        rmse: (error_power / pixels as f64).sqrt(),
        pixels,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = 32 * 24;

    /// A bright square of 8 × 8 pixels that moves 3 pixels a frame over a slope.
    fn moving() -> Vec<Map> {
        let value = |i: usize, t: usize| {
            let (x, y) = (i % 32, i / 32);
            let inside = (3 * t..3 * t + 8).contains(&x) && (8..16).contains(&y);
            if inside { 0.9 } else { 0.2 + 0.01 * y as f32 }
        };
        let frame = |t: usize| Map { width: 32, values: (0..SIZE).map(|i| value(i, t)).collect() };
        (0..6).map(frame).collect()
    }

    fn blend(a: &Map, b: &Map, share: f32) -> Map {
        let values = a.values.iter().zip(&b.values).map(|(a, b)| a + share * (b - a)).collect();
        Map { width: a.width, values }
    }

    #[test]
    fn a_constant_error_does_not_flicker() {
        let truth = moving();
        let off = |by: f32| {
            move |map: &Map| Map { values: map.values.iter().map(|v| v + by).collect(), ..map.clone() }
        };
        let steady: Vec<Map> = truth.iter().map(off(0.1)).collect();
        assert!(flicker_of(&steady, &truth).unwrap() < 1e-7);
        // Errors of +0.125 and −0.125 in turn change by 0.25 every time.
        let restless: Vec<Map> =
            truth.iter().zip([0.125, -0.125].into_iter().cycle()).map(|(m, by)| off(by)(m)).collect();
        assert!((flicker_of(&restless, &truth).unwrap() - 0.25).abs() < 1e-6);
        assert!((flicker([&restless[0], &restless[1]], [&truth[0], &truth[1]]) - 0.25).abs() < 1e-6);
        assert_eq!(flicker_of(&truth[..1], &truth[..1]), None);
    }

    #[test]
    fn lag_is_the_part_of_a_frame_by_which_a_sequence_is_late() {
        let truth = moving();
        for late in [0.0, 0.25, 0.5, 1.0] {
            let frames: Vec<Map> =
                (0..truth.len()).map(|t| blend(&truth[t], &truth[t.max(1) - 1], late)).collect();
            let found = ghosting(&frames, &truth, 0.05).unwrap();
            assert!((found.lag - f64::from(late)).abs() < 1e-6, "{late}: {found:?}");
            // Three columns of eight pixels appear and three vanish in each of five steps.
            assert_eq!(found.pixels, 2 * 3 * 8 * 5);
        }
    }

    #[test]
    fn noise_is_no_lag() {
        let truth = moving();
        let mut random = fastrand::Rng::with_seed(3);
        let mut noisy = |map: &Map| Map {
            values: map.values.iter().map(|v| v + 0.2 * (random.f32() - 0.5)).collect(),
            ..map.clone()
        };
        let frames: Vec<Map> = truth.iter().map(&mut noisy).collect();
        let found = ghosting(&frames, &truth, 0.05).unwrap();
        // σ = 0.2/√12 = 0.058 over 240 pixels that step by about 0.57: the coefficient has σ = 0.058/(0.57 √240) = 0.0066.
        assert!(found.lag.abs() < 4.0 * 0.0066, "{found:?}");
        assert!((found.rmse - 0.058).abs() < 0.01, "{found:?}");
    }

    #[test]
    fn where_nothing_moves_there_is_no_ghost() {
        let still = vec![moving()[0].clone(); 3];
        assert_eq!(ghosting(&still, &still, 0.05), None);
    }
}
