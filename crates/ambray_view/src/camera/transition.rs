//! A short way from one viewpoint to another, so that the eye can follow.

use glam::{Mat3, Quat, Vec3};

use super::{Lens, Viewpoint};

/// How long it takes, seconds.
const DURATION: f32 = 0.25;

/// A camera on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    from: Viewpoint,
    to: Viewpoint,
    elapsed: f32,
}

impl Transition {
    /// From `from` to `to`.
    #[must_use]
    pub const fn new(from: Viewpoint, to: Viewpoint) -> Self {
        Self { from, to, elapsed: 0.0 }
    }

    /// Goes on for `dt` seconds: where the camera is now.
    pub fn step(&mut self, dt: f32) -> Viewpoint {
        self.elapsed += dt;
        self.at(self.elapsed / DURATION)
    }

    /// Whether it has arrived, at exactly the viewpoint that was asked for.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.elapsed >= DURATION
    }

    /// A share of the way.
    fn at(&self, share: f32) -> Viewpoint {
        if share >= 1.0 {
            return self.to;
        }
        let share = share.max(0.0);
        let t = share * share * (3.0 - 2.0 * share);
        let (from, to) = (&self.from, &self.to);
        let turn = turn(from).slerp(turn(to), t);
        let distance = from.distance() + t * (to.distance() - from.distance());
        let position = from.position.lerp(to.position, t);
        let lens = match (from.lens, to.lens) {
            (Lens::Perspective(a), Lens::Perspective(b)) => Lens::Perspective(a + t * (b - a)),
            (Lens::Orthographic(a), Lens::Orthographic(b)) => Lens::Orthographic(a + t * (b - a)),
            _ => to.lens,
        };
        Viewpoint { position, target: position + distance * (turn * Vec3::NEG_Z), up: turn * Vec3::Y, lens }
    }
}

/// Rotation from a camera that looks along −z to a viewpoint.
fn turn(viewpoint: &Viewpoint) -> Quat {
    let (right, forward) = (viewpoint.right(), viewpoint.forward());
    Quat::from_mat3(&Mat3::from_cols(right, right.cross(forward), -forward))
}

#[cfg(test)]
mod tests {
    use super::{super::AxisView, super::tests::somewhere, *};

    #[test]
    fn it_begins_and_ends_where_it_should() {
        let to = somewhere().focused(Vec3::new(0.7, 0.2, -1.0));
        let mut way = Transition::new(somewhere(), to);
        let first = way.step(0.0);
        assert!(first.position.distance(somewhere().position) < 1e-5);
        assert!(first.target.distance(somewhere().target) < 1e-4);
        assert!(first.right().distance(somewhere().right()) < 1e-4);
        for _ in 0..7 {
            let there = way.step(0.05);
            assert!(there.position.is_finite() && there.right().dot(there.up).abs() < 1e-4);
        }
        assert!(way.is_over());
        assert_eq!(way.step(0.0), to, "the end is exact");
    }

    #[test]
    fn opposite_views_are_reached() {
        let from = somewhere().along(AxisView::Front);
        let mut way = Transition::new(from, from.along(AxisView::Back));
        assert!(way.step(0.125).forward().is_normalized());
        assert_eq!(way.step(0.2), from.along(AxisView::Back));
    }
}
