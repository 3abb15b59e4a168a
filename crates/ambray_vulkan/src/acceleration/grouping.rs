//! Which static meshes share a structure: grouping of boxes, without Vulkan.

use std::ops::Range;

use glam::Vec3;

use super::bounds::Bounds;

/// What to group: one placed mesh or shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    /// World space.
    pub(super) bounds: Bounds,
    /// Number of triangles or boxes.
    pub(super) primitives: u64,
}

/// Cost of a node of the upper tree in the unit of entering a structure. What a ray saves by a split, entering the common
/// box, must exceed what it pays for two boxes and this node.
const NODE: f64 = 0.3;

/// Groups of fewer primitives are not split: a structure takes some kilobytes and a build.
const LEAST: u64 = 256;

/// Groups of more primitives are split whatever it costs, so that building needs bounded memory at a time.
pub(super) const MOST: u64 = 1 << 22;

/// Levels of splits by cost; below them groups are halved, so that recursion is bounded.
const LEVELS: u32 = 32;

/// Groups `items`, as indices; each item is in one group.
///
/// A ray enters a structure if it meets its box, at a probability that follows the box's surface (the surface area
/// heuristic, MacDonald and Booth 1990). So where the boxes of two halves together have less surface than the box around
/// them, mostly because it is empty between them, two structures are cheaper than one; where the halves overlap, one is
/// cheaper, since its tree sorts their triangles and two structures would both be searched. All items are split top-down,
/// each time where surface × primitives is least, and of the resulting tree the cheapest cut is taken: the surface of its
/// groups' boxes, and [`NODE`] times that of the boxes above them.
pub(super) fn group(items: &[Item]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..items.len()).collect();
    let mut groups = Vec::new();
    if !items.is_empty() {
        cut(items, &mut order, 0, 0, &mut groups);
    }
    groups.into_iter().map(|range| order[range].to_vec()).collect()
}

/// Appends the groups of the cheapest cut below `order`, which begins at `start` of the whole order; returns their cost.
fn cut(items: &[Item], order: &mut [usize], start: usize, level: u32, groups: &mut Vec<Range<usize>>) -> f64 {
    let bounds = order.iter().map(|&i| items[i].bounds).fold(Bounds::EMPTY, Bounds::union);
    let primitives: u64 = order.iter().map(|&i| items[i].primitives).sum();
    let whole = start..start + order.len();
    if order.len() == 1 || primitives <= LEAST {
        groups.push(whole);
        return bounds.half_area();
    }
    let middle = split(items, order, level);
    let before = groups.len();
    let (left, right) = order.split_at_mut(middle);
    let apart = cut(items, left, start, level + 1, groups)
        + cut(items, right, start + middle, level + 1, groups)
        + NODE * bounds.half_area();
    if primitives <= MOST && bounds.half_area() <= apart {
        groups.truncate(before);
        groups.push(whole);
        return bounds.half_area();
    }
    apart
}

/// Sorts `order` so that its best split is at the returned position, which is neither end.
fn split(items: &[Item], order: &mut [usize], level: u32) -> usize {
    let sort = |order: &mut [usize], axis: usize| {
        let at = |i: usize| items[i].bounds.centre()[axis];
        order.sort_unstable_by(|&a, &b| at(a).total_cmp(&at(b)).then(a.cmp(&b)));
    };
    if level >= LEVELS {
        let centres: Bounds = order.iter().map(|&i| items[i].bounds.centre()).collect();
        sort(order, Vec3::max_position(centres.hi - centres.lo));
        return order.len() / 2;
    }
    let middle = order.len() / 2;
    let mut best = (f64::INFINITY, 0, middle);
    // Surface × primitives of all items from the end to each one.
    let mut behind = vec![0.0; order.len()];
    let grow = |(bounds, count): (Bounds, u64), i: usize| {
        (bounds.union(items[i].bounds), count + items[i].primitives)
    };
    let cost = |(bounds, count): (Bounds, u64)| bounds.half_area() * count as f64;
    for axis in 0..3 {
        sort(order, axis);
        let mut sum = (Bounds::EMPTY, 0);
        for (position, &i) in order.iter().enumerate().rev() {
            sum = grow(sum, i);
            behind[position] = cost(sum);
        }
        let mut sum = (Bounds::EMPTY, 0);
        for position in 1..order.len() {
            sum = grow(sum, order[position - 1]);
            let total = cost(sum) + behind[position];
            // Where all is in one place, halves.
            let is_tie = (total - best.0).abs() <= 1e-9 * total;
            let is_better =
                if is_tie { position.abs_diff(middle) < best.2.abs_diff(middle) } else { total < best.0 };
            if is_better {
                best = (total, axis, position);
            }
        }
    }
    sort(order, best.1);
    best.2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(x: f32, y: f32, size: f32) -> Item {
        let lo = Vec3::new(x, y, 0.0);
        Item { bounds: Bounds { lo, hi: lo + size }, primitives: 1000 }
    }

    fn sizes(items: &[Item]) -> Vec<usize> {
        let groups = group(items);
        let mut all: Vec<usize> = groups.iter().flatten().copied().collect();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..items.len()), "each item is in one group");
        let mut sizes: Vec<_> = groups.iter().map(Vec::len).collect();
        sizes.sort_unstable();
        sizes
    }

    #[test]
    fn what_overlaps_stays_together() {
        let heap: Vec<_> = (0..20).map(|i| cube(0.1 * i as f32, 0.0, 1.0)).collect();
        assert_eq!(sizes(&heap), [20]);
        assert_eq!(sizes(&[cube(0.0, 0.0, 1.0); 5]), [5]);
        assert!(sizes(&[]).is_empty());
    }

    #[test]
    fn what_is_far_apart_is_split() {
        assert_eq!(sizes(&[cube(0.0, 0.0, 1.0), cube(30.0, 0.0, 1.0)]), [1, 1]);
        // Touching: nothing is gained.
        assert_eq!(sizes(&[cube(0.0, 0.0, 1.0), cube(1.0, 0.0, 1.0)]), [2]);
        // Two heaps.
        let heaps: Vec<_> = (0..20).map(|i| cube(0.1 * i as f32 + 50.0 * (i % 2) as f32, 0.0, 1.0)).collect();
        assert_eq!(sizes(&heaps), [10, 10]);
        // Four corners of a field: the first split alone would not pay.
        let corners = [(0.0, 0.0), (20.0, 0.0), (0.0, 20.0), (20.0, 20.0)].map(|(x, y)| cube(x, y, 2.0));
        assert_eq!(sizes(&corners), [1, 1, 1, 1]);
    }

    #[test]
    fn small_things_are_not_worth_a_structure() {
        let small = |x| Item { primitives: 12, ..cube(x, 0.0, 1.0) };
        assert_eq!(sizes(&[small(0.0), small(30.0)]), [2]);
    }

    #[test]
    fn groups_are_bounded_and_so_is_recursion() {
        let large = Item { primitives: MOST / 2, ..cube(0.0, 0.0, 1.0) };
        assert_eq!(sizes(&[large; 8]), [2, 2, 2, 2]);
        // Sizes and places that double: every split cuts off one.
        let spiral: Vec<_> = (0..100).map(|i| cube(2_f32.powi(i), 0.0, 2_f32.powi(i - 4))).collect();
        assert!(sizes(&spiral).len() > 10);
        assert!(sizes(&vec![large; 3000]).iter().all(|&n| n <= 2));
    }
}
