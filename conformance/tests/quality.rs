//! Sponza meets the quality bars of spec §11, and the sampling modes stand in the measured order.

use ambray::{Control, Frame, Renderer};
use ambray_core::settings::{Sampling, Settings, Window};
use ambray_metrics::{Map, edges, flip, masked_rmse, pattern_left, psnr, rmse};
use conformance::{
    shared,
    views::{self, SPONZA, View},
};
use serde_json::Value;

/// Bars of `golden/quality.json`, kept with the goldens of the core.
fn bars() -> Value {
    let text = include_str!("../../crates/ambray_core/tests/golden/quality.json");
    serde_json::from_str(text).expect("the golden file is JSON")
}

fn render(renderer: &mut Renderer, settings: &Settings) -> Frame {
    renderer.render(settings, Control::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The truth: 1024 rays a pixel, an independent scramble in every pixel, no filter.
fn reference(renderer: &mut Renderer, view: &View) -> Map {
    let settings =
        Settings { spp: 1024, sampling: Sampling::Random, filter: Window::Off, seed: 7, ..view.settings() };
    views::openness(&render(renderer, &settings)).0
}

#[test]
fn sponza_meets_the_bars() {
    let Some(mut scene) = shared::load("Sponza/Sponza.gltf") else { return };
    views::remove_masked(&mut scene);
    let mut renderer = Renderer::new(scene);
    let bars = bars();
    let mut failures = Vec::new();
    for view in SPONZA {
        let truth = reference(&mut renderer, &view);
        let settings = view.settings();
        let frame = render(&mut renderer, &settings);
        let (raw, filtered) = views::openness(&frame);
        let filtered_truth = views::filtered(&truth, &frame, &settings);
        let edges = edges(&truth);
        let mut sampling_part =
            |settings: &Settings| rmse(&views::openness(&render(&mut renderer, settings)).1, &filtered_truth);
        let four = sampling_part(&Settings { spp: 4, ..settings.clone() });
        let interleaved = rmse(&filtered, &filtered_truth);
        // Plain Monte Carlo is the "random" of the bars; a good set per pixel lies between.
        let random = sampling_part(&Settings { sampling: Sampling::Independent, ..settings.clone() });
        let same = sampling_part(&Settings { sampling: Sampling::Same, ..settings.clone() });

        let bar = |group: &str, quantity: &str| bars[group][quantity][view.name].as_f64().expect("a bar");
        let eight = |quantity: &str| bar("bars_interleaved_8", quantity);
        let ratio = |name: &str| bars["bars_ratio"][name].as_f64().expect("a bar");
        let mean = bars["views"][view.name]["mean_openness"].as_f64().expect("a mean");
        let loss = bars["views"][view.name]["filter_loss"].as_f64().expect("a loss");
        let flat = masked_rmse(&filtered, &truth, |i| !edges[i]);
        let mut check = |name: &str, value: f64, low: f64, high: f64| {
            println!("{:8} {name:24} {value:8.4}   {low:8.4} to {high:.4}", view.name);
            if !(low..=high).contains(&value) {
                failures.push(format!("{} {name} {value:.4} is not in {low:.4} to {high:.4}", view.name));
            }
        };
        check("mean openness", truth.mean(), mean - 0.002, mean + 0.002);
        check("filter loss", rmse(&filtered_truth, &truth), 0.9 * loss, 1.1 * loss);
        check("raw rmse", rmse(&raw, &truth), 0.0, eight("raw_rmse"));
        check("filtered rmse", rmse(&filtered, &truth), 0.0, eight("filtered_rmse"));
        check("sampling part", interleaved, 0.0, eight("sampling_part"));
        check("flat rmse", flat, 0.0, eight("flat_rmse"));
        check("psnr", psnr(&filtered, &truth), eight("psnr_db_min"), f64::INFINITY);
        check("flip", flip(&truth, &filtered), 0.0, eight("flip"));
        check("sampling part, 4 spp", four, 0.0, bar("bars_interleaved_4", "sampling_part"));
        check("pattern raw", pattern_left(&raw, &truth, &edges), 100.0, f64::INFINITY);
        check("pattern filtered", pattern_left(&filtered, &filtered_truth, &edges), 0.0, 40.0);
        let worst = ratio("interleaved_over_random_sampling_part_max");
        check("interleaved / random", interleaved / random, 0.0, worst);
        check("same / random", same / random, ratio("same_over_random_sampling_part_min"), f64::INFINITY);
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
