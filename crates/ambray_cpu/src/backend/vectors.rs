//! Work outside the tracing kernels, compiled for each instruction set.

use crate::Isa;

/// Something to do, whose loops are worth compiling for wide vectors: `run` is to be inlined, and so is what it calls.
///
/// Products and sums stay separate and in their order, so that its results do not depend on the instruction set.
pub(super) trait Work {
    type Output;
    fn run(self) -> Self::Output;
}

/// An instruction set that this machine has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vectors(Isa);

impl Vectors {
    /// Those of `isa`.
    ///
    /// # Panics
    /// If the machine lacks them.
    pub(super) fn of(isa: Isa) -> Self {
        assert!(isa.is_available(), "this machine lacks {}", isa.name());
        Self(isa)
    }

    /// Does `work` with these vectors.
    #[inline]
    pub(super) fn run<W: Work>(self, work: W) -> W::Output {
        match self.0 {
            Isa::Portable => work.run(),
            #[cfg(target_arch = "x86_64")]
            // SAFETY: whoever made `self` saw that the instruction set is available.
            Isa::Avx2 => unsafe { avx2(work) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: as above.
            Isa::Avx512 => unsafe { avx512(work) },
            #[cfg(not(target_arch = "x86_64"))]
            _ => unreachable!("x86-64 only"),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
unsafe fn avx2<W: Work>(work: W) -> W::Output {
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw")]
unsafe fn avx512<W: Work>(work: W) -> W::Output {
    work.run()
}
