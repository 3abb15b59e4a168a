//! Frames of two backends, side by side.

use std::path::{Path, PathBuf};

use ambray::{
    BackendChoice, Control, Frame, Renderer, RendererOptions,
    scene::Scene,
    settings::Settings,
    vulkan::{DeviceKind, DeviceOptions, TraceMode, VulkanError},
};
use glam::{Vec3, Vec4, Vec4Swizzles};
use image::{Rgb, RgbImage};

/// Largest difference of O and of each channel of I at which pixels count as equal.
pub const TOLERANCE: f32 = 1e-3;
/// Share of the pixels that must be equal.
pub const SHARE: f64 = 0.999;

/// A renderer on a Vulkan device with the validation layer watching; software will do. `None`, with a line that says so,
/// where there is no Vulkan; a failure there if `AMBRAY_REQUIRE_VULKAN=1`.
///
/// # Panics
/// If Vulkan is there but fails, or is required and not there.
#[must_use]
pub fn vulkan(scene: Scene, trace: TraceMode) -> Option<Renderer> {
    let options = RendererOptions {
        backend: BackendChoice::Vulkan,
        device: DeviceOptions { software: true, validation: true, ..DeviceOptions::default() },
        trace,
        ..RendererOptions::default()
    };
    match Renderer::open(scene, &options, Control::default()) {
        Ok(renderer) => {
            let is_software = renderer.device().is_some_and(|device| device.kind == DeviceKind::Software);
            let hardware = std::env::var_os("AMBRAY_VULKAN").is_some_and(|value| value == "hardware");
            assert!(!(hardware && is_software), "AMBRAY_VULKAN=hardware, but the device is the processor");
            Some(renderer)
        }
        Err(error) => {
            let absent = matches!(
                error,
                ambray::RenderError::Vulkan(
                    VulkanError::NoLoader { .. }
                        | VulkanError::NoDriver
                        | VulkanError::NoDevice { .. }
                        | VulkanError::Missing { .. }
                )
            );
            let required = std::env::var_os("AMBRAY_REQUIRE_VULKAN").is_some_and(|value| value == "1");
            assert!(absent && !required, "{error}");
            eprintln!("skipped: {error}");
            None
        }
    }
}

/// Compares what a device rendered with what the processor rendered.
///
/// # Panics
/// If fewer than [`SHARE`] of the pixels of O or I agree within [`TOLERANCE`], before or after the filter; the pictures are
/// then in the folder for test results, as expected | difference | actual.
pub fn assert_equal(name: &str, expected: &Frame, actual: &Frame) {
    let planes = [
        ("before the filter", &expected.ambient_raw, &actual.ambient_raw),
        ("after the filter", &expected.ambient, &actual.ambient),
    ];
    for (when, expected_plane, actual_plane) in planes {
        let unequal =
            expected_plane.iter().zip(actual_plane.iter()).filter(|(a, b)| !is_equal(**a, **b)).count();
        let share = 1.0 - unequal as f64 / expected_plane.len() as f64;
        if share < SHARE {
            let path = write_triptych(name, expected.width as usize, expected_plane, actual_plane);
            panic!(
                "{name} {when}: {unequal} of {} pixels differ, see {}",
                expected_plane.len(),
                path.display()
            );
        }
    }
}

fn is_equal(a: Vec4, b: Vec4) -> bool {
    // Written so that what is not a number differs.
    (a - b).abs().max_element() <= TOLERANCE && a.is_finite() && b.is_finite()
}

/// Openness above near radiance: expected | ten times the difference | actual.
fn write_triptych(name: &str, width: usize, expected: &[Vec4], actual: &[Vec4]) -> PathBuf {
    let height = expected.len() / width;
    let openness = |v: Vec4| Vec3::splat(v.x);
    let near = |v: Vec4| v.yzw();
    let picture = RgbImage::from_fn(3 * width as u32, 2 * height as u32, |x, y| {
        let (column, row) = (x as usize % width, y as usize % height);
        let (a, b) = (expected[row * width + column], actual[row * width + column]);
        let channel = |v: Vec4| if (y as usize) < height { openness(v) } else { near(v) };
        let value = match x as usize / width {
            0 => channel(a),
            1 => 10.0 * (channel(a) - channel(b)).abs(),
            _ => channel(b),
        };
        Rgb((value.clamp(Vec3::ZERO, Vec3::ONE) * 255.0).to_array().map(|v| v as u8))
    });
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/parity");
    let file: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    let path = folder.join(format!("{file}.png"));
    let written = std::fs::create_dir_all(&folder).map(|()| picture.save(&path));
    if !matches!(written, Ok(Ok(()))) {
        eprintln!("{} could not be written", path.display());
    }
    path
}

/// Renders `settings` on the processor.
///
/// # Panics
/// If it fails.
#[must_use]
pub fn render(renderer: &mut Renderer, settings: &Settings) -> Frame {
    renderer.render(settings, Control::default()).unwrap_or_else(|error| panic!("{error}"))
}
