//! Rays that do not agree with their neighbours in the batch, brought together by direction.
//!
//! Where a tile shows many small surfaces, the directions of a run point everywhere. But a batch has thousands of rays: by
//! direction they are sorted into as many cells as make packets of them again.

use glam::Vec3;

/// Cells along a side of the part of a cube's face in one octant; a power of two.
const SIDE: u32 = 4;

/// Cells in one octant on one face.
const CELLS: u32 = SIDE * SIDE;

/// All cells.
const ALL: usize = (24 * CELLS) as usize;

/// A ray of a batch.
#[derive(Clone, Copy, Default)]
pub(crate) struct LooseRay {
    cell: u32,
    /// Its place in the batch.
    pub(crate) index: u32,
}

/// Loose rays of a batch.
#[derive(Default)]
pub(crate) struct Loose {
    rays: Vec<LooseRay>,
    sorted: Vec<LooseRay>,
}

impl Loose {
    /// Adds ray `index` of the batch.
    #[inline(always)]
    pub(crate) fn push(&mut self, index: usize, direction: Vec3) {
        self.rays.push(LooseRay { cell: cell(direction), index: index as u32 });
    }

    /// The rays sorted by cell, by counting; those of one cell keep their order.
    #[inline(always)]
    pub(crate) fn sort(&mut self) -> &[LooseRay] {
        let mut starts = [0_u32; ALL + 1];
        for ray in &self.rays {
            starts[ray.cell as usize + 1] += 1;
        }
        for cell in 0..ALL {
            starts[cell + 1] += starts[cell];
        }
        self.sorted.resize(self.rays.len(), LooseRay::default());
        for &ray in &self.rays {
            let place = &mut starts[ray.cell as usize];
            self.sorted[*place as usize] = ray;
            *place += 1;
        }
        &self.sorted
    }

    /// Takes the next rays that agree in octant and longest axis, up to `N`, from those that are left of the sorted ones.
    #[inline(always)]
    pub(crate) fn take<'a, const N: usize>(left: &mut &'a [LooseRay]) -> Option<&'a [LooseRay]> {
        let first = left.first()?;
        let same = |ray: &LooseRay| ray.cell / CELLS == first.cell / CELLS;
        let count = left.iter().take(N).take_while(|ray| same(ray)).count();
        let (taken, rest) = left.split_at(count);
        *left = rest;
        Some(taken)
    }
}

/// Cell of a direction on a cube around the origin: octant and longest axis first, then a grid in Morton order. Any number
/// will do for directions that are not finite.
#[inline(always)]
fn cell(d: Vec3) -> u32 {
    let a = d.abs();
    let (face, z, x, y) = if a.x >= a.y && a.x >= a.z {
        (0, a.x, a.y, a.z)
    } else if a.y >= a.z {
        (1, a.y, a.z, a.x)
    } else {
        (2, a.z, a.x, a.y)
    };
    let octant = u32::from(d.x < 0.0) | u32::from(d.y < 0.0) << 1 | u32::from(d.z < 0.0) << 2;
    let scale = SIDE as f32 / z;
    let (x, y) = (((x * scale) as u32).min(SIDE - 1), ((y * scale) as u32).min(SIDE - 1));
    let morton = x & 1 | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
    (octant * 3 + face) * CELLS + morton
}
