//! Several backends on one device, in several threads at once: each renders what it renders alone.

mod common;
#[path = "common/moving.rs"]
mod moving;
#[path = "common/scenes.rs"]
mod scenes;

use std::{
    sync::{Arc, Mutex},
    time::Duration,
};

use ambray_core::{
    control::Control,
    frame::Frame,
    settings::{Settings, Temporal, Thin},
};
use ambray_scene::Scene;
use ambray_vulkan::{Device, VulkanBackend, VulkanOptions};
use common::{assert_valid, context};
use scenes::{assert_same, room, view};

const ROUNDS: usize = 3;

fn open(device: &Device, scene: &Scene) -> VulkanBackend {
    let options = VulkanOptions { submission: Some(Duration::from_millis(5)), ..VulkanOptions::default() };
    VulkanBackend::on(device, &Arc::new(scene.clone()), options, &Control::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn render(backend: &VulkanBackend, settings: &Settings) -> Frame {
    let frame = backend.render(settings, &view(settings, 96, 54), Control::default());
    frame.unwrap_or_else(|error| panic!("{error}"))
}

/// Frames of a scene that is opened anew in each round, with settings that need programs of their own.
fn still(device: &Device, walls: u32, thin: Thin) -> Vec<Frame> {
    let frames = (0..ROUNDS).flat_map(|round| {
        let backend = open(device, &room(walls + round as u32 % 2));
        let settings = |spp: u32| Settings { spp, thin, ..Settings::default() };
        [1, 4].map(|spp| render(&backend, &settings(spp)))
    });
    frames.collect()
}

/// Frames of a scene that moves, and accumulates.
fn moving(device: &Device) -> Vec<Frame> {
    let scene = moving::scene(6);
    let mut backend = open(device, &scene);
    let settings = Settings { spp: 2, temporal: Temporal::On, ..Settings::default() };
    let mut random = moving::Random(7);
    let frames = (0..2 * ROUNDS).map(|round| {
        let pose = moving::pose(&scene, &mut random, (round % 3) as f32);
        let [placed, _] = moving::posed(&scene, &pose);
        backend.pose(&placed, &pose, &Control::default()).unwrap_or_else(|error| panic!("{error}"));
        render(&backend, &settings)
    });
    frames.collect()
}

#[test]
fn threads_that_share_a_device_render_what_they_render_alone() {
    let Some(context) = context() else { return };
    let empty = context.live();
    type Work = fn(&Device) -> Vec<Frame>;
    // Twice the same moving scene: the programs that move it are of whichever comes first, and outlive its scene.
    let works: [Work; 4] =
        [|device| still(device, 1, Thin::Off), |device| still(device, 3, Thin::Sheet), moving, moving];
    let alone = works.map(|work| work(&Device::of(Arc::clone(&context))));
    let device = Device::of(Arc::clone(&context));
    let together = Mutex::new(works.map(|_| Vec::new()));
    std::thread::scope(|scope| {
        for (index, work) in works.iter().enumerate() {
            let (device, together) = (&device, &together);
            scope.spawn(move || {
                let frames = work(device);
                together.lock().unwrap()[index] = frames;
            });
        }
    });
    for (index, (alone, together)) in alone.iter().zip(together.into_inner().unwrap()).enumerate() {
        assert_eq!(alone.len(), together.len());
        for (round, (alone, together)) in alone.iter().zip(&together).enumerate() {
            assert_same(together, alone, &format!("thread {index}, frame {round}"));
        }
    }
    drop(device);
    assert_eq!(context.live(), empty);
    assert_valid(&context);
}

#[test]
fn a_bound_cuts_frames_finer_and_changes_nothing() {
    let Some(context) = context() else { return };
    let device = Device::of(Arc::clone(&context));
    let settings = Settings::default();
    let submissions = |submission: Option<Duration>| {
        let options = VulkanOptions { submission, ..VulkanOptions::default() };
        let backend = VulkanBackend::on(&device, &Arc::new(room(3)), options, &Control::default())
            .unwrap_or_else(|error| panic!("{error}"));
        let count = Mutex::new(0);
        let progress = |_: f32| *count.lock().unwrap() += 1;
        let control = Control { progress: &progress, ..Control::default() };
        let frame = backend.render(&settings, &view(&settings, 160, 90), control);
        (frame.unwrap_or_else(|error| panic!("{error}")), count.into_inner().unwrap())
    };
    let (whole, few) = submissions(None);
    let (cut, many) = submissions(Some(Duration::from_millis(1)));
    assert!(many > few, "{many} submissions, {few} without a bound");
    assert_same(&cut, &whole, "a bound");
    assert_valid(&context);
}
