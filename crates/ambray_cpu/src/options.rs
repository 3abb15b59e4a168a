//! What the user of the tracer may choose.

use crate::Isa;

/// How a [`Tracer`](crate::Tracer) is built. No choice changes any result, only build time and speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuildOptions {
    /// Effort spent on the tree.
    pub quality: Quality,
    /// Instruction set of the kernels; `None` takes the best of this machine.
    pub isa: Option<Isa>,
    /// Children of a node; `None` takes what suits the instruction set.
    pub width: Option<Width>,
    /// Whether rays of a batch are traced in packets of 16 where they share directions. Default true.
    pub packets: bool,
}

impl BuildOptions {
    /// For geometry that lives for a frame or two: builds several times faster than [`Self::best_trace`].
    #[must_use]
    pub const fn fast_build() -> Self {
        Self::with_quality(Quality::FastBuild)
    }

    /// The default: most of the tracing speed at a fraction of the build time.
    #[must_use]
    pub const fn balanced() -> Self {
        Self::with_quality(Quality::Balanced)
    }

    /// For static scenes that are looked at for long.
    #[must_use]
    pub const fn best_trace() -> Self {
        Self::with_quality(Quality::BestTrace)
    }

    const fn with_quality(quality: Quality) -> Self {
        Self { quality, isa: None, width: None, packets: true }
    }
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self::balanced()
    }
}

/// Effort spent on a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quality {
    /// Short search for neighbours, hardly any reinsertion.
    FastBuild,
    /// Longer search, some reinsertion.
    Balanced,
    /// Reinsertion of every node.
    BestTrace,
}

impl Quality {
    /// Every quality, fastest build first.
    pub const ALL: [Self; 3] = [Self::FastBuild, Self::Balanced, Self::BestTrace];
}

/// Children of a node, and triangles of a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Width {
    /// One AVX2 register.
    Eight,
    /// One AVX-512 register.
    Sixteen,
}

impl Width {
    /// Both widths.
    pub const ALL: [Self; 2] = [Self::Eight, Self::Sixteen];
}
