//! Where a reference has edges.

use crate::Map;

/// Least step between neighbours that is an edge (spec §10).
const STEP: f32 = 0.08;

/// Pixels whose `reference` differs by more than 0.08 from one of their four neighbours. The RMSE inside is the loss of
/// detail, that outside ("flat") the noise (spec §10).
#[must_use]
pub fn edges(reference: &Map) -> Vec<bool> {
    let (width, height) = (reference.width, reference.height());
    let at = |x: usize, y: usize| reference.values[y * width + x];
    let differs = |a: f32, b: f32| (a - b).abs() > STEP;
    (0..reference.values.len())
        .map(|i| {
            let (x, y) = (i % width, i / width);
            (x > 0 && differs(at(x, y), at(x - 1, y)))
                || (x + 1 < width && differs(at(x, y), at(x + 1, y)))
                || (y > 0 && differs(at(x, y), at(x, y - 1)))
                || (y + 1 < height && differs(at(x, y), at(x, y + 1)))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_steps() {
        let step = |t: fn(usize) -> usize| {
            edges(&Map {
                width: 64,
                values: (0..64 * 48).map(|i| if t(i) < 10 { 0.0 } else { 0.1 }).collect(),
            })
        };
        let across = step(|i| i % 64);
        assert!((0..64 * 48).all(|i| across[i] == (i % 64 == 9 || i % 64 == 10)));
        let down = step(|i| i / 64);
        assert!((0..64 * 48).all(|i| down[i] == (i / 64 == 9 || i / 64 == 10)));
    }

    #[test]
    fn a_slope_is_no_edge() {
        let slope = Map { width: 12, values: (0..12).map(|x| x as f32 * 0.075).collect() };
        assert!(edges(&slope).iter().all(|edge| !edge));
    }
}
