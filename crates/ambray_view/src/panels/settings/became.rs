//! What `auto` became: the values that the last picture was made with.

use ambray::{
    View,
    camera::Projection,
    settings::{Rgb, Triple},
};
use glam::Vec3;

use crate::engine::{Opened, Rendered};

/// The value that the setting `name` has in the picture, spelled as a setting; `None` where a picture has none.
#[must_use]
pub(crate) fn value(name: &str, rendered: Option<&Rendered>, opened: Option<&Opened>) -> Option<String> {
    match name {
        "animation" => return Some(opened?.animations.first()?.name.clone()),
        "camera" => return Some(opened?.cameras.first()?.name.clone()),
        "time" => return Some("0".to_owned()),
        _ => {}
    }
    let rendered = rendered?;
    let view = &rendered.view;
    let number = |v: f32| v.is_finite().then(|| v.to_string());
    let point = |v: Vec3| Some(Triple::from(v).to_string());
    let color = |v: Vec3| Some(Rgb(v.to_array()).to_string());
    match name {
        "radius" => number(view.radius),
        "sigma" => number(3.0 / view.radius),
        "near-limit" => number(view.near_limit),
        "ambient" => color(view.ambient),
        "background" => color(view.background),
        "camera-position" => point(view.camera.position()),
        "camera-target" => point(target(view, opened)),
        "camera-up" => point(view.camera.up()),
        "vertical-fov" => match view.camera.projection() {
            Projection::Perspective { vertical_fov } => number(vertical_fov.to_degrees()),
            Projection::Orthographic { .. } => None,
        },
        "orthographic-height" => match view.camera.projection() {
            Projection::Perspective { .. } => None,
            Projection::Orthographic { height } => number(height),
        },
        "sun-strength" => Some("0".to_owned()),
        "range" => {
            let statistics = rendered.statistics.as_ref()?;
            (statistics.low < statistics.high).then(|| format!("{},{}", statistics.low, statistics.high))
        }
        _ => None,
    }
}

/// A point in the middle of the picture, as far away as the middle of the scene.
#[must_use]
pub(crate) fn target(view: &View, opened: Option<&Opened>) -> Vec3 {
    let camera = &view.camera;
    let (low, high) = opened.map_or((Vec3::ZERO, Vec3::ONE), |opened| opened.bounds);
    let depth = camera.depth(0.5 * (low + high));
    let least = 0.05 * (high - low).length();
    camera.position() + depth.max(least).max(1e-3) * camera.forward()
}
