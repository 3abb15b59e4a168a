//! What the user of the tracer may choose.

use ambray_scene::animation::Updates;

use crate::Isa;

/// How a [`Tracer`](crate::Tracer) is built. No choice but [`bake_budget`](Self::bake_budget) changes any result, only build
/// time and speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildOptions {
    /// Effort spent on the trees. Those that are built anew while the scene moves get [`Quality::Balanced`] at most.
    pub quality: Quality,
    /// Instruction set of the kernels; `None` takes the best of this machine.
    pub isa: Option<Isa>,
    /// Children of a node; `None` takes the default.
    pub width: Option<Width>,
    /// Whether rays of a batch are traced in packets of 16 where they share directions.
    pub packets: Packets,
    /// Triangles that baked copies of meshes with several instances may have, all together. Default
    /// [`Self::BAKE_BUDGET`]; 0 bakes no such mesh, [`u64::MAX`] all.
    ///
    /// A baked instance has triangles of its own in world space, in the one tree of all baked triangles, where rays go in
    /// packets and need no transform. A shared mesh has its triangles once, in object space, where each ray goes
    /// alone. Meshes with the fewest triangles over all their instances are baked first. Hits on an instance agree
    /// both ways up to the rounding of its transform.
    pub bake_budget: u64,
    /// What is done with the trees of meshes that deform, at each new pose.
    pub updates: Updates,
}

impl BuildOptions {
    /// Default of [`Self::bake_budget`]: at most about 200 MB of trees and a second or two of building.
    pub const BAKE_BUDGET: u64 = 2_000_000;

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
        Self {
            quality,
            isa: None,
            width: None,
            packets: Packets::Measured,
            bake_budget: Self::BAKE_BUDGET,
            updates: Updates::DEFAULT,
        }
    }
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self::balanced()
    }
}

/// When rays go in packets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Packets {
    /// Where that has turned out to be quicker: now and then a part of a batch goes ray by ray and the rest in packets, and their
    /// times are compared. Answers do not depend on it, but which instructions are run does.
    #[default]
    Measured,
    /// In every batch.
    Always,
    /// Each ray goes alone.
    Never,
}

impl Packets {
    /// All choices.
    pub const ALL: [Self; 3] = [Self::Measured, Self::Always, Self::Never];
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

    /// Effort spent on a tree that is built anew at a pose.
    ///
    /// Reinsertion of every node takes 4 to 8 times as long as all else together, and such a tree is traced for a few frames
    /// only. Between the others there is little to choose: on 262 000 triangles 110 ms and 120 ms of one thread.
    pub(crate) const fn at_a_pose(self) -> Self {
        match self {
            Self::BestTrace => Self::Balanced,
            other => other,
        }
    }
}

/// Children of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Width {
    /// One AVX2 register.
    Eight,
    /// One AVX-512 register. The default with every instruction set: packets visit fewer nodes.
    #[default]
    Sixteen,
}

impl Width {
    /// Both widths.
    pub const ALL: [Self; 2] = [Self::Eight, Self::Sixteen];
}
