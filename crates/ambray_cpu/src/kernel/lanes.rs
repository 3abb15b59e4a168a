//! Vectors of `f32` as the kernels see them, so that each kernel is written once.
//!
//! Every operation is one IEEE 754 operation a lane, with the NaN rule of x86 for minima and maxima, so all
//! implementations return the same bits.

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

impl Rays for Array<16> {
    #[inline(always)]
    fn transposed(rays: &[Ray; 16]) -> [Self; 8] {
        let mut out = [Self([0.0; 16]); 8];
        for (lane, ray) in rays.iter().enumerate() {
            let numbers: &[f32; 8] = bytemuck::cast_ref(ray);
            for (out, number) in out.iter_mut().zip(numbers) {
                out.0[lane] = *number;
            }
        }
        out
    }
    #[inline(always)]
    fn plane_distances(plane: &Plane, origin: [Self; 3], shear: [Self; 3]) -> Self {
        let mut out = [0.0; 16];
        for (lane, out) in out.iter_mut().enumerate() {
            let origin = [origin[0].0[lane], origin[1].0[lane], origin[2].0[lane]];
            let shear = [shear[0].0[lane], shear[1].0[lane], shear[2].0[lane]];
            *out = plane.distance(origin, shear);
        }
        Self(out)
    }
}

/// Plain arrays: any machine, vectorised by the compiler as far as it can.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Array<const W: usize>([f32; W]);

impl<const W: usize> Array<W> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut out = [0.0; W];
        for (out, (a, b)) in out.iter_mut().zip(self.0.into_iter().zip(other.0)) {
            *out = f(a, b);
        }
        Self(out)
    }

    #[inline(always)]
    fn compare(self, other: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        let mut mask = 0;
        for i in 0..W {
            mask |= u32::from(f(self.0[i], other.0[i])) << i;
        }
        mask
    }
}

impl<const W: usize> Lanes<W> for Array<W> {
    type Eight = Array<8>;
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; W])
    }
    #[inline(always)]
    fn load(x: &[f32; W]) -> Self {
        Self(*x)
    }
    #[inline(always)]
    fn to_array(self) -> [f32; W] {
        self.0
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        self.compare(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        self.compare(other, |a, b| a < b)
    }
    #[inline(always)]
    fn select(mask: u32, a: Self, b: Self) -> Self {
        Self(std::array::from_fn(|i| if mask >> i & 1 != 0 { a.0[i] } else { b.0[i] }))
    }
    #[inline(always)]
    fn put(self, mask: u32, into: &mut [f32; W]) {
        *into = Self::select(mask, self, Self(*into)).0;
    }
    #[inline(always)]
    fn signs(self) -> u32 {
        self.compare(self, |a, _| a.is_sign_negative())
    }
    #[inline(always)]
    fn smallest(self) -> f32 {
        self.0.into_iter().fold(f32::INFINITY, f32::min)
    }
    #[inline(always)]
    fn largest(self) -> f32 {
        self.0.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }
}
