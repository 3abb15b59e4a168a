//! Ranges that sliders offer: narrower than what is allowed, wide enough for every sensible picture.

use std::ops::RangeInclusive;

/// What a slider covers; other values can be typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// Evenly from one end to the other.
    Linear(f32, f32),
    /// By factors.
    Log(f32, f32),
    /// By factors, in shares of the scene's diagonal.
    OfScene(f32, f32),
    /// By factors, divided by the scene's diagonal.
    PerScene(f32, f32),
    /// Evenly over the length of the animation.
    OfAnimation,
}

/// What is known of the scene that scales depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    /// Diagonal of the box around it, scene units.
    pub(crate) diagonal: f32,
    /// Length of the animation, seconds.
    pub(crate) duration: f32,
}

impl Default for Extent {
    fn default() -> Self {
        Self { diagonal: 10.0, duration: 10.0 }
    }
}

/// The scale of the setting `name`; settings without one are dragged, not slid.
#[must_use]
pub(crate) fn of(name: &str) -> Option<Scale> {
    Some(match name {
        "exposure" => Scale::Linear(-6.0, 6.0),
        "spp" => Scale::Log(1.0, 1024.0),
        "radius" | "near-limit" => Scale::OfScene(1e-3, 1.0),
        "exponent" => Scale::Log(0.1, 8.0),
        "sigma" => Scale::PerScene(3.0, 3e3),
        "filter-plane" => Scale::Log(0.05, 20.0),
        "filter-absolute" => Scale::OfScene(1e-5, 0.1),
        "filter-relative" => Scale::Log(1e-4, 1.0),
        "filter-cos-normal" => Scale::Linear(-1.0, 1.0),
        "time" => Scale::OfAnimation,
        "sun-strength" => Scale::Linear(0.0, 10.0),
        "vertical-fov" => Scale::Linear(5.0, 120.0),
        "orthographic-height" => Scale::OfScene(1e-2, 2.0),
        _ => return None,
    })
}

impl Scale {
    /// The values at the ends.
    #[must_use]
    pub(crate) fn range(self, extent: Extent) -> RangeInclusive<f32> {
        let diagonal = extent.diagonal.max(f32::MIN_POSITIVE);
        match self {
            Self::Linear(low, high) | Self::Log(low, high) => low..=high,
            Self::OfScene(low, high) => low * diagonal..=high * diagonal,
            Self::PerScene(low, high) => low / diagonal..=high / diagonal,
            Self::OfAnimation => 0.0..=extent.duration.max(0.1),
        }
    }

    /// Whether steps are factors.
    #[must_use]
    pub(crate) const fn is_logarithmic(self) -> bool {
        matches!(self, Self::Log(..) | Self::OfScene(..) | Self::PerScene(..))
    }
}

/// What stands behind a value: its unit.
#[must_use]
pub(crate) fn unit(value_name: &str) -> &'static str {
    match value_name {
        "DEGREES" => "°",
        "STOPS" => " EV",
        "SECONDS" => " s",
        "FOOTPRINTS" => " px",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use ambray::settings::{Kind, Settings};

    use super::*;

    #[test]
    fn both_ends_of_every_scale_are_allowed_and_the_default_lies_between() {
        let extent = Extent::default();
        for field in Settings::fields() {
            let Some(scale) = of(field.name) else { continue };
            let range = scale.range(extent);
            assert!(range.start() < range.end(), "{}", field.name);
            for end in [range.start(), range.end()] {
                let mut settings = Settings::default();
                settings.set(field.name, &end.to_string()).unwrap();
                assert_eq!(settings.validate(), [], "{}", field.name);
            }
            if let (Kind::Number | Kind::Whole, Some(text)) =
                (field.kind, Settings::default().get(field.name))
            {
                assert!(range.contains(&text.parse().unwrap()), "{}", field.name);
            }
        }
    }

    #[test]
    fn scales_name_settings_that_exist() {
        let scaled = Settings::fields().iter().filter(|field| of(field.name).is_some()).count();
        assert_eq!(scaled, 14);
    }
}
