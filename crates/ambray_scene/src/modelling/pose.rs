//! Placements that come out the same on every machine: scalar arithmetic and `libm` alone.

use core::f32::consts::PI;

use glam::{Affine3A, Mat3, Vec3};

/// Where a thing stands, how it is turned and how large it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    linear: Mat3,
    translation: Vec3,
}

impl Pose {
    /// Moved to `translation`.
    pub(crate) const fn at(translation: Vec3) -> Self {
        Self { linear: Mat3::IDENTITY, translation }
    }

    /// Moved to (x, y, z).
    pub(crate) const fn xyz(x: f32, y: f32, z: f32) -> Self {
        Self::at(Vec3::new(x, y, z))
    }

    /// First turned about its upright axis, anticlockwise as seen from above; degrees.
    pub(crate) fn turned(self, degrees: f32) -> Self {
        let (sin, cos) = sin_cos(degrees);
        self.before(Mat3::from_cols(Vec3::new(cos, 0.0, -sin), Vec3::Y, Vec3::new(sin, 0.0, cos)))
    }

    /// First tilted about its x axis, so that its top goes towards +z; degrees.
    pub(crate) fn tilted(self, degrees: f32) -> Self {
        let (sin, cos) = sin_cos(degrees);
        self.before(Mat3::from_cols(Vec3::X, Vec3::new(0.0, cos, sin), Vec3::new(0.0, -sin, cos)))
    }

    /// First rolled about its z axis, so that its top goes towards -x; degrees.
    pub(crate) fn rolled(self, degrees: f32) -> Self {
        let (sin, cos) = sin_cos(degrees);
        self.before(Mat3::from_cols(Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0), Vec3::Z))
    }

    /// First scaled along its axes.
    pub(crate) fn scaled(self, scale: Vec3) -> Self {
        self.before(Mat3::from_diagonal(scale))
    }

    /// First scaled alike in all directions.
    pub(crate) fn sized(self, scale: f32) -> Self {
        self.scaled(Vec3::splat(scale))
    }

    /// `inner` placed within this one.
    pub(crate) fn then(&self, inner: &Self) -> Self {
        Self { linear: self.linear * inner.linear, translation: self.point(inner.translation) }
    }

    /// Where `point` goes.
    pub(crate) fn point(&self, point: Vec3) -> Vec3 {
        self.linear * point + self.translation
    }

    /// The same as the scene wants it.
    pub(crate) fn affine(&self) -> Affine3A {
        Affine3A::from_mat3_translation(self.linear, self.translation)
    }

    fn before(self, first: Mat3) -> Self {
        Self { linear: self.linear * first, translation: self.translation }
    }
}

/// Sine and cosine of an angle in degrees; exact at quarter turns, so that walls meet.
pub(crate) fn sin_cos(degrees: f32) -> (f32, f32) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => libm::sincosf(other * (PI / 180.0)),
    }
}
