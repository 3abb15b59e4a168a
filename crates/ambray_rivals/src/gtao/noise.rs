//! The noise that turns slices and shifts steps: the R2 sequence along a Hilbert curve, as XeGTAO has it.

use ambray_core::sampling::{r2_point, unit_float};
use glam::Vec2;

/// Pixels along the side of a tile (`XE_HILBERT_WIDTH`).
const TILE: u32 = 64;

/// Frames after which the noise repeats (`GTAOUpdateConstants`).
const FRAMES: u32 = 64;

/// How far a frame moves along the sequence; found by trying (`SpatioTemporalNoise`).
const FRAME_STEP: u32 = 288;

/// Place of pixel (x, y) on the Hilbert curve that fills its tile (`HilbertIndex`).
const fn hilbert_index(x: u32, y: u32) -> u32 {
    let (mut x, mut y) = (x % TILE, y % TILE);
    let mut index = 0;
    let mut side = TILE / 2;
    while side > 0 {
        let (right, below) = ((x / side) % 2, (y / side) % 2);
        // The curve visits the quadrants (0, 0), (0, 1), (1, 1), (1, 0).
        index += side * side * ((3 * right) ^ below);
        if below == 0 {
            if right == 1 {
                (x, y) = (TILE - 1 - x, TILE - 1 - y);
            }
            (x, y) = (y, x);
        }
        side /= 2;
    }
    index
}

/// Noise of pixel (x, y) in `[0, 1)²`: x turns the slices, y shifts the steps (`SpatioTemporalNoise`).
///
/// Seed 0 gives XeGTAO's own noise, another one the same shifted as a whole (Cranley and Patterson 1976).
pub(super) fn spatio_temporal_noise(x: u32, y: u32, frame: u32, seed: u32) -> Vec2 {
    const HALF: u32 = 1 << 31;
    let shift = [0x9e37_79b9, 0x85eb_ca6b].map(|odd: u32| HALF.wrapping_add(seed.wrapping_mul(odd)));
    let index = hilbert_index(x, y) + FRAME_STEP * (frame % FRAMES);
    let [u, v] = r2_point(index, shift);
    Vec2::new(unit_float(u), unit_float(v))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn the_curve_visits_every_pixel_of_a_tile_and_steps_to_neighbours() {
        let mut places = vec![None; (TILE * TILE) as usize];
        for y in 0..TILE {
            for x in 0..TILE {
                let place = &mut places[hilbert_index(x, y) as usize];
                assert_eq!(*place, None, "two pixels share a place");
                *place = Some((x, y));
            }
        }
        for pair in places.windows(2) {
            let ((ax, ay), (bx, by)) = (pair[0].unwrap(), pair[1].unwrap());
            assert_eq!(ax.abs_diff(bx) + ay.abs_diff(by), 1, "{pair:?}");
        }
        assert_eq!(hilbert_index(64 + 5, 128 + 9), hilbert_index(5, 9));
    }

    #[test]
    fn noise_is_that_of_xegtao() {
        // frac(0.5 + i · (1/g, 1/g²)) with the plastic number g = 1.32471795724474602596, worked out with 50 digits for the
        // curve's first pixels (0, 0), (1, 0), (1, 1), (0, 1), the tile's far corner (index 4095) and frame 1 (index 288).
        let expected = [
            ((0, 0, 0), (0.5, 0.5)),
            ((1, 0, 0), (0.254_877_666, 0.069_840_291)),
            ((1, 1, 0), (0.009_755_332, 0.639_680_582)),
            ((0, 1, 0), (0.764_632_999, 0.209_520_873)),
            ((63, 0, 0), (0.724_043_280, 0.995_991_637)),
            ((0, 0, 1), (0.904_767_879, 0.614_003_807)),
        ];
        for ((x, y, frame), (u, v)) in expected {
            let noise = spatio_temporal_noise(x, y, frame, 0);
            assert!(noise.as_dvec2().abs_diff_eq(dvec2(u, v), 2e-6), "{noise} for {x}, {y} in frame {frame}");
        }
        assert_eq!(spatio_temporal_noise(3, 4, 64, 0), spatio_temporal_noise(3, 4, 0, 0));
        assert_ne!(spatio_temporal_noise(3, 4, 0, 1), spatio_temporal_noise(3, 4, 0, 0));
    }
}
