//! Going where something is.

use glam::Vec3;

use super::{Lens, Viewpoint, closest, lens::half_tan};

/// Share of the picture that a framed box fills at most.
const FILLED: f32 = 0.95;
/// Share of the way to a point that is left when it has been gone to.
const LEFT: f32 = 0.6;

impl Viewpoint {
    /// Makes `point` the target, and comes closer to it.
    ///
    /// In perspective the camera goes along the straight line to the point, which is free if it can be seen; in parallel
    /// projection it moves across the picture.
    #[must_use]
    pub fn focused(self, point: Vec3) -> Self {
        match self.lens {
            Lens::Perspective(_) => {
                let away = self.position - point;
                let distance = (LEFT * away.length()).max(closest(point));
                let position = point + distance * away.normalize_or(-self.forward());
                // Looking there by way of `looked` keeps the picture upright, and off the poles.
                let seen = Self { position, target: position + distance * self.forward(), ..self };
                Self { target: point, ..seen.looked(0.0, 0.0) }
            }
            Lens::Orthographic(_) => {
                Self { position: point - self.distance() * self.forward(), target: point, ..self }
            }
        }
    }

    /// Shows the whole box from the direction of the view, in a picture of `aspect` = width/height.
    #[must_use]
    pub fn framed(self, (low, high): (Vec3, Vec3), aspect: f32) -> Self {
        let middle = 0.5 * (low + high);
        let (forward, right) = (self.forward(), self.right());
        let upright = right.cross(forward);
        let corners = (0..8).map(|corner| {
            let pick = |bit: u8, low: f32, high: f32| if corner & bit == 0 { low } else { high };
            Vec3::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z)) - middle
        });
        // Half the height at the depth of a corner that shows it.
        let half_height =
            |offset: Vec3| offset.dot(upright).abs().max(offset.dot(right).abs() / aspect) / FILLED;
        let (distance, lens) = match self.lens {
            Lens::Perspective(degrees) => {
                let needed = |offset: Vec3| half_height(offset) / half_tan(degrees) - offset.dot(forward);
                (corners.map(needed).fold(0.0, f32::max), self.lens)
            }
            Lens::Orthographic(_) => {
                let height = corners.map(|offset| 2.0 * half_height(offset)).fold(0.0, f32::max);
                // All of the box is in front of the camera.
                (low.distance(high), if height > 0.0 { Lens::orthographic(height) } else { self.lens })
            }
        };
        let distance = if distance > 0.0 { distance } else { self.distance() }.max(closest(middle));
        Self { position: middle - distance * forward, target: middle, lens, ..self }
    }
}

#[cfg(test)]
mod tests {
    use ambray::camera::{Camera, Projection};

    use super::{super::tests::somewhere, *};

    fn camera(viewpoint: &Viewpoint, (width, height): (u32, u32)) -> Camera {
        let projection = match viewpoint.lens {
            Lens::Perspective(degrees) => Projection::Perspective { vertical_fov: degrees.to_radians() },
            Lens::Orthographic(height) => Projection::Orthographic { height },
        };
        Camera::new(viewpoint.position, viewpoint.forward(), viewpoint.up, projection, width, height)
    }

    #[test]
    fn a_point_comes_to_the_middle_along_the_free_way() {
        let start = somewhere();
        let point = Vec3::new(0.7, 0.2, -1.0);
        let near = start.focused(point);
        assert_eq!(near.target, point);
        let way = (near.position - start.position).normalize();
        assert!(way.distance((point - start.position).normalize()) < 1e-5);
        assert!((near.distance() / start.position.distance(point) - LEFT).abs() < 1e-5);
        let (place, _) = camera(&near, (200, 100)).project(point).expect("in front");
        assert!(place.distance(glam::Vec2::new(99.5, 49.5)) < 1e-2);
        assert_eq!(near.up, Vec3::Y);
    }

    #[test]
    fn in_parallel_projection_only_the_place_changes() {
        let start = somewhere().orthographic();
        let point = Vec3::new(0.7, 0.2, -1.0);
        let near = start.focused(point);
        assert_eq!((near.target, near.lens), (point, start.lens));
        assert!(near.forward().distance(start.forward()) < 1e-5);
        assert!((near.distance() / start.distance() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn the_point_under_the_eye_does_not_break_it() {
        let start = somewhere();
        let there = start.focused(start.position);
        assert!(there.position.is_finite() && there.position != there.target);
    }

    #[test]
    fn a_framed_box_is_in_the_picture_and_fills_it() {
        for start in [somewhere(), somewhere().orthographic()] {
            for high in [Vec3::splat(3.0), Vec3::new(30.0, 0.0, 1.0), Vec3::new(0.1, 50.0, 0.1)] {
                let framed = start.framed((-high, high), 1.6);
                let camera = camera(&framed, (160, 100));
                let mut reach = 0.0_f32;
                for corner in 0..8 {
                    let sign = |bit: u32| if corner & bit == 0 { -1.0 } else { 1.0 };
                    let point = high * Vec3::new(sign(1), sign(2), sign(4));
                    let (place, depth) = camera.project(point).expect("in front");
                    assert!(depth > 0.0);
                    let offset = (place - glam::Vec2::new(79.5, 49.5)).abs() / glam::Vec2::new(80.0, 50.0);
                    reach = reach.max(offset.max_element());
                }
                assert!((0.9..=1.0).contains(&reach), "{reach} for {high}, {start:?}");
                assert!(framed.forward().distance(start.forward()) < 1e-4);
            }
        }
    }

    #[test]
    fn a_box_without_size_leaves_the_distance() {
        let start = somewhere();
        for start in [start, start.orthographic()] {
            let framed = start.framed((Vec3::ONE, Vec3::ONE), 1.0);
            assert_eq!(framed.target, Vec3::ONE);
            assert!(framed.position.is_finite() && framed.position != framed.target);
            assert_eq!(framed.lens, start.lens);
        }
    }
}
