//! Frames that stay on a device, as windows show them: the same pictures as on the host, from many threads.

use std::{sync::Arc, thread, time::Duration};

use ambray::{
    Aov, BackendChoice, Control, Device, Drawn, RenderError, Renderer, RendererOptions, display,
    scene::{Scene, moving},
    settings::{Auto, Settings, Size, ToneMap},
    vulkan::{Context, TraceMode, testing::picture_bytes},
};
use conformance::{parity, shared};

const SHARED: [&str; 4] = [
    "DamagedHelmet/glTF-Binary/DamagedHelmet.glb",
    "AlphaBlendModeTest/glTF-Binary/AlphaBlendModeTest.glb",
    "AlphaMask/01_alpha_mask.gltf",
    "CornellBox/CornellBox.glb",
];

/// A device with the validation layer watching; `None` where there is none.
fn device() -> Option<Device> {
    parity::vulkan(Scene::default(), TraceMode::Auto)?.shared()
}

fn open(device: &Device, scene: Scene) -> Renderer {
    let options = RendererOptions {
        backend: BackendChoice::Vulkan,
        shared: Some(device.clone()),
        submission: Some(Duration::from_millis(20)),
        ..RendererOptions::default()
    };
    Renderer::open(scene, &options, Control::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Draws a frame and shows every plane of it; returns how many bytes were compared with those of the host, and how many differ.
fn compare(context: &Arc<Context>, renderer: &mut Renderer, settings: &Settings, what: &str) -> [usize; 2] {
    let drawn = renderer.draw(settings, Control::default()).unwrap_or_else(|error| panic!("{error}"));
    let frame = renderer.read_frame().unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(drawn, Drawn::Device(_)), "{what}");
    assert_eq!((drawn.stats().rays, drawn.view()), (frame.stats.rays, &frame.view), "{what}");
    let (mut bytes, mut different) = (0, 0);
    for &aov in Aov::ALL {
        let picture = renderer.show(aov, settings).unwrap_or_else(|error| panic!("{error}"));
        let actual = picture_bytes(context, &picture).unwrap_or_else(|error| panic!("{error}"));
        let expected = display::show(&frame, aov, settings).rgba8();
        assert_eq!(actual.len(), expected.len(), "{what} {aov:?}");
        for (a, b) in actual.iter().zip(&expected) {
            assert!(a.abs_diff(*b) <= 1, "{what} {aov:?}: {a} for {b}");
            different += usize::from(a != b);
        }
        bytes += actual.len();
    }
    [bytes, different]
}

#[track_caller]
fn assert_few([bytes, different]: [usize; 2], what: &str) {
    println!("{what}: {different} of {bytes} bytes differ, {:.5} %", 100.0 * different as f64 / bytes as f64);
    assert!(different * 1000 < bytes, "{what}");
}

fn assert_valid(device: &Device) {
    let messages = device.context().validation_messages();
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}

#[test]
fn threads_open_scenes_and_show_them_on_one_device() {
    let Some(device) = device() else { return };
    let size = Size { width: 96, height: 54 };
    thread::scope(|scope| {
        for (name, make) in [("flock", moving::flock as fn() -> Scene), ("banner", moving::banner)] {
            let device = &device;
            scope.spawn(move || {
                let mut renderer = open(device, make());
                for (frame, tone_map) in [ToneMap::Neutral, ToneMap::None].into_iter().enumerate() {
                    let time = Auto::Value(0.2 * frame as f32);
                    let settings =
                        Settings { size, tone_map, time, exposure: frame as f32, ..Settings::default() };
                    assert_few(compare(device.context(), &mut renderer, &settings, name), name);
                }
            });
        }
    });
    assert_valid(&device);
}

#[test]
fn shared_scenes_are_shown_as_on_the_host() {
    let scenes = SHARED.map(|path| (path, shared::scene_path(path)));
    let Some(device) = device() else { return };
    for (name, path) in scenes {
        let Some(path) = path else { continue };
        let scene = ambray::scene::load(&path).unwrap_or_else(|error| panic!("{error}")).scene;
        let mut renderer = open(&device, scene);
        let settings = Settings { size: Size { width: 160, height: 90 }, ..Settings::default() };
        assert_few(compare(device.context(), &mut renderer, &settings, name), name);
    }
    assert_valid(&device);
}

/// The processor hands its frames over: there is nothing to be shown by a device.
#[test]
fn the_processor_draws_on_the_host() {
    let mut renderer = Renderer::new(Scene::default());
    let settings = Settings { size: Size { width: 16, height: 9 }, ..Settings::default() };
    let drawn = renderer.draw(&settings, Control::default()).expect("drawn");
    let Drawn::Host(frame) = drawn else { panic!("the processor has no device") };
    assert_eq!(frame.beauty.len(), 16 * 9);
    assert!(matches!(renderer.show(Aov::Beauty, &settings), Err(RenderError::NothingDrawn)));
    assert!(matches!(renderer.read_frame(), Err(RenderError::NothingDrawn)));
    assert!(renderer.shared().is_none());
}
