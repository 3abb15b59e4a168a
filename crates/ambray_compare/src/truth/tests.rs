use ambray::{
    scene::{AlphaMode, atrium::atrium},
    settings::{Falloff, Size},
};

use super::*;

fn small() -> Settings {
    Settings { size: Size { width: 32, height: 18 }, ..Settings::default() }
}

#[test]
fn the_standard_error_is_what_truths_by_other_seeds_differ_by() {
    let mut renderer = Renderer::new(atrium());
    let content = Content::of(renderer.scene());
    let options = TruthOptions::default();
    let mut find = |seed| {
        let settings = Settings { seed, ..small() };
        Truth::find(&mut renderer, &content, &settings, &options, Control::default()).expect("renders")
    };
    let (a, b) = (find(0), find(100));
    assert!(a.about.is_reached() && a.about.spp >= 1024, "{:?}", a.about);
    // The difference of two independent truths has twice the variance of one.
    let between = ambray_metrics::rmse(&a.openness, &b.openness) / 2.0_f64.sqrt();
    let said = (a.about.standard_error.powi(2) / 2.0 + b.about.standard_error.powi(2) / 2.0).sqrt();
    assert!((0.7..1.4).contains(&(between / said)), "differ by {between}, said {said}");
}

#[test]
fn a_smaller_bound_takes_more_rays_up_to_a_limit() {
    let mut renderer = Renderer::new(atrium());
    let content = Content::of(renderer.scene());
    let mut find = |bound, most| {
        let options = TruthOptions { bound, most, cache: None };
        Truth::find(&mut renderer, &content, &small(), &options, Control::default()).expect("renders").about
    };
    let (rough, fine) = (find(0.01, 16_384), find(0.0012, 16_384));
    assert!(fine.spp > rough.spp && fine.is_reached(), "{rough:?} {fine:?}");
    let limited = find(1e-6, 2048);
    assert!(limited.spp == 2048 && !limited.is_reached(), "{limited:?}");
}

#[test]
fn what_was_found_once_is_read_the_next_time() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut renderer = Renderer::new(atrium());
    let content = Content::of(renderer.scene());
    let options = TruthOptions { cache: Some(folder.path().join("truths")), ..TruthOptions::default() };
    let mut find = |settings: &Settings| {
        Truth::find(&mut renderer, &content, settings, &options, Control::default()).expect("renders")
    };
    let first = find(&small());
    let again = find(&Settings { method: Method::Gtao, spp: 2, ..small() });
    assert!(!first.about.cached && again.about.cached);
    assert_eq!((&first.openness, &first.near), (&again.openness, &again.near));
    assert_eq!(first.about.standard_error, again.about.standard_error);
    let step = find(&Settings { method: Method::TracedStep, ..small() });
    assert!(!step.about.cached, "another falloff has another truth");
    assert_eq!(step.openness, find(&Settings { falloff: Falloff::Step, ..small() }).openness);
    // A damaged file is found again.
    for file in std::fs::read_dir(folder.path().join("truths")).expect("a folder") {
        std::fs::write(file.expect("a file").path(), b"not a picture").expect("written");
    }
    assert_eq!(find(&small()).openness, first.openness);
}

#[test]
fn the_truth_of_blended_surfaces_is_of_those_that_frames_see() {
    // Every other block of pixels sees a pane, the others the floor under it.
    let mut scene = atrium();
    for material in &mut scene.materials {
        material.alpha_mode = AlphaMode::Blend;
        material.base_color.w *= 0.5;
    }
    let mut renderer = Renderer::new(scene);
    let content = Content::of(renderer.scene());
    let options = TruthOptions::default();
    let settings = Settings { filter: Window::Off, sampling: Sampling::Random, ..small() };
    let truth =
        Truth::find(&mut renderer, &content, &settings, &options, Control::default()).expect("renders");
    let frame = renderer.render(&Settings { spp: 2048, ..settings }, Control::default()).expect("renders");
    let error = ambray_metrics::rmse(&crate::maps::raw(&frame), &truth.openness);
    assert!(truth.about.is_reached(), "{:?}", truth.about);
    assert!(error < 3.0 * truth.about.standard_error, "{error} with {:?}", truth.about);
}
