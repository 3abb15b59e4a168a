//! Projections, and how one becomes the other.

use super::{Viewpoint, closest};

/// How the world is projected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Perspective with a full vertical angle of view, degrees.
    Perspective(f32),
    /// Orthographic with a height of the view, scene units.
    Orthographic(f32),
}

/// Heights of an orthographic view that the settings take, scene units.
const HEIGHTS: (f32, f32) = (1e-12, 1e12);

impl Lens {
    /// Angle of view of a camera for which nobody chose one, degrees.
    pub const DEFAULT_FOV: f32 = 50.0;

    /// Height of what is seen at `distance`, scene units.
    #[must_use]
    pub fn height_at(self, distance: f32) -> f32 {
        match self {
            Self::Perspective(degrees) => 2.0 * distance * half_tan(degrees),
            Self::Orthographic(height) => height,
        }
    }

    /// An orthographic lens with the nearest height that is allowed.
    #[must_use]
    pub const fn orthographic(height: f32) -> Self {
        Self::Orthographic(height.clamp(HEIGHTS.0, HEIGHTS.1))
    }
}

/// Half the height of what is seen at distance 1.
pub(super) fn half_tan(degrees: f32) -> f32 {
    libm::tanf(0.5 * degrees.to_radians())
}

impl Viewpoint {
    /// The same view in parallel projection: what is at the target keeps its size.
    #[must_use]
    pub fn orthographic(self) -> Self {
        Self { lens: Lens::orthographic(self.height()), ..self }
    }

    /// The same view in perspective with a full vertical angle of view of `degrees`: what is at the target keeps its size,
    /// for which the camera moves along its direction.
    #[must_use]
    pub fn perspective(self, degrees: f32) -> Self {
        let distance = (0.5 * self.height() / half_tan(degrees)).max(closest(self.target));
        let position = self.target - distance * self.forward();
        Self { position, lens: Lens::Perspective(degrees), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::somewhere;

    #[test]
    fn the_target_keeps_its_size() {
        let start = somewhere();
        let parallel = start.orthographic();
        assert_eq!(parallel.position, start.position);
        assert!((parallel.height() / start.height() - 1.0).abs() < 1e-6);
        for degrees in [10.0, 47.0, 120.0] {
            let again = parallel.perspective(degrees);
            assert!((again.height() / start.height() - 1.0).abs() < 1e-5);
            assert!(again.forward().distance(start.forward()) < 1e-6);
        }
        assert!(parallel.perspective(47.0).position.distance(start.position) < 1e-5);
    }
}
