//! Vectors of `f32` as the kernels see them, so that each kernel is written once.
//!
//! Every operation but [`mul_sub`](Lanes::mul_sub) is one IEEE 754 operation a lane, with the NaN rule of x86 for minima and
//! maxima, so all implementations return the same bits.

use ambray_core::trace::Ray;

use super::triangle::Plane;

/// `W` lanes of `f32`. Masks have lane i in bit i.
pub(crate) trait Lanes<const W: usize>: Copy {
    /// The same with eight lanes.
    type Eight: Lanes<8>;
    fn splat(x: f32) -> Self;
    fn load(x: &[f32; W]) -> Self;
    fn to_array(self) -> [f32; W];
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// `self * factor - less`, of which the product may be rounded or not.
    fn mul_sub(self, factor: Self, less: Self) -> Self;
    /// `if self < other { self } else { other }`
    fn min(self, other: Self) -> Self;
    /// `if self > other { self } else { other }`
    fn max(self, other: Self) -> Self;
    /// Lanes where `self <= other`; false for NaN.
    fn le(self, other: Self) -> u32;
    /// Lanes where `self < other`; false for NaN.
    fn lt(self, other: Self) -> u32;
    /// `a` in the lanes of `mask`, `b` elsewhere.
    fn select(mask: u32, a: Self, b: Self) -> Self;
    /// `x` in the lanes where `a <= b`, `y` elsewhere.
    fn where_le(a: Self, b: Self, x: Self, y: Self) -> Self;
    /// Writes the lanes of `mask` to `into`.
    fn put(self, mask: u32, into: &mut [f32; W]);
    /// Lanes whose sign bit is set.
    fn signs(self) -> u32;
    /// Smallest lane, where none is NaN.
    fn smallest(self) -> f32;
    /// Largest lane, where none is NaN.
    fn largest(self) -> f32;
}

/// Sixteen rays against one plane.
pub(crate) trait Rays: Lanes<16> {
    /// The numbers of rays as structure of arrays: origin, end, direction; the last has no meaning.
    fn transposed(rays: &[Ray; 16]) -> [Self; 8];
    /// [`Plane::distance`] of each.
    fn plane_distances(plane: &Plane, origin: [Self; 3], shear: [Self; 3]) -> Self;
}
