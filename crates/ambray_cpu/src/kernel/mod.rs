//! Tracing kernels: written once, compiled for each instruction set.

mod bundle;
pub(crate) mod lanes;
mod packet;
pub(crate) mod ray;
mod single;
pub(crate) mod slab;
mod triangle;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::mem::MaybeUninit;

use ambray_core::trace::{Hit, Ray};

use crate::bvh::layout::{Blas, Tlas};
use crate::{AlphaTest, Isa};
use bundle::Bundle;
use lanes::{Array, Lanes};

/// What is asked about a ray.
pub(crate) trait Query {
    /// Whether the first hit found ends the ray.
    const ANY: bool;
    type Answer: Copy;
    fn answer(hit: Hit) -> Self::Answer;
}

/// Asks for the closest hit.
pub(crate) struct Closest;

/// Asks whether there is a hit.
pub(crate) struct Any;

impl Query for Closest {
    const ANY: bool = false;
    type Answer = Hit;
    #[inline(always)]
    fn answer(hit: Hit) -> Hit {
        hit
    }
}

impl Query for Any {
    const ANY: bool = true;
    type Answer = bool;
    #[inline(always)]
    fn answer(hit: Hit) -> bool {
        hit.is_hit()
    }
}

/// What the kernels read.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a, const W: usize> {
    /// World-space tree of all that is baked.
    pub(crate) baked: &'a Blas<W>,
    /// Instances of meshes with trees of their own.
    pub(crate) placed: &'a Tlas<W>,
    /// Object-space trees of these meshes.
    pub(crate) meshes: &'a [Blas<W>],
    /// Instances whose object space is the world.
    pub(crate) direct: &'a [Direct],
    pub(crate) alpha: &'a dyn AlphaTest,
    /// Stack entries that the walk over instances may need.
    pub(crate) instance_stack: usize,
    /// Stack entries that all walks together may need.
    pub(crate) stack: usize,
    pub(crate) packets: bool,
}

/// Instance of a mesh with a tree of its own that rays go through as they are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Direct {
    /// Index among the trees of placed meshes.
    pub(crate) tree: u32,
    /// Index in the scene.
    pub(crate) instance: u32,
}

impl<'a, const W: usize> Scene<'a, W> {
    /// Trees in world space, with the instance where it is one for the whole tree.
    #[inline(always)]
    pub(crate) fn world_trees(&self) -> impl Iterator<Item = (&'a Blas<W>, Option<u32>)> + use<'a, W> {
        let (meshes, direct) = (self.meshes, self.direct);
        let direct = direct.iter().map(|one| (&meshes[one.tree as usize], Some(one.instance)));
        std::iter::once((self.baked, None)).chain(direct)
    }
}

/// Stack entries that a walk through `depth` levels may need: each level leaves fewer than `W`, the last adds `W`.
pub(crate) const fn stack_for(depth: usize, width: usize) -> usize {
    (depth + 1) * width
}

/// Answers `rays`, with the kernels of `isa`, which must be available.
pub(crate) fn batch<const W: usize, Q: Query>(
    isa: Isa,
    scene: &Scene<'_, W>,
    rays: &[Ray],
    answers: &mut [Q::Answer],
) where
    Array<W>: Lanes<W>,
    X86: Kernels<W>,
{
    assert_eq!(rays.len(), answers.len(), "one answer for each ray");
    match isa {
        Isa::Portable => generic::<W, Array<W>, Array<16>, Q>(scene, rays, answers),
        // SAFETY: the tracer only holds instruction sets that it found available.
        Isa::Avx2 => unsafe { X86::avx2::<Q>(scene, rays, answers) },
        // SAFETY: as above.
        Isa::Avx512 => unsafe { X86::avx512::<Q>(scene, rays, answers) },
    }
}

/// Carrier of the x86-64 kernels for each width.
pub(crate) struct X86;

/// The kernels of one width; on other machines they are never called.
pub(crate) trait Kernels<const W: usize> {
    /// # Safety
    /// [`Isa::Avx2`] must be available.
    unsafe fn avx2<Q: Query>(scene: &Scene<'_, W>, rays: &[Ray], answers: &mut [Q::Answer]);
    /// # Safety
    /// [`Isa::Avx512`] must be available.
    unsafe fn avx512<Q: Query>(scene: &Scene<'_, W>, rays: &[Ray], answers: &mut [Q::Answer]);
}

macro_rules! kernels {
    ($width:literal, $avx2:ident, $avx512:ident) => {
        #[cfg(target_arch = "x86_64")]
        impl Kernels<$width> for X86 {
            #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
            unsafe fn avx2<Q: Query>(scene: &Scene<'_, $width>, rays: &[Ray], answers: &mut [Q::Answer]) {
                generic::<$width, x86::$avx2, x86::Avx2x16, Q>(scene, rays, answers);
            }
            #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw")]
            unsafe fn avx512<Q: Query>(scene: &Scene<'_, $width>, rays: &[Ray], answers: &mut [Q::Answer]) {
                generic::<$width, x86::$avx512, x86::Avx512x16, Q>(scene, rays, answers);
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        impl Kernels<$width> for X86 {
            unsafe fn avx2<Q: Query>(_: &Scene<'_, $width>, _: &[Ray], _: &mut [Q::Answer]) {
                unreachable!("x86-64 only");
            }
            unsafe fn avx512<Q: Query>(_: &Scene<'_, $width>, _: &[Ray], _: &mut [Q::Answer]) {
                unreachable!("x86-64 only");
            }
        }
    };
}
kernels!(8, Avx2x8, Avx2x8);
kernels!(16, Avx2x16, Avx512x16);

#[inline(always)]
fn generic<const W: usize, L: Lanes<W>, R: Lanes<16>, Q: Query>(
    scene: &Scene<'_, W>,
    rays: &[Ray],
    answers: &mut [Q::Answer],
) {
    let mut single = vec![MaybeUninit::uninit(); scene.stack];
    if !scene.packets {
        for (ray, answer) in rays.iter().zip(answers) {
            *answer = Q::answer(single::trace::<W, L, Q>(scene, ray, &mut single));
        }
        return;
    }
    let mut scratch = packet::Scratch { packet: vec![MaybeUninit::uninit(); scene.stack], single };
    let (mut rays, mut answers) = (rays, answers);
    while !rays.is_empty() {
        let (bundle, count) = Bundle::next::<R>(rays);
        let (now, later) = rays.split_at(count);
        let (first, rest) = answers.split_at_mut(count);
        packet::trace::<W, L, R, Q>(scene, &bundle, now, first, &mut scratch);
        (rays, answers) = (later, rest);
    }
}
