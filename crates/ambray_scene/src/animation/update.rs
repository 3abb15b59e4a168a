//! How acceleration structures follow what deforms: the policy that both backends share.

/// What is done with the structure of a mesh that deforms, at each new pose. None changes a picture: all find the same hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Updates {
    /// The policy.
    pub policy: UpdatePolicy,
    /// Surface-area cost of a refitted structure, over that of its build, above which it counts as poor: 1 is as good as
    /// new.
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
