//! Lanes as plain arrays: any machine, vectorised by the compiler as far as it can.

use ambray_core::trace::Ray;

use super::lanes::{Lanes, Rays};
use super::triangle::Plane;

/// `W` numbers.
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
    fn mul_sub(self, factor: Self, less: Self) -> Self {
        self.mul(factor).sub(less)
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
    fn where_le(a: Self, b: Self, x: Self, y: Self) -> Self {
        Self::select(a.le(b), x, y)
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

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::super::sse2::{Sse2x8, Sse2x16};
    use super::super::x86::{Avx2x8, Avx2x16, Avx512x16};
    use super::*;

    /// What comes out of every operation on `a` and `b`, as bits.
    fn outcomes<const W: usize, L: Lanes<W>>(a: &[f32; W], b: &[f32; W], mask: u32) -> Vec<u32> {
        let (x, y) = (L::load(a), L::load(b));
        let mut put = *b;
        x.put(mask, &mut put);
        let arrays = [
            L::splat(a[1]).to_array(),
            x.add(y).to_array(),
            x.sub(y).to_array(),
            x.mul(y).to_array(),
            x.div(y).to_array(),
            x.min(y).to_array(),
            x.max(y).to_array(),
            L::select(mask, x, y).to_array(),
            put,
        ];
        // Which bits say that something is not a number is nobody's business.
        let bits = |v: f32| if v.is_nan() { u32::MAX } else { v.to_bits() };
        let mut all: Vec<u32> = arrays.as_flattened().iter().map(|&v| bits(v)).collect();
        all.extend([x.le(y), x.lt(y), x.signs()]);
        if a.iter().all(|v| !v.is_nan()) {
            // Which of two zeros is found does not matter.
            all.extend([x.smallest(), x.largest()].map(|v| (v + 0.0).to_bits()));
        }
        all
    }

    /// Numbers of all sizes and signs, also such as are none.
    fn numbers<const W: usize>(seed: u32) -> [f32; W] {
        const SPECIAL: [f32; 6] = [0.0, -0.0, 1.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        std::array::from_fn(|lane| {
            let bits = ambray_core::sampling::pcg(ambray_core::sampling::pcg(seed) ^ lane as u32);
            if bits.is_multiple_of(3) { SPECIAL[(bits >> 8) as usize % 6] } else { f32::from_bits(bits) }
        })
    }

    fn compare<L: Lanes<8>, R: Lanes<16>>() {
        for seed in 0..2_000 {
            let mask = ambray_core::sampling::pcg(seed);
            let (a, b) = (numbers::<8>(seed), numbers::<8>(seed + 10_000));
            assert_eq!(outcomes::<8, L>(&a, &b, mask & 0xff), outcomes::<8, Array<8>>(&a, &b, mask & 0xff));
            let (a, b) = (numbers::<16>(seed), numbers::<16>(seed + 10_000));
            assert_eq!(
                outcomes::<16, R>(&a, &b, mask & 0xffff),
                outcomes::<16, Array<16>>(&a, &b, mask & 0xffff)
            );
        }
    }

    #[test]
    fn the_vectors_of_every_processor_do_what_arrays_do() {
        compare::<Sse2x8, Sse2x16>();
        if crate::Isa::Avx2.is_available() {
            compare::<Avx2x8, Avx2x16>();
        }
        if crate::Isa::Avx512.is_available() {
            compare::<Avx2x8, Avx512x16>();
        }
    }
}
