//! From linear radiance to display values.

use glam::Vec3;

use crate::settings::ToneMap;

/// Radiance beyond this is cut, so that infinities stay out of the formulas.
const BRIGHTEST: f32 = 1e30;

/// Display value in `[0, 1]`, sRGB-encoded, of linear `radiance` under `exposure` stops.
#[must_use]
pub fn display(radiance: Vec3, exposure: f32, tone_map: ToneMap) -> Vec3 {
    let exposed = finite(radiance) * libm::exp2f(exposure);
    let mapped = match tone_map {
        ToneMap::None => exposed,
        ToneMap::Neutral => neutral(exposed.min(Vec3::splat(BRIGHTEST))),
    };
    encode(mapped)
}

/// Display value of a linear colour in `[0, 1]`: the sRGB transfer function (IEC 61966-2-1) alone; brighter is clipped.
#[must_use]
pub fn encode(linear: Vec3) -> Vec3 {
    Vec3::from_array(finite(linear).to_array().map(|x| srgb(x.min(1.0))))
}

fn srgb(x: f32) -> f32 {
    // libm's power gives the same bits on every machine.
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::powf(x, 1.0 / 2.4) - 0.055 }
}

/// Khronos PBR Neutral tone mapper: hue and saturation of colours below 0.8 are kept, highlights roll off towards white.
///
/// Khronos Group 2024, "Khronos PBR Neutral Tone Mapper", specification and its sample code; names as there.
#[must_use]
pub fn neutral(mut color: Vec3) -> Vec3 {
    const F90: f32 = 0.04; // Fresnel reflection at normal incidence, which the mapper takes out of base colours
    const START_COMPRESSION: f32 = 0.8 - F90;
    const DESATURATION: f32 = 0.15;
    const D: f32 = 1.0 - START_COMPRESSION;

    let x = color.min_element();
    let offset = if x < 2.0 * F90 { x - x * x / (4.0 * F90) } else { F90 };
    color -= offset;
    let peak = color.max_element();
    if peak < START_COMPRESSION {
        return color;
    }
    let new_peak = 1.0 - D * D / (peak + D - START_COMPRESSION);
    color *= new_peak / peak;
    let g = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    color.lerp(Vec3::splat(new_peak), g)
}

/// `color` without negative parts, infinities and NaN.
fn finite(color: Vec3) -> Vec3 {
    Vec3::from_array(color.to_array().map(|x| if x > 0.0 { x.min(BRIGHTEST) } else { 0.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(actual: Vec3, expected: Vec3) {
        assert!(actual.abs_diff_eq(expected, 2e-6), "{actual} is not {expected}");
    }

    #[test]
    fn neutral_keeps_dark_colours_but_for_the_offset() {
        check(neutral(Vec3::ZERO), Vec3::ZERO);
        check(neutral(Vec3::splat(0.5)), Vec3::splat(0.46));
        check(neutral(Vec3::new(0.5, 0.3, 0.1)), Vec3::new(0.46, 0.26, 0.06));
        // x = 0.04: offset 0.04 − 6.25 · 0.04² = 0.03
        check(neutral(Vec3::new(0.5, 0.3, 0.04)), Vec3::new(0.47, 0.27, 0.01));
    }

    #[test]
    fn neutral_rolls_off_highlights() {
        // Grey 1.04 becomes 1 after the offset; 1 − 0.24² / (1 + 0.24 − 0.76) = 0.88.
        check(neutral(Vec3::splat(1.04)), Vec3::splat(0.88));
        check(neutral(Vec3::splat(BRIGHTEST)), Vec3::ONE);
        let mut last = -1.0;
        for i in 0..2000 {
            let value = neutral(Vec3::splat(i as f32 * 0.01)).x;
            assert!(value > last && value < 1.0, "{i}: {value} after {last}");
            last = value;
        }
    }

    #[test]
    fn transfer_function_is_that_of_srgb() {
        check(encode(Vec3::new(0.0, 1.0, 0.5)), Vec3::new(0.0, 1.0, 0.735_356_9));
        check(encode(Vec3::new(0.002, 0.214_041_1, 9.0)), Vec3::new(0.025_84, 0.5, 1.0));
    }

    #[test]
    fn display_values_stay_in_range() {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, f32::MAX, 0.3] {
            for tone_map in [ToneMap::None, ToneMap::Neutral] {
                for exposure in [-64.0, 0.0, 64.0] {
                    let shown = display(Vec3::new(value, 0.1, 2.0), exposure, tone_map);
                    assert!(
                        shown.cmpge(Vec3::ZERO).all() && shown.cmple(Vec3::ONE).all(),
                        "{value}: {shown}"
                    );
                }
            }
        }
        check(display(Vec3::splat(0.25), 2.0, ToneMap::None), Vec3::ONE);
    }
}
