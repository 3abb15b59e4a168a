//! The rays of the first batch as structure of arrays, and what became of them.

use std::ops::Range;

use glam::Vec3;

use super::{GatherParams, ShadedPoint};
use crate::settings::Thin;

/// Points that are worked on at once. A tile has as many of each class.
pub(super) const LANES: usize = 16;

/// One ray of the first batch, after tracing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// World direction w_i.
    pub(super) direction: Vec3,
    /// Distance d_i of the hit; infinite on a miss, 0 below the geometric horizon.
    pub(super) distance: f32,
    /// Radiance L_r of the hit, 0 on a miss.
    pub(super) radiance: Vec3,
}

/// Points of equal class that follow each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// The first one.
    pub(super) first: usize,
    pub(super) points: usize,
    /// Slot of the first sample of the first one.
    slots: usize,
}

/// The N samples of each point of a batch: run by run, in a run sample by sample, and point by point for each. So are the
/// rays ordered too, and neighbours are worked on together.
#[derive(Debug, Default)]
pub(super) struct Samples {
    pub(super) runs: Vec<Run>,
    /// World directions w_i.
    pub(super) direction: [Vec<f32>; 3],
    /// Distances d_i: see [`Sample::distance`].
    pub(super) distance: Vec<f32>,
    /// Radiances L_r.
    pub(super) radiance: [Vec<f32>; 3],
    /// Azimuths v of the directions; empty unless the second batch asks for them.
    pub(super) azimuth: Vec<f32>,
    /// 1 where what the ray hit may move against its point, else 0; empty unless that is asked for.
    pub(super) changing: Vec<f32>,
}

impl Run {
    /// Slot of sample `j` of point `point` of the run.
    #[inline(always)]
    pub(super) const fn slot(&self, point: usize, j: usize) -> usize {
        self.slots + j * self.points + point
    }

    /// The points of the batch.
    pub(super) const fn range(&self) -> Range<usize> {
        self.first..self.first + self.points
    }
}

impl Samples {
    /// Point and number of the sample in `slot`.
    pub(super) fn place(&self, slot: usize) -> (usize, usize) {
        let run = self.runs[self.runs.partition_point(|run| run.slots <= slot) - 1];
        let within = slot - run.slots;
        (run.first + within % run.points, within / run.points)
    }

    /// Makes room for the samples of `points`. What was there stays until it is written.
    pub(super) fn begin(&mut self, params: &GatherParams<'_>, points: &[ShadedPoint]) {
        let spp = params.samples.spp() as usize;
        self.runs.clear();
        let mut first = 0;
        for run in points.chunk_by(|a, b| a.key.class == b.key.class) {
            self.runs.push(Run { first, points: run.len(), slots: first * spp });
            first += run.len();
        }
        let slots = first * spp;
        let planes = self.direction.iter_mut().chain(&mut self.radiance).chain([&mut self.distance]);
        planes.for_each(|plane| plane.resize(slots, 0.0));
        self.azimuth.resize(if params.thin == Thin::Sheet { slots } else { 0 }, 0.0);
        self.changing.resize(if params.temporal { slots } else { 0 }, 0.0);
    }

    /// The sample at `slot`.
    #[inline(always)]
    pub(super) fn get(&self, slot: usize) -> Sample {
        Sample {
            direction: at(&self.direction, slot),
            distance: self.distance[slot],
            radiance: at(&self.radiance, slot),
        }
    }
}

/// The vector in a `slot` of three planes.
#[inline(always)]
fn at([x, y, z]: &[Vec<f32>; 3], slot: usize) -> Vec3 {
    Vec3::new(x[slot], y[slot], z[slot])
}

/// `count` points in groups of [`LANES`], then one by one: `group` gets the first and how many, as a constant.
macro_rules! in_groups {
    ($count:expr, $group:ident($($argument:expr),*)) => {{
        let (count, mut at) = ($count, 0);
        while at + crate::gather::samples::LANES <= count {
            $group::<{ crate::gather::samples::LANES }>(at, $($argument),*);
            at += crate::gather::samples::LANES;
        }
        while at < count {
            $group::<1>(at, $($argument),*);
            at += 1;
        }
    }};
}
pub(super) use in_groups;

/// `L` values of `plane` from `at` on.
#[inline(always)]
pub(super) fn group<const L: usize>(plane: &[f32], at: usize) -> &[f32; L] {
    plane[at..at + L].try_into().expect("L values")
}

/// `L` values of `plane` from `at` on.
#[inline(always)]
pub(super) fn group_mut<const L: usize>(plane: &mut [f32], at: usize) -> &mut [f32; L] {
    (&mut plane[at..at + L]).try_into().expect("L values")
}
