//! Final radiance L = emission + a (L_a O + I) + direct light (spec §4).

use glam::Vec3;

use crate::settings::RadianceSource;

/// Near-field radiance I from the filtered sum of the gather.
///
/// All sources but the self-similar one are complete after the gather. The self-similar bounce multiplies the mean
/// albedo of the near hits, `near` = ã (1 − O), by L_a F with F = O / (1 − ã (1 − O)) per channel (spec §3).
#[must_use]
pub fn near_radiance(source: RadianceSource, ambient: Vec3, openness: f32, near: Vec3) -> Vec3 {
    match source {
        RadianceSource::SelfSimilar => near * ambient * self_similar_factor(openness, near),
        _ => near,
    }
}

/// F = O / (1 − ã (1 − O)), given `near` = ã (1 − O). Nothing glows where nothing is open.
#[must_use]
pub fn self_similar_factor(openness: f32, near: Vec3) -> Vec3 {
    if openness > 0.0 { openness / (Vec3::ONE - near) } else { Vec3::ZERO }
}

/// L = emission + a (L_a O + I) + `direct`, with `direct` = (a/π) Σ E cos V.
#[must_use]
pub fn compose(emission: Vec3, albedo: Vec3, ambient: Vec3, openness: f32, near: Vec3, direct: Vec3) -> Vec3 {
    emission + albedo * (ambient * openness + near) + direct
}
