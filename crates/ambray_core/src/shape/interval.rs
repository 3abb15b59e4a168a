//! The part of a line that lies within a convex body.

/// Parameters t from where a line enters a convex body to where it leaves it; empty if `near > far`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub(super) near: f32,
    pub(super) far: f32,
}

impl Interval {
    pub(super) const ALL: Self = Self { near: f32::NEG_INFINITY, far: f32::INFINITY };
    pub(super) const EMPTY: Self = Self { near: f32::INFINITY, far: f32::NEG_INFINITY };

    /// Between two parameters in any order.
    pub(super) fn between(a: f32, b: f32) -> Self {
        Self { near: a.min(b), far: a.max(b) }
    }

    /// What both cover.
    pub(super) fn intersection(self, other: Self) -> Self {
        Self { near: self.near.max(other.near), far: self.far.min(other.far) }
    }

    /// From the first to the last parameter of both.
    pub(super) fn hull(self, other: Self) -> Self {
        Self { near: self.near.min(other.near), far: self.far.max(other.far) }
    }

    /// The first end within (0, `t_max`].
    pub(super) fn first(self, t_max: f32) -> Option<f32> {
        if self.near > self.far {
            return None;
        }
        let t = if self.near > 0.0 { self.near } else { self.far };
        (t > 0.0 && t <= t_max && t < f32::INFINITY).then_some(t)
    }
}
