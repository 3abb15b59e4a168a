//! The filter against golden values, and its promise: on a flat signal the interleaved pattern vanishes (spec §7).

mod common;

use ambray_core::{
    filter::{Filter, Guide},
    sampling::sample_class,
    settings::{FilterTest, Settings, Window},
};
use common::{golden, list, number, vec3};
use glam::{Vec3, Vec4};

fn run(filter: &Filter, guides: &[Guide], width: usize, input: &[Vec4]) -> Vec<Vec4> {
    let mut output = vec![Vec4::NAN; input.len()];
    for (y, row) in output.chunks_mut(width).enumerate() {
        filter.filter_row(guides, width, y, [input], [row]);
    }
    output
}

fn settings(window: Window) -> Settings {
    Settings { filter: window, ..Settings::default() }
}

#[test]
fn golden_pictures() {
    let file = golden("filter");
    let flat = |name: &str| list(&file[name]).iter().flat_map(list).cloned().collect::<Vec<_>>();
    let (z, pixel) = (number(&file["z"]) as f32, number(&file["pixel_size"]) as f32);
    let guides: Vec<Guide> = flat("position")
        .iter()
        .zip(flat("normal"))
        .map(|(p, n)| Guide { position: vec3(p), depth: z, normal: vec3(&n), footprint: z * pixel })
        .collect();
    let input: Vec<Vec4> = flat("image").iter().map(|v| Vec4::splat(number(v) as f32)).collect();
    for (name, window) in [("box", Window::Box), ("centred", Window::Centred)] {
        let settings = Settings {
            filter_plane: number(&file["tau"]) as f32,
            filter_cos_normal: number(&file["cos_normal"]) as f32,
            ..settings(window)
        };
        let output = run(&Filter::from(&settings), &guides, 8, &input);
        for (i, (value, expected)) in output.iter().zip(flat(name)).enumerate() {
            let error = (f64::from(value.x) - number(&expected)).abs();
            assert!(error < 2e-6 && value.x == value.w, "{name}, pixel {i}: {value} for {expected}");
        }
    }
}

const PLANE: Guide = Guide { position: Vec3::ZERO, depth: 1.0, normal: Vec3::Y, footprint: 0.1 };

#[test]
fn pattern_vanishes_on_a_plane() {
    let (width, height) = (24, 20);
    let pattern: Vec<Vec4> = (0..width * height)
        .map(|i| Vec4::splat(f32::from(sample_class((i % width) as u32, (i / width) as u32)).powi(2)))
        .collect();
    let mean = (0..16).map(|k| (k * k) as f32).sum::<f32>() / 16.0;
    for window in [Window::Box, Window::Centred] {
        let output = run(&Filter::from(&settings(window)), &vec![PLANE; width * height], width, &pattern);
        for (x, y) in (2..width - 2).flat_map(|x| (2..height - 2).map(move |y| (x, y))) {
            assert!((output[y * width + x].x - mean).abs() < 1e-4, "{window:?} at {x}, {y}");
        }
    }
}

#[test]
fn tests_accept_and_refuse() {
    let filter = |test| Filter::from(&Settings { filter_test: test, ..settings(Window::Centred) });
    let at = |position: Vec3, depth: f32| Guide { position, depth, ..PLANE };
    let (beside, above, behind) = (at(Vec3::X, 1.0), at(Vec3::Y * 0.11, 1.0), at(Vec3::X, 1.2));
    let turned = Guide { normal: Vec3::X, ..PLANE };
    for (test, accepts_above, accepts_behind) in [
        (FilterTest::Plane, false, true),
        (FilterTest::Absolute, true, false),
        (FilterTest::Relative, true, false),
        (FilterTest::None, true, true),
    ] {
        let filter = filter(test);
        assert!(filter.accepts(&PLANE, &beside), "{test:?}");
        assert!(!filter.accepts(&PLANE, &turned), "{test:?}");
        assert_eq!(filter.accepts(&PLANE, &above), accepts_above, "{test:?}");
        assert_eq!(filter.accepts(&PLANE, &behind), accepts_behind, "{test:?}");
    }
    let all = Filter::from(&Settings { filter_cos_normal: -1.0, ..settings(Window::Centred) });
    assert!(all.accepts(&PLANE, &Guide { normal: Vec3::NEG_Y, ..PLANE }));
}

#[test]
fn sky_is_neither_read_nor_written() {
    let mut guides = vec![PLANE; 64];
    let mut input = vec![Vec4::splat(0.5); 64];
    for i in (0..64).filter(|i| i % 8 > 4) {
        (guides[i], input[i]) = (Guide::NOTHING, Vec4::splat(9.0));
    }
    let output = run(&Filter::from(&settings(Window::Centred)), &guides, 8, &input);
    assert_eq!(output, input);
}
