//! Range checks: every problem is reported, not the first.

use super::{Auto, Settings, Thin};

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

/// Pictures up to this many pixels a side.
const MAX_SIDE: u32 = 32_768;
/// Pixels of a picture: their planes take 55 GB.
const MAX_PIXELS: u64 = 1 << 28;
/// Rays per pixel.
const MAX_SPP: u32 = 65_536;
/// Longest time in an animation, seconds: single precision tells milliseconds apart there.
const MAX_TIME: f32 = 1e4;
/// Rays per pixel with all pairs of the paper's second batch: about half a million chords per pixel would follow from 1024.
const MAX_PAPER_SPP: u32 = 256;

impl Settings {
    /// Checks every setting; the list is empty if the settings can be used.
    #[must_use]
    pub fn validate(&self) -> Vec<SettingsError> {
        let mut errors = Vec::new();
        let mut check = |ok: bool, name: &'static str, value: String, allowed: &'static str| {
            if !ok {
                errors.push(SettingsError { name, value, allowed });
            }
        };
        let length = |v: f32| (1e-15..=1e15).contains(&v);
        let optional = |v: &Auto<f32>| v.value().is_none_or(|&v| length(v));
        let color = |c: [f32; 3]| c.iter().all(|v| v.is_finite() && *v >= 0.0);
        let direction = |v: [f32; 3]| v.iter().all(|v| v.is_finite()) && v.iter().any(|&v| v != 0.0);
        // Far enough from the ends of single precision that squares of lengths stay numbers.
        const LENGTH: &str = "1e-15 to 1e15";
        const OPTIONAL: &str = "auto or 1e-15 to 1e15";
        const COLOR: &str = "three finite numbers, none negative";
        const POINT: &str = "auto or three finite numbers";
        const DIRECTION: &str = "auto or three finite numbers, not all 0";

        let size = self.size;
        let pixels = u64::from(size.width) * u64::from(size.height);
        let sides_fit = (1..=MAX_SIDE).contains(&size.width) && (1..=MAX_SIDE).contains(&size.height);
        let allowed = "1 to 32768 pixels a side, at most 268435456 in all";
        check(sides_fit && pixels <= MAX_PIXELS, "size", size.to_string(), allowed);
        check(
            (-64.0..=64.0).contains(&self.exposure),
            "exposure",
            self.exposure.to_string(),
            "-64 to 64 stops",
        );
        let ordered = self.range.value().is_none_or(|range| {
            let [low, high] = range.0;
            low.is_finite() && high.is_finite() && low < high
        });
        check(ordered, "range", self.range.to_string(), "auto or two finite numbers, the smaller first");

        let time = self.time.unwrap_or(0.0);
        check((0.0..=MAX_TIME).contains(&time), "time", self.time.to_string(), "auto or 0 to 10000 seconds");
        check((1..=MAX_SPP).contains(&self.spp), "spp", self.spp.to_string(), "1 to 65536");
        let paper_fits = self.thin != Thin::Paper || self.spp <= MAX_PAPER_SPP;
        check(
            paper_fits,
            "spp",
            self.spp.to_string(),
            "1 to 256 with thin paper, which joins all pairs of missed rays",
        );
        check(optional(&self.radius), "radius", self.radius.to_string(), OPTIONAL);
        check(length(self.exponent), "exponent", self.exponent.to_string(), LENGTH);
        check(optional(&self.sigma), "sigma", self.sigma.to_string(), OPTIONAL);
        check(optional(&self.near_limit), "near-limit", self.near_limit.to_string(), OPTIONAL);
        for (name, value) in [("ambient", &self.ambient), ("background", &self.background)] {
            check(value.value().is_none_or(|c| color(c.0)), name, value.to_string(), COLOR);
        }

        let tolerances = [
            ("filter-plane", self.filter_plane),
            ("filter-absolute", self.filter_absolute),
            ("filter-relative", self.filter_relative),
        ];
        for (name, value) in tolerances {
            check(length(value), name, value.to_string(), LENGTH);
        }
        let cos_normal = self.filter_cos_normal;
        check((-1.0..=1.0).contains(&cos_normal), "filter-cos-normal", cos_normal.to_string(), "-1 to 1");

        check(color(self.sun_color.0), "sun-color", self.sun_color.to_string(), COLOR);
        let strength = self.sun_strength.value().is_none_or(|v| v.is_finite() && *v >= 0.0);
        check(
            strength,
            "sun-strength",
            self.sun_strength.to_string(),
            "auto or a finite number, not negative",
        );
        for (name, value) in [("sun-direction", &self.sun_direction), ("camera-up", &self.camera_up)] {
            check(value.value().is_none_or(|v| direction(v.0)), name, value.to_string(), DIRECTION);
        }
        for (name, value) in
            [("camera-position", &self.camera_position), ("camera-target", &self.camera_target)]
        {
            let finite = value.value().is_none_or(|v| v.0.iter().all(|v| v.is_finite()));
            check(finite, name, value.to_string(), POINT);
        }
        let fov = self.vertical_fov.value().is_none_or(|v| *v > 0.0 && *v < 180.0);
        check(fov, "vertical-fov", self.vertical_fov.to_string(), "auto or degrees above 0 and below 180");
        let height = &self.orthographic_height;
        check(optional(height), "orthographic-height", height.to_string(), OPTIONAL);
        let both = self.vertical_fov.value().is_some() && height.value().is_some();
        check(!both, "orthographic-height", height.to_string(), "auto where vertical-fov is set");
        errors
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Preset, Range, Rgb, Size, Triple};
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
            "camera-up",
            "camera-position",
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
