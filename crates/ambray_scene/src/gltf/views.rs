//! Cameras and lights, placed by their nodes.

use ambray_core::camera::Projection;
use ambray_core::light::{Cone, Light};
use glam::{DAffine3, Vec3};

use crate::SceneCamera;
use crate::animation::{place_camera, place_light};
use crate::error::{Fault, Outcome, quoted};

use super::json;

/// The camera at `world`; `None` where that leaves it without a direction.
pub(super) fn camera(
    json: &json::Camera,
    node_name: Option<&str>,
    world: DAffine3,
    at: &str,
) -> Outcome<Option<SceneCamera>> {
    let projection = projection(json, at)?;
    let name = json.name.as_deref().or(node_name).unwrap_or_default().to_owned();
    let mut camera =
        SceneCamera { name, position: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, projection };
    Ok(place_camera(&mut camera, world).then_some(camera))
}

/// Checks and converts the camera's own numbers.
pub(super) fn projection(json: &json::Camera, at: &str) -> Outcome<Projection> {
    match (json.kind.as_str(), &json.perspective, &json.orthographic) {
        ("perspective", Some(perspective), _) => {
            let vertical_fov = perspective.yfov;
            if !(vertical_fov > 0.0 && vertical_fov < std::f32::consts::PI) {
                let reason = format!("{vertical_fov} is not between 0 and π");
                return Err(Fault::invalid(format!("{at}.perspective.yfov"), reason));
            }
            Ok(Projection::Perspective { vertical_fov })
        }
        ("orthographic", _, Some(orthographic)) => {
            let (x, y) = (orthographic.xmag, orthographic.ymag);
            // Negative magnifications are discouraged, not forbidden; they would mirror the picture.
            let height = 2.0 * y.abs();
            if x == 0.0 || y == 0.0 || !x.is_finite() || !height.is_finite() {
                return Err(Fault::invalid(format!("{at}.orthographic"), format!("magnification {x} × {y}")));
            }
            Ok(Projection::Orthographic { height })
        }
        ("perspective" | "orthographic", ..) => {
            Err(Fault::invalid(at, format!("camera of type {} without its numbers", quoted(&json.kind))))
        }
        (other, ..) => Err(Fault::invalid(format!("{at}.type"), format!("no such type: {}", quoted(other)))),
    }
}

/// The light at `world`; `None` where that leaves it without a direction.
pub(super) fn light(json: &json::Light, world: DAffine3, at: &str) -> Outcome<Option<Light>> {
    let power = Vec3::from(json.color.unwrap_or([1.0; 3])) * json.intensity.unwrap_or(1.0);
    if !power.is_finite() || power.min_element() < 0.0 {
        return Err(Fault::invalid(at, "colour times intensity is negative or beyond the range of numbers"));
    }
    let mut light = match json.kind.as_str() {
        "directional" => Light::Directional { to_light: Vec3::Z, irradiance: power },
        "point" => point(json, power, None, at)?,
        "spot" => {
            let (inner, outer) = cone_angles(json, at)?;
            let cone = Cone { axis: Vec3::NEG_Z, cos_inner: libm::cosf(inner), cos_outer: libm::cosf(outer) };
            point(json, power, Some(cone), at)?
        }
        other => {
            return Err(Fault::invalid(format!("{at}.type"), format!("no such type: {}", quoted(other))));
        }
    };
    Ok(place_light(&mut light, world).then_some(light))
}

/// A point light or spot light at the origin.
fn point(json: &json::Light, intensity: Vec3, cone: Option<Cone>, at: &str) -> Outcome<Light> {
    let range = json.range.unwrap_or(f32::INFINITY);
    if range.is_nan() || range <= 0.0 {
        return Err(Fault::invalid(format!("{at}.range"), format!("{range} is not positive")));
    }
    Ok(Light::Point { position: Vec3::ZERO, intensity, range, cone })
}

/// Inner and outer half-angle of a spot light in radians.
fn cone_angles(json: &json::Light, at: &str) -> Outcome<(f32, f32)> {
    let Some(spot) = &json.spot else {
        return Err(Fault::invalid(format!("{at}.spot"), "spot light without a cone"));
    };
    let inner = spot.inner_cone_angle.unwrap_or(0.0);
    let outer = spot.outer_cone_angle.unwrap_or(std::f32::consts::FRAC_PI_4);
    // The single-precision π/2 lies above the true one; files hold either.
    if !(0.0 <= inner && inner < outer && outer <= std::f32::consts::FRAC_PI_2 + 1e-6) {
        let reason = format!("angles {inner} and {outer} are not 0 ≤ inner < outer ≤ π/2");
        return Err(Fault::invalid(format!("{at}.spot"), reason));
    }
    Ok((inner, outer))
}
