//! A backend under odd demands: none of them makes a difference to the next frame.

mod common;
#[path = "common/scenes.rs"]
mod scenes;

use std::sync::{
    Arc, Mutex,
    atomic::{AtomicBool, Ordering},
};

use ambray_core::{
    control::Control,
    frame::Frame,
    query::QueryPoint,
    settings::{NearRadiance, RadianceSource, Sampling, Settings, Thin},
};
use ambray_scene::Scene;
use ambray_vulkan::{Context, TraceMode, VulkanBackend, VulkanError, VulkanOptions};
use common::{assert_valid, context};
use glam::Vec3;
use scenes::{assert_same, room, view};

fn open(context: &Arc<Context>, scene: Scene, trace: TraceMode) -> VulkanBackend {
    let options = VulkanOptions { trace, ..VulkanOptions::default() };
    VulkanBackend::new(context, &Arc::new(scene), options, &Control::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Ways to trace that the device has.
fn modes(context: &Context) -> Vec<TraceMode> {
    let modes = [(context.has_pipelines(), TraceMode::Pipeline), (context.has_queries(), TraceMode::Query)];
    modes.into_iter().filter(|(has, _)| *has).map(|(_, mode)| mode).collect()
}

fn render(backend: &VulkanBackend, settings: &Settings, width: u32, height: u32) -> Frame {
    let frame = backend.render(settings, &view(settings, width, height), Control::default());
    frame.unwrap_or_else(|error| panic!("{error}"))
}

fn points() -> Vec<QueryPoint> {
    let at = |i: u8| Vec3::new(f32::from(i) * 0.1 - 0.8, 0.0, 0.3);
    (0..16).map(|i| QueryPoint { position: at(i), normal: Vec3::Y, class: i }).collect()
}

#[test]
fn cancelled_frames_leave_a_sound_backend() {
    let Some(context) = context() else { return };
    for mode in modes(&context) {
        let backend = open(&context, room(3), mode);
        let settings = Settings { spp: 4, ..Settings::default() };
        let view = view(&settings, 48, 32);
        let expected = render(&backend, &settings, 48, 32);
        backend.limit_submissions(600);
        for stop_after in [0, 1, 3] {
            let (cancel, calls) = (AtomicBool::new(false), Mutex::new(Vec::new()));
            let progress = |share: f32| {
                let mut calls = calls.lock().unwrap();
                calls.push(share);
                cancel.store(calls.len() > stop_after, Ordering::Relaxed);
            };
            let control = Control { progress: &progress, cancel: &cancel, threads: 0 };
            let stopped = backend.render(&settings, &view, control);
            assert!(matches!(stopped, Err(VulkanError::Cancelled(_))), "{mode:?}");
            let calls = calls.into_inner().unwrap();
            assert_eq!(calls.len(), stop_after + 1, "{mode:?}");
            assert!(calls.last().is_some_and(|&share| share < 1.0), "{mode:?}: {calls:?}");
        }
        let cancel = AtomicBool::new(true);
        let control = Control { cancel: &cancel, ..Control::default() };
        assert!(matches!(
            backend.query(&settings, &view, &points(), control),
            Err(VulkanError::Cancelled(_))
        ));
        assert_same(&render(&backend, &settings, 48, 32), &expected, "the next frame");
    }
    assert_valid(&context);
}

#[test]
fn frames_too_large_for_the_memory_are_errors() {
    let Some(context) = context() else { return };
    let backend = open(&context, room(1), TraceMode::Auto);
    let settings = Settings { spp: 1, ..Settings::default() };
    let expected = render(&backend, &settings, 16, 16);
    let live = context.live();
    for _ in 0..2 {
        let error =
            backend.render(&settings, &view(&settings, 60_000, 60_000), Control::default()).unwrap_err();
        assert!(matches!(error, VulkanError::OutOfMemory { .. } | VulkanError::Limit { .. }), "{error:?}");
        let text = error.to_string();
        assert!(!text.contains('\n') && text.contains("memory"), "{text}");
        assert_same(&render(&backend, &settings, 16, 16), &expected, "the next frame");
    }
    assert_eq!(context.live(), live);
    assert_valid(&context);
}

#[test]
fn nothing_to_see() {
    let Some(context) = context() else { return };
    for mode in modes(&context) {
        let backend = open(&context, Scene::default(), mode);
        let settings = Settings { thin: Thin::Sheet, ..Settings::default() };
        let frame = render(&backend, &settings, 20, 10);
        let view = view(&settings, 1, 1);
        assert!(frame.beauty.iter().all(|&v| v == view.background), "{mode:?}");
        assert!(frame.gbuffer.iter().all(|pixel| !pixel.is_surface()));
        let open = backend.query(&settings, &view, &points(), Control::default()).unwrap();
        assert!(open.iter().all(|r| r.openness == 1.0 && r.near_radiance == Vec3::ZERO), "{mode:?}");
    }
    assert_valid(&context);
}

#[test]
fn one_pixel_and_no_points() {
    let Some(context) = context() else { return };
    for mode in modes(&context) {
        let backend = open(&context, room(2), mode);
        let settings = Settings::default();
        let frame = render(&backend, &settings, 1, 1);
        assert!(frame.gbuffer[0].is_surface() && frame.beauty[0].is_finite(), "{mode:?}");
        let view = view(&settings, 1, 1);
        assert_eq!(backend.query(&settings, &view, &[], Control::default()).unwrap(), []);
        assert_eq!(backend.closest_hits(&[]).unwrap(), []);
        assert_eq!(backend.any_hits(&[]).unwrap(), [false; 0]);
        assert_eq!(backend.query(&settings, &view, &points()[..1], Control::default()).unwrap().len(), 1);
    }
    assert_valid(&context);
}

#[test]
fn threads_take_turns() {
    let Some(context) = context() else { return };
    let backend = open(&context, room(3), TraceMode::Auto);
    let settings = |i: u32| Settings { spp: 1 + i, seed: i, ..Settings::default() };
    let expected: Vec<_> = (0..4).map(|i| render(&backend, &settings(i), 16 + 4 * i, 12)).collect();
    let view = view(&settings(0), 8, 8);
    let lit = backend.query(&settings(0), &view, &points(), Control::default()).unwrap();
    std::thread::scope(|scope| {
        for thread in 0..4 {
            let (backend, expected, lit, view) = (&backend, &expected, &lit, &view);
            scope.spawn(move || {
                for round in 0..6 {
                    let i = (thread + round) % 4;
                    let frame = render(backend, &settings(i), 16 + 4 * i, 12);
                    assert_same(&frame, &expected[i as usize], "a frame of a thread");
                    let results = backend.query(&settings(0), view, &points(), Control::default()).unwrap();
                    assert_eq!(results, *lit);
                }
            });
        }
    });
    assert_valid(&context);
}

/// Both ways to trace give the same bits on software devices, for any number of rays.
#[test]
fn any_number_of_rays() {
    let Some(context) = context() else { return };
    let backends: Vec<_> = modes(&context).into_iter().map(|mode| open(&context, room(2), mode)).collect();
    for (i, spp) in [1, 3, 7, 64].into_iter().enumerate() {
        let settings = Settings {
            spp,
            thin: Thin::ALL[i % Thin::ALL.len()],
            sampling: Sampling::ALL[i % Sampling::ALL.len()],
            radiance_source: RadianceSource::ALL[i % RadianceSource::ALL.len()],
            near_radiance: NearRadiance::ALL[i % NearRadiance::ALL.len()],
            ..Settings::default()
        };
        let frames: Vec<_> = backends.iter().map(|backend| render(backend, &settings, 13, 9)).collect();
        for frame in &frames {
            let surfaces = frame.gbuffer.iter().filter(|pixel| pixel.is_surface()).count() as u64;
            let rays = frame.stats.rays;
            // Rays below the horizon of a surface are not traced.
            assert!(
                rays.ambient <= surfaces * u64::from(spp)
                    && rays.ambient * 10 > surfaces * u64::from(spp) * 9
            );
            assert!(frame.ambient.iter().all(|v| v.is_finite() && (0.0..=1.0).contains(&v.x)));
            if is_software(&context) {
                assert_same(frame, &frames[0], &format!("{spp} rays"));
            }
        }
    }
    assert_valid(&context);
}

/// A frame that is cut into many submissions, of bands or of parts of rows.
#[test]
fn submissions_make_no_difference() {
    let Some(context) = context() else { return };
    for mode in modes(&context) {
        let settings = Settings { spp: 4, thin: Thin::Sheet, ..Settings::default() };
        let whole = open(&context, room(3), mode);
        let (frame, points) = (render(&whole, &settings, 61, 37), points());
        let view = view(&settings, 61, 37);
        let results = whole.query(&settings, &view, &points, Control::default()).unwrap();
        for rays in [1, 100, 5000, 100_000] {
            let count = Mutex::new(0);
            let progress = |_: f32| *count.lock().unwrap() += 1;
            let control = Control { progress: &progress, ..Control::default() };
            whole.limit_submissions(rays);
            // One ray a submission would take thousands.
            let (width, height) = if rays == 1 { (5, 3) } else { (61, 37) };
            let expected = if rays == 1 { None } else { Some(&frame) };
            let small = scenes::view(&settings, width, height);
            let cut = whole.render(&settings, &small, control).unwrap();
            if let Some(expected) = expected {
                assert_same(&cut, expected, &format!("{mode:?}, {rays} rays a submission"));
            } else {
                whole.limit_submissions(u64::MAX);
                assert_same(&cut, &render(&whole, &settings, width, height), "single pixels");
                whole.limit_submissions(rays);
            }
            let submissions = count.into_inner().unwrap();
            assert!(rays == 100_000 || submissions > 3, "{submissions} submissions of {rays} rays");
            let cut = whole.query(&settings, &view, &points, Control::default()).unwrap();
            assert_eq!(cut, results, "{mode:?}, {rays} rays a submission");
        }
    }
    assert_valid(&context);
}

/// The pipeline's hit groups and callables against ray queries that choose by a switch.
#[test]
fn pipeline_and_queries_agree_on_the_atrium() {
    let Some(context) = context() else { return };
    let modes = modes(&context);
    if modes.len() < 2 || !is_software(&context) {
        eprintln!("skipped: the device has one way to trace, or rounds differently in both");
        return;
    }
    let atrium = ambray_scene::atrium::atrium();
    let camera = atrium.cameras[0].clone();
    let backends = modes.into_iter().map(|mode| open(&context, atrium.clone(), mode)).collect::<Vec<_>>();
    for (thin, source) in [(Thin::Sheet, RadianceSource::SelfSimilar), (Thin::Paper, RadianceSource::Lit)] {
        let settings = Settings { spp: 4, thin, radiance_source: source, ..Settings::default() };
        let mut view = view(&settings, 64, 36);
        view.camera = ambray_core::camera::Camera::new(
            camera.position,
            camera.forward,
            camera.up,
            camera.projection,
            64,
            36,
        );
        view.lights.clone_from(&atrium.lights);
        let [a, b] = [0, 1].map(|i| backends[i].render(&settings, &view, Control::default()).unwrap());
        assert!(a.gbuffer.iter().filter(|pixel| pixel.is_surface()).count() > 64 * 18);
        assert_same(&a, &b, &format!("{thin:?} {source:?}"));
    }
    assert_valid(&context);
}

fn is_software(context: &Context) -> bool {
    context.report().kind == ambray_vulkan::DeviceKind::Software
}
