//! Rays that do not agree with their neighbours in the batch, brought together by direction.
//!
//! Where a tile shows many small surfaces, the directions of a run point everywhere. But a batch has thousands of rays: by
//! direction they are sorted into as many cells as make packets of them again.

use super::bundle::{Bundle, LANES};

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
    /// Adds the rays of `group` of a `bundle` that begins with ray `first` of the batch.
    #[inline(always)]
    pub(crate) fn push(&mut self, first: usize, bundle: &Bundle, group: u32) {
        // They agree in octant and longest axis.
        let (order, axes) = bundle.turn(group.trailing_zeros() as usize % LANES);
        let octant = u32::from(order.down[0]) | u32::from(order.down[1]) << 1 | u32::from(order.down[2]) << 2;
        let cells = (octant * 3 + axes[2] as u32) * CELLS;
        let mut lanes = group;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % LANES;
            lanes &= lanes - 1;
            let cell = cells + cell(bundle, lane);
            self.rays.push(LooseRay { cell, index: (first + lane) as u32 });
        }
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

/// Cell of a ray's direction among those of its octant on a face of a cube around the origin, in Morton order.
#[inline(always)]
fn cell(bundle: &Bundle, lane: usize) -> u32 {
    // Not above 1: the direction is longest along the last axis.
    let along = |axis: usize| ((bundle.shear[axis].0[lane % LANES].abs() * SIDE as f32) as u32).min(SIDE - 1);
    let (x, y) = (along(0), along(1));
    x & 1 | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2
}
