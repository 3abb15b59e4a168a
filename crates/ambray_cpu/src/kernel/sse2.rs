//! SSE2 lanes: what every x86-64 processor has, so that nothing has to be detected; that is the SAFETY condition of every
//! intrinsic here.

use std::arch::x86_64::*;

use ambray_core::trace::Ray;

use super::lanes::{Lanes, Rays};
use super::triangle::Plane;

/// 8 lanes in two registers.
#[derive(Clone, Copy)]
pub(crate) struct Sse2x8([__m128; 2]);

/// 16 lanes in four registers.
#[derive(Clone, Copy)]
pub(crate) struct Sse2x16([__m128; 4]);

#[inline(always)]
fn load(x: &[f32; 4]) -> __m128 {
    // SAFETY: see the module; the array holds 4 values.
    unsafe { _mm_loadu_ps(x.as_ptr()) }
}

#[inline(always)]
fn store(x: __m128, into: &mut [f32; 4]) {
    // SAFETY: see the module; the array holds 4 values.
    unsafe { _mm_storeu_ps(into.as_mut_ptr(), x) };
}

/// All bits of the lanes whose bit is set in the lowest four of `mask`.
#[inline(always)]
fn spread(mask: u32) -> __m128 {
    // SAFETY: see the module.
    unsafe {
        let bits = _mm_setr_epi32(1, 2, 4, 8);
        _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(mask.cast_signed()), bits), bits))
    }
}

/// Applies an intrinsic to each register of both.
macro_rules! each {
    ($a:ident, $b:ident, $intrinsic:ident) => {{
        let mut out = $a;
        for (out, b) in out.0.iter_mut().zip($b.0) {
            // SAFETY: see the module.
            *out = unsafe { $intrinsic(*out, b) };
        }
        out
    }};
}

/// Gathers the bits of comparisons of all registers.
macro_rules! bits {
    ($a:ident, $b:ident, $intrinsic:ident) => {{
        let mut mask = 0;
        for (i, (&a, b)) in $a.0.iter().zip($b.0).enumerate() {
            // SAFETY: see the module.
            mask |= unsafe { _mm_movemask_ps($intrinsic(a, b)) }.cast_unsigned() << (4 * i);
        }
        mask
    }};
}

macro_rules! lanes {
    ($name:ident, $width:literal) => {
        impl Lanes<$width> for $name {
            type Eight = Sse2x8;
            #[inline(always)]
            fn splat(x: f32) -> Self {
                // SAFETY: see the module.
                Self([unsafe { _mm_set1_ps(x) }; $width / 4])
            }
            #[inline(always)]
            fn load(x: &[f32; $width]) -> Self {
                let mut out = Self::splat(0.0);
                for (out, x) in out.0.iter_mut().zip(x.as_chunks::<4>().0) {
                    *out = load(x);
                }
                out
            }
            #[inline(always)]
            fn to_array(self) -> [f32; $width] {
                let mut out = [0.0; $width];
                for (out, x) in out.as_chunks_mut::<4>().0.iter_mut().zip(self.0) {
                    store(x, out);
                }
                out
            }
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                each!(self, other, _mm_add_ps)
            }
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                each!(self, other, _mm_sub_ps)
            }
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                each!(self, other, _mm_mul_ps)
            }
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                each!(self, other, _mm_div_ps)
            }
            #[inline(always)]
            fn mul_sub(self, factor: Self, less: Self) -> Self {
                self.mul(factor).sub(less)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                each!(self, other, _mm_min_ps)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                each!(self, other, _mm_max_ps)
            }
            #[inline(always)]
            fn le(self, other: Self) -> u32 {
                bits!(self, other, _mm_cmple_ps)
            }
            #[inline(always)]
            fn lt(self, other: Self) -> u32 {
                bits!(self, other, _mm_cmplt_ps)
            }
            #[inline(always)]
            fn select(mask: u32, a: Self, b: Self) -> Self {
                let mut out = b;
                for (i, (out, a)) in out.0.iter_mut().zip(a.0).enumerate() {
                    let chosen = spread(mask >> (4 * i));
                    // SAFETY: see the module.
                    *out = unsafe { _mm_or_ps(_mm_and_ps(chosen, a), _mm_andnot_ps(chosen, *out)) };
                }
                out
            }
            #[inline(always)]
            fn where_le(a: Self, b: Self, x: Self, y: Self) -> Self {
                let mut out = y;
                for (i, (out, x)) in out.0.iter_mut().zip(x.0).enumerate() {
                    // SAFETY: see the module.
                    *out = unsafe {
                        let chosen = _mm_cmple_ps(a.0[i], b.0[i]);
                        _mm_or_ps(_mm_and_ps(chosen, x), _mm_andnot_ps(chosen, *out))
                    };
                }
                out
            }
            #[inline(always)]
            fn put(self, mask: u32, into: &mut [f32; $width]) {
                *into = Self::select(mask, self, Self::load(into)).to_array();
            }
            #[inline(always)]
            fn signs(self) -> u32 {
                let mut mask = 0;
                for (i, x) in self.0.into_iter().enumerate() {
                    // SAFETY: see the module.
                    mask |= unsafe { _mm_movemask_ps(x) }.cast_unsigned() << (4 * i);
                }
                mask
            }
            #[inline(always)]
            fn smallest(self) -> f32 {
                let mut x = self.0[0];
                // SAFETY: see the module.
                unsafe {
                    for &other in &self.0[1..] {
                        x = _mm_min_ps(x, other);
                    }
                    let x = _mm_min_ps(x, _mm_movehl_ps(x, x));
                    _mm_cvtss_f32(_mm_min_ss(x, _mm_shuffle_ps::<1>(x, x)))
                }
            }
            #[inline(always)]
            fn largest(self) -> f32 {
                let mut x = self.0[0];
                // SAFETY: see the module.
                unsafe {
                    for &other in &self.0[1..] {
                        x = _mm_max_ps(x, other);
                    }
                    let x = _mm_max_ps(x, _mm_movehl_ps(x, x));
                    _mm_cvtss_f32(_mm_max_ss(x, _mm_shuffle_ps::<1>(x, x)))
                }
            }
        }
    };
}
lanes!(Sse2x8, 8);
lanes!(Sse2x16, 16);

impl Rays for Sse2x16 {
    #[inline(always)]
    fn transposed(rays: &[Ray; 16]) -> [Self; 8] {
        let mut out = [Self::splat(0.0); 8];
        for (i, four) in rays.as_chunks::<4>().0.iter().enumerate() {
            let rows: &[[[f32; 4]; 2]; 4] = bytemuck::cast_ref(four);
            for half in 0..2 {
                let (mut a, mut b) = (load(&rows[0][half]), load(&rows[1][half]));
                let (mut c, mut d) = (load(&rows[2][half]), load(&rows[3][half]));
                // SAFETY: see the module.
                unsafe { _MM_TRANSPOSE4_PS(&mut a, &mut b, &mut c, &mut d) };
                out[4 * half].0[i] = a;
                out[4 * half + 1].0[i] = b;
                out[4 * half + 2].0[i] = c;
                out[4 * half + 3].0[i] = d;
            }
        }
        out
    }

    #[inline(always)]
    fn plane_distances(plane: &Plane, origin: [Self; 3], shear: [Self; 3]) -> Self {
        let mut out = Self::splat(0.0);
        for (i, out) in out.0.iter_mut().enumerate() {
            let (o, s) = (
                [origin[0].0[i], origin[1].0[i], origin[2].0[i]],
                [shear[0].0[i], shear[1].0[i], shear[2].0[i]],
            );
            let upper = ([high(o[0]), high(o[1]), high(o[2])], [high(s[0]), high(s[1]), high(s[2])]);
            let (low, high) = (two(plane, o, s), two(plane, upper.0, upper.1));
            // SAFETY: see the module.
            *out = unsafe { _mm_movelh_ps(low, high) };
        }
        out
    }
}

/// The last two lanes in place of the first two.
#[inline(always)]
fn high(x: __m128) -> __m128 {
    // SAFETY: see the module.
    unsafe { _mm_movehl_ps(x, x) }
}

/// [`Plane::distance`] of the first two rays of each register.
#[inline(always)]
fn two(plane: &Plane, [ox, oy, oz]: [__m128; 3], [sx, sy, per_depth]: [__m128; 3]) -> __m128 {
    // SAFETY: see the module.
    unsafe {
        let [x, y, z] =
            [_mm_set1_pd(plane.normal[0]), _mm_set1_pd(plane.normal[1]), _mm_set1_pd(plane.normal[2])];
        let ax = _mm_sub_pd(_mm_set1_pd(plane.corner[0]), _mm_cvtps_pd(ox));
        let ay = _mm_sub_pd(_mm_set1_pd(plane.corner[1]), _mm_cvtps_pd(oy));
        let az = _mm_sub_pd(_mm_set1_pd(plane.corner[2]), _mm_cvtps_pd(oz));
        let above = _mm_add_pd(_mm_add_pd(_mm_mul_pd(x, ax), _mm_mul_pd(y, ay)), _mm_mul_pd(z, az));
        let below = _mm_add_pd(_mm_mul_pd(x, _mm_cvtps_pd(sx)), _mm_mul_pd(y, _mm_cvtps_pd(sy)));
        let depth = _mm_div_pd(above, _mm_add_pd(below, z));
        _mm_cvtpd_ps(_mm_mul_pd(depth, _mm_cvtps_pd(per_depth)))
    }
}
