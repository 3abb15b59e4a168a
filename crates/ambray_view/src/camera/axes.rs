//! Views along the axes of the world.

use glam::Vec3;

use super::Viewpoint;

/// An axis of the world, and the side that it is looked at from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisView {
    /// From +x.
    Right,
    /// From −x.
    Left,
    /// From +y.
    Top,
    /// From −y.
    Bottom,
    /// From +z.
    Front,
    /// From −z.
    Back,
}

impl AxisView {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Right, Self::Left, Self::Top, Self::Bottom, Self::Front, Self::Back];

    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Right => "right (from +x)",
            Self::Left => "left (from \u{2212}x)",
            Self::Top => "top (from +y)",
            Self::Bottom => "bottom (from \u{2212}y)",
            Self::Front => "front (from +z)",
            Self::Back => "back (from \u{2212}z)",
        }
    }

    /// Where it is looked from, as a unit vector away from the target.
    #[must_use]
    pub const fn from(self) -> Vec3 {
        match self {
            Self::Right => Vec3::X,
            Self::Left => Vec3::NEG_X,
            Self::Top => Vec3::Y,
            Self::Bottom => Vec3::NEG_Y,
            Self::Front => Vec3::Z,
            Self::Back => Vec3::NEG_Z,
        }
    }

    const fn up(self) -> Vec3 {
        match self {
            Self::Top => Vec3::NEG_Z,
            Self::Bottom => Vec3::Z,
            _ => Vec3::Y,
        }
    }
}

impl Viewpoint {
    /// Looks at the target along an axis, from the same distance.
    #[must_use]
    pub fn along(self, view: AxisView) -> Self {
        Self { position: self.target + self.distance() * view.from(), up: view.up(), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::tests::somewhere, *};

    #[test]
    fn views_along_axes_keep_target_and_distance() {
        let start = somewhere();
        for view in AxisView::ALL {
            let along = start.along(view);
            assert_eq!(along.target, start.target);
            assert!((along.distance() - start.distance()).abs() < 1e-5);
            assert!(along.forward().distance(-view.from()) < 1e-5, "{view:?}");
            assert!(along.right().is_normalized() && along.right().y.abs() < 1e-6);
        }
        assert!(start.along(AxisView::Top).right().distance(Vec3::X) < 1e-6);
        assert!(start.along(AxisView::Front).right().distance(Vec3::X) < 1e-6);
    }

    #[test]
    fn they_can_be_turned_on_from() {
        for view in AxisView::ALL {
            let turned = somewhere().along(view).orbited(0.2, 0.1);
            assert!(turned.position.is_finite());
            assert_eq!(turned.up, Vec3::Y, "{view:?}");
        }
    }
}
