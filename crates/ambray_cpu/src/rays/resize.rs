//! The same surface in more triangles, to see how tracers scale.

use std::collections::HashMap;

use glam::Vec3;

use super::Triangles;

impl Triangles {
    /// The same surface in `count` triangles, or up to two fewer: each triangle is cut in four, and again, and a share of
    /// them, evenly spread, once more. If there are more to begin with, the largest of them stay, in their order.
    ///
    /// Edges are halved in single precision, so a cut moves the surface by rounding, and a neighbour that was not cut leaves
    /// as much of a gap.
    #[must_use]
    pub fn resized(mut self, count: usize) -> Self {
        if count < self.indices.len() {
            self.keep_largest(count);
            return self;
        }
        while !self.indices.is_empty() && self.indices.len() <= count / 4 {
            self.cut(|_| true);
        }
        let have = self.indices.len();
        let to_cut = (count - have) / 3;
        // As Bresenham draws a line: `to_cut` of `have`, evenly.
        self.cut(|i| (i + 1) * to_cut / have > i * to_cut / have);
        self
    }

    fn keep_largest(&mut self, count: usize) {
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize].as_dvec3());
            (b - a).cross(c - a).length_squared()
        };
        let areas: Vec<f64> = self.indices.iter().map(area).collect();
        let mut largest: Vec<usize> = (0..areas.len()).collect();
        largest.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]).then(a.cmp(&b)));
        largest.truncate(count);
        largest.sort_unstable();
        self.indices = largest.into_iter().map(|i| self.indices[i]).collect();
    }

    /// Cuts the triangles that `which` names in four, at the middles of their edges.
    fn cut(&mut self, which: impl Fn(usize) -> bool) {
        let mut middles = HashMap::new();
        let mut cut = Vec::with_capacity(self.indices.len());
        for (i, &[a, b, c]) in self.indices.iter().enumerate() {
            if !which(i) {
                cut.push([a, b, c]);
                continue;
            }
            let [ab, bc, ca] =
                [[a, b], [b, c], [c, a]].map(|edge| middle(&mut self.positions, &mut middles, edge));
            cut.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        self.indices = cut;
    }
}

/// The vertex in the middle of an edge; neighbours share it.
fn middle(positions: &mut Vec<Vec3>, middles: &mut HashMap<[u32; 2], u32>, [a, b]: [u32; 2]) -> u32 {
    *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
        positions.push(0.5 * positions[a as usize] + 0.5 * positions[b as usize]);
        (positions.len() - 1) as u32
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit square of two triangles and a small triangle beside it.
    fn shapes() -> Triangles {
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [2.1, 0.0], [2.0, 0.1]];
        Triangles {
            positions: positions.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
            indices: vec![[4, 5, 6], [0, 1, 2], [0, 2, 3]],
        }
    }

    fn area(triangles: &Triangles) -> f32 {
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| triangles.positions[corner as usize]);
            0.5 * (b - a).cross(c - a).z // with its sign: a flipped triangle would count against
        };
        triangles.indices.iter().map(area).sum()
    }

    #[test]
    fn cuts_keep_the_surface() {
        for count in [3, 4, 6, 9, 12, 13, 48, 50, 100, 1000] {
            let resized = shapes().resized(count);
            assert!(
                (count - 2..=count).contains(&resized.indices.len()),
                "{count}: {}",
                resized.indices.len()
            );
            assert!((area(&resized) - 1.005).abs() < 1e-5, "{count}: {}", area(&resized));
        }
    }

    #[test]
    fn neighbours_share_the_middles_of_their_edges() {
        // Square in four by four: 9 vertices; the small triangle: 6.
        assert_eq!(shapes().resized(12).positions.len(), 15);
    }

    #[test]
    fn of_fewer_the_largest_stay() {
        assert_eq!(shapes().resized(2).indices, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(shapes().resized(1).indices, [[0, 1, 2]]);
        assert_eq!(Triangles::default().resized(5), Triangles::default());
    }
}
