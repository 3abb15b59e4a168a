//! Ways to move the camera: pure functions of a viewpoint and what hand and keys did.

mod axes;
mod fly;
mod focus;
mod lens;
mod orbit;
mod transition;

use ambray::{
    View,
    camera::Projection,
    settings::{Auto, Settings, Triple},
};
use glam::Vec3;

pub use axes::AxisView;
pub use fly::{Fly, Thrust};
pub use lens::Lens;
pub use transition::Transition;

/// Where the camera is and where it looks.
///
/// Every function that moves one leaves position and target apart, the lens within what the settings allow, and a picture
/// that does not lean unless it did before.
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
        let camera = &view.camera;
        let lens = match camera.projection() {
            Projection::Perspective { vertical_fov } => Lens::Perspective(vertical_fov.to_degrees()),
            Projection::Orthographic { height } => Lens::Orthographic(height),
        };
        // Most pictures are upright in the world; then turning goes on about the vertical.
        let leans = camera.right().y.abs() > LEAN || camera.up().y < LEAN;
        Self {
            position: camera.position(),
            target: camera.position() + distance * camera.forward(),
            up: if leans { camera.up() } else { Vec3::Y },
            lens,
        }
    }

    /// What `settings` say, bit for bit; where they leave something to be chosen, what was chosen for `view`. A target that
    /// was not given lies at `distance`.
    #[must_use]
    pub fn current(settings: &Settings, view: &View, distance: f32) -> Self {
        let given = |value: &Auto<Triple>| value.value().map(|&value| Vec3::from(value));
        let chosen = Self::of(view, distance);
        let position = given(&settings.camera_position).unwrap_or(chosen.position);
        let target = given(&settings.camera_target);
        let target = target.unwrap_or(position + distance * view.camera.forward());
        let lens = match (settings.orthographic_height.value(), settings.vertical_fov.value()) {
            (Some(&height), _) => Lens::Orthographic(height),
            (None, Some(&degrees)) => Lens::Perspective(degrees),
            (None, None) => chosen.lens,
        };
        Self { position, target, up: given(&settings.camera_up).unwrap_or(chosen.up), lens }
    }

    /// Puts it into `settings`, with nothing left to choose: [`current`](Self::current) gives it back bit for bit.
    pub fn apply(&self, settings: &mut Settings) {
        settings.camera_position = Auto::Value(Triple::from(self.position));
        settings.camera_target = Auto::Value(Triple::from(self.target));
        settings.camera_up = Auto::Value(Triple::from(self.up));
        (settings.vertical_fov, settings.orthographic_height) = match self.lens {
            Lens::Perspective(degrees) => (Auto::Value(degrees), Auto::Auto),
            Lens::Orthographic(height) => (Auto::Auto, Auto::Value(height)),
        };
    }

    /// Unit viewing direction.
    #[must_use]
    pub fn forward(&self) -> Vec3 {
        (self.target - self.position).try_normalize().unwrap_or(Vec3::NEG_Z)
    }

    /// Unit vector to the right in the picture.
    #[must_use]
    pub fn right(&self) -> Vec3 {
        let forward = self.forward();
        forward.cross(self.up).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector())
    }

    /// Distance of the target, scene units.
    #[must_use]
    pub fn distance(&self) -> f32 {
        self.position.distance(self.target)
    }

    /// Height of what is seen at the target, scene units.
    #[must_use]
    pub fn height(&self) -> f32 {
        self.lens.height_at(self.distance())
    }
}

/// Vertical part of a unit vector below which it counts as level.
const LEAN: f32 = 1e-3;

/// Shortest distance of a camera from `target`: closer, single precision cannot tell the two apart.
fn closest(target: Vec3) -> f32 {
    (1e-5 * target.abs().max_element()).max(1e-12)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ambray::{Control, Renderer, scene::atrium, settings::Size};

    /// A viewpoint with nothing special about it.
    pub(super) fn somewhere() -> Viewpoint {
        Viewpoint {
            position: Vec3::new(1.0, 2.0, 7.0),
            target: Vec3::new(-0.5, 1.25, 0.5),
            up: Vec3::Y,
            lens: Lens::Perspective(47.0),
        }
    }

    fn view(settings: &Settings) -> View {
        let mut renderer = Renderer::new(atrium::atrium());
        renderer.render(settings, Control::default()).expect("renders").view
    }

    fn small() -> Settings {
        Settings { size: Size { width: 8, height: 6 }, spp: 1, ..Settings::default() }
    }

    #[test]
    fn settings_give_back_the_viewpoint_bit_for_bit() {
        for lens in [Lens::Perspective(33.3), Lens::Orthographic(2.7)] {
            let viewpoint = Viewpoint { lens, up: Vec3::new(0.1, 0.9, -0.2), ..somewhere() };
            let mut settings = small();
            viewpoint.apply(&mut settings);
            assert_eq!(settings.validate(), []);
            assert_eq!(Viewpoint::current(&settings, &view(&small()), 3.0), viewpoint);
        }
    }

    #[test]
    fn the_viewpoint_of_a_picture_gives_its_camera() {
        let settings = small();
        let seen = view(&settings);
        let viewpoint = Viewpoint::current(&settings, &seen, 2.5);
        let mut given = settings.clone();
        viewpoint.apply(&mut given);
        let again = view(&given);
        assert_eq!(again.camera.position(), seen.camera.position());
        for (a, b) in [
            (again.camera.forward(), seen.camera.forward()),
            (again.camera.up(), seen.camera.up()),
            (again.camera.right(), seen.camera.right()),
        ] {
            assert!(a.distance(b) < 1e-5, "{a} for {b}");
        }
        assert!((again.camera.half_height() - seen.camera.half_height()).abs() < 1e-6);
        assert!((viewpoint.distance() - 2.5).abs() < 1e-5);
    }

    #[test]
    fn a_leaning_camera_keeps_its_own_upright() {
        let leaning = Vec3::new(0.5, 1.0, 0.0).normalize();
        let mut settings = small();
        Viewpoint { up: leaning, ..somewhere() }.apply(&mut settings);
        let seen = view(&settings);
        assert!(Viewpoint::of(&seen, 1.0).up.distance(seen.camera.up()) < 1e-6);
        somewhere().apply(&mut settings);
        assert_eq!(Viewpoint::of(&view(&settings), 1.0).up, Vec3::Y);
    }
}
