//! Vulkan against the CPU backend: pictures agree, whatever traces the rays.
//!
//! Every scene is rendered with every falloff and every kind of thin-object detection, by pipeline and by query; the zoo
//! also with every other setting that changes the arithmetic. The validation layer watches all of it.

use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use ambray::{Control, Frame, Renderer, vulkan::TraceMode};
use ambray_core::settings::{
    Auto, Falloff, FilterTest, NearRadiance, Normals, RadianceSource, Rgb, Sampling, Sequence, Settings,
    Size, Thin, ThinMinimum, Triple, Window,
};
use ambray_scene::{Scene, atrium};
use conformance::{parity, scenes, shared, views};

const MODES: [TraceMode; 2] = [TraceMode::Pipeline, TraceMode::Query];

/// A renderer for each way to trace, whose programs all scenes share. Empty where there is no Vulkan.
///
/// Software devices use all cores for each frame, so one test at a time has them.
fn devices() -> MutexGuard<'static, Vec<Renderer>> {
    static DEVICES: LazyLock<Mutex<Vec<Renderer>>> = LazyLock::new(|| {
        let open = |&mode: &TraceMode| parity::vulkan(Scene::default(), mode);
        Mutex::new(MODES.iter().filter_map(open).collect())
    });
    DEVICES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Renders `scene` with each of `settings` on all backends.
fn check(name: &str, scene: &Scene, settings: &[Settings]) {
    let devices = devices();
    if devices.is_empty() {
        return;
    }
    let ready = |device: &Renderer| device.with_scene(scene.clone(), Control::default());
    let mut devices: Vec<_> =
        devices.iter().map(|device| ready(device).unwrap_or_else(|error| panic!("{error}"))).collect();
    let mut cpu = Renderer::new(scene.clone());
    for (i, settings) in settings.iter().enumerate() {
        let expected = parity::render(&mut cpu, settings);
        for (device, mode) in devices.iter_mut().zip(MODES) {
            let actual = parity::render(device, settings);
            let name = format!("{name} {i} {mode:?} {:?} {:?}", settings.thin, settings.falloff);
            parity::assert_equal(&name, &expected, &actual);
            assert_counts(&name, &expected, &actual);
        }
    }
    for device in &devices {
        let messages = device.validation_messages();
        assert!(messages.is_empty(), "{name}: {}", messages.join("\n"));
    }
}

/// As many rays of each type, up to what a few other hits change.
#[track_caller]
fn assert_counts(name: &str, expected: &Frame, actual: &Frame) {
    let (a, b) = (expected.stats.rays, actual.stats.rays);
    assert_eq!(a.primary, b.primary, "{name}");
    for (a, b) in [(a.ambient, b.ambient), (a.chord, b.chord), (a.shadow, b.shadow)] {
        assert!(a.abs_diff(b) as f64 <= 1e-3 * a as f64 + 2.0, "{name}: {a} rays on the processor, {b} here");
    }
}

/// Every falloff with every kind of thin-object detection.
fn matrix(base: &Settings) -> Vec<Settings> {
    let pairs = Thin::ALL.iter().flat_map(|&thin| Falloff::ALL.iter().map(move |&falloff| (thin, falloff)));
    pairs.map(|(thin, falloff)| Settings { thin, falloff, ..base.clone() }).collect()
}

fn small() -> Settings {
    Settings { size: Size { width: 96, height: 54 }, ..Settings::default() }
}

/// Settings that differ from the default in one thing each, or in what belongs together.
fn others(base: &Settings) -> Vec<Settings> {
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut settings = base.clone();
        change(&mut settings);
        settings
    };
    let mut all = Vec::new();
    all.extend(NearRadiance::ALL.iter().map(|&near| {
        with(&|s| (s.near_radiance, s.thin, s.radiance_source) = (near, Thin::Sheet, RadianceSource::Albedo))
    }));
    all.extend(RadianceSource::ALL.iter().map(|&source| {
        with(&|s| (s.radiance_source, s.ambient) = (source, Auto::Value(Rgb([0.9, 0.7, 0.5]))))
    }));
    all.extend(
        Sampling::ALL.iter().map(|&sampling| with(&|s| (s.sampling, s.thin) = (sampling, Thin::Sheet))),
    );
    all.extend(Sequence::ALL.iter().map(|&sequence| {
        with(&|s| (s.sequence, s.spp, s.sampling, s.frame) = (sequence, 5, Sampling::Random, 3))
    }));
    all.extend(Window::ALL.iter().map(|&window| with(&|s| (s.filter, s.filter_cos_normal) = (window, -1.0))));
    all.extend(FilterTest::ALL.iter().map(|&test| with(&|s| s.filter_test = test)));
    all.extend(Normals::ALL.iter().map(|&normals| with(&|s| s.normals = normals)));
    all.extend([Thin::Paper, Thin::Sheet].map(|thin| {
        with(&|s| (s.thin, s.thin_minimum, s.thin_edge) = (thin, ThinMinimum::AfterFilter, true))
    }));
    all.push(with(&|s| (s.exponent, s.seed, s.near_limit) = (2.5, 7, Auto::Value(0.3))));
    all.push(with(&|s| s.orthographic_height = Auto::Value(3.0)));
    all.push(with(&|s| (s.spp, s.size) = (70, Size { width: 17, height: 9 })));
    all
}

#[test]
fn the_atrium_with_all_measures_and_modes() {
    let base = Settings { size: Size { width: 160, height: 90 }, ..Settings::default() };
    check("atrium", &atrium::atrium(), &matrix(&base));
}

#[test]
fn a_zoo_of_shapes_and_materials() {
    let base = Settings {
        size: Size { width: 160, height: 90 },
        radius: Auto::Value(0.8),
        camera_position: Auto::Value(Triple([0.5, 2.2, 4.5])),
        camera_target: Auto::Value(Triple([0.0, 0.3, -0.2])),
        ..Settings::default()
    };
    check("zoo", &scenes::zoo(), &matrix(&base));
    check("zoo", &scenes::zoo(), &others(&Settings { size: small().size, ..base }));
}

#[test]
fn sponza() {
    let Some(scene) = shared::load("Sponza/Sponza.gltf") else { return };
    for view in views::SPONZA {
        let size = Size { width: 160, height: 90 };
        let base = Settings { size, normals: Normals::Shading, ..view.settings() };
        check(view.name, &scene, &matrix(&base));
    }
}

/// Closed forms, alpha, instances, mirrored and strange geometry, textures and vertex colours.
#[test]
fn shared_scenes() {
    const SCENES: [&str; 16] = [
        "Analytic/closed_room.glb",
        "Analytic/degenerate_triangles.glb",
        "Analytic/furnace_box.glb",
        "Analytic/right_angle_h1.glb",
        "Analytic/right_angle_h1_far.glb",
        "Analytic/right_angle_h1_millimetres.glb",
        "Analytic/sphere_over_plane.glb",
        "Analytic/thin_sheets.glb",
        "Analytic/two_rooms_zero_thickness.glb",
        "AlphaBlendModeTest",
        "AlphaMask",
        "CornellBox",
        "NegativeScaleTest",
        "SimpleInstancing",
        "TextureSettingsTest",
        "VertexColorTest",
    ];
    for name in SCENES {
        let Some(path) = shared::scene_path(name) else { return };
        let path = if path.is_dir() { only_file_of(&path) } else { path };
        let scene = ambray_scene::load(&path).unwrap_or_else(|error| panic!("{error}")).scene;
        check(name, &scene, &matrix(&small()));
    }
}

/// The binary file of a scene's folder, or else its first glTF file.
fn only_file_of(folder: &std::path::Path) -> std::path::PathBuf {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in
            std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        {
            let path = entry.unwrap_or_else(|error| panic!("{error}")).path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|kind| kind == "glb" || kind == "gltf") {
                files.push(path);
            }
        }
    }
    files.sort_by_key(|path| (path.extension().map(std::ffi::OsStr::to_owned), path.clone()));
    files.into_iter().next().unwrap_or_else(|| panic!("{} has no glTF file", folder.display()))
}
