//! Turning around the target, moving across it, and coming closer.

use glam::{Quat, Vec3};

use super::{LEAN, Lens, Viewpoint, closest};

/// Steepest view up or down, radians: beyond it the horizontal direction is lost in rounding.
const STEEPEST: f32 = 89.5 * std::f32::consts::PI / 180.0;
/// Factor of the distance for one notch of the wheel.
const NOTCH: f32 = 0.88;
/// Farthest distance of the target, scene units.
const FARTHEST: f32 = 1e12;

impl Viewpoint {
    /// Turns around the target: the camera goes to the left and up by these angles, radians. It stops short of the poles.
    #[must_use]
    pub fn orbited(self, left: f32, up: f32) -> Self {
        let (forward, axis) = self.turned(left, -up);
        Self { position: self.target - self.distance() * forward, up: axis, ..self }
    }

    /// Turns on the spot: the view goes to the right and up by these angles, radians. It stops short of the poles.
    #[must_use]
    pub fn looked(self, right: f32, up: f32) -> Self {
        let (forward, axis) = self.turned(right, up);
        Self { target: self.position + self.distance() * forward, up: axis, ..self }
    }

    /// Moves across the picture, target and all: to the right and up by shares of the height of what is seen at the target.
    #[must_use]
    pub fn panned(self, right: f32, up: f32) -> Self {
        let to_right = self.right();
        let upright = to_right.cross(self.forward());
        let offset = self.height() * (right * to_right + up * upright);
        Self { position: self.position + offset, target: self.target + offset, ..self }
    }

    /// Comes closer to the target by notches of the wheel; in parallel projection the view becomes smaller instead.
    #[must_use]
    pub fn dollied(self, notches: f32) -> Self {
        let factor = libm::powf(NOTCH, notches);
        match self.lens {
            Lens::Perspective(_) => {
                let distance = (factor * self.distance()).clamp(closest(self.target), FARTHEST);
                Self { position: self.target - distance * self.forward(), ..self }
            }
            Lens::Orthographic(height) => Self { lens: Lens::orthographic(factor * height), ..self },
        }
    }

    /// Direction of the view after turns to the right and up, and the axis that it turns about, which becomes upright.
    fn turned(&self, to_right: f32, upwards: f32) -> (Vec3, Vec3) {
        let (forward, right, axis) = (self.forward(), self.right(), self.axis());
        // At a pole the forward direction has no horizontal part, but right is horizontal all the same.
        let ahead = axis.cross(right).normalize();
        let pitch = libm::atan2f(forward.dot(axis), forward.dot(ahead));
        let pitch = (pitch + upwards).clamp(-STEEPEST, STEEPEST);
        let ahead = Quat::from_axis_angle(axis, -to_right) * ahead;
        let (sin, cos) = libm::sincosf(pitch);
        ((cos * ahead + sin * axis).normalize(), axis)
    }

    /// What the camera turns about: the vertical, unless the picture leans.
    fn axis(&self) -> Vec3 {
        let right = self.right();
        let is_level = right.y.abs() < LEAN && right.cross(self.forward()).y > -LEAN;
        if is_level { Vec3::Y } else { self.up.try_normalize().unwrap_or(Vec3::Y) }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::tests::somewhere, *};

    fn roll(viewpoint: &Viewpoint) -> f32 {
        viewpoint.right().dot(viewpoint.up)
    }

    #[test]
    fn orbiting_keeps_target_and_distance_and_does_not_roll() {
        let start = somewhere();
        let mut turned = start;
        for i in 0..1000 {
            let angle = i as f32;
            turned = turned.orbited(0.1 * angle.sin(), 0.3 * (0.37 * angle).cos());
            assert_eq!(turned.target, start.target);
            assert!((turned.distance() / start.distance() - 1.0).abs() < 1e-4);
            assert!(roll(&turned).abs() < 1e-4);
            assert!(turned.right().cross(turned.forward()).y > 0.0, "upside down after {i} turns");
        }
    }

    #[test]
    fn dragging_over_the_pole_stops_there_and_comes_back() {
        let start = somewhere();
        let top = start.orbited(0.0, 10.0);
        assert!(top.forward().y < -0.999 && top.position.y > start.position.y);
        let heading = |v: &Viewpoint| v.right();
        assert!(heading(&top).distance(heading(&start)) < 1e-3, "the heading is kept at the pole");
        let back = top.orbited(0.0, -0.5);
        assert!(back.forward().y > top.forward().y);
        assert!(heading(&back).distance(heading(&start)) < 1e-3);
    }

    #[test]
    fn a_view_straight_down_turns_about_the_vertical() {
        let down = Viewpoint {
            position: Vec3::new(0.0, 5.0, 0.0),
            target: Vec3::ZERO,
            up: Vec3::NEG_Z,
            lens: Lens::Perspective(50.0),
        };
        let turned = down.orbited(0.3, -0.2);
        assert_eq!(turned.up, Vec3::Y);
        assert!(turned.right().y.abs() < 1e-5);
        assert!((turned.distance() - 5.0).abs() < 1e-4);
    }

    #[test]
    fn a_leaning_view_turns_about_its_own_upright() {
        let up = Vec3::new(0.5, 1.0, 0.0).normalize();
        let turned = Viewpoint { up, ..somewhere() }.orbited(0.4, 0.1);
        assert!(turned.up.distance(up) < 1e-6 && roll(&turned).abs() < 1e-5);
    }

    #[test]
    fn turning_back_returns() {
        let start = somewhere();
        let back = start.orbited(0.7, 0.2).orbited(0.0, -0.2).orbited(-0.7, 0.0);
        assert!(back.position.distance(start.position) < 1e-4);
    }

    #[test]
    fn dragging_left_brings_the_camera_to_the_left() {
        let start = somewhere();
        let moved = start.orbited(0.1, 0.0).position - start.position;
        assert!(moved.dot(start.right()) < 0.0);
        let looked = start.looked(0.1, 0.0);
        assert_eq!(looked.position, start.position);
        assert!(looked.forward().dot(start.right()) > 0.0);
    }

    #[test]
    fn panning_moves_in_the_plane_of_the_target() {
        let start = somewhere();
        let moved = start.panned(0.5, -0.25);
        assert!((moved.target - start.target).dot(start.forward()).abs() < 1e-5);
        assert!(((moved.position - start.position) - (moved.target - start.target)).length() < 1e-5);
        let share = (moved.target - start.target).dot(start.right()) / start.height();
        assert!((share - 0.5).abs() < 1e-5);
    }

    #[test]
    fn the_wheel_comes_closer_and_never_arrives() {
        let start = somewhere();
        assert!((start.dollied(1.0).distance() / start.distance() - NOTCH).abs() < 1e-5);
        assert!(start.dollied(3.0).dollied(-3.0).position.distance(start.position) < 1e-4);
        let close = start.dollied(1e4);
        assert!(close.position != close.target && close.forward().distance(start.forward()) < 0.05);
        assert!(start.dollied(-1e4).position.is_finite());
    }

    #[test]
    fn in_parallel_projection_the_wheel_changes_the_height() {
        let start = somewhere().orthographic();
        let closer = start.dollied(2.0);
        assert_eq!(closer.position, start.position);
        assert!((closer.height() / start.height() - NOTCH * NOTCH).abs() < 1e-5);
        assert!(matches!(start.dollied(1e6).lens, Lens::Orthographic(height) if height > 0.0));
    }
}
