//! Lights that reach a point from one direction (spec §4).

use glam::Vec3;

/// A light of no extent. Colours are linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Parallel light, such as the sun.
    Directional {
        /// Unit vector from any point towards the light.
        to_light: Vec3,
        /// Irradiance E of a surface that faces the light.
        irradiance: Vec3,
    },
    /// Light from a point, in all directions or in a cone.
    Point {
        /// Position, world space.
        position: Vec3,
        /// Radiant intensity Φ: irradiance of a facing surface at distance r is Φ/r².
        intensity: Vec3,
        /// Distance at which the light has faded to zero; infinite for none.
        range: f32,
        /// Cone of a spot light.
        cone: Option<Cone>,
    },
}

/// Cone of a spot light, as in KHR_lights_punctual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Unit vector along which the light shines.
    pub axis: Vec3,
    /// Cosine of the angle at which the light begins to fade.
    pub cos_inner: f32,
    /// Cosine of the angle at which the light has faded to zero.
    pub cos_outer: f32,
}

/// Light arriving at a point: what a shadow ray needs, and what to add if it is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incident {
    /// Unit vector towards the light.
    pub to_light: Vec3,
    /// Distance to the light, infinite for directional ones.
    pub distance: f32,
    /// Irradiance E of a surface that faces the light.
    pub irradiance: Vec3,
}

impl Light {
    /// Light arriving at `point`, before visibility and the cosine of the surface.
    #[must_use]
    #[inline(always)]
    pub fn incident(&self, point: Vec3) -> Incident {
        match *self {
            Self::Directional { to_light, irradiance } => {
                Incident { to_light, distance: f32::INFINITY, irradiance }
            }
            Self::Point { position, intensity, range, cone } => {
                let offset = position - point;
                let distance = offset.length();
                let to_light = if distance > 0.0 { offset / distance } else { Vec3::ZERO };
                let cone_factor = cone.map_or(1.0, |cone| cone.factor(-to_light));
                let falloff =
                    if distance > 0.0 { range_window(distance, range) / (distance * distance) } else { 0.0 };
                Incident { to_light, distance, irradiance: intensity * (falloff * cone_factor) }
            }
        }
    }
}

impl Cone {
    /// Share of the intensity sent along the unit vector `direction` (KHR_lights_punctual, "Inner and Outer Cone Angles").
    #[inline(always)]
    fn factor(&self, direction: Vec3) -> f32 {
        let scale = 1.0 / (self.cos_inner - self.cos_outer).max(0.001);
        let x = ((self.axis.dot(direction) - self.cos_outer) * scale).clamp(0.0, 1.0);
        x * x
    }
}

/// Smooth window that brings a point light to zero at its range (KHR_lights_punctual, "Range Property").
#[inline(always)]
fn range_window(distance: f32, range: f32) -> f32 {
    let square = (distance / range) * (distance / range);
    if range.is_finite() { (1.0 - square * square).clamp(0.0, 1.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn point_light_falls_with_the_square() {
        let light = Light::Point {
            position: Vec3::Y * 2.0,
            intensity: Vec3::splat(8.0),
            range: f32::INFINITY,
            cone: None,
        };
        let incident = light.incident(Vec3::ZERO);
        assert_eq!(incident, Incident { to_light: Vec3::Y, distance: 2.0, irradiance: Vec3::splat(2.0) });
    }

    #[test]
    fn spot_light_fades_between_its_cones() {
        let cone = Cone { axis: Vec3::NEG_Y, cos_inner: 0.9, cos_outer: 0.5 };
        assert_eq!(cone.factor(Vec3::NEG_Y), 1.0);
        assert_eq!(cone.factor(Vec3::X), 0.0);
        let between = cone.factor(Vec3::new(0.714_142_9, -0.7, 0.0));
        assert!((between - 0.25).abs() < 1e-5, "{between}");
    }

    #[test]
    fn range_ends_the_light_smoothly() {
        assert_eq!(range_window(3.0, 3.0), 0.0);
        assert_eq!(range_window(3.0, f32::INFINITY), 1.0);
    }
}
