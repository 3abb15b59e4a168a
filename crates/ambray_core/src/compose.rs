//! Final radiance L = emission + a (L_a O + I) + direct light (spec §4).

use std::f32::consts::FRAC_1_PI;

use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::settings::RadianceSource;

/// Near-field radiance I from the filtered sum of the gather.
///
/// All sources but the self-similar one are complete after the gather. The self-similar bounce multiplies the mean
/// albedo of the near hits, `near` = ã (1 − O), by L_a F with F = O / (1 − ã (1 − O)) per channel (spec §3).
#[must_use]
#[inline(always)]
pub fn near_radiance(source: RadianceSource, ambient: Vec3, openness: f32, near: Vec3) -> Vec3 {
    match source {
        RadianceSource::SelfSimilar => near * ambient * self_similar_factor(openness, near),
        _ => near,
    }
}

/// Openness (x) and the sum of the gather (yzw) with the near-field radiance in its place (see [`near_radiance`]).
#[must_use]
#[inline(always)]
pub fn finished(source: RadianceSource, ambient: Vec3, sum: Vec4) -> Vec4 {
    near_radiance(source, ambient, sum.x, sum.yzw()).extend(sum.x).wxyz()
}

/// F = O / (1 − ã (1 − O)) in `[0, 1]`, given `near` = ã (1 − O). Nothing glows where nothing is open.
#[must_use]
#[inline(always)]
pub fn self_similar_factor(openness: f32, near: Vec3) -> Vec3 {
    // With ã ≤ 1 the divisor is at least O; rounding must not make it less.
    if openness > 0.0 { openness / (Vec3::ONE - near).max(Vec3::splat(openness)) } else { Vec3::ZERO }
}

/// Light reflected by a diffuse surface that receives `irradiance`: (a/π) Σ E cos V.
#[must_use]
#[inline(always)]
pub fn reflected(albedo: Vec3, irradiance: Vec3) -> Vec3 {
    albedo * irradiance * FRAC_1_PI
}

/// Albedo and emission of a surface. Unlit ones show their base colour whatever the light.
#[must_use]
#[inline(always)]
pub fn albedo_and_emission(base_color: Vec3, emission: Vec3, unlit: bool) -> (Vec3, Vec3) {
    if unlit { (Vec3::ZERO, base_color + emission) } else { (base_color, emission) }
}

/// Of two batches, each openness (x) with its near radiance (yzw), the one with the smaller openness:
/// O = min(O1, A2) (spec §8).
#[must_use]
#[inline(always)]
pub fn smaller_batch(first: Vec4, second: Vec4) -> Vec4 {
    if second.x < first.x { second } else { first }
}

/// L = emission + a (L_a O + I) + `direct`, with `direct` from [`reflected`].
#[must_use]
#[inline(always)]
pub fn compose(emission: Vec3, albedo: Vec3, ambient: Vec3, openness: f32, near: Vec3, direct: Vec3) -> Vec3 {
    emission + albedo * (ambient * openness + near) + direct
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn self_similar_light_stays_finite_and_within_the_ambient() {
        for openness in [0.0, 1e-12, 1e-7, 1e-3, 0.5, 1.0] {
            for albedo in [0.0, 0.5, 1.0] {
                let near = Vec3::splat(albedo * (1.0 - openness));
                let light = near_radiance(RadianceSource::SelfSimilar, Vec3::ONE, openness, near);
                let total = light + Vec3::splat(openness);
                let sound = total.min_element() >= 0.0 && total.max_element() <= 1.0 + 1e-6;
                assert!(sound, "{openness} {albedo}: {total}");
            }
        }
    }
}
