//! XeGTAO's denoiser: a mean over 3 × 3 pixels that stops where depth jumps.

use ambray_core::control::{Cancelled, Control};
use rayon::prelude::*;

use super::march::view_distance;
use crate::Screen;

/// Weight of the pixel itself in the last pass (`DenoiseBlurBeta`).
const CENTRE_WEIGHT: f32 = 1.2;

/// Weight of the pixel itself in a pass before the last, relative to that.
const EARLY_PASS: f32 = 0.2;

/// Weight of each of the two ways to a diagonal neighbour.
const DIAGONAL_WEIGHT: f32 = 0.85 * 0.5;

/// How well a pixel is connected with its left, right, top and bottom neighbour: 1 on a surface, 0 across an edge.
type Edges = [f32; 4];

const LEFT: usize = 0;
const RIGHT: usize = 1;
const TOP: usize = 2;
const BOTTOM: usize = 3;

/// `values` after so many passes (`XeGTAO_Denoise`): 1 is XeGTAO's "sharp", 2 "medium", 3 "soft".
///
/// Values stay floats between passes, where XeGTAO rounds them to 8 bits. The result is at most 1.
pub(crate) fn denoise(
    screen: &Screen,
    values: &[f32],
    passes: u32,
    control: &Control<'_>,
) -> Result<Vec<f32>, Cancelled> {
    let edges = Connections::of(screen, control)?;
    let mut values = values.to_vec();
    for pass in 1..=passes {
        let centre_weight = if pass == passes { CENTRE_WEIGHT } else { EARLY_PASS * CENTRE_WEIGHT };
        values = screen.map(control, |x, y| edges.mean(&values, x, y, centre_weight))?;
    }
    values.iter_mut().for_each(|value| *value = value.min(1.0));
    Ok(values)
}

/// The edges of all pixels, packed to two bits each.
struct Connections {
    width: usize,
    height: usize,
    packed: Vec<u8>,
}

impl Connections {
    fn of(screen: &Screen, control: &Control<'_>) -> Result<Self, Cancelled> {
        let (width, height) = screen.size();
        let mut packed = vec![0; width * height];
        packed.par_chunks_mut(width).enumerate().try_for_each(|(y, row)| {
            control.check()?;
            for (x, out) in row.iter_mut().enumerate() {
                *out = pack(edges(screen, x, y));
            }
            Ok(())
        })?;
        Ok(Self { width, height, packed })
    }

    /// Edges of the pixel that is `dx`, `dy` from (x, y), or of the nearest one in the picture, and its index.
    fn at(&self, x: usize, y: usize, [dx, dy]: [isize; 2]) -> (usize, Edges) {
        let x = x.saturating_add_signed(dx).min(self.width - 1);
        let y = y.saturating_add_signed(dy).min(self.height - 1);
        let index = y * self.width + x;
        (index, unpack(self.packed[index]))
    }

    /// The pixel at (x, y) averaged with those that it is connected with.
    fn mean(&self, values: &[f32], x: usize, y: usize, centre_weight: f32) -> f32 {
        let (centre, own) = self.at(x, y, [0, 0]);
        let [(l, left), (r, right), (t, top), (b, bottom)] =
            [[-1, 0], [1, 0], [0, -1], [0, 1]].map(|step| self.at(x, y, step));
        let edges = leak([
            own[LEFT] * left[RIGHT],
            own[RIGHT] * right[LEFT],
            own[TOP] * top[BOTTOM],
            own[BOTTOM] * bottom[TOP],
        ]);
        // A diagonal neighbour is reached over either of two neighbours.
        let diagonals = [
            ([-1, -1], edges[LEFT] * left[TOP] + edges[TOP] * top[LEFT]),
            ([1, -1], edges[TOP] * top[RIGHT] + edges[RIGHT] * right[TOP]),
            ([-1, 1], edges[BOTTOM] * bottom[LEFT] + edges[LEFT] * left[BOTTOM]),
            ([1, 1], edges[RIGHT] * right[BOTTOM] + edges[BOTTOM] * bottom[RIGHT]),
        ];
        let straight = [l, r, t, b].into_iter().zip(edges);
        let diagonal =
            diagonals.into_iter().map(|(step, ways)| (self.at(x, y, step).0, DIAGONAL_WEIGHT * ways));
        let start = (centre_weight * values[centre], centre_weight);
        let (sum, weight) = straight
            .chain(diagonal)
            .fold(start, |(sum, weights), (index, weight)| (sum + weight * values[index], weights + weight));
        sum / weight
    }
}

/// Connections of pixel (x, y) by depth alone (`XeGTAO_CalculateEdges`). The slope of the surface is no edge.
fn edges(screen: &Screen, x: usize, y: usize) -> Edges {
    /// Jump of the depth, relative to the depth, at which a connection ends.
    const JUMP: f32 = 0.011;
    let (width, height) = screen.size();
    let depth = |x: usize, y: usize| screen.depths()[y * width + x];
    let centre = depth(x, y);
    if !centre.is_finite() {
        return [0.0; 4];
    }
    let [left, right, top, bottom] = [
        depth(x.saturating_sub(1), y),
        depth((x + 1).min(width - 1), y),
        depth(x, y.saturating_sub(1)),
        depth(x, (y + 1).min(height - 1)),
    ]
    .map(|neighbour| neighbour - centre);
    let (across, down) = (0.5 * (right - left), 0.5 * (bottom - top));
    let tolerance = JUMP * view_distance(screen.camera(), centre);
    [(left, across), (right, -across), (top, down), (bottom, -down)].map(|(jump, slope)| {
        let jump = jump.abs().min((jump + slope).abs());
        (1.25 - jump / tolerance).clamp(0.0, 1.0)
    })
}

/// A pixel with three or four edges takes a little from its neighbours all the same, against aliasing.
fn leak(edges: Edges) -> Edges {
    const THRESHOLD: f32 = 2.5;
    const STRENGTH: f32 = 0.5;
    let connected: f32 = edges.iter().sum();
    let edginess = (4.0 - THRESHOLD - connected).clamp(0.0, 1.0) / (4.0 - THRESHOLD) * STRENGTH;
    edges.map(|edge| (edge + edginess).min(1.0))
}

/// Four levels for each of the edges (`XeGTAO_PackEdges`).
fn pack(edges: Edges) -> u8 {
    edges.iter().fold(0, |packed, edge| packed << 2 | (edge * 2.9).round_ties_even() as u8)
}

/// `XeGTAO_UnpackEdges`.
fn unpack(packed: u8) -> Edges {
    [6, 4, 2, 0].map(|shift| f32::from((packed >> shift) & 3) / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_packed_to_four_levels() {
        let edges = [1.0, 0.0, 0.34, 0.6];
        assert_eq!(unpack(pack(edges)), [1.0, 0.0, 1.0 / 3.0, 2.0 / 3.0]);
        assert_eq!(unpack(pack([1.0; 4])), [1.0; 4]);
    }

    #[test]
    fn only_pixels_with_three_edges_leak() {
        assert_eq!(leak([1.0, 1.0, 1.0, 0.0]), [1.0, 1.0, 1.0, 0.0]);
        // One connection left: (4 − 2.5 − 1)/(4 − 2.5) · 0.5 = 1/6 is added to each.
        let expected = [1.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0];
        for (edge, expected) in leak([1.0, 0.0, 0.0, 0.0]).into_iter().zip(expected) {
            assert!((edge - expected).abs() < 1e-6, "{edge} for {expected}");
        }
        // None: saturate(1.5) is 1, over 1.5, halved.
        assert!((leak([0.0; 4])[0] - 1.0 / 3.0).abs() < 1e-6);
    }
}
