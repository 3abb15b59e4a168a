//! HBAO against its published equation, integrated here on closed forms, and its known faults.

mod common;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI, TAU};

use ambray_core::{
    control::Control,
    settings::{Method, Settings},
};
use ambray_rivals::{Hbao, Screen};
use common::{Scene, Seen, Shape, mean, parallel, perspective, see, truth};
use glam::DVec3;

const DOWN: DVec3 = DVec3::NEG_Y;

fn raw(hbao: &Hbao, screen: &Screen) -> Vec<f32> {
    hbao.estimate(screen, &Control::default()).unwrap()
}

fn default() -> Hbao {
    Hbao::of(&Settings::default())
}

/// Steps and directions enough for the integral: a step a pixel.
fn converged(angle_bias: f64) -> Hbao {
    Hbao { directions: 48, steps: 1000, angle_bias: angle_bias as f32, contrast: 1.0 }
}

/// Means over the columns of a picture, of its middle 16 rows: whole tiles of jitter.
fn columns(seen: &Seen, values: &[f32]) -> Vec<f64> {
    let (width, height) = seen.screen.size();
    let rows = height / 2 - 8..height / 2 + 8;
    (0..width).map(|x| mean(rows.clone().map(|y| values[y * width + x]))).collect()
}

#[test]
fn an_open_plane_is_open_however_it_is_seen() {
    let floor = Scene(vec![Shape::level(0.0, -50.0, 50.0)]);
    let cameras = [
        parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (48, 32), 10.0),
        parallel(DVec3::new(0.0, 5.0, 0.0), DVec3::new(2.0, -1.0, 0.5), (48, 32), 10.0),
        perspective(DVec3::new(0.0, 2.0, 0.0), DVec3::new(3.0, 0.0, 1.0), (48, 32)),
        // Level, and up: the normal of the floor is across the view, and away from it.
        perspective(DVec3::new(0.0, 1.0, 0.0), DVec3::new(3.0, 1.0, 1.0), (48, 32)),
        perspective(DVec3::new(0.0, 1.0, 0.0), DVec3::new(3.0, 1.6, 1.0), (48, 32)),
    ];
    for camera in cameras {
        let seen = see(&floor, camera, 1.0, &Settings::default());
        assert!(seen.gbuffer.iter().filter(|pixel| pixel.is_surface()).count() > 300);
        assert!(raw(&default(), &seen.screen).iter().all(|o| *o == 1.0));
        // Without a bias only rounding is left.
        let unbiased = raw(&Hbao { angle_bias: 0.0, ..default() }, &seen.screen);
        assert!(unbiased.iter().all(|o| *o > 0.9999), "{unbiased:?}");
    }
}

/// A step of height H seen from straight above, at distance d. The tangent is level. In the direction φ from the
/// perpendicular the first sample beyond the edge, ρ = d/cos φ away, has the highest horizon: sin h = H/√(ρ² + H²). So
///
/// A = 1 − 1/(2π (1 − sin b)) ∫ (1 − (ρ² + H²)/R²) max(0, sin h − sin b) dφ  over ρ² + H² < R².
fn beside_a_step(height: f64, distance: f64, radius: f64, bias: f64) -> f64 {
    let count = 20_000;
    let integral: f64 = (0..count)
        .map(|i| {
            let phi = (f64::from(i) + 0.5) / f64::from(count) * PI - FRAC_PI_2;
            let square = (distance / phi.cos()).powi(2) + height * height;
            let attenuation = (1.0 - square / (radius * radius)).max(0.0);
            attenuation * (height / square.sqrt() - bias.sin()).max(0.0)
        })
        .sum::<f64>()
        * PI
        / f64::from(count);
    1.0 - integral / (TAU * (1.0 - bias.sin()))
}

#[test]
fn a_step_from_above_is_what_the_equation_says() {
    // 64 pixels to the unit, the edge between columns 79 and 80.
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (160, 146), 64.0);
    // The higher one leaves the radius aslant.
    for (height, bias) in [(0.4, 0.0), (0.4, FRAC_PI_6), (0.8, 0.0)] {
        let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::level(height, -50.0, 0.0)]);
        let seen = see(&scene, camera, 1.0, &Settings::default());
        let found = columns(&seen, &raw(&converged(bias), &seen.screen));
        for x in (80..150).step_by(3) {
            let distance = (x as f64 - 79.5) / 64.0;
            let expected = beside_a_step(height, distance, 1.0, bias);
            // Samples lie a pixel apart, so that the edge is met half a pixel late: |dA/dρ| / 128 < 0.006.
            assert!((found[x] - expected).abs() < 0.008, "{distance}: {} for {expected}", found[x]);
        }
        // On the step, above everything, nothing blocks.
        assert!((10..80).all(|x| found[x] == 1.0));
    }
}

/// The published equation at the floor of a corner that is seen at 45° by parallel rays: the horizon is searched in angles,
/// in double precision, on rays through any point of the picture instead of pixels.
///
/// Floor y = 0 and wall x = 0; the viewer looks along (−1, −1, 0)/√2. With u the axis of the picture that points up,
/// (−1, 1, 0)/√2, the point (x, y) has u = (y − x)/√2 and the depth z = −(x + y)/√2: on the floor (u < 0) z = u, on the wall
/// z = −u.
fn in_a_corner(x: f64, radius: f64, bias: f64) -> f64 {
    let depth = |u: f64| if u < 0.0 { u } else { -u };
    let (u0, directions, steps) = (-x / 2.0_f64.sqrt(), 360, 4000);
    let blocked = |theta: f64| {
        let tangent = (-theta.sin()).atan() + bias;
        let (mut horizon, mut sum) = (tangent, 0.0);
        for i in 1..=steps {
            let rho = f64::from(i) / f64::from(steps) * radius;
            let rise = depth(u0) - depth(u0 + rho * theta.sin());
            let square = rho * rho + rise * rise;
            let angle = rise.atan2(rho);
            if square < radius * radius && angle > horizon {
                sum += (1.0 - square / (radius * radius)) * (angle.sin() - horizon.sin());
                horizon = angle;
            }
        }
        sum
    };
    let sum: f64 = (0..directions).map(|i| blocked((f64::from(i) + 0.5) / f64::from(directions) * TAU)).sum();
    1.0 - sum / f64::from(directions) / (1.0 - bias.sin())
}

#[test]
fn a_corner_seen_obliquely_is_what_the_equation_says() {
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::upright(0.0, 0.0, 50.0)]);
    let camera = parallel(DVec3::new(3.0, 3.0, 0.0), DVec3::new(-1.0, -1.0, 0.0), (146, 160), 64.0);
    let seen = see(&scene, camera, 1.0, &Settings::default());
    for bias in [0.0, FRAC_PI_6] {
        let values = raw(&converged(bias), &seen.screen);
        for y in (82..150).step_by(6) {
            let row = &values[y * 146..][..146];
            let x = f64::from(seen.gbuffer[y * 146].position.x);
            let (found, expected) = (mean(row[65..81].iter().copied()), in_a_corner(x, 1.0, bias));
            assert!((found - expected).abs() < 0.012, "x = {x}, bias {bias}: {found} for {expected}");
        }
    }
}

#[test]
fn any_quality_has_the_same_mean() {
    common::any_quality_has_the_same_mean(Method::Hbao, 0.01);
}

#[test]
fn what_is_outside_the_picture_is_not_seen() {
    let (scene, camera) = common::beside_a_wall_that_is_not_seen();
    let seen = see(&scene, camera, 1.0, &truth());
    assert!(raw(&default(), &seen.screen).iter().all(|o| *o == 1.0));
    let truth = columns(&seen, &common::traced(&scene, &seen, &truth()));
    assert!(truth[0] < 0.75, "{}", truth[0]);
}

#[test]
fn what_is_hidden_is_not_seen() {
    // Under a table top, out of reach, stands a wall beside the visible floor.
    let table = [Shape::level(0.0, -50.0, 50.0), Shape::level(1.5, -50.0, 0.0)];
    let with_wall = Scene([table.as_slice(), &[Shape::upright(0.0, 0.0, 1.5)]].concat());
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (40, 20), 20.0);
    let seen = see(&with_wall, camera, 1.0, &truth());
    assert!(raw(&default(), &seen.screen).iter().all(|o| *o == 1.0));
    let truth = columns(&seen, &common::traced(&with_wall, &seen, &truth()));
    assert!(truth[20] < 0.75, "{}", truth[20]);
}

#[test]
fn a_thin_sheet_in_front_darkens_like_a_block() {
    // From above a sheet at half the radius looks like a block of that height, though light comes in under it.
    let floor = Shape::level(0.0, -50.0, 50.0);
    let sheet = Scene(vec![floor, Shape::level(0.5, -50.0, 0.0)]);
    let block = Scene(vec![floor, Shape::level(0.5, -50.0, 0.0), Shape::upright(0.0, 0.0, 0.5)]);
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (40, 20), 20.0);
    let of = |scene| {
        let seen = see(scene, camera, 1.0, &truth());
        (raw(&default(), &seen.screen), columns(&seen, &common::traced(scene, &seen, &truth()))[20])
    };
    let ((of_sheet, true_sheet), (of_block, true_block)) = (of(&sheet), of(&block));
    assert_eq!(of_sheet, of_block);
    assert!(of_sheet[10 * 40 + 20] < 0.9 && true_sheet > true_block + 0.1, "{true_sheet} {true_block}");
}

#[test]
fn the_filter_keeps_constants_and_stops_at_edges_of_depth() {
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::level(1.0, -50.0, 0.0)]);
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (40, 20), 20.0);
    let seen = see(&scene, camera, 1.0, &Settings::default());
    let filter = |values: &[f32]| default().filter(&seen.screen, values, &Control::default()).unwrap();
    assert!(filter(&[0.25; 800]).iter().all(|o| (o - 0.25).abs() < 1e-6));
    // Dark on the step only: the floor stays as it is.
    let halves: Vec<f32> = (0..800).map(|i| if i % 40 < 20 { 0.2 } else { 0.9 }).collect();
    assert!(filter(&halves).iter().zip(&halves).all(|(a, b)| (a - b).abs() < 1e-6));
    // On a level a single dark pixel spreads: its weight is 1/Σ², Σ = Σ 2^(−2 r²/9) over r = −3..3.
    let mut dot = vec![1.0; 800];
    dot[10 * 40 + 30] = 0.0;
    let sum: f64 = (-3..=3).map(|r: i32| (-2.0 * f64::from(r * r) / 9.0).exp2()).sum();
    let centre = f64::from(filter(&dot)[10 * 40 + 30]);
    assert!((centre - (1.0 - 1.0 / (sum * sum))).abs() < 1e-5, "{centre}");
}

#[test]
fn threads_change_nothing_and_work_can_be_stopped() {
    common::threads_change_nothing_and_work_can_be_stopped(&default());
}

#[test]
fn where_nothing_is_seen_it_is_open() {
    common::where_nothing_is_seen_it_is_open(&default());
}
