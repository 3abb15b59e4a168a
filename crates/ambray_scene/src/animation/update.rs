//! How acceleration structures follow what deforms: the policy that both backends share.

/// What is done with the structure of a mesh that deforms, at each new pose. None changes a picture: all find the same hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Updates {
    /// The policy.
    pub policy: UpdatePolicy,
    /// Surface-area cost of a refitted structure, over that of its build, above which it counts as poor: 1 is as good as
    /// new. Both costs are relative to the box around everything. Default 1.5.
    ///
    /// Measured on the processor, rays through refitted trees take 1.05 to 1.4 times as long as through new ones where this
    /// is near 1.5, 1.3 to 1.6 times near 2.2, and 2.3 times near 5. A new tree costs as much as 3 or 4 ambient rays a
    /// triangle, so rebuilding earlier pays only where meshes are small beside the picture.
    pub poor: f32,
    /// Most structures that are kept of one mesh, each built in another pose; at least 1.
    pub poses: u32,
}

/// See [`Updates`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UpdatePolicy {
    /// Refit, and rebuild what has become poor.
    #[default]
    Auto,
    /// Refit, however poor.
    Refit,
    /// Rebuild at every pose.
    Rebuild,
    /// Keep structures built in several poses and refit the one whose pose is nearest; build another one where even that
    /// is poor.
    Cache,
}

impl Updates {
    /// The default.
    pub const DEFAULT: Self = Self { policy: UpdatePolicy::Auto, poor: 1.5, poses: 8 };
}

impl Default for Updates {
    fn default() -> Self {
        Self::DEFAULT
    }
}
