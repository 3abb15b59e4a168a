//! Pseudo-random numbers and noise from an integer hash: the same on every machine.

use ambray_core::sampling::{pcg, unit_float};

/// Stream of numbers in `[0, 1)`.
#[derive(Clone, Debug)]
pub(crate) struct Dice(u32);

impl Dice {
    /// Begins the stream of `seed`.
    pub(crate) const fn new(seed: u32) -> Self {
        Self(pcg(seed))
    }

    /// The next number in `[0, 1)`.
    pub(crate) const fn unit(&mut self) -> f32 {
        self.0 = pcg(self.0.wrapping_add(0x9e37_79b9));
        unit_float(self.0)
    }

    /// The next number in `[lo, hi)`.
    pub(crate) fn between(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * self.unit()
    }
}

/// Smooth value noise in `[0, 1]` with `cells` cells per unit; repeats with period 1.
pub(crate) fn noise(u: f32, v: f32, cells: [u32; 2], seed: u32) -> f32 {
    let axis = |x: f32, cells: u32| {
        let x = x * cells as f32;
        let floor = libm::floorf(x);
        let cell = (floor as i32).rem_euclid(cells as i32) as u32;
        let t = x - floor;
        (cell, (cell + 1) % cells, t * t * (3.0 - 2.0 * t))
    };
    let ((x0, x1, s), (y0, y1, t)) = (axis(u, cells[0]), axis(v, cells[1]));
    let seed = pcg(seed);
    let row = |y: u32| {
        let row = pcg(y.wrapping_add(seed));
        let value = |x: u32| unit_float(pcg(x.wrapping_add(row)));
        value(x0) * (1.0 - s) + value(x1) * s
    };
    row(y0) * (1.0 - t) + row(y1) * t
}

/// Sum of `octaves` of noise, each twice as fine and half as strong; in `[0, 1]`.
pub(crate) fn cloud(u: f32, v: f32, cells: [u32; 2], octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..octaves {
        sum += weight * noise(u, v, cells.map(|c| c << octave), seed.wrapping_add(octave));
        total += weight;
        weight *= 0.5;
    }
    sum / total
}

/// 0 below `from`, 1 above `to`, smooth between.
pub(crate) fn smoothstep(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
