//! From settings to a view: the only place where `auto` gets its meaning.

use ambray_core::{
    camera::{Camera, Projection},
    light::Light,
    offset::RayOffset,
    openness::Openness,
    settings::{Auto, Falloff, NearRadiance, Rgb, Settings, Triple},
    view::View,
};
use ambray_scene::{
    Scene, SceneCamera,
    animation::{Clips, Moment},
};
use glam::Vec3;

use crate::{
    RenderError,
    framing::{self, Framing},
};

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

/// The word for all animations at once.
const ALL: &str = "all";

/// What of the scene's animations plays, and when; `None` is the scene at rest.
pub(crate) fn moment(settings: &Settings, scene: &Scene) -> Result<Option<Moment>, RenderError> {
    let (name, time) = (settings.animation.value(), settings.time.value());
    if name.is_none() && time.is_none() {
        return Ok(None);
    }
    let unknown = |known: String| RenderError::UnknownAnimation {
        name: name.cloned().unwrap_or_else(|| "0".to_owned()),
        known,
    };
    let rig = scene.rig.as_ref().ok_or_else(|| unknown("it has none".to_owned()))?;
    let clips = match name {
        None => Clips::One(0),
        Some(name) => match rig.clip(name) {
            Some(index) => Clips::One(index),
            None if name == ALL => Clips::All,
            None => {
                let names = rig.clips.iter().enumerate().map(|(i, clip)| format!("{i} ({})", clip.name));
                return Err(unknown(format!("it has {}", names.collect::<Vec<_>>().join(", "))));
            }
        },
    };
    let time = f64::from(time.copied().unwrap_or(0.0));
    Ok(Some(Moment { clips, time, repeat: settings.animation_loop }))
}

/// Whether the camera of `settings` depends on a look around in the scene.
pub(crate) fn needs_framing(settings: &Settings, scene: &Scene) -> bool {
    scene.cameras.is_empty() && settings.camera.value().is_none()
}

/// `bounds` are those of the scene as it was opened, and `framing` looks around in it: what is automatic does not follow
/// an animation.
pub(crate) fn view(
    settings: &Settings,
    scene: &Scene,
    bounds: (Vec3, Vec3),
    framing: &dyn Fn() -> Result<Framing, RenderError>,
) -> Result<View, RenderError> {
    let radius = settings.radius.value().copied().or(scene.radius).unwrap_or_else(|| framing::radius(bounds));
    let openness = openness(settings, radius);
    // All hits keep the weighted average equal to the sum per hit; the plain one ends at R (spec §3).
    let plain = settings.near_radiance == NearRadiance::AveragedPlain;
    let near_limit = if plain { radius } else { openness.reach() };
    let rgb = |color: &Auto<Rgb>| color.value().map(|&color| Vec3::from(color));
    let sky = rgb(&settings.ambient).or(scene.ambient);
    let (camera, camera_origin) = camera(settings, scene, framing)?;
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
    framing: &dyn Fn() -> Result<Framing, RenderError>,
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
            let (camera, how) = framing()?.camera(fov, width as f32 / height as f32);
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
