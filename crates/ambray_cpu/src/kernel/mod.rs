//! Tracing kernels: written once, compiled for each instruction set.

#[cfg(any(test, not(target_arch = "x86_64")))]
mod array;
mod batch;
mod best;
mod bundle;
mod cut;
pub(crate) mod lanes;
mod leaf;
mod loose;
mod packet;
pub(crate) mod ray;
mod single;
pub(crate) mod slab;
#[cfg(target_arch = "x86_64")]
mod sse2;
#[cfg(test)]
mod tests;
mod triangle;
#[cfg(target_arch = "x86_64")]
mod x86;

use ambray_core::trace::{Hit, Ray};

use crate::bvh::layout::{Blas, Child, Node, Tlas};
use crate::bvh::names::Names;
use crate::{AlphaTest, Isa};
use triangle::{BAKED, Entry};

/// What is asked about a ray.
pub(crate) trait Query {
    /// Whether the first hit found ends the ray.
    const ANY: bool;
    type Answer: Copy;
    /// What is said of a ray: whether it has a hit, and which, where that is asked.
    fn answer(is_hit: bool, hit: impl FnOnce() -> Hit) -> Self::Answer;
}

/// Asks for the closest hit.
pub(crate) struct Closest;

/// Asks whether there is a hit.
pub(crate) struct Any;

impl Query for Closest {
    const ANY: bool = false;
    type Answer = Hit;
    #[inline(always)]
    fn answer(is_hit: bool, hit: impl FnOnce() -> Hit) -> Hit {
        if is_hit { hit() } else { Hit::MISS }
    }
}

impl Query for Any {
    const ANY: bool = true;
    type Answer = bool;
    #[inline(always)]
    fn answer(is_hit: bool, _hit: impl FnOnce() -> Hit) -> bool {
        is_hit
    }
}

/// What the kernels read.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a, const W: usize> {
    /// World-space tree of all that is baked.
    pub(crate) baked: &'a Blas<W>,
    /// Node that takes the place of its root for the rays of a batch.
    pub(crate) entry: Option<&'a Node<W>>,
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
    /// Trees in world space.
    #[inline(always)]
    pub(crate) fn world_trees(&self) -> impl Iterator<Item = Trunk<'a, W>> + use<'a, W> {
        let (meshes, alpha, names) = (self.meshes, self.alpha, &self.baked.names);
        let root = self.entry.or(self.baked.nodes.first());
        let baked = root.map(|root| Trunk { tree: self.baked, root, instance: BAKED, alpha, names });
        let direct = self.direct.iter().filter_map(move |one| {
            let tree = &meshes[one.tree as usize];
            let root = tree.nodes.first()?;
            Some(Trunk { tree, root, instance: one.instance, alpha, names })
        });
        baked.into_iter().chain(direct)
    }
}

/// A tree in world space.
#[derive(Clone, Copy)]
pub(crate) struct Trunk<'a, const W: usize> {
    pub(crate) tree: &'a Blas<W>,
    /// What stands for its node 0.
    pub(crate) root: &'a Node<W>,
    /// As in [`Entry`].
    pub(crate) instance: u32,
    pub(crate) alpha: &'a dyn AlphaTest,
    /// Of the baked triangles.
    pub(crate) names: &'a Names,
}

impl<'a, const W: usize> Trunk<'a, W> {
    #[inline(always)]
    pub(crate) fn node(&self, child: Child) -> &'a Node<W> {
        if child == Child::ROOT { self.root } else { &self.tree.nodes[child.index()] }
    }

    /// What its triangles share for a ray with `seed`.
    #[inline(always)]
    pub(crate) fn entry(&self, seed: u32) -> Entry<'a> {
        Entry { instance: self.instance, near: 0.0, seed, alpha: self.alpha, names: self.names }
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
    Compiled: Kernels<W>,
{
    assert_eq!(rays.len(), answers.len(), "one answer for each ray");
    match isa {
        Isa::Portable => Compiled::portable::<Q>(scene, rays, answers),
        // SAFETY: the tracer only holds instruction sets that it found available.
        Isa::Avx2 => unsafe { Compiled::avx2::<Q>(scene, rays, answers) },
        // SAFETY: as above.
        Isa::Avx512 => unsafe { Compiled::avx512::<Q>(scene, rays, answers) },
    }
}

/// Carrier of the kernels for each width.
pub(crate) struct Compiled;

/// The kernels of one width, for each instruction set; those that only x86-64 has are never called on other machines.
pub(crate) trait Kernels<const W: usize> {
    fn portable<Q: Query>(scene: &Scene<'_, W>, rays: &[Ray], answers: &mut [Q::Answer]);
    /// # Safety
    /// [`Isa::Avx2`] must be available.
    unsafe fn avx2<Q: Query>(scene: &Scene<'_, W>, rays: &[Ray], answers: &mut [Q::Answer]);
    /// # Safety
    /// [`Isa::Avx512`] must be available.
    unsafe fn avx512<Q: Query>(scene: &Scene<'_, W>, rays: &[Ray], answers: &mut [Q::Answer]);
}

macro_rules! kernels {
    ($width:literal, $sse2:ident, $avx2:ident, $avx512:ident) => {
        #[cfg(target_arch = "x86_64")]
        impl Kernels<$width> for Compiled {
            fn portable<Q: Query>(scene: &Scene<'_, $width>, rays: &[Ray], answers: &mut [Q::Answer]) {
                batch::answer::<$width, sse2::$sse2, sse2::Sse2x16, Q>(scene, rays, answers);
            }
            #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
            unsafe fn avx2<Q: Query>(scene: &Scene<'_, $width>, rays: &[Ray], answers: &mut [Q::Answer]) {
                batch::answer::<$width, x86::$avx2, x86::Avx2x16, Q>(scene, rays, answers);
            }
            #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw")]
            unsafe fn avx512<Q: Query>(scene: &Scene<'_, $width>, rays: &[Ray], answers: &mut [Q::Answer]) {
                batch::answer::<$width, x86::$avx512, x86::Avx512x16, Q>(scene, rays, answers);
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        impl Kernels<$width> for Compiled {
            fn portable<Q: Query>(scene: &Scene<'_, $width>, rays: &[Ray], answers: &mut [Q::Answer]) {
                batch::answer::<$width, array::Array<$width>, array::Array<16>, Q>(scene, rays, answers);
            }
            unsafe fn avx2<Q: Query>(_: &Scene<'_, $width>, _: &[Ray], _: &mut [Q::Answer]) {
                unreachable!("x86-64 only");
            }
            unsafe fn avx512<Q: Query>(_: &Scene<'_, $width>, _: &[Ray], _: &mut [Q::Answer]) {
                unreachable!("x86-64 only");
            }
        }
    };
}
kernels!(8, Sse2x8, Avx2x8, Avx2x8);
kernels!(16, Sse2x16, Avx2x16, Avx512x16);
