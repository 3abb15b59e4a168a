//! Scenes that move: the same picture on every backend at many times of each clip, as if the scene had been opened there.

use std::sync::atomic::AtomicBool;

use ambray::{
    BackendChoice, BuildOptions, Control, Frame, Renderer, RendererOptions,
    scene::{
        Scene,
        animation::{UpdatePolicy, Updates},
    },
    vulkan::{AccelerationOptions, TraceMode},
};
use ambray_core::settings::{Auto, Settings, Size};
use conformance::{moving, parity, shared};

const MODES: [TraceMode; 2] = [TraceMode::Pipeline, TraceMode::Query];

fn settings(animation: &str, time: f32) -> Settings {
    Settings {
        size: Size { width: 72, height: 48 },
        spp: 4,
        animation: Auto::Value(animation.to_owned()),
        time: Auto::Value(time),
        ..Settings::default()
    }
}

/// Clips of a scene as the settings name them.
fn clips(scene: &Scene) -> Vec<String> {
    let count = scene.rig.as_ref().map_or(0, |rig| rig.clips.len());
    let all = (count > 1).then(|| "all".to_owned());
    (0..count).map(|clip| clip.to_string()).chain(all).collect()
}

/// Times that are on no keyframe of most clips, forwards, backwards and beyond the end.
fn times(scene: &Scene, clip: &str) -> Vec<f32> {
    let rig = scene.rig.as_ref().expect("it moves");
    let duration = clip.parse().map_or(2.0, |clip: usize| rig.clips[clip].duration);
    [0.0, 0.31, 0.83, 0.52, 1.27].iter().map(|share| share * duration).collect()
}

/// The scene as if it had been loaded at the time of `settings`: nothing of it can move.
fn frozen(scene: &Scene, settings: &Settings) -> Scene {
    use ambray_scene::{
        Motion,
        animation::{Clips, Moment},
    };
    let rig = scene.rig.as_ref().expect("it moves");
    let clips = settings.animation.value().expect("a clip").parse().map_or(Clips::All, Clips::One);
    let time = f64::from(*settings.time.value().expect("a time"));
    let pose = rig.pose(Some(&Moment { clips, time, repeat: true }));
    let mut frozen = scene.clone();
    frozen.place(&pose);
    frozen.deform(&pose);
    frozen.rig = None;
    frozen.instances.iter_mut().for_each(|instance| instance.motion = Motion::Static);
    frozen.shape_instances.iter_mut().for_each(|instance| instance.motion = Motion::Static);
    frozen
}

fn render(renderer: &mut Renderer, settings: &Settings) -> Frame {
    renderer.render(settings, Control::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// What looks at the scene, chosen before it moves.
fn with_view(renderer: &mut Renderer, settings: &Settings) -> Settings {
    let view = renderer.view(settings).unwrap_or_else(|error| panic!("{error}"));
    let triple = |v: glam::Vec3| Auto::Value(ambray_core::settings::Triple(v.to_array()));
    let (camera, target) = (view.camera, view.camera.position() + view.camera.forward());
    Settings {
        camera_position: triple(camera.position()),
        camera_target: triple(target),
        camera_up: triple(camera.up()),
        radius: Auto::Value(view.radius),
        ..settings.clone()
    }
}

/// Scenes of this project, and the shared ones where they are.
fn scenes() -> Vec<(&'static str, Scene)> {
    const SHARED: [&str; 11] = [
        "Fox/glTF/Fox.gltf",
        "CesiumMan/glTF/CesiumMan.gltf",
        "RiggedFigure/glTF-Binary/RiggedFigure.glb",
        "SkinnedCylinder/03_skinned_cylinder.gltf",
        "SimpleSkin/glTF-Embedded/SimpleSkin.gltf",
        "BoxAnimated/glTF-Binary/BoxAnimated.glb",
        "CesiumMilkTruck/glTF-Binary/CesiumMilkTruck.glb",
        "InterpolationTest/glTF-Binary/InterpolationTest.glb",
        "AnimatedMorphCube/glTF-Quantized/AnimatedMorphCube.gltf",
        "MorphStressTest/glTF-Binary/MorphStressTest.glb",
        "SimpleMorph/glTF-Embedded/SimpleMorph.gltf",
    ];
    let mut scenes = vec![
        ("removed", moving::removed()),
        ("sliding", moving::sliding()),
        ("bending", moving::bending()),
        ("banner", ambray_scene::moving::banner()),
    ];
    scenes.extend(SHARED.iter().filter_map(|&name| Some((name, shared::load(name)?))));
    scenes
}

/// What moved there is what was opened there: hits on trees that follow agree with hits on trees of the pose.
#[test]
fn a_scene_that_moved_is_the_scene_opened_there() {
    for (name, scene) in scenes() {
        let mut moving = Renderer::new(scene.clone());
        for clip in clips(&scene).iter().take(3) {
            for time in times(&scene, clip) {
                let settings = with_view(&mut moving, &settings(clip, time));
                let actual = render(&mut moving, &settings);
                let mut opened = Renderer::new(frozen(&scene, &settings));
                let still = Settings { animation: Auto::Auto, time: Auto::Auto, ..settings.clone() };
                let expected = render(&mut opened, &still);
                parity::assert_equal(&format!("{name} {clip} at {time}"), &expected, &actual);
            }
        }
    }
}

/// Backend against backend at every time.
#[test]
fn backends_agree_at_all_times() {
    let Some(devices) =
        MODES.map(|mode| parity::vulkan(Scene::default(), mode)).into_iter().collect::<Option<Vec<_>>>()
    else {
        return;
    };
    for (name, scene) in scenes() {
        let mut cpu = Renderer::new(scene.clone());
        let mut devices: Vec<Renderer> = devices
            .iter()
            .map(|device| device.with_scene(scene.clone(), Control::default()).expect("a scene"))
            .collect();
        for clip in clips(&scene) {
            for time in times(&scene, &clip) {
                let settings = with_view(&mut cpu, &settings(&clip, time));
                let expected = render(&mut cpu, &settings);
                for (device, mode) in devices.iter_mut().zip(MODES) {
                    let actual = render(device, &settings);
                    parity::assert_equal(&format!("{name} {clip} at {time} {mode:?}"), &expected, &actual);
                }
            }
        }
        for device in &devices {
            let messages = device.validation_messages();
            assert!(messages.is_empty(), "{name}: {}", messages.join("\n"));
        }
    }
}

/// The camera that nobody chose does not follow what moves, and is the same whatever was asked for first.
#[test]
fn automatic_cameras_stand_still() {
    let scene = ambray_scene::Scene { cameras: Vec::new(), ..moving::sliding() };
    let plain = Settings { animation: Auto::Auto, time: Auto::Auto, ..settings("0", 0.0) };
    let mut first = Renderer::new(scene.clone());
    let at_rest = first.view(&plain).expect("a view");
    let later = first.view(&settings("0", 3.0)).expect("a view");
    let mut second = Renderer::new(scene);
    let directly = second.view(&settings("0", 3.0)).expect("a view");
    assert_eq!(at_rest.camera, later.camera);
    assert_eq!(later, directly);
}

/// There and back again gives the picture of before, bit for bit on the processor.
#[test]
fn time_can_go_back() {
    for (name, scene) in [("sliding", moving::sliding()), ("bending", moving::bending())] {
        let mut renderer = Renderer::new(scene);
        let first = render(&mut renderer, &settings("0", 0.4)).ambient;
        render(&mut renderer, &settings("0", 1.7));
        assert_eq!(render(&mut renderer, &settings("0", 0.4)).ambient, first, "{name}");
    }
}

#[test]
fn what_is_not_there_is_named() {
    let mut renderer = Renderer::new(moving::sliding());
    let error = renderer.render(&settings("walk", 0.0), Control::default()).expect_err("no such clip");
    assert_eq!(error.to_string(), "animation walk is not in the scene: it has 0 (clip)");
    let mut still = Renderer::new(Scene::default());
    let timed = Settings { animation: Auto::Auto, ..settings("0", 1.0) };
    let error = still.render(&timed, Control::default()).expect_err("nothing moves");
    assert_eq!(error.to_string(), "animation 0 is not in the scene: it has none");
}

/// However structures follow what deforms, rays hit the same: bit for bit on the processor, up to rounding on devices.
#[test]
fn refitted_structures_are_as_good_as_new_ones() {
    const POLICIES: [UpdatePolicy; 4] =
        [UpdatePolicy::Rebuild, UpdatePolicy::Refit, UpdatePolicy::Auto, UpdatePolicy::Cache];
    let scenes = [
        ("bending", moving::bending()),
        ("banner", ambray_scene::moving::banner()),
        ("CesiumMan", shared::load("CesiumMan/glTF/CesiumMan.gltf").unwrap_or_default()),
    ];
    for (name, scene) in scenes.iter().filter(|(_, scene)| scene.rig.is_some()) {
        for backend in [BackendChoice::Cpu, BackendChoice::Vulkan] {
            if backend == BackendChoice::Vulkan && parity::vulkan(Scene::default(), MODES[1]).is_none() {
                continue;
            }
            let mut renderers = POLICIES.map(|policy| {
                let updates = Updates { policy, ..Updates::default() };
                let options = RendererOptions {
                    backend,
                    build: BuildOptions { updates, ..BuildOptions::default() },
                    acceleration: AccelerationOptions { updates, ..AccelerationOptions::default() },
                    trace: TraceMode::Query,
                    ..RendererOptions::default()
                };
                Renderer::open(scene.clone(), &options, Control::default()).expect("opened")
            });
            for time in times(scene, "0") {
                let settings = settings("0", time);
                let [expected, others @ ..] =
                    renderers.each_mut().map(|renderer| render(renderer, &settings));
                for (other, policy) in others.iter().zip(&POLICIES[1..]) {
                    let name = format!("{name} at {time} {backend:?} {policy:?}");
                    if backend == BackendChoice::Cpu {
                        assert!(other.ambient_raw == expected.ambient_raw, "{name}");
                    } else {
                        parity::assert_equal(&name, &expected, other);
                    }
                }
            }
        }
    }
}

/// A move that was stopped leaves nothing half moved: neither on the device, nor cameras and lights.
#[test]
fn a_move_that_was_stopped_shows_in_no_picture() {
    let scene = moving::sliding();
    let mut renderers = vec![Renderer::new(scene.clone())];
    renderers.extend(
        parity::vulkan(Scene::default(), MODES[1])
            .map(|device| device.with_scene(scene.clone(), Control::default()).expect("a scene")),
    );
    for mut renderer in renderers {
        let view = with_view(&mut renderer, &settings("0", 0.5));
        let at = |time: f32| Settings { time: Auto::Value(time), ..view.clone() };
        let expected = render(&mut renderer, &at(0.5)).ambient;
        let cancel = AtomicBool::new(true);
        let control = Control { cancel: &cancel, ..Control::default() };
        assert!(renderer.render(&at(3.5), control).is_err());
        assert!(render(&mut renderer, &at(0.5)).ambient == expected, "{:?}", renderer.machine());
        assert!(render(&mut renderer, &at(3.5)).ambient != expected);
    }
}
