//! The filter over many rows at once: pixels side by side, as structure of arrays.

use std::{array::from_fn, ops::Range};

use glam::Vec4;

use super::{Filter, Guide, REACH};
use crate::settings::FilterTest;

/// Pixels that are filtered at once.
const LANES: usize = 16;
/// Columns that are transposed at once: with sixteen rows and their margins, what the cache next to the core holds.
const COLUMNS: usize = 128;
/// Pixels beyond each side of them.
const MARGIN: usize = REACH as usize;
/// Transposed pixels of a row.
const STRIDE: usize = COLUMNS + 2 * MARGIN;

/// Planes of a transposed guide.
const POSITION: usize = 0;
const NORMAL: usize = 3;
const DEPTH: usize = 6;
const FOOTPRINT: usize = 7;
/// The first plane of the first input.
const VALUES: usize = 8;

/// Buffers of [`Filter::filter_band`], reused from band to band.
#[derive(Debug, Default)]
pub struct BandScratch {
    /// Row by row, in a row plane by plane: [`STRIDE`] values of each.
    values: Vec<f32>,
}

/// Rows of a picture, some columns of them, transposed.
#[derive(Clone, Copy)]
struct Transposed<'a> {
    values: &'a [f32],
    planes: usize,
}

/// Sixteen pixels in whose windows others are tested.
struct Centre {
    position: [[f32; LANES]; 3],
    normal: [[f32; LANES]; 3],
    depth: [f32; LANES],
    /// What the distance or the difference in depth must be below.
    allowed: [f32; LANES],
}

impl Filter {
    /// Filters the `rows` of a picture of `width` pixels a row: writes these rows of each plane of `inputs` to `outputs`.
    ///
    /// Taps outside the picture and taps that see no surface are skipped; pixels that see no surface are copied.
    ///
    /// Inlined, so that its loops over neighbouring pixels are compiled for the instruction set of the caller. The bits do
    /// not depend on it.
    ///
    /// # Panics
    /// If the slices do not have the size of the picture, or of the rows.
    #[inline(always)]
    pub fn filter_band<const PLANES: usize>(
        &self,
        guides: &[Guide],
        width: usize,
        rows: Range<usize>,
        inputs: [&[Vec4]; PLANES],
        mut outputs: [&mut [Vec4]; PLANES],
        scratch: &mut BandScratch,
    ) {
        for first in (0..width).step_by(COLUMNS) {
            let columns = first..width.min(first + COLUMNS);
            let from = scratch.transpose(guides, width, rows.clone(), columns.clone(), inputs);
            for row in 0..rows.len() {
                for column in (0..columns.len()).step_by(LANES) {
                    let filtered: [[[f32; LANES]; 4]; PLANES] = match self.test {
                        FilterTest::Plane => self.filter_group(from, (row, column), Centre::plane_distance),
                        FilterTest::Absolute | FilterTest::Relative => {
                            self.filter_group(from, (row, column), Centre::depth_difference)
                        }
                        FilterTest::None => self.filter_group(from, (row, column), |_, _, _| -1.0),
                    };
                    let (start, count) = (row * width + first + column, LANES.min(columns.len() - column));
                    for (output, planes) in outputs.iter_mut().zip(&filtered) {
                        for (lane, value) in output[start..start + count].iter_mut().enumerate() {
                            *value = Vec4::from_array(planes.each_ref().map(|plane| plane[lane]));
                        }
                    }
                }
            }
        }
    }

    /// O' of sixteen pixels from (row, column) on, where `off` is how far pixel `at` is off the centre of a lane.
    #[inline(always)]
    fn filter_group<const PLANES: usize>(
        &self,
        from: Transposed<'_>,
        (row, column): (usize, usize),
        off: impl Fn(&Centre, &Around<'_>, usize) -> f32,
    ) -> [[[f32; LANES]; 4]; PLANES] {
        let (row, column) = (row + MARGIN, column + MARGIN);
        let centre = self.centre(from, row, column);
        let tests_normals = self.cos_normal > -1.0;
        let mut sums = [[[0.0; LANES]; 4]; PLANES];
        let mut weights = [0.0; LANES];
        for &(dy, ky) in self.axis() {
            for &(dx, kx) in self.axis() {
                let k = kx * ky;
                let around = Around::new(from, row, column, dy, dx);
                let values: [[&[f32; LANES]; 4]; PLANES] =
                    from_fn(|plane| from_fn(|channel| around.plane(VALUES + 4 * plane + channel)));
                // The centre is always accepted, so the weight is never zero.
                let is_centre = dx == 0 && dy == 0;
                for lane in 0..LANES {
                    let [x, y, z] =
                        [0, 1, 2].map(|axis| centre.normal[axis][lane] * around.normal[axis][lane]);
                    let faces_alike = !tests_normals | (x + y + z > self.cos_normal);
                    let is_near = off(&centre, &around, lane) < centre.allowed[lane];
                    let is_surface = around.depth[lane].is_finite();
                    let accepted = is_centre | (is_surface & is_near & faces_alike);
                    weights[lane] = if accepted { weights[lane] + k } else { weights[lane] };
                    for (sums, values) in sums.iter_mut().zip(&values) {
                        for (sum, value) in sums.iter_mut().zip(values) {
                            sum[lane] = if accepted { sum[lane] + k * value[lane] } else { sum[lane] };
                        }
                    }
                }
            }
        }
        for (plane, sums) in sums.iter_mut().enumerate() {
            for (channel, sums) in sums.iter_mut().enumerate() {
                let unchanged = from.plane(row, VALUES + 4 * plane + channel, column);
                for lane in 0..LANES {
                    let mean = sums[lane] / weights[lane];
                    sums[lane] = if centre.depth[lane].is_finite() { mean } else { unchanged[lane] };
                }
            }
        }
        sums
    }

    #[inline(always)]
    fn centre(&self, from: Transposed<'_>, row: usize, column: usize) -> Centre {
        let plane = |plane: usize| *from.plane(row, plane, column);
        let (depth, footprint) = (plane(DEPTH), plane(FOOTPRINT));
        let allowed = match self.test {
            FilterTest::Plane => footprint.map(|footprint| self.tolerance * footprint),
            FilterTest::Absolute => [self.tolerance; LANES],
            FilterTest::Relative => depth.map(|depth| self.tolerance * depth),
            FilterTest::None => [0.0; LANES],
        };
        let vector = |first: usize| from_fn(|axis| plane(first + axis));
        Centre { position: vector(POSITION), normal: vector(NORMAL), depth, allowed }
    }
}

/// One tap of sixteen pixels.
struct Around<'a> {
    from: Transposed<'a>,
    row: usize,
    column: usize,
    position: [&'a [f32; LANES]; 3],
    normal: [&'a [f32; LANES]; 3],
    depth: &'a [f32; LANES],
}

impl<'a> Around<'a> {
    #[inline(always)]
    fn new(from: Transposed<'a>, row: usize, column: usize, dy: i32, dx: i32) -> Self {
        let (row, column) = (row.wrapping_add_signed(dy as isize), column.wrapping_add_signed(dx as isize));
        let vector = |first: usize| from_fn(|axis| from.plane(row, first + axis, column));
        let depth = from.plane(row, DEPTH, column);
        Self { from, row, column, position: vector(POSITION), normal: vector(NORMAL), depth }
    }

    #[inline(always)]
    fn plane(&self, plane: usize) -> &'a [f32; LANES] {
        self.from.plane(self.row, plane, self.column)
    }
}

impl Centre {
    /// Distance from the tangent plane, scene units.
    #[inline(always)]
    fn plane_distance(&self, around: &Around<'_>, lane: usize) -> f32 {
        let [x, y, z] = [0, 1, 2]
            .map(|axis| self.normal[axis][lane] * (around.position[axis][lane] - self.position[axis][lane]));
        (x + y + z).abs()
    }

    /// Difference of depth, scene units.
    #[inline(always)]
    fn depth_difference(&self, around: &Around<'_>, lane: usize) -> f32 {
        (around.depth[lane] - self.depth[lane]).abs()
    }
}

impl<'a> Transposed<'a> {
    #[inline(always)]
    fn plane(self, row: usize, plane: usize, column: usize) -> &'a [f32; LANES] {
        let start = (row * self.planes + plane) * STRIDE + column;
        self.values[start..start + LANES].try_into().expect("sixteen values")
    }
}

impl BandScratch {
    /// The `columns` of the `rows`, and a margin around them that sees nothing outside the picture.
    #[inline(always)]
    fn transpose<const PLANES: usize>(
        &mut self,
        guides: &[Guide],
        width: usize,
        rows: Range<usize>,
        columns: Range<usize>,
        inputs: [&[Vec4]; PLANES],
    ) -> Transposed<'_> {
        let planes = VALUES + 4 * PLANES;
        let size = (rows.len() + 2 * MARGIN) * planes * STRIDE;
        if self.values.len() < size {
            self.values.resize(size, 0.0);
        }
        let height = guides.len() / width;
        for (i, row) in self.values.chunks_mut(planes * STRIDE).take(rows.len() + 2 * MARGIN).enumerate() {
            let depth = &mut row[DEPTH * STRIDE..][..STRIDE];
            depth.fill(f32::INFINITY);
            let Some(y) = (rows.start + i).checked_sub(MARGIN).filter(|&y| y < height) else { continue };
            // The first column that is there, and its place in the margin.
            let seen = columns.start.saturating_sub(MARGIN)..width.min(columns.end + MARGIN);
            let place = seen.start + MARGIN - columns.start;
            let pixels = y * width + seen.start..y * width + seen.end;
            transpose_guides(&guides[pixels.clone()], row, place);
            for (input, to) in inputs.iter().zip(row[VALUES * STRIDE..].chunks_mut(4 * STRIDE)) {
                transpose_values(&input[pixels.clone()], to, place);
            }
        }
        Transposed { values: &self.values, planes }
    }
}

#[inline(always)]
fn transpose_guides(guides: &[Guide], row: &mut [f32], place: usize) {
    let mut planes = row.chunks_mut(STRIDE);
    let planes: [&mut [f32]; VALUES] =
        from_fn(|_| &mut planes.next().expect("planes of a guide")[place..place + guides.len()]);
    for (i, guide) in guides.iter().enumerate() {
        for axis in 0..3 {
            planes[POSITION + axis][i] = guide.position[axis];
            planes[NORMAL + axis][i] = guide.normal[axis];
        }
        planes[DEPTH][i] = guide.depth;
        planes[FOOTPRINT][i] = guide.footprint;
    }
}

#[inline(always)]
fn transpose_values(values: &[Vec4], to: &mut [f32], place: usize) {
    let mut planes = to.chunks_mut(STRIDE);
    let planes: [&mut [f32]; 4] =
        from_fn(|_| &mut planes.next().expect("planes of an input")[place..place + values.len()]);
    for (i, value) in values.iter().enumerate() {
        for channel in 0..4 {
            planes[channel][i] = value[channel];
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{
        sampling::{pcg, unit_float},
        settings::{Settings, Window},
    };

    fn hash(i: u32, seed: u32) -> f32 {
        unit_float(pcg(i ^ pcg(seed)))
    }

    /// Steps, slopes and holes: every test accepts some neighbours and refuses others.
    fn scene(width: usize, height: usize) -> Vec<Guide> {
        let guide = |i: usize| {
            let (x, y, random) = ((i % width) as f32, (i / width) as f32, hash(i as u32, 7));
            let depth = 4.0 + if random < 0.2 { 0.1 } else { 0.02 * random };
            let position = Vec3::new(0.01 * x, 0.01 * y, -depth);
            let normal = Vec3::new(0.3 * hash(i as u32, 8), 0.2 * hash(i as u32, 9), 1.0).normalize();
            if random > 0.95 { Guide::NOTHING } else { Guide { position, depth, normal, footprint: 0.03 } }
        };
        (0..width * height).map(guide).collect()
    }

    /// Sums the taps that [`Filter::taps`] accepts, in their order.
    fn expected(filter: &Filter, guides: &[Guide], width: usize, p: usize, input: &[Vec4]) -> Vec4 {
        if !guides[p].is_surface() {
            return input[p];
        }
        let (mut sum, mut weight) = (Vec4::ZERO, 0.0);
        for ([dx, dy], k, verdict) in filter.taps(guides, width, (p % width, p / width)) {
            if verdict.is_accepted() {
                let q = p as i64 + i64::from(dy) * width as i64 + i64::from(dx);
                sum += k * input[q as usize];
                weight += k;
            }
        }
        sum / weight
    }

    #[test]
    fn bands_are_the_sums_of_the_accepted_taps_bit_for_bit() {
        for (width, height) in [(1, 1), (7, 5), (16, 3), (131, 21), (257, 18)] {
            let guides = scene(width, height);
            let value = |i: usize, s: u32| Vec4::from_array(from_fn(|c| hash(i as u32 * 8 + c as u32, s)));
            let inputs = [1, 2].map(|s| (0..width * height).map(|i| value(i, s)).collect::<Vec<_>>());
            for window in [Window::Off, Window::Box, Window::Centred] {
                for test in [FilterTest::Plane, FilterTest::Absolute, FilterTest::Relative, FilterTest::None]
                {
                    for cos_normal in [-1.0, 0.95] {
                        let settings = Settings { filter: window, filter_test: test, ..Settings::default() };
                        let filter = Filter { cos_normal, ..Filter::from(&settings) };
                        let mut scratch = BandScratch::default();
                        for first in (0..height).step_by(16) {
                            let rows = first..height.min(first + 16);
                            let mut outputs = [0, 1].map(|_| vec![Vec4::NAN; rows.len() * width]);
                            let [a, b] = &mut outputs;
                            let from = [&inputs[0][..], &inputs[1]];
                            filter.filter_band(&guides, width, rows.clone(), from, [a, b], &mut scratch);
                            for (i, plane) in outputs.iter().enumerate() {
                                for (j, &value) in plane.iter().enumerate() {
                                    let p = first * width + j;
                                    let expected = expected(&filter, &guides, width, p, &inputs[i]);
                                    assert_eq!(
                                        value, expected,
                                        "pixel {p} of {width} × {height}, {filter:?}"
                                    );
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
