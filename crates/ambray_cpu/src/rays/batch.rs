//! Rays of one type with their places in the picture, and the orders in which they can be traced.

use std::ops::Range;

use ambray_core::{sampling::sample_class, trace::Ray};

use crate::backend::TILE;

/// What is asked about a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// Its closest hit.
    Closest,
    /// Whether it hits anything.
    Any,
}

/// Rays of one type, tile by tile, in the order in which they were traced.
#[derive(Clone, Debug, PartialEq)]
pub struct RayBatch {
    /// What is asked about them.
    pub kind: RayKind,
    /// Pixels in a row of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Most rays that a pixel can have, at least 1.
    pub per_pixel: u32,
    /// The rays.
    pub rays: Vec<Ray>,
    /// Where each belongs: (y · width + x) · `per_pixel` + number of the ray in its pixel. At pixels of one class, rays of
    /// one number are parallel on flat surfaces.
    pub tags: Vec<u32>,
}

/// An order of the rays within each tile of 16 × 16 pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Order {
    /// As they are in the batch, tile by tile.
    Traced,
    /// By sample class, then by number, then by pixel: what is parallel on flat surfaces stands together.
    Deinterleaved,
    /// By pixel, then by number.
    Pixel,
}

impl Order {
    /// Its lower-case name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Traced => "traced",
            Self::Deinterleaved => "deinterleaved",
            Self::Pixel => "pixel",
        }
    }
}

impl RayBatch {
    /// Whether the tags of such a picture are numbers of 32 bits.
    #[must_use]
    pub const fn has_tags(width: u32, height: u32, per_pixel: u32) -> bool {
        // Below 2^96, but not by much: 128 bits.
        width as u128 * height as u128 * per_pixel as u128 <= 1 << 32
    }

    /// Pixel (x, y) of a tag.
    #[must_use]
    pub const fn pixel(&self, tag: u32) -> (u32, u32) {
        let pixel = tag / self.per_pixel;
        (pixel % self.width, pixel / self.width)
    }

    /// Indices of the rays in `order`, and which of these indices are of one tile.
    ///
    /// # Panics
    /// If there are more than 2³² rays, or not as many tags.
    #[must_use]
    pub fn ordered(&self, order: Order) -> (Vec<u32>, Vec<Range<usize>>) {
        assert_eq!(self.rays.len(), self.tags.len(), "a tag for each ray");
        let count = u32::try_from(self.rays.len()).expect("tags are numbers of 32 bits");
        let tiles = u64::from(self.width.div_ceil(TILE as u32));
        let tile = |(x, y): (u32, u32)| u64::from(y / TILE as u32) * tiles + u64::from(x / TILE as u32);
        let tile_of = |i: u32| tile(self.pixel(self.tags[i as usize]));
        let key = |&i: &u32| {
            let tag = self.tags[i as usize];
            let ((x, y), number) = (self.pixel(tag), tag % self.per_pixel);
            let in_tile = match order {
                Order::Traced => (0, 0, 0),
                Order::Deinterleaved => (u32::from(sample_class(x, y)), number, y * self.width + x),
                Order::Pixel => (y * self.width + x, number, 0),
            };
            (tile((x, y)), in_tile)
        };
        let mut indices: Vec<u32> = (0..count).collect();
        indices.sort_by_cached_key(key);
        let mut ranges = Vec::new();
        let mut start = 0;
        for run in indices.chunk_by(|&a, &b| tile_of(a) == tile_of(b)) {
            ranges.push(start..start + run.len());
            start += run.len();
        }
        (indices, ranges)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// A batch of 20 × 4 pixels with two rays each, the last pixel first; the origin tells pixel and number.
    fn batch() -> RayBatch {
        let tags: Vec<u32> = (0..160).rev().collect();
        let origin = |tag: u32| Vec3::new((tag / 2 % 20) as f32, (tag / 40) as f32, (tag % 2) as f32);
        let ray = |&tag: &u32| Ray { origin: origin(tag), t_max: 1.0, direction: Vec3::X, seed: 0 };
        let rays = tags.iter().map(ray).collect();
        RayBatch { kind: RayKind::Any, width: 20, height: 4, per_pixel: 2, rays, tags }
    }

    #[test]
    fn every_order_has_each_ray_once_and_whole_tiles() {
        let batch = batch();
        for order in [Order::Traced, Order::Deinterleaved, Order::Pixel] {
            let (indices, tiles) = batch.ordered(order);
            let mut sorted = indices.clone();
            sorted.sort_unstable();
            assert!(sorted.iter().copied().eq(0..160), "{order:?}");
            assert_eq!(tiles, [0..128, 128..160], "{order:?}: 16 × 4 and 4 × 4 pixels");
            let is_left = |&i: &u32| batch.rays[i as usize].origin.x < 16.0;
            assert!(indices[..128].iter().all(is_left) && !indices[128..].iter().any(is_left), "{order:?}");
        }
    }

    #[test]
    fn orders_are_what_they_say() {
        let batch = batch();
        let first = |order: Order| {
            let (indices, _) = batch.ordered(order);
            indices[..4].iter().map(|&i| batch.rays[i as usize].origin.to_array()).collect::<Vec<_>>()
        };
        assert_eq!(first(Order::Pixel), [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]]);
        let traced = [[15.0, 3.0, 1.0], [15.0, 3.0, 0.0], [14.0, 3.0, 1.0], [14.0, 3.0, 0.0]];
        assert_eq!(first(Order::Traced), traced);
        // Class 0 is at one pixel of each 4 × 4: four of them in this tile, the first rays of all before the second.
        let deinterleaved = first(Order::Deinterleaved);
        let [x, y, _] = deinterleaved[0];
        assert_eq!(sample_class(x as u32, y as u32), 0);
        assert_eq!(deinterleaved, [0.0, 4.0, 8.0, 12.0].map(|step| [x + step, y, 0.0]));
    }

    #[test]
    fn tags_end_at_32_bits() {
        assert!(RayBatch::has_tags(1 << 16, 1 << 16, 1));
        assert!(!RayBatch::has_tags(1 << 16, 1 << 16, 2));
        assert!(!RayBatch::has_tags(u32::MAX, u32::MAX, u32::MAX));
    }
}
