//! Ways to move the camera: pure functions of a viewpoint and what hand and keys did.

use ambray::{
    View,
    settings::{Auto, Settings, Triple},
};
use glam::Vec3;

/// How the world is projected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Perspective with a full vertical angle of view, degrees.
    Perspective(f32),
    /// Orthographic with a height of the view, scene units.
    Orthographic(f32),
}

/// Where the camera is and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Position, world space.
    pub position: Vec3,
    /// Point that it looks at and turns around, world space.
    pub target: Vec3,
    /// Direction that is upright in the picture.
    pub up: Vec3,
    /// Projection.
    pub lens: Lens,
}

impl Viewpoint {
    /// The viewpoint of a rendered picture, with its target at `distance`.
    #[must_use]
    pub fn of(view: &View, distance: f32) -> Self {
        use ambray::camera::Projection;
        let camera = &view.camera;
        let lens = match camera.projection() {
            Projection::Perspective { .. } => Lens::Perspective(50.0),
            Projection::Orthographic { .. } => Lens::Orthographic(1.0),
        };
        Self {
            position: camera.position(),
            target: camera.position() + distance * camera.forward(),
            up: Vec3::Y,
            lens,
        }
    }

    /// Puts it into `settings`, with nothing left to choose.
    pub fn apply(&self, settings: &mut Settings) {
        settings.camera_position = Auto::Value(Triple::from(self.position));
        settings.camera_target = Auto::Value(Triple::from(self.target));
        settings.camera_up = Auto::Value(Triple::from(self.up));
        (settings.vertical_fov, settings.orthographic_height) = match self.lens {
            Lens::Perspective(degrees) => (Auto::Value(degrees), Auto::Auto),
            Lens::Orthographic(height) => (Auto::Auto, Auto::Value(height)),
        };
    }
}
