//! From radiance to display values.

use ambray_core::{
    display::{display, neutral},
    settings::{Settings, ToneMap},
};
use ambray_scene::Scene;
use ambray_vulkan::layout::FUNCTION_TONE_MAP;
use glam::Vec3;

use crate::{
    calls::{Call, Device, view},
    compare::Comparison,
    random::Random,
};

/// The power of the sRGB function is the device's own, off by some units of the last place of its logarithm; a byte of a
/// picture is 65793 units wide. The tone mapper rounds as the host does but for what a compiler folds in more digits.
#[test]
fn display_values() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let mut random = Random::new(17);
    let arguments: Vec<_> = (0..20_000)
        .map(|i| {
            let radiance = match i {
                0 => Vec3::new(f32::NAN, -1.0, 0.0),
                1 => Vec3::new(f32::MAX, 1e30, 1.0),
                2 => Vec3::splat(0.003_130_8),
                _ => Vec3::ONE.map(|_| random.magnitude(-4.0, 3.0)),
            };
            let tone_map = ToneMap::ALL[random.below(2)];
            (radiance, random.between(-8.0, 8.0), tone_map)
        })
        .collect();
    let calls: Vec<_> = (arguments.iter())
        .map(|&(radiance, exposure, tone_map)| {
            Call::default().vector(radiance).number(libm::exp2f(exposure)).word(tone_map as u32)
        })
        .collect();
    let (mut shown, mut mapped) = (Comparison::new("display values"), Comparison::new("neutral colours"));
    let all = device.functions(&Settings::default()).call(FUNCTION_TONE_MAP, &view(), &calls);
    for (&(radiance, exposure, tone_map), values) in arguments.iter().zip(all) {
        let what = || format!("{radiance} {exposure} {tone_map:?}");
        shown.add_vector(display(radiance, exposure, tone_map), values.vector(0), 1.0, what);
        if radiance.is_finite() && radiance.max_element() < 1e4 {
            mapped.add_vector(neutral(radiance), values.vector(3), 1.0, what);
        }
    }
    shown.finish(64.0);
    mapped.finish(4.0);
}
