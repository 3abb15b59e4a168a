//! Triangles in the very place of others.
//!
//! Of hits at equal distance the smallest (instance, triangle) counts (`ambray_core::trace`), but a device returns whichever
//! it comes across. Where opaque triangles have the same corners the others can never be what counts, so they are left out.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::Vec3;

/// Whether each of `triangles` is the one that counts among those with the same corners in any order. `refs` holds instance
/// and triangle of each.
pub(super) fn counting(positions: &[Vec3], triangles: &[[u32; 3]], refs: &[[u32; 2]]) -> Vec<bool> {
    let mut counts = vec![true; triangles.len()];
    let mut first: HashMap<[[u32; 3]; 3], usize> = HashMap::with_capacity(triangles.len());
    for (index, triangle) in triangles.iter().enumerate() {
        // Zero has two signs.
        let bits = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
        let mut corners = triangle.map(|i| bits(positions[i as usize]));
        corners.sort_unstable();
        match first.entry(corners) {
            Entry::Vacant(entry) => {
                entry.insert(index);
            }
            Entry::Occupied(mut entry) => {
                let other = *entry.get();
                let loser = if refs[index] < refs[other] { entry.insert(index) } else { index };
                counts[loser] = false;
            }
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_of_equals_counts() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(-0.0, 0.0, 0.0), Vec3::Z];
        let triangles = [[0, 1, 2], [2, 1, 3], [0, 1, 4], [1, 2, 0]];
        let refs = [[5, 0], [3, 9], [5, 1], [3, 8]];
        assert_eq!(counting(&positions, &triangles, &refs), [false, false, true, true]);
    }
}
