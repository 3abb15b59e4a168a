//! Planes shown on the device have the bytes of those shown on the host, and the pictures behave.

mod common;
#[path = "common/moving.rs"]
mod moving;
#[path = "common/scenes.rs"]
mod scenes;

use std::{sync::Arc, thread};

use ambray_core::{
    aov::Aov,
    control::Control,
    display,
    frame::Frame,
    query::QueryPoint,
    settings::{Auto, RadianceSource, Ramp, Range, Settings, Temporal, Thin, ThinMinimum, ToneMap},
};
use ambray_scene::{Scene, atrium};
use ambray_vulkan::{Context, VulkanBackend, VulkanError, VulkanOptions, testing::picture_bytes};
use common::{assert_valid, context};
use glam::Vec3;
use scenes::{assert_same, room, view};

fn open(context: &Arc<Context>, scene: Scene) -> VulkanBackend {
    VulkanBackend::new(context, &Arc::new(scene), VulkanOptions::default(), &Control::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Draws, and copies the frame to the host.
fn draw(backend: &VulkanBackend, settings: &Settings, width: u32, height: u32) -> Frame {
    let drawn = backend.draw(settings, &view(settings, width, height), Control::default());
    let stats = drawn.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(stats.rays.primary, u64::from(width * height));
    backend.read().unwrap_or_else(|error| panic!("{error}"))
}

/// Bytes that were compared, and those that differed.
#[derive(Default)]
struct Tally {
    bytes: usize,
    different: usize,
}

impl Tally {
    /// Compares a plane of the drawn frame as the device and as the host show it, who has a copy.
    fn compare(&mut self, backend: &VulkanBackend, frame: &Frame, aov: Aov, settings: &Settings, what: &str) {
        let expected = display::show(frame, aov, settings).rgba8();
        let picture = backend.show(aov, settings).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(picture.size(), (frame.width, frame.height), "{what}");
        let actual = picture_bytes(backend.context(), &picture).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(actual.len(), expected.len(), "{what}");
        for (i, (a, b)) in actual.iter().zip(&expected).enumerate() {
            let pixel = (i / 4 % frame.width as usize, i / 4 / frame.width as usize);
            // The neighbour at most; a ramp may have other colours there.
            let is_near = a.abs_diff(*b) <= if settings.ramp == Ramp::Grey { 1 } else { 4 };
            assert!(is_near, "{what} {aov:?} {pixel:?}: {a} for {b}");
            self.different += usize::from(a != b);
        }
        self.bytes += actual.len();
    }

    fn finish(self) {
        let Self { bytes, different } = self;
        let share = different as f64 / bytes as f64;
        println!("{different} of {bytes} bytes differ: {:.4} %", 100.0 * share);
        assert!(share < 1e-3, "{different} of {bytes} bytes");
    }
}

/// Ways to show, each of which changes something.
fn shown() -> Vec<Settings> {
    let base = Settings::default();
    let range = |low: f32, high: f32| Auto::Value(Range([low, high]));
    vec![
        base.clone(),
        Settings { exposure: 1.5, tone_map: ToneMap::None, ..base.clone() },
        Settings { exposure: -3.0, ramp: Ramp::Viridis, ..base.clone() },
        Settings { exposure: 20.0, ramp: Ramp::Turbo, range: range(0.25, 3.0), ..base.clone() },
        Settings { exposure: 5.0, ramp: Ramp::Cividis, range: range(-1e38, 1e38), ..base.clone() },
        Settings { ramp: Ramp::Magma, ..base },
    ]
}

#[test]
fn every_plane_has_the_bytes_of_the_host() {
    let Some(context) = context() else { return };
    let mut tally = Tally::default();
    let drawn = [
        Settings::default(),
        Settings { radiance_source: RadianceSource::SelfSimilar, spp: 2, ..Settings::default() },
        Settings { thin: Thin::Sheet, thin_minimum: ThinMinimum::AfterFilter, ..Settings::default() },
    ];
    for (scene, sizes) in [(room(3), [(61, 37), (1, 1)]), (Scene::default(), [(16, 9), (3, 1)])] {
        let backend = open(&context, scene);
        for settings in &drawn {
            for (width, height) in sizes {
                let frame = draw(&backend, settings, width, height);
                for shown in shown() {
                    let what = format!("{width} x {height} {:?} {:?}", shown.ramp, shown.tone_map);
                    Aov::ALL.iter().for_each(|&aov| tally.compare(&backend, &frame, aov, &shown, &what));
                }
            }
        }
    }
    tally.finish();
    assert_valid(&context);
}

#[test]
fn the_atrium_has_the_bytes_of_the_host() {
    let Some(context) = context() else { return };
    let mut tally = Tally::default();
    let backend = open(&context, atrium::atrium());
    let frame = draw(&backend, &Settings { spp: 2, ..Settings::default() }, 640, 360);
    for shown in shown().iter().take(2) {
        Aov::ALL.iter().for_each(|&aov| tally.compare(&backend, &frame, aov, shown, "atrium"));
    }
    tally.finish();
    assert_valid(&context);
}

#[test]
fn accumulation_and_movement_are_shown() {
    let Some(context) = context() else { return };
    let scene = moving::scene(6);
    let mut backend = open(&context, scene.clone());
    let settings = Settings { temporal: Temporal::On, spp: 2, ..Settings::default() };
    let (mut tally, mut random) = (Tally::default(), moving::Random(3));
    for round in 0..3 {
        let pose = moving::pose(&scene, &mut random, 0.1);
        let [placed, _] = moving::posed(&scene, &pose);
        backend.pose(&placed, &pose, &Control::default()).unwrap_or_else(|error| panic!("{error}"));
        let frame = draw(&backend, &settings, 64, 36);
        for aov in [Aov::Motion, Aov::History, Aov::Beauty, Aov::BentNormal] {
            tally.compare(&backend, &frame, aov, &settings, &format!("frame {round}"));
        }
        let moves = frame.gbuffer.iter().any(|pixel| pixel.motion != glam::Vec2::ZERO);
        assert_eq!(moves, round > 0, "frame {round}");
    }
    tally.finish();
    assert_valid(&context);
}

#[test]
fn what_is_read_is_what_would_have_been_rendered() {
    let Some(context) = context() else { return };
    let backend = open(&context, room(3));
    for thin in Thin::ALL {
        let settings = Settings { thin: *thin, ..Settings::default() };
        let rendered = backend.render(&settings, &view(&settings, 48, 27), Control::default()).unwrap();
        let stats = backend.draw(&settings, &view(&settings, 48, 27), Control::default()).unwrap();
        assert_eq!(stats.rays, rendered.stats.rays, "sums of the device, {thin:?}");
        assert_same(&backend.read().unwrap(), &rendered, "the frame that was drawn");
        backend.show(Aov::Depth, &settings).unwrap();
        assert_same(&backend.read().unwrap(), &rendered, "the frame that was shown");
    }
    assert_valid(&context);
}

#[test]
fn nothing_is_shown_that_was_not_drawn() {
    let Some(context) = context() else { return };
    let backend = open(&context, room(1));
    let settings = Settings::default();
    let is_nothing = |backend: &VulkanBackend| {
        matches!(backend.show(Aov::Beauty, &settings), Err(VulkanError::NothingDrawn))
            && matches!(backend.read(), Err(VulkanError::NothingDrawn))
    };
    assert!(is_nothing(&backend), "no frame yet");
    draw(&backend, &settings, 16, 9);
    assert!(!is_nothing(&backend));
    let point = QueryPoint { position: Vec3::ZERO, normal: Vec3::Y, class: 0 };
    backend.query(&settings, &view(&settings, 16, 9), &[point], Control::default()).unwrap();
    assert!(is_nothing(&backend), "points were in the planes");
    draw(&backend, &settings, 16, 9);
    let cancel = true.into();
    let control = Control { cancel: &cancel, ..Control::default() };
    assert!(backend.draw(&settings, &view(&settings, 16, 9), control).is_err());
    assert!(is_nothing(&backend), "half a frame");
    assert_valid(&context);
}

#[test]
fn pictures_are_painted_again_when_they_are_given_back() {
    let Some(context) = context() else { return };
    let empty = context.live();
    let backend = open(&context, room(1));
    let settings = Settings::default();
    let show = || backend.show(Aov::Beauty, &settings).unwrap_or_else(|error| panic!("{error}"));
    draw(&backend, &settings, 32, 18);
    let held = [show(), show(), show(), show(), show()];
    for (i, a) in held.iter().enumerate() {
        assert!(held.iter().skip(i + 1).all(|b| a.image() != b.image() && a.view() != b.view()));
    }
    assert_eq!(context.live().images, 5);
    let images = held.each_ref().map(|picture| picture.image());
    drop(held);
    assert!(images.contains(&show().image()), "none is made while one is free");
    assert_eq!(context.live().images, 3, "more than that are not kept");
    let full = context.live();
    for _ in 0..20 {
        show();
    }
    assert_eq!(context.live(), full);

    // A new size; the old picture stays its holder's.
    let old = show();
    let bytes = picture_bytes(&context, &old).unwrap();
    draw(&backend, &settings, 20, 40);
    assert_eq!(show().size(), (20, 40));
    assert_eq!((old.size(), context.live().images), ((32, 18), 2));
    assert_eq!(picture_bytes(&context, &old).unwrap(), bytes);

    // Holders in other threads, one of which outlives the backend.
    thread::scope(|scope| {
        for _ in 0..3 {
            for _ in 0..10 {
                let picture = show();
                scope.spawn(move || drop(picture));
            }
        }
    });
    let last = show();
    drop(backend);
    assert_eq!(context.live().images, 2);
    thread::spawn(move || drop((old, last))).join().unwrap();
    assert_eq!(context.live(), empty);
    assert_valid(&context);
}
