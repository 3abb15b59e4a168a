//! Cameras by what they look at.

use ambray_core::camera::Projection;
use glam::Vec3;

use crate::SceneCamera;

/// A camera at `eye` that looks at `target`; `fov` is its full vertical angle in degrees.
pub(crate) fn look(name: &str, eye: Vec3, target: Vec3, fov: f32) -> SceneCamera {
    let forward = (target - eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    SceneCamera {
        name: name.to_owned(),
        position: eye,
        forward,
        up: right.cross(forward),
        projection: Projection::Perspective { vertical_fov: fov.to_radians() },
    }
}
