//! The tasks of pass 1: some tiles with the rows of all planes that are theirs.

use std::iter::repeat_with;

use ambray_core::{filter::Guide, frame::GBufferPixel};
use glam::{Vec3, Vec4};

use super::pass1::Pass1;

/// Pixels a side of a tile: 16 pixels of each class, a packet of parallel rays.
pub(crate) const TILE: usize = 16;

/// Pixels in a row of a task: small enough that all threads end at the same time, large enough that tasks cost nothing.
pub(super) const SEGMENT: usize = 4 * TILE;

/// Some tiles side by side: for each plane the slices that are their rows. The pixel at `(row, column)` is that at
/// (`x0` + column, `y0` + row) of the picture.
pub(super) struct Segment<'a> {
    pub(super) x0: usize,
    pub(super) y0: usize,
    pub(super) gbuffer: Rows<'a, GBufferPixel>,
    pub(super) guides: Rows<'a, Guide>,
    /// Empty unless light is accumulated.
    pub(super) then: Rows<'a, Guide>,
    pub(super) ambient: Rows<'a, Vec4>,
    /// Empty where the minimum is taken before the filter.
    pub(super) second: Rows<'a, Vec4>,
    pub(super) bent: Rows<'a, Vec4>,
}

/// Rows of a segment.
pub(super) type Rows<'a, T> = Vec<&'a mut [T]>;

/// Row and column in a segment.
pub(super) type Place = (usize, usize);

impl<'a> Segment<'a> {
    /// Cuts the planes of `pass` to segments, row by row of tiles.
    pub(super) fn all(pass: &'a mut Pass1, width: usize) -> Vec<Self> {
        let places = (0..).flat_map(|band| (0..width).step_by(SEGMENT).map(move |x0| (x0, band * TILE)));
        let always = cut(&mut pass.gbuffer, width).zip(cut(&mut pass.guides, width));
        let always = always.zip(cut(&mut pass.ambient, width)).zip(cut(&mut pass.bent, width));
        let then = cut(&mut pass.then, width).chain(repeat_with(Vec::new));
        let second = cut(&mut pass.second, width).chain(repeat_with(Vec::new));
        places
            .zip(always.zip(then.zip(second)))
            .map(|((x0, y0), ((((gbuffer, guides), ambient), bent), (then, second)))| Self {
                x0,
                y0,
                gbuffer,
                guides,
                then,
                ambient,
                second,
                bent,
            })
            .collect()
    }

    /// A pixel sees no surface: its planes are those of an open place before the `background`.
    pub(super) fn see_nothing(&mut self, (row, column): Place, background: Vec3) {
        self.gbuffer[row][column] = GBufferPixel { emission: background, rays: 1, ..GBufferPixel::NOTHING };
        self.guides[row][column] = Guide::NOTHING;
        if let Some(then) = self.then.get_mut(row) {
            then[column] = Guide::NOTHING;
        }
        self.leave_open((row, column));
    }

    /// Nothing is gathered at a pixel.
    pub(super) fn leave_open(&mut self, (row, column): Place) {
        self.ambient[row][column] = Vec4::X;
        self.bent[row][column] = Vec4::ZERO;
        if let Some(second) = self.second.get_mut(row) {
            second[column] = Vec4::X;
        }
    }
}

/// The rows of each segment of a plane; none of an empty one.
fn cut<T>(plane: &mut [T], width: usize) -> impl Iterator<Item = Rows<'_, T>> {
    plane.chunks_mut(TILE * width).flat_map(move |band| {
        let mut rows: Vec<_> = band.chunks_mut(width).map(|row| row.chunks_mut(SEGMENT)).collect();
        let segment = move |_| rows.iter_mut().filter_map(Iterator::next).collect();
        (0..width.div_ceil(SEGMENT)).map(segment)
    })
}
