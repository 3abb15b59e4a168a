//! Randomness that repeats every 4 × 4 pixels, as in the small textures of SSAO and HBAO.

use ambray_core::sampling::{PixelKey, unit_float};

/// Pixels along a side of the tile.
const SIDE: usize = 4;

/// A value for each pixel of a tile of 4 × 4.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tile<T>([[T; SIDE]; SIDE]);

impl<T: Copy> Tile<T> {
    /// The tile whose values `value` makes of random numbers: its argument gives number i in [0, 1) of a pixel.
    pub(crate) fn new(seed: u32, value: impl Fn(&dyn Fn(u32) -> f32) -> T) -> Self {
        Self(std::array::from_fn(|y| {
            std::array::from_fn(|x| {
                let key = PixelKey::new(x as u32, y as u32, 0, seed);
                value(&|i| unit_float(key.ray_seed(i)))
            })
        }))
    }

    /// The value at pixel (x, y) of the picture.
    pub(crate) const fn at(&self, x: usize, y: usize) -> T {
        self.0[y % SIDE][x % SIDE]
    }
}
