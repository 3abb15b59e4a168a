//! From settings to a view: the only place where `auto` gets its meaning.

use ambray_core::{
    camera::{Camera, Projection},
    light::Light,
    offset::RayOffset,
    openness::Openness,
    settings::{Auto, Falloff, NearRadiance, Rgb, Settings, Triple},
    trace::Trace,
    view::View,
};
use ambray_scene::{Scene, SceneCamera};
use glam::Vec3;

use crate::{RenderError, framing};

/// Irradiance of the additional sun where only its direction is set.
const SUN_STRENGTH: f32 = 3.0;
/// Direction towards the additional sun where only its strength is set.
const SUN_DIRECTION: Vec3 = Vec3::new(0.4, 1.0, 0.3);
/// σ·R of the exponential falloffs where no rate is set: μ(R) = 0.95 (spec §13).
const SIGMA_RADIUS: f32 = 3.0;
/// Background where nobody chose an ambient radiance: the white of the default would hide white objects.
const BACKGROUND: Vec3 = Vec3::splat(0.2);
/// Vertical angle of view where no camera says otherwise, degrees.
const VERTICAL_FOV: f32 = 50.0;

pub(crate) fn view(
    settings: &Settings,
    scene: &Scene,
    bounds: Option<(Vec3, Vec3)>,
    trace: &impl Trace,
) -> Result<View, RenderError> {
    // An empty scene is looked at as if a box of two units were there.
    let bounds = bounds.unwrap_or((Vec3::NEG_ONE, Vec3::ONE));
    let radius = settings.radius.value().copied().or(scene.radius).unwrap_or_else(|| framing::radius(bounds));
    let openness = openness(settings, radius);
    // All hits keep the weighted average equal to the sum per hit; the plain one ends at R (spec §3).
    let plain = settings.near_radiance == NearRadiance::AveragedPlain;
    let near_limit = if plain { radius } else { openness.reach() };
    let rgb = |color: &Auto<Rgb>| color.value().map(|&color| Vec3::from(color));
    let sky = rgb(&settings.ambient).or(scene.ambient);
    let (camera, camera_origin) = camera(settings, scene, bounds, trace)?;
    Ok(View {
        camera,
        camera_origin,
        radius,
        openness,
        near_limit: settings.near_limit.unwrap_or(near_limit),
        ambient: sky.unwrap_or(Vec3::ONE),
        background: rgb(&settings.background).or(sky).unwrap_or(BACKGROUND),
        offset: RayOffset::for_extent(bounds.0.abs().max(bounds.1.abs()).max_element()),
        lights: lights(settings, scene),
    })
}

fn openness(settings: &Settings, radius: f32) -> Openness {
    let sigma = settings.sigma.unwrap_or(SIGMA_RADIUS / radius);
    match settings.falloff {
        Falloff::Power => Openness::Power { radius, exponent: settings.exponent },
        Falloff::Exponential => Openness::Exponential { sigma },
        Falloff::ExponentialTruncated => Openness::ExponentialTruncated { radius, sigma },
        Falloff::Step => Openness::Step { radius },
    }
}

fn lights(settings: &Settings, scene: &Scene) -> Vec<Light> {
    let mut lights = if settings.lights { scene.lights.clone() } else { Vec::new() };
    let direction = settings.sun_direction.value().map(|&direction| Vec3::from(direction));
    let strength = settings.sun_strength.unwrap_or(if direction.is_some() { SUN_STRENGTH } else { 0.0 });
    if strength > 0.0 {
        let to_light = unit(direction.unwrap_or(SUN_DIRECTION));
        lights.push(Light::Directional { to_light, irradiance: Vec3::from(settings.sun_color) * strength });
    }
    lights
}

/// Unit vector along `v`, which is finite and not zero but may be as small or large as numbers are.
fn unit(v: Vec3) -> Vec3 {
    (v / v.abs().max_element()).normalize()
}

/// The camera that the settings ask for, and where it came from.
///
/// A position or a target alone changes the camera of the file; without any camera the scene is framed.
fn camera(
    settings: &Settings,
    scene: &Scene,
    bounds: (Vec3, Vec3),
    trace: &impl Trace,
) -> Result<(Camera, String), RenderError> {
    let (width, height) = (settings.size.width, settings.size.height);
    let vec3 = |value: &Auto<Triple>| value.value().map(|&value| Vec3::from(value));
    let (position, target) = (vec3(&settings.camera_position), vec3(&settings.camera_target));
    let (base, mut origin) = match chosen_camera(&settings.camera, scene)? {
        Some((number, camera)) => {
            let name = if camera.name.is_empty() { number.to_string() } else { camera.name.clone() };
            (camera.clone(), format!("camera {name} of the scene"))
        }
        None => {
            let fov = settings.vertical_fov.unwrap_or(VERTICAL_FOV).to_radians();
            let (camera, how) = framing::camera(scene, bounds, trace, fov, width as f32 / height as f32);
            (camera, how.to_owned())
        }
    };
    match (position.is_some(), target.is_some()) {
        (true, true) => origin = "given".to_owned(),
        (true, false) => origin += ", moved",
        (false, true) => origin += ", turned",
        (false, false) => {}
    }
    let eye = position.unwrap_or(base.position);
    let forward = match target {
        Some(target) => (target - eye).try_normalize().ok_or_else(|| {
            RenderError::Camera("camera-target is the position of the camera: they must differ".to_owned())
        })?,
        None => base.forward,
    };
    let up = match vec3(&settings.camera_up) {
        Some(up) => unit(up),
        None if target.is_some() => Vec3::Y,
        None => base.up,
    };
    let projection = match (settings.orthographic_height.value(), settings.vertical_fov.value()) {
        (Some(&height), _) => Projection::Orthographic { height },
        (None, Some(fov)) => Projection::Perspective { vertical_fov: fov.to_radians() },
        (None, None) => base.projection,
    };
    Ok((Camera::new(eye, forward, up, projection, width, height), origin))
}

/// The camera of the file with the given name or number; the first one for `auto`.
fn chosen_camera<'a>(
    choice: &Auto<String>,
    scene: &'a Scene,
) -> Result<Option<(usize, &'a SceneCamera)>, RenderError> {
    let mut cameras = scene.cameras.iter().enumerate();
    let Some(name) = choice.value() else { return Ok(cameras.next()) };
    let by_name = cameras.clone().find(|(_, camera)| camera.name == *name);
    let by_number = || cameras.nth(name.parse().ok()?);
    by_name.or_else(by_number).map(Some).ok_or_else(|| RenderError::UnknownCamera {
        name: name.clone(),
        known: match scene.cameras.as_slice() {
            [] => "it has none".to_owned(),
            cameras => {
                let names = cameras.iter().enumerate().map(|(i, camera)| format!("{i} ({})", camera.name));
                format!("it has {}", names.collect::<Vec<_>>().join(", "))
            }
        },
    })
}
