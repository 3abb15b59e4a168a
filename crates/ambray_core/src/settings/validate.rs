//! Range checks: every problem is reported, not the first.

use super::{Settings, Thin};

/// A setting outside its range.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} {value} is not allowed: {allowed}")]
pub struct SettingsError {
    /// The setting, spelled as in files and flags.
    pub name: &'static str,
    /// Its value.
    pub value: String,
    /// What would be allowed.
    pub allowed: &'static str,
}

/// Rays per pixel with all pairs of the paper's second batch: about half a million chords per pixel would follow from 1024.
const MAX_PAPER_SPP: u32 = 256;

impl Settings {
    /// Checks every setting; the list is empty if the settings can be used.
    #[must_use]
    pub fn validate(&self) -> Vec<SettingsError> {
        let mut errors = self.outside();
        if self.thin == Thin::Paper && self.spp > MAX_PAPER_SPP {
            let allowed = "1 to 256 with thin paper, which joins all pairs of missed rays";
            errors.push(SettingsError { name: "spp", value: self.spp.to_string(), allowed });
        }
        errors.extend(self.method_errors());
        if let (Some(_), Some(height)) = (self.vertical_fov.value(), self.orthographic_height.value()) {
            let allowed = "auto where vertical-fov is set";
            errors.push(SettingsError { name: "orthographic-height", value: height.to_string(), allowed });
        }
        errors
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Auto, Preset, Range, Rgb, Size, Triple};
    use super::*;

    #[test]
    fn defaults_and_presets_are_valid() {
        assert_eq!(Settings::default().validate(), []);
        for preset in [Preset::Draft, Preset::Realtime, Preset::Reference] {
            let mut settings = Settings::default();
            preset.patch().apply(&mut settings);
            assert_eq!(settings.validate(), [], "{preset:?}");
        }
    }

    #[test]
    fn each_problem_is_named() {
        let settings = Settings {
            size: Size { width: 0, height: 9 },
            range: Auto::Value(Range([1.0, 1.0])),
            spp: 0,
            radius: Auto::Value(f32::NAN),
            exponent: -1.0,
            ambient: Auto::Value(Rgb([0.0, -1.0, 0.0])),
            camera_up: Auto::Value(Triple([0.0; 3])),
            camera_position: Auto::Value(Triple([f32::INFINITY, 0.0, 0.0])),
            vertical_fov: Auto::Value(180.0),
            ..Settings::default()
        };
        let names: Vec<_> = settings.validate().iter().map(|e| e.name).collect();
        let expected = [
            "size",
            "range",
            "spp",
            "radius",
            "exponent",
            "ambient",
            "camera-position",
            "camera-up",
            "vertical-fov",
        ];
        assert_eq!(names, expected);
        assert_eq!(settings.validate()[2].to_string(), "spp 0 is not allowed: 1 to 65536");
    }

    #[test]
    fn files_round_trip() {
        let settings = Settings {
            radius: Auto::Value(1.5),
            ambient: Auto::Value(Rgb([0.25, 0.5, 1.0])),
            camera: Auto::Value("nave".to_owned()),
            range: Auto::Value(Range([-0.5, 2.0])),
            thin: Thin::Sheet,
            thin_edge: true,
            ..Settings::default()
        };
        let text = toml::to_string(&settings).expect("settings are plain data");
        assert_eq!(toml::from_str::<Settings>(&text).expect("what was written can be read"), settings);
        let camera = |text: &str| toml::from_str::<Settings>(text).map(|settings| settings.camera);
        assert_eq!(camera("camera = \"auto\""), Ok(Auto::Auto));
        assert!(toml::from_str::<Settings>("raduis = 1").is_err(), "an unknown key passed");
        assert!(toml::from_str::<Settings>("radius = \"wide\"").is_err(), "a word passed for a number");
    }
}
