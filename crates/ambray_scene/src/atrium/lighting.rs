//! Sun, sky and cameras.

use ambray_core::light::Light;
use glam::Vec3;

use crate::Scene;
use crate::modelling::camera::look;

/// Puts the light and the cameras into `scene`; the first camera is the default one.
pub(super) fn light(scene: &mut Scene) {
    scene.lights.push(Light::Directional {
        to_light: Vec3::new(0.40, 0.74, -0.54).normalize(),
        irradiance: Vec3::new(4.4, 3.4, 2.25),
    });
    scene.ambient = Some(Vec3::new(0.31, 0.36, 0.44));
    scene.radius = Some(1.0);
    scene.cameras = vec![
        look("arcade", Vec3::new(3.45, 1.4, 6.05), Vec3::new(-2.6, 1.45, 2.75), 55.0),
        look("courtyard", Vec3::new(6.4, 5.9, -4.45), Vec3::new(-2.2, 2.0, 1.6), 60.0),
        look("curtain-hem", Vec3::new(0.35, 0.38, 5.35), Vec3::new(-0.25, 0.13, 4.2), 42.0),
        look("gallery", Vec3::new(-8.6, 5.85, -3.2), Vec3::new(-7.7, 5.6, 4.0), 58.0),
    ];
}
