//! How much the boxes of structures overlap: what makes rays enter several of them in one place.

use super::bounds::Bounds;

/// Most boxes that are compared with each other; of more, evenly spaced ones stand for all.
const SAMPLE: usize = 2048;

/// Σ over all pairs of the surface area that they have in common, over the surface area of the box around all.
///
/// 0 where nothing overlaps; a ray through the scene enters about this many structures more than it must.
pub(super) fn overlap(boxes: &[Bounds]) -> f64 {
    let boxes: Vec<_> = boxes.iter().filter(|b| !b.is_empty()).copied().collect();
    let all = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union).half_area();
    let count = boxes.len().min(SAMPLE);
    if count < 2 || all <= 0.0 {
        return 0.0;
    }
    let sample: Vec<_> = (0..count).map(|i| boxes[i * boxes.len() / count]).collect();
    let common: f64 = (1..count)
        .flat_map(|i| sample[..i].iter().map(move |b| (i, b)))
        .map(|(i, b)| sample[i].intersection(*b).half_area())
        .sum();
    let pairs = |n: usize| n as f64 * (n - 1) as f64;
    common / all * (pairs(boxes.len()) / pairs(count))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn cube(at: f32) -> Bounds {
        Bounds { lo: Vec3::new(at, 0.0, 0.0), hi: Vec3::new(at + 1.0, 1.0, 1.0) }
    }

    #[test]
    fn overlap_counts_what_is_common() {
        assert_eq!(overlap(&[]), 0.0);
        assert_eq!(overlap(&[cube(0.0), Bounds::EMPTY]), 0.0);
        assert_eq!(overlap(&[cube(0.0), cube(2.0), cube(4.0)]), 0.0);
        assert_eq!(overlap(&[cube(0.0), cube(0.0)]), 1.0);
        // Three pairs.
        assert_eq!(overlap(&[cube(0.0); 3]), 3.0);
        // Sampled: n (n - 1) / 2 pairs of the same box.
        assert!((overlap(&[cube(0.0); 10_000]) / (10_000.0 * 9_999.0 / 2.0) - 1.0).abs() < 1e-9);
    }
}
