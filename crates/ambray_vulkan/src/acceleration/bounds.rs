//! Axis-aligned boxes.

use glam::{Affine3A, Vec3};

/// A box given by its lower and upper corner; empty where one is beyond the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub lo: Vec3,
    /// Upper corner.
    pub hi: Vec3,
}

impl Bounds {
    /// Contains nothing.
    pub const EMPTY: Self = Self { lo: Vec3::INFINITY, hi: Vec3::NEG_INFINITY };

    /// Whether there is no point in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.lo.cmple(self.hi).all()
    }

    /// Smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Smallest box around it and `point`.
    #[must_use]
    pub fn with(self, point: Vec3) -> Self {
        Self { lo: self.lo.min(point), hi: self.hi.max(point) }
    }

    /// What is in both.
    pub(super) fn intersection(self, other: Self) -> Self {
        Self { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi) }
    }

    /// Half the surface area, 0 if empty.
    pub(super) fn half_area(self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let d = (self.hi - self.lo).as_dvec3();
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    pub(super) fn centre(self) -> Vec3 {
        0.5 * self.lo + 0.5 * self.hi
    }

    /// Largest magnitude of a coordinate, 0 if empty.
    pub(super) fn extent(self) -> f32 {
        if self.is_empty() { 0.0 } else { self.lo.abs().max(self.hi.abs()).max_element() }
    }

    /// Box around it after `transform`; empty stays empty.
    pub(super) fn transformed(self, transform: &Affine3A) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let corner = |i: usize| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { self.lo[axis] } else { self.hi[axis] };
            transform.transform_point3(Vec3::new(pick(0), pick(1), pick(2)))
        };
        (0..8).map(corner).fold(Self::EMPTY, Self::with)
    }

    /// The box with `share` of its largest coordinate around it, to cover rounding.
    pub(super) fn padded(self, share: f32) -> Self {
        let pad = Vec3::splat(self.extent() * share);
        Self { lo: self.lo - pad, hi: self.hi + pad }
    }
}

impl FromIterator<Vec3> for Bounds {
    fn from_iter<I: IntoIterator<Item = Vec3>>(points: I) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }
}
