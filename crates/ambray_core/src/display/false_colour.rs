//! Which colours the values of a plane get.

use glam::Vec3;

use super::{Picture, scalar, tone_map};
use crate::{
    aov::{Aov, AovKind},
    frame::Frame,
    settings::Settings,
};

/// The plane `aov` of `frame` as a picture.
#[must_use]
pub fn show(frame: &Frame, aov: Aov, settings: &Settings) -> Picture {
    let values = frame.plane(aov);
    let seen = |i: usize| frame.gbuffer.get(i).is_some_and(|pixel| pixel.depth.is_finite());
    match aov.kind() {
        AovKind::Color if aov == Aov::Albedo => color(vectors(&values).map(tone_map::encode)),
        AovKind::Color => {
            color(vectors(&values).map(|v| tone_map::display(v, settings.exposure, settings.tone_map)))
        }
        kind @ (AovKind::Unit | AovKind::Depth | AovKind::Count) => scalar::show(kind, &values, settings),
        AovKind::Position => plain(position(&values, seen)),
        AovKind::Normal => plain(vectors(&values).map(normal).collect()),
        AovKind::Id => plain(values.iter().map(|&id| palette(id)).collect()),
        AovKind::Motion => plain(motion(&values)),
    }
}

fn vectors(values: &[f32]) -> impl Iterator<Item = Vec3> {
    values.chunks_exact(3).map(Vec3::from_slice)
}

fn color(pixels: impl Iterator<Item = Vec3>) -> Picture {
    Picture::Rgb { pixels: pixels.collect(), is_color: true }
}

fn plain(pixels: Vec<Vec3>) -> Picture {
    Picture::Rgb { pixels, is_color: false }
}

fn position(values: &[f32], seen: impl Fn(usize) -> bool) -> Vec<Vec3> {
    let points = || vectors(values).enumerate().filter(|(i, _)| seen(*i)).map(|(_, p)| p);
    let low = points().fold(Vec3::INFINITY, Vec3::min);
    let size = points().fold(Vec3::NEG_INFINITY, Vec3::max) - low;
    let size = Vec3::select(size.cmpgt(Vec3::ZERO), size, Vec3::ONE);
    vectors(values).enumerate().map(|(i, p)| if seen(i) { (p - low) / size } else { Vec3::ZERO }).collect()
}

fn normal(n: Vec3) -> Vec3 {
    if n == Vec3::ZERO { n } else { 0.5 * n + 0.5 }
}

/// A colour for the index `id`, neighbours far apart in hue; black for -1.
fn palette(id: f32) -> Vec3 {
    if id < 0.0 {
        return Vec3::ZERO;
    }
    // Multiplicative hashing (Knuth 1998, vol. 3, §6.4): consecutive indices spread evenly around the circle of hues.
    let hash = (id as u32).wrapping_mul(0x9E37_79B9);
    let hue = (hash >> 8) as f32 / (1 << 24) as f32;
    let value = 0.6 + 0.4 * ((hash >> 3) & 7) as f32 / 7.0;
    let channel = |shift: f32| {
        let h = (hue + shift).fract();
        ((6.0 * h - 3.0).abs() - 1.0).clamp(0.0, 1.0)
    };
    let saturated = Vec3::new(channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0));
    value * Vec3::ONE.lerp(saturated, 0.7)
}

/// To the right and down as red and green about grey, relative to the largest movement.
fn motion(values: &[f32]) -> Vec<Vec3> {
    let most = values.iter().map(|v| v.abs()).fold(f32::MIN_POSITIVE, f32::max);
    let pixels = values.chunks_exact(2).map(|v| Vec3::new(v[0], v[1], 0.0) / (2.0 * most) + 0.5);
    pixels.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_fill_the_box_of_what_is_seen() {
        let values = [1.0, 5.0, 0.0, 3.0, 5.0, 4.0, 0.0, 0.0, 0.0];
        let shown = position(&values, |i| i < 2);
        assert_eq!(shown, [Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0), Vec3::ZERO]);
    }

    #[test]
    fn neighbouring_indices_differ() {
        assert_eq!(palette(-1.0), Vec3::ZERO);
        for id in 0..64 {
            let (a, b) = (palette(id as f32), palette((id + 1) as f32));
            assert!(a.distance(b) > 0.1, "{id}: {a} {b}");
            assert!(a.cmpge(Vec3::ZERO).all() && a.cmple(Vec3::ONE).all(), "{id}: {a}");
        }
    }

    #[test]
    fn directions_are_about_grey_and_nothing_is_black() {
        assert_eq!(motion(&[0.0, 0.0]), [Vec3::splat(0.5)]);
        let moved = motion(&[2.0, -4.0, 0.0, 4.0]);
        assert_eq!(moved, [Vec3::new(0.75, 0.0, 0.5), Vec3::new(0.5, 1.0, 0.5)]);
        assert_eq!(normal(Vec3::Y), Vec3::new(0.5, 1.0, 0.5));
        assert_eq!(normal(Vec3::ZERO), Vec3::ZERO);
    }
}
