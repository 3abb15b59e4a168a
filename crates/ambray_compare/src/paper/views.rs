//! Where the figures are seen from.

use ambray::{
    scene::Scene,
    settings::{Auto, Normals, Settings, Triple},
};

/// Settings with the camera of each kind of figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Views {
    /// Figure 1: something coloured near something white.
    pub bleeding: Settings,
    /// Figures 2 and 6, and the table: the whole.
    pub overview: Settings,
    /// Figures 3 and 5: a thin thing that ends above the floor.
    pub thin: Settings,
    /// How they were chosen, in words.
    pub origin: String,
}

/// Eye and target in Khronos' Sponza (spec §11).
const NAVE: ([f32; 3], [f32; 3]) = ([-9.0, 1.6, -0.3], [0.0, 2.2, -0.3]);
const CURTAIN: ([f32; 3], [f32; 3]) = ([-2.6, 0.55, 3.3], [-3.6, 0.25, 1.7]);

/// The camera of the built-in atrium that looks at the hem of its curtain.
const HEM: &str = "curtain-hem";

impl Views {
    /// The views of `scene`, with all else of `settings`. A camera that the settings choose is used for all figures.
    #[must_use]
    pub fn of(scene: &Scene, settings: &Settings) -> Self {
        let asked = settings.camera.value().is_some()
            || settings.camera_position.value().is_some()
            || settings.camera_target.value().is_some();
        let all = |origin: &str| Self {
            bleeding: settings.clone(),
            overview: settings.clone(),
            thin: settings.clone(),
            origin: origin.to_owned(),
        };
        if asked {
            all("one view, as it was asked for")
        } else if scene.cameras.iter().any(|camera| camera.name == HEM) {
            let hem = Settings { camera: Auto::Value(HEM.to_owned()), ..settings.clone() };
            Self {
                bleeding: hem.clone(),
                overview: settings.clone(),
                thin: hem,
                origin: "the atrium's cameras".to_owned(),
            }
        } else if is_sponza(scene) {
            let at = |(eye, target): ([f32; 3], [f32; 3])| Settings {
                camera_position: Auto::Value(Triple(eye)),
                camera_target: Auto::Value(Triple(target)),
                vertical_fov: if settings.orthographic_height.value().is_some() {
                    settings.vertical_fov.clone()
                } else {
                    Auto::Value(settings.vertical_fov.unwrap_or(50.0))
                },
                radius: Auto::Value(settings.radius.unwrap_or(1.0)),
                normals: Normals::Geometric,
                ..settings.clone()
            };
            Self {
                bleeding: at(CURTAIN),
                overview: at(NAVE),
                thin: at(CURTAIN),
                origin: "Sponza's nave and curtain, R = 1, geometric normals (docs/specification.md §11)"
                    .to_owned(),
            }
        } else {
            all("one view: name a camera with --camera-position and --camera-target to see something else")
        }
    }
}

/// Whether this is Sponza as Khronos distributes it: by name and by its extent of about 30 × 12 × 18 metres.
fn is_sponza(scene: &Scene) -> bool {
    let size = scene.bounds().map(|(low, high)| high - low);
    let fits = size.is_some_and(|size| {
        (25.0..35.0).contains(&size.x) && (10.0..20.0).contains(&size.y) && (15.0..25.0).contains(&size.z)
    });
    fits && scene.name.eq_ignore_ascii_case("sponza")
}

#[cfg(test)]
mod tests {
    use ambray::scene::atrium::atrium;

    use super::*;

    #[test]
    fn the_atrium_has_a_view_for_each_figure() {
        let views = Views::of(&atrium(), &Settings::default());
        assert_eq!(views.thin.camera, Auto::Value(HEM.to_owned()));
        assert_eq!(views.overview, Settings::default());
    }

    #[test]
    fn a_camera_that_is_asked_for_is_used_for_all_figures() {
        let asked = Settings { camera: Auto::Value("gallery".to_owned()), ..Settings::default() };
        let views = Views::of(&atrium(), &asked);
        assert_eq!([&views.thin, &views.bleeding, &views.overview], [&asked; 3]);
    }

    #[test]
    fn other_scenes_are_seen_as_they_are() {
        let views = Views::of(&Scene::default(), &Settings::default());
        assert_eq!(views.thin, Settings::default());
        assert!(views.origin.contains("--camera-position"));
    }
}
