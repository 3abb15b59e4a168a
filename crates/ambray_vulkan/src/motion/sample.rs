//! How near poses of a mesh are: by a few of its vertices.

use ambray_scene::animation::Deformer;
use glam::{Affine3A, Vec3};

/// Most vertices that are compared.
const MOST: usize = 256;

/// Positions of evenly spaced vertices at a pose.
pub(super) fn posed(deformer: &Deformer, weights: &[f32], joints: &[Affine3A]) -> Vec<Vec3> {
    vertices(deformer.positions.len()).map(|i| deformer.vertex(i, weights, joints).position).collect()
}

/// The same of `positions`.
pub(super) fn of(positions: &[Vec3]) -> Vec<Vec3> {
    vertices(positions.len()).map(|i| positions[i]).collect()
}

fn vertices(count: usize) -> impl Iterator<Item = usize> {
    let sampled = count.min(MOST);
    (0..sampled).map(move |k| k * count / sampled)
}

/// Which of `samples` is nearest to `sample` by the mean squared distance; the first of equals.
///
/// # Panics
/// If there is none.
pub(super) fn nearest<'s>(samples: impl Iterator<Item = Option<&'s [Vec3]>>, sample: &[Vec3]) -> usize {
    let distance = |other: &[Vec3]| -> f64 {
        other.iter().zip(sample).map(|(a, b)| (a.as_dvec3() - b.as_dvec3()).length_squared()).sum()
    };
    let known = samples.enumerate().filter_map(|(i, other)| Some((i, other?)));
    let nearest = known.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
    nearest.expect("one has been built").0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_pose_wins() {
        let at = |x: f32| vec![Vec3::ZERO, Vec3::X * x];
        let samples = [Some(at(0.0)), None, Some(at(4.0)), Some(at(4.0)), Some(at(9.0))];
        let find = |x: f32| nearest(samples.iter().map(Option::as_deref), &at(x));
        assert_eq!([-3.0, 1.9, 2.1, 7.0, 1e12].map(find), [0, 0, 2, 4, 4]);
    }

    #[test]
    fn samples_are_spread_and_bounded() {
        assert!(vertices(0).eq(0..0));
        assert!(vertices(3).eq(0..3));
        let many: Vec<_> = vertices(100_000).collect();
        assert_eq!((many.len(), many[0], many[255]), (256, 0, 99_609));
    }
}
