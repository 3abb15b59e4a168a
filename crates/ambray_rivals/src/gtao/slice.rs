//! A slice: the half-discs to both sides of the viewing ray, in which horizons are angles from the viewer.

use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3};

/// The plane through the viewing ray that meets the picture in `direction` (Jimenez et al. 2016, Algorithm 1, lines 5 to 15).
///
/// Angles in it are measured from the direction to the viewer, positive towards `direction`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slice {
    /// Unit vector in the picture, pixels to the right and down.
    pub(crate) direction: Vec2,
    /// Angle γ of the normal projected into the plane, in [−π/2, π/2].
    pub(crate) normal_angle: f32,
    /// Length ‖n‖ of that projection.
    pub(crate) normal_length: f32,
}

impl Slice {
    /// The slice at angle `azimuth` of the picture for the unit vectors `viewer` and `normal`, view space.
    pub(crate) fn new(azimuth: f32, viewer: Vec3, normal: Vec3) -> Self {
        let (sin, cos) = libm::sincosf(azimuth);
        let across = Vec3::new(cos, sin, 0.0);
        let tangent = (across - across.dot(viewer) * viewer).normalize();
        let (along_tangent, along_viewer) = (normal.dot(tangent), normal.dot(viewer));
        Self {
            direction: Vec2::new(cos, -sin),
            // A normal that points away from the viewer is taken as perpendicular.
            normal_angle: libm::atan2f(along_tangent, along_viewer).clamp(-FRAC_PI_2, FRAC_PI_2),
            normal_length: Vec2::new(along_tangent, along_viewer).length(),
        }
    }
}

/// Cosine-weighted share of a slice that is open between `horizons`, on either side of the viewer, for the projected normal
/// at angle γ: the inner integral ∫ max(cos(θ − γ), 0) |sin θ| dθ in closed form (Jimenez et al. 2016, §4.1 and Algorithm 1,
/// line 27).
pub(crate) fn visible_arc(horizons: [f32; 2], normal_angle: f32) -> f32 {
    let (sin, cos) = libm::sincosf(normal_angle);
    let arc = |h: f32| 0.25 * (cos + 2.0 * h * sin - libm::cosf(2.0 * h - normal_angle));
    arc(horizons[0]) + arc(horizons[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The inner integral by the midpoint rule, in double precision.
    fn quadrature([from, to]: [f64; 2], normal_angle: f64) -> f64 {
        const STEPS: u32 = 100_000;
        let width = (to - from) / f64::from(STEPS);
        let integrand = |theta: f64| (theta - normal_angle).cos().max(0.0) * theta.sin().abs();
        (0..STEPS).map(|i| integrand(from + (f64::from(i) + 0.5) * width)).sum::<f64>() * width
    }

    #[test]
    fn the_closed_form_is_the_integral() {
        for normal_angle in [-1.4, -0.6, 0.0, 0.3, 1.1] {
            for closed in [(0.0, 0.0), (0.2, 0.0), (0.0, 0.5), (0.4, 0.3), (1.3, 1.5)] {
                let half_pi = std::f64::consts::FRAC_PI_2;
                // Horizons have the viewer between them, and are within the hemisphere of the normal.
                let from = (normal_angle - half_pi + closed.0).min(0.0);
                let to = (normal_angle + half_pi - closed.1).max(0.0);
                let expected = quadrature([from, to], normal_angle);
                let arc = visible_arc([from as f32, to as f32], normal_angle as f32);
                assert!(
                    (f64::from(arc) - expected).abs() < 1e-6,
                    "{arc} for {expected} at {normal_angle}, {closed:?}"
                );
            }
        }
    }

    #[test]
    fn slices_of_an_open_hemisphere_add_up_to_one() {
        // (1/π) ∫₀^π ‖n‖ â(φ) dφ is 1 for every normal that the viewer sees: the estimator is exact where nothing blocks.
        // So it is in the middle of the picture. Elsewhere slices that are even in the picture are not even around the viewing
        // ray, and XeGTAO's estimator is off by up to some hundredths.
        let viewer = Vec3::NEG_Z;
        for normal in [viewer, Vec3::new(1.0, 0.4, -0.5).normalize(), Vec3::new(0.0, 1.0, -0.1).normalize()] {
            const SLICES: u32 = 4096;
            let mean = (0..SLICES)
                .map(|i| {
                    let azimuth = (i as f32 + 0.5) * std::f32::consts::PI / SLICES as f32;
                    let slice = Slice::new(azimuth, viewer, normal);
                    let horizons = [slice.normal_angle - FRAC_PI_2, slice.normal_angle + FRAC_PI_2];
                    slice.normal_length * visible_arc(horizons, slice.normal_angle)
                })
                .sum::<f32>()
                / SLICES as f32;
            assert!((mean - 1.0).abs() < 2e-3, "{mean} for {normal}");
        }
    }

    #[test]
    fn the_angle_of_the_normal_has_the_side_of_the_slice() {
        let tilted = Vec3::new(0.6, 0.0, -0.8);
        let towards = Slice::new(0.0, Vec3::NEG_Z, tilted);
        assert!((towards.normal_angle - 0.6_f32.asin()).abs() < 1e-6);
        assert!((towards.normal_length - 1.0).abs() < 1e-6);
        let across = Slice::new(FRAC_PI_2, Vec3::NEG_Z, tilted);
        assert!(across.normal_angle.abs() < 1e-6 && (across.normal_length - 0.8).abs() < 1e-6);
        // Up in view space is towards smaller rows.
        assert!(across.direction.abs_diff_eq(Vec2::NEG_Y, 1e-6));
    }
}
