//! A turn of the camera around its target.

use ambray::{
    camera::Camera,
    settings::{Auto, Settings, Triple},
};
use glam::{Quat, Vec3};

/// `settings` with the camera after `share` of a full turn about the upright axis through its target. `camera` is the one
/// that they have now. Without a target, it is the point in the middle of its view that is as far as the `center` of the scene.
pub(super) fn turned(settings: &Settings, camera: &Camera, center: Vec3, share: f32) -> Settings {
    if share == 0.0 {
        return settings.clone();
    }
    let (eye, forward) = (camera.position(), camera.forward());
    let ahead = || {
        let distance = (center - eye).dot(forward);
        eye + forward * if distance > 0.0 { distance } else { (center - eye).length() }
    };
    let target = settings.camera_target.value().map_or_else(ahead, |&target| Vec3::from(target));
    let axis = settings.camera_up.value().map(|&up| Vec3::from(up)).and_then(Vec3::try_normalize);
    let turn = Quat::from_axis_angle(axis.unwrap_or(Vec3::Y), share * std::f32::consts::TAU);
    Settings {
        camera_position: Auto::Value(Triple::from(target + turn * (eye - target))),
        camera_target: Auto::Value(Triple::from(target)),
        ..settings.clone()
    }
}

#[cfg(test)]
mod tests {
    use ambray::camera::Projection;

    use super::*;

    #[test]
    fn the_camera_keeps_its_height_and_distance() {
        let (eye, target) = (Vec3::new(3.0, 2.0, 1.0), Vec3::new(0.5, 1.0, -1.0));
        let settings = Settings { camera_target: Auto::Value(Triple::from(target)), ..Settings::default() };
        let projection = Projection::Perspective { vertical_fov: 1.0 };
        let camera = Camera::new(eye, (target - eye).normalize(), Vec3::Y, projection, 16, 9);
        let at = |share| {
            let turned = turned(&settings, &camera, Vec3::ZERO, share);
            turned.camera_position.value().map_or(eye, |&position| Vec3::from(position))
        };
        assert_eq!(at(0.0), eye);
        for i in 1..12 {
            let position = at(i as f32 / 12.0);
            assert!((position.distance(target) - eye.distance(target)).abs() < 1e-5);
            assert!((position.y - eye.y).abs() < 1e-5);
        }
        let half = at(0.5);
        assert!(half.abs_diff_eq(Vec3::new(-2.0, 2.0, -3.0), 1e-5), "{half}");
    }
}
