//! The visibility bitmask against the angles that its publication counts, and what its thickness is for.

mod common_gtao;

use std::f64::consts::{FRAC_PI_2, PI};

use ambray_core::{
    camera::Projection,
    settings::{Auto, Method, ScreenQuality, Settings},
};
use ambray_rivals::{Bitmask, Gtao, Screen, SliceSampling};
use common_gtao::{
    Shape, ball, camera, check_golden, cuboid, free, golden_screen, mean_around, openness_by_rays, pixel_of,
    plane, screen, with_one_and_two_threads,
};
use glam::{DVec3, dvec3};

const RADIUS: f64 = 5.0;

/// So many samples at full resolution that only the sectors are coarse.
const DENSE: SliceSampling =
    SliceSampling { slices: 8, steps: 96, distribution_power: 2.0, depth_mip_offset: 30.0 };

fn dense(thickness: f32) -> Bitmask {
    Bitmask { sampling: DENSE, thickness: Auto::Value(thickness), denoise_passes: 1 }
}

fn floor() -> Shape {
    plane(DVec3::ZERO, DVec3::Y, |_| true)
}

/// `shapes` from straight above, in parallel projection.
fn from_above(shapes: &[Shape]) -> Screen {
    let projection = Projection::Orthographic { height: 5.0 };
    let camera = camera(dvec3(0.0, 10.0, 0.0), DVec3::ZERO, projection, (100, 100));
    screen(camera, shapes, RADIUS as f32, &Settings::default())
}

/// Openness around the middle of the picture, whose pixel (50, 50) sees the floor 0.025 beside the origin.
fn found(bitmask: &Bitmask, screen: &Screen) -> f64 {
    f64::from(mean_around(screen, &bitmask.estimate(screen, &free()).unwrap(), (50, 50), 2))
}

/// Which way +x is in the picture, and so where the middle pixel is.
fn middle_x(screen: &Screen) -> f64 {
    0.025 * f64::from(screen.camera().right().x)
}

/// The published measure of a floor beside what spans `angles(a, reach)` of a slice that meets it at distance a, at
/// `distance` across, where samples end at `reach`: the mean over the slices of the share of their angles.
fn share_closed(distance: f64, angles: impl Fn(f64, f64) -> f64) -> f64 {
    const SLICES: u32 = 20_000;
    let of_slice = |i: u32| {
        let (sin, cos) = ((f64::from(i) + 0.5) / f64::from(SLICES) * FRAC_PI_2).sin_cos();
        // The picture is 5 wide and high.
        let reach = RADIUS.min(2.5 / sin).min(2.5 / cos);
        let along = distance / cos;
        if along < reach { angles(along, reach) / PI } else { 0.0 }
    };
    (0..SLICES).map(of_slice).sum::<f64>() / f64::from(SLICES)
}

/// A slab over the floor, from 0.5 to 1 across and 1 to 1.4 up.
const SLAB: (f64, f64, f64, f64) = (0.5, 1.0, 1.0, 1.4);

fn slab() -> [Shape; 2] {
    let (near, far, low, high) = SLAB;
    [floor(), cuboid(dvec3(near, low, -9.0), dvec3(far, high, 9.0))]
}

#[test]
fn infinite_thickness_makes_a_horizon() {
    // A block of height 0.8 from 0.6 on closes all below its edge: π/2 − atan(a/0.8) where the slice meets it at a.
    let screen = from_above(&[floor(), cuboid(dvec3(0.6, -1.0, -9.0), dvec3(9.0, 0.8, 9.0))]);
    let found = found(&dense(1e6), &screen);
    let expected = 1.0 - share_closed(0.6 - middle_x(&screen), |along, _| FRAC_PI_2 - (along / 0.8).atan());
    assert!((found - expected).abs() < 0.01, "{found} for {expected}");
}

#[test]
fn a_thin_slab_closes_its_own_angles_only() {
    let (near, far, low, high) = SLAB;
    let screen = from_above(&slab());
    let x = middle_x(&screen);
    let found = found(&dense((high - low) as f32), &screen);
    // From the front of its near edge to the back of its far one, or of where samples end.
    let expected = 1.0
        - share_closed(near - x, |along, reach| {
            let end = (along / (near - x) * (far - x)).min(reach);
            (end / low).atan() - (along / high).atan()
        });
    assert!((found - expected).abs() < 0.01, "{found} for {expected}");
}

#[test]
fn light_passes_under_a_slab_where_gtao_has_none() {
    let shapes = slab();
    let screen = from_above(&shapes);
    let (thin, thick) = (found(&dense(0.4), &screen), found(&dense(1e6), &screen));
    assert!(thin - thick > 0.15, "{thin}, and {thick} with infinite thickness");
    // GTAO cannot tell the slab from a block; rays, and the bitmask, can.
    let gtao = Gtao {
        sampling: DENSE,
        radius_multiplier: 1.0,
        falloff_range: 0.0,
        slope_correction: 0.0,
        final_power: 1.0,
        ..Gtao::of(&Settings::default())
    };
    let horizon = f64::from(mean_around(&screen, &gtao.estimate(&screen, &free()).unwrap(), (50, 50), 2));
    let point = dvec3(middle_x(&screen), 0.0, 0.0);
    let block = [floor(), cuboid(dvec3(0.5, -1.0, -9.0), dvec3(1.0, 1.4, 9.0))];
    let as_block = openness_by_rays(&block, point, DVec3::Y, 300);
    let truth = openness_by_rays(&shapes, point, DVec3::Y, 300);
    assert!((horizon - as_block).abs() < 0.01, "{horizon} for {as_block}");
    assert!(truth - horizon > 0.1, "{truth} by rays, {horizon} by GTAO");
}

#[test]
fn light_leaks_behind_what_is_thicker_than_the_thickness() {
    // The fault that the authors show in figure 6: of the block only its top is seen, 0.8 up, and it is taken for a sheet.
    let screen = from_above(&[floor(), cuboid(dvec3(0.6, -1.0, -9.0), dvec3(9.0, 0.8, 9.0))]);
    let (sheet, block) = (found(&dense(0.1), &screen), found(&dense(1e6), &screen));
    assert!(sheet - block > 0.05, "{sheet} and {block}");
}

#[test]
fn what_is_outside_the_picture_or_hidden_does_not_block() {
    let at = |shapes: &[Shape], point: DVec3| {
        let screen = from_above(shapes);
        let values = dense(0.5).estimate(&screen, &free()).unwrap();
        mean_around(&screen, &values, pixel_of(&screen, point), 1)
    };
    let point = dvec3(2.3, 0.0, 0.0);
    let outside = [floor(), cuboid(dvec3(2.6, 0.0, -9.0), dvec3(3.0, 2.0, 9.0))];
    assert_eq!(at(&outside, point), 1.0);
    assert!(openness_by_rays(&outside, point, DVec3::Y, 200) < 0.7);
    let hidden = || cuboid(dvec3(0.6, 0.0, -9.0), dvec3(0.8, 1.0, 9.0));
    let [floor, slab] = slab();
    let without = at(&[floor, slab], DVec3::ZERO);
    let [floor, slab] = self::slab();
    assert_eq!(at(&[floor, slab, hidden()], DVec3::ZERO), without);
}

#[test]
fn an_open_plane_is_open() {
    for position in [dvec3(0.0, 5.0, 0.0), dvec3(0.0, 3.0, 4.0)] {
        for projection in
            [Projection::Perspective { vertical_fov: 0.9 }, Projection::Orthographic { height: 4.0 }]
        {
            let camera = camera(position, DVec3::ZERO, projection, (96, 96));
            let screen = screen(camera, &[floor()], 1.0, &Settings::default());
            for screen_quality in ScreenQuality::ALL {
                let settings = Settings { screen_quality: *screen_quality, ..Settings::default() };
                let values = Bitmask::of(&settings).estimate(&screen, &free()).unwrap();
                let middle = mean_around(&screen, &values, (48, 48), 8);
                // Near samples lie beside their slice by part of a pixel, where an oblique plane is higher: that closes sectors at
                // its horizon, which count as much as others. Here 16 samples are within 22 pixels.
                let least = if position.z == 0.0 { 1.0 } else { 0.95 };
                assert!(middle >= least, "{middle} from {position} with {projection:?}");
            }
        }
    }
}

#[test]
fn every_quality_has_the_same_mean() {
    common_gtao::every_quality_has_the_same_mean(Method::Bitmask, 0.03);
}

#[test]
fn auto_thickness_is_a_quarter_of_the_radius() {
    let screen = ball(&Settings::default());
    let with = |thickness| {
        let bitmask = Bitmask { thickness, ..Bitmask::of(&Settings::default()) };
        bitmask.estimate(&screen, &free()).unwrap()
    };
    assert_eq!(with(Auto::Auto), with(Auto::Value(0.25)));
    assert_ne!(with(Auto::Auto), with(Auto::Value(0.1)));
}

#[test]
fn values_depend_on_frame_and_seed_but_not_on_threads() {
    let bitmask = Bitmask::of(&Settings::default());
    let screen = ball(&Settings::default());
    let [one, two] = with_one_and_two_threads(|| bitmask.estimate(&screen, &free()).unwrap());
    assert_eq!(one, two);
    assert!(one.iter().all(|value| (0.0..=1.0).contains(value)));
    for other in [Settings { frame: 1, ..Settings::default() }, Settings { seed: 1, ..Settings::default() }] {
        assert_ne!(bitmask.estimate(&ball(&other), &free()).unwrap(), one);
    }
}

#[test]
fn values_are_those_of_the_paper_written_out_in_another_language() {
    let screen = golden_screen();
    let bitmask = Bitmask::of(&Settings::default());
    let raw = bitmask.estimate(&screen, &free()).unwrap();
    check_golden(include_str!("golden/bitmask.csv"), &raw, &bitmask.filter(&screen, &raw, &free()).unwrap());
}
