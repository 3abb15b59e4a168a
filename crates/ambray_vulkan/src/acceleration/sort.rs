//! The order of the primitives of a structure.

use glam::Vec3;

use super::bounds::Bounds;

/// Spatial order of the primitives with these centres: positions in the order, as indices into `centres`.
///
/// Recursive halves at the object median of the largest extent, the left half taking the odd one. Some drivers build
/// balanced trees over primitives in the order given (Mesa's software device up to version 25, which splits in exactly
/// these halves), and trace up to 16 times faster for it; elsewhere neighbours in space are neighbours in memory.
///
/// Equal coordinates are ordered by index, so the order is a function of the centres alone.
pub(super) fn spatial_order(centres: &[Vec3]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..centres.len() as u32).collect();
    // Halves shrink with each level, so the list never holds more than two entries a level.
    let mut pending = vec![(0, order.len())];
    while let Some((start, end)) = pending.pop() {
        if end - start <= 2 {
            continue;
        }
        let part = &mut order[start..end];
        let bounds: Bounds = part.iter().map(|&i| centres[i as usize]).collect();
        let axis = (bounds.hi - bounds.lo).max_position();
        let half = part.len().div_ceil(2);
        part.select_nth_unstable_by(half, |&a, &b| {
            let (x, y) = (centres[a as usize][axis], centres[b as usize][axis]);
            x.total_cmp(&y).then(a.cmp(&b))
        });
        pending.push((start + half, end));
        pending.push((start, start + half));
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_a_permutation_for_any_size() {
        for n in 0..70_u32 {
            let centres: Vec<_> =
                (0..n).map(|i| Vec3::new((i * 37 % 11) as f32, (i * 17 % 5) as f32, 0.0)).collect();
            let mut order = spatial_order(&centres);
            order.sort_unstable();
            assert!(order.into_iter().eq(0..n));
        }
        // All in one place.
        assert_eq!(spatial_order(&[Vec3::ONE; 1000]).len(), 1000);
    }

    #[test]
    fn halves_are_apart() {
        // A line of 101 points, shuffled.
        let centres: Vec<_> = (0..101).map(|i| Vec3::new(0.0, (i * 40 % 101) as f32, 0.0)).collect();
        let order = spatial_order(&centres);
        let y = |i: &u32| centres[*i as usize].y;
        let (left, right) = order.split_at(51);
        assert!(left.iter().map(y).fold(0.0, f32::max) < right.iter().map(y).fold(1e9, f32::min));
        // And so on within the halves: neighbours in the order are close.
        assert!(order.windows(2).all(|w| (y(&w[0]) - y(&w[1])).abs() < 8.0));
    }
}
