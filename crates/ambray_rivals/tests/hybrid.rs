//! The hybrid against tracing every ray, and what it saves.

mod common;

use ambray_core::{
    control::{Cancelled, Control},
    gather::GatherParams,
    openness::Openness,
    sampling::SampleSets,
    settings::{ScreenQuality, Settings},
};
use ambray_rivals::{Hbao, Hybrid, HybridEstimate};
use common::{Scene, Seen, Shape, mean, parallel, perspective, rays, see, traced};
use glam::{DVec3, Vec3};

const DOWN: DVec3 = DVec3::NEG_Y;

fn settings() -> Settings {
    Settings { spp: 64, ..rays() }
}

fn estimate(hybrid: &Hybrid, scene: &Scene, seen: &Seen, control: &Control<'_>) -> HybridEstimate {
    let settings = settings();
    let samples = SampleSets::of(&settings);
    let params = GatherParams::new(&settings, &seen.view, &samples);
    hybrid.estimate(&seen.screen, &seen.gbuffer, scene, &params, control).unwrap()
}

fn default(scene: &Scene, seen: &Seen) -> HybridEstimate {
    estimate(&Hybrid::of(&settings()), scene, seen, &Control::default())
}

fn with_thickness(thickness: f32, scene: &Scene, seen: &Seen) -> HybridEstimate {
    let hybrid = Hybrid { thickness, ..Hybrid::of(&settings()) };
    estimate(&hybrid, scene, seen, &Control::default())
}

/// Share of the rays that were traced.
fn share(estimate: &HybridEstimate) -> f64 {
    mean(estimate.rays.iter().map(|rays| *rays as f32)) / f64::from(settings().spp)
}

/// Mean and largest difference.
fn difference(a: &[f32], b: &[f32]) -> (f64, f64) {
    let apart = |(a, b): (&f32, &f32)| f64::from((a - b).abs());
    let sum: f64 = a.iter().zip(b).map(apart).sum();
    (sum / a.len() as f64, a.iter().zip(b).map(apart).fold(0.0, f64::max))
}

#[test]
fn where_the_picture_shows_nothing_else_it_is_plain_ray_tracing() {
    // A picture of one pixel, a thousandth of the radius: every ray leaves it.
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::upright(0.0, 0.0, 50.0)]);
    let camera = parallel(DVec3::new(0.3, 5.0, 0.0), DOWN, (1, 1), 1000.0);
    let mut seen = see(&scene, camera, 1.0, &settings());
    // A normal map: some directions are below the horizon and have no ray.
    seen.gbuffer[0].shading_normal = Vec3::new(0.6, 0.8, 0.0);
    let found = default(&scene, &seen);
    assert_eq!(found.openness, traced(&scene, &seen, &settings()));
    assert!((50..64).contains(&found.rays[0]), "{:?}", found.rays);
}

#[test]
fn an_open_plane_needs_no_rays_away_from_the_border() {
    let floor = Scene(vec![Shape::level(0.0, -50.0, 50.0)]);
    let cameras = [
        parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (60, 50), 16.0),
        parallel(DVec3::new(0.0, 5.0, 0.0), DVec3::new(2.0, -1.0, 0.5), (60, 50), 16.0),
        perspective(DVec3::new(0.0, 2.0, 0.0), DVec3::new(1.0, 0.0, 1.0), (60, 50)),
    ];
    for camera in cameras {
        let seen = see(&floor, camera, 1.0, &settings());
        let found = default(&floor, &seen);
        assert!(found.openness.iter().all(|o| *o == 1.0));
        assert_eq!(found.rays[25 * 60 + 30], 0);
        assert!(found.rays[0] > 16);
    }
}

#[test]
fn a_corner_in_full_view_is_found_in_the_depth_buffer() {
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::upright(0.0, 0.0, 50.0)]);
    let cameras = [
        parallel(DVec3::new(3.0, 3.0, 0.0), DVec3::new(-1.0, -1.0, 0.0), (120, 120), 32.0),
        perspective(DVec3::new(2.5, 2.5, 0.5), DVec3::ZERO, (120, 120)),
    ];
    for camera in cameras {
        let seen = see(&scene, camera, 1.0, &settings());
        let (found, truth) = (default(&scene, &seen), traced(&scene, &seen, &settings()));
        let (apart, most) = difference(&found.openness, &truth);
        // The planes are met exactly: only steps over pixels of the other side of the corner are left.
        assert!(apart < 1e-3 && most < 0.02, "{apart} {most}");
        // In the middle, farther than the radius from the border, everything is known but where the planes meet.
        assert_eq!((found.rays[60 * 120 + 60], found.rays[63 * 120 + 60]), (64, 0));
        assert!(share(&found) < 0.35, "{}", share(&found));
        assert!(truth[63 * 120 + 60] < 0.8, "{}", truth[63 * 120 + 60]);
    }
}

#[test]
fn what_is_outside_the_picture_is_traced() {
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::upright(0.0, 0.0, 50.0)]);
    let camera = parallel(DVec3::new(0.9, 5.0, 0.0), DOWN, (32, 40), 20.0);
    let seen = see(&scene, camera, 1.0, &settings());
    let (found, truth) = (default(&scene, &seen), traced(&scene, &seen, &settings()));
    assert_eq!(difference(&found.openness, &truth).1, 0.0);
    assert!(truth[20 * 32] < 0.75 && share(&found) < 0.8, "{} {}", truth[20 * 32], share(&found));
    let hbao = Hbao::of(&settings()).estimate(&seen.screen, &Control::default()).unwrap();
    assert_eq!(hbao[20 * 32], 1.0);
}

#[test]
fn what_is_hidden_is_traced() {
    // Under a table top stands a wall beside the visible floor.
    let table = [Shape::level(0.0, -50.0, 50.0), Shape::level(1.5, -50.0, 0.0)];
    let scene = Scene([table.as_slice(), &[Shape::upright(0.0, 0.0, 1.5)]].concat());
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (80, 60), 20.0);
    let seen = see(&scene, camera, 1.0, &settings());
    let (found, truth) = (default(&scene, &seen), traced(&scene, &seen, &settings()));
    let (apart, most) = difference(&found.openness, &truth);
    assert!(apart < 1e-4 && most < 0.01, "{apart} {most}");
    assert!(truth[30 * 80 + 40] < 0.75 && share(&found) < 0.5, "{}", share(&found));
    let hbao = Hbao::of(&settings()).estimate(&seen.screen, &Control::default()).unwrap();
    assert_eq!(hbao[30 * 80 + 40], 1.0);
}

#[test]
fn thickness_decides_between_a_sheet_and_a_block() {
    // Seen from above, a sheet over the floor and a block of that height are the same picture.
    let floor = Shape::level(0.0, -50.0, 50.0);
    let sheet = Scene(vec![floor, Shape::level(0.5, -50.0, 0.0)]);
    let block = Scene(vec![floor, Shape::level(0.5, -50.0, 0.0), Shape::upright(0.0, 0.0, 0.5)]);
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (80, 60), 20.0);
    let (seen_sheet, seen_block) =
        (see(&sheet, camera, 1.0, &settings()), see(&block, camera, 1.0, &settings()));
    let true_sheet = traced(&sheet, &seen_sheet, &settings());
    let true_block = traced(&block, &seen_block, &settings());
    assert!(true_sheet[30 * 80 + 42] > true_block[30 * 80 + 42] + 0.1);
    // Nothing is thick: whatever passes behind the edge is traced. What is left is a ray of the 64 that goes in under the sheet
    // and through it within a step.
    let (apart, most) = difference(&with_thickness(0.0, &sheet, &seen_sheet).openness, &true_sheet);
    assert!(apart < 1e-3 && most < 1.1 / 64.0, "{apart} {most}");
    // Everything is: the sheet is a block, for rays that stay in the picture.
    let thick = with_thickness(10.0, &sheet, &seen_sheet);
    let rows = 20 * 80..40 * 80;
    let (apart, most) = difference(&thick.openness[rows.clone()], &true_block[rows]);
    assert!(apart < 5e-4 && most < 0.01, "{apart} {most}");
    assert_eq!(thick.rays[30 * 80 + 42], 0);
    // A part of the height: in between. By default nothing is thick.
    let found = with_thickness(0.25, &sheet, &seen_sheet).openness[30 * 80 + 42];
    assert!(found < true_sheet[30 * 80 + 42] && found > true_block[30 * 80 + 42], "{found}");
    assert_eq!(default(&sheet, &seen_sheet), with_thickness(0.0, &sheet, &seen_sheet));
}

#[test]
fn any_quality_is_close_to_ray_tracing_with_a_fraction_of_the_rays() {
    let ball = Shape::Sphere(DVec3::new(0.0, 0.5, 0.0), 0.5);
    let scene = Scene(vec![Shape::level(0.0, -50.0, 50.0), ball, Shape::upright(-1.0, 0.0, 50.0)]);
    let camera = perspective(DVec3::new(2.0, 1.5, 1.0), DVec3::new(0.0, 0.3, 0.0), (96, 64));
    let seen = see(&scene, camera, 0.8, &settings());
    let truth = traced(&scene, &seen, &settings());
    for &screen_quality in ScreenQuality::ALL {
        let hybrid = Hybrid::of(&Settings { screen_quality, ..settings() });
        let found = estimate(&hybrid, &scene, &seen, &Control::default());
        let bias = mean(found.openness.iter().copied()) - mean(truth.iter().copied());
        let (apart, _) = difference(&found.openness, &truth);
        assert!(bias.abs() < 5e-4 && apart < 1e-3, "{screen_quality}: {bias} {apart}");
        assert!(share(&found) < 0.4, "{screen_quality}: {}", share(&found));
    }
}

#[test]
fn rays_without_an_end_are_followed_too() {
    let scene = Scene(vec![Shape::level(0.0, 0.0, 50.0), Shape::upright(0.0, 0.0, 50.0)]);
    let cameras = [
        parallel(DVec3::new(3.0, 3.0, 0.0), DVec3::new(-1.0, -1.0, 0.0), (80, 80), 20.0),
        perspective(DVec3::new(2.5, 2.5, 0.5), DVec3::ZERO, (80, 80)),
    ];
    for camera in cameras {
        let mut seen = see(&scene, camera, 1.0, &settings());
        seen.view.openness = Openness::Exponential { sigma: 1.0 };
        let (found, truth) = (default(&scene, &seen), traced(&scene, &seen, &settings()));
        let (apart, most) = difference(&found.openness, &truth);
        assert!(apart < 2e-3 && most < 0.03, "{apart} {most}");
        assert!(share(&found) < 0.9, "{}", share(&found));
    }
}

#[test]
fn threads_change_nothing_and_work_can_be_stopped() {
    let scene = Scene(vec![Shape::level(0.0, -50.0, 50.0), Shape::Sphere(DVec3::new(0.0, 0.5, 0.0), 0.5)]);
    let camera = perspective(DVec3::new(2.0, 1.5, 1.0), DVec3::ZERO, (48, 32));
    let seen = see(&scene, camera, 0.8, &settings());
    common::same_bits_for_any_threads(|control| {
        estimate(&Hybrid::of(&settings()), &scene, &seen, control).openness
    });
    let cancel = true.into();
    let control = Control { cancel: &cancel, ..Control::default() };
    let (settings, hybrid) = (settings(), Hybrid::of(&settings()));
    let samples = SampleSets::of(&settings);
    let params = GatherParams::new(&settings, &seen.view, &samples);
    let stopped = hybrid.estimate(&seen.screen, &seen.gbuffer, &scene, &params, &control);
    assert_eq!(stopped, Err(Cancelled));
}

#[test]
fn where_nothing_is_seen_it_is_open_without_rays() {
    let scene = Scene(vec![Shape::Sphere(DVec3::ZERO, 0.5)]);
    let camera = parallel(DVec3::new(0.0, 5.0, 0.0), DOWN, (24, 24), 12.0);
    let seen = see(&scene, camera, 0.5, &settings());
    let found = default(&scene, &seen);
    assert_eq!((found.openness[0], found.rays[0]), (1.0, 0));
    // A ball does not block itself.
    assert!(mean(found.openness.iter().copied()) > 0.995);
}

#[test]
fn a_fin_seen_at_a_glancing_angle_ends_where_it_ends() {
    // Seen from 8° off its plane, a fin 0.4 high is 1.1 pixels wide. What passes over it up to a height of
    // 0.1/tan 8° = 0.71 goes through its plane in the same pixels.
    let scene = Scene(vec![Shape::level(0.0, -50.0, 50.0), Shape::upright(0.0, 0.0, 0.4)]);
    let forward = DVec3::new(-(8.0_f64.to_radians().tan()), -1.0, 0.0);
    for shift in [0.0, 0.013, 0.031, 0.044] {
        let camera = parallel(DVec3::new(shift, 5.0, 0.0) - 0.4 * forward, forward, (80, 60), 20.0);
        let seen = see(&scene, camera, 1.0, &settings());
        let truth = traced(&scene, &seen, &settings());
        // Steps small enough not to pass behind the fin within one.
        let ultra = Hybrid::of(&Settings { screen_quality: ScreenQuality::Ultra, ..settings() });
        let found = estimate(&ultra, &scene, &seen, &Control::default());
        let (apart, most) = difference(&found.openness, &truth);
        assert!(apart < 2.5e-3 && most < 0.045, "{shift}: {apart} {most}");
        assert!(share(&found) < 0.4, "{shift}: {}", share(&found));
    }
}

#[test]
fn pleats_about_as_fine_as_pixels_block_no_more_than_they_do() {
    // A curtain of pleats over a floor, one and a half pixels wide and deeper than that, seen from the side.
    let pleat = |i: i32| {
        let (x, side) = (0.03 * f64::from(i), f64::from(i.rem_euclid(2)));
        let (near, far) = (DVec3::new(x, 0.0, 0.1 * side), DVec3::new(0.03, 0.0, 0.1 * (1.0 - 2.0 * side)));
        Shape::Rectangle(near, far, DVec3::new(0.0, 2.0, 0.0))
    };
    let mut shapes: Vec<Shape> = (-60..60).map(pleat).collect();
    shapes.push(Shape::level(0.0, -50.0, 50.0));
    let scene = Scene(shapes);
    let camera = perspective(DVec3::new(3.0, 1.2, 2.0), DVec3::new(0.0, 0.8, 0.0), (96, 64));
    let seen = see(&scene, camera, 1.0, &settings());
    let (found, truth) = (default(&scene, &seen), traced(&scene, &seen, &settings()));
    let (apart, most) = difference(&found.openness, &truth);
    // The flanks are met where they are, or not at all: their planes, which reach far beyond them, make 0.009 and 0.17.
    assert!(apart < 2e-4 && most < 0.02, "{apart} {most}");
    assert!(share(&found) < 0.4, "{}", share(&found));
}
