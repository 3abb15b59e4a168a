//! Cameras, lights, bases and ray origins.

use ambray_core::{
    basis::Basis,
    camera::{Camera, Projection},
    light::{Cone, Light},
    offset::RayOffset,
    settings::Settings,
    view::View,
};
use ambray_scene::Scene;
use ambray_vulkan::layout::{FAR, FUNCTION_BASIS, FUNCTION_CAMERA, FUNCTION_LIGHT, FUNCTION_OFFSET};
use glam::Vec3;

use crate::{
    calls::{Call, Device, view},
    compare::Comparison,
    random::Random,
};

/// Sums of products of numbers up to 1: a few units of the last place of 1.
#[test]
fn bases_of_normals() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(7);
    let mut normals = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
    normals.push(Vec3::new(1e-4, -1e-4, -1.0));
    normals.push(Vec3::new(1.0, 0.0, -0.0));
    normals.extend((0..10_000).map(|_| random.direction()));
    let calls: Vec<_> = normals.iter().map(|&n| Call::default().vector(n)).collect();
    let mut axes = Comparison::new("bases");
    for (&n, values) in normals.iter().zip(functions.call(FUNCTION_BASIS, &view(), &calls)) {
        let expected = Basis::from_normal(n);
        axes.add_vector(expected.tangent, values.vector(0), 1.0, || format!("tangent of {n}"));
        axes.add_vector(expected.bitangent, values.vector(3), 1.0, || format!("bitangent of {n}"));
    }
    axes.finish(4.0);
}

/// Equal in all bits on every device: one unit decides whether a ray meets the surface that it leaves.
#[test]
fn ray_origins() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(8);
    let arguments: Vec<_> = (0..20_000)
        .map(|i| {
            let mut p = Vec3::ZERO;
            for axis in 0..3 {
                p[axis] = match random.below(8) {
                    0 => 0.0,
                    // Around the bound of the fixed distance.
                    1 => random.between(0.9, 1.1) / 32.0,
                    2 => random.between(-1.1, -0.9) / 32.0,
                    _ => random.signed(-8.0, 8.0),
                };
            }
            // None, as large as the point, and more than that.
            let reach = [0.0, p.abs().max_element(), random.magnitude(-6.0, 8.0)][i % 3];
            let offset = RayOffset::for_extent(if i % 4 == 0 { random.magnitude(-6.0, 1.0) } else { 1.0 });
            (p, random.direction(), reach, offset)
        })
        .collect();
    let calls: Vec<_> = (arguments.iter())
        .map(|&(p, n, reach, offset)| {
            let [near_zero, distance] = offset.constants();
            Call::default().vector(p).vector(n).number(reach).number(near_zero).number(distance)
        })
        .collect();
    for (&(p, n, reach, offset), values) in
        arguments.iter().zip(functions.call(FUNCTION_OFFSET, &view(), &calls))
    {
        let expected = offset.apply(p, n, reach);
        assert_eq!(values.vector(0), expected, "{p:?} {n:?} {reach:e} {offset:?}");
    }
}

fn lights(random: &mut Random) -> Vec<Light> {
    (0..96)
        .map(|i| {
            let strength = random.vector(0.0, 1.0) * random.magnitude(-2.0, 4.0);
            if i % 4 == 0 {
                return Light::Directional { to_light: random.direction(), irradiance: strength };
            }
            let cos_outer = random.between(-0.2, 0.99);
            let cos_inner = if i % 5 == 0 { cos_outer } else { random.between(cos_outer, 1.0) };
            let cone = (i % 4 > 1).then(|| Cone { axis: random.direction(), cos_inner, cos_outer });
            let range = if i % 3 == 0 { f32::INFINITY } else { random.magnitude(-1.0, 2.0) };
            Light::Point { position: random.vector(-10.0, 10.0), intensity: strength, range, cone }
        })
        .collect()
}

/// Lengths and products of vectors are sums of three terms: some units of the last place of what is summed. The slope of
/// narrow cones magnifies them.
#[test]
fn arriving_light() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(9);
    let view = View { lights: lights(&mut random), ..view() };
    let arguments: Vec<_> = (0..20_000)
        .map(|_| {
            let light = random.below(view.lights.len());
            let point = match view.lights[light] {
                Light::Point { position, .. } if random.word() & 15 == 0 => position,
                Light::Point { position, range, .. } if range.is_finite() && random.word() & 1 == 0 => {
                    position + random.direction() * (range * random.between(0.0, 1.1))
                }
                // Within the cone.
                Light::Point { position, cone: Some(cone), .. } if random.word() & 1 == 0 => {
                    position + (cone.axis + random.vector(-0.5, 0.5)) * random.magnitude(-2.0, 2.0)
                }
                _ => random.vector(-20.0, 20.0),
            };
            (light, point)
        })
        .collect();
    let calls: Vec<_> =
        arguments.iter().map(|&(light, point)| Call::default().word(light as u32).vector(point)).collect();
    let (mut directions, mut distances) =
        (Comparison::new("directions to lights"), Comparison::new("distances"));
    let mut irradiances = Comparison::new("irradiances");
    let all = functions.call(FUNCTION_LIGHT, &view, &calls);
    for (&(light, point), values) in arguments.iter().zip(all) {
        let light = &view.lights[light];
        let expected = light.incident(point);
        let what = || format!("{light:?} from {point}");
        directions.add_vector(expected.to_light, values.vector(0), 1.0, what);
        let distance = expected.distance.min(FAR);
        distances.add(distance, values.number(3), distance, what);
        let scale = match *light {
            Light::Directional { irradiance, .. } => irradiance.max_element(),
            Light::Point { intensity, cone, .. } => {
                let slope = cone.map_or(1.0, |c| 1.0 + 1.0 / (c.cos_inner - c.cos_outer).max(0.001));
                slope * intensity.max_element() / (distance * distance).max(f32::MIN_POSITIVE)
            }
        };
        irradiances.add_vector(expected.irradiance, values.vector(4), scale, what);
    }
    directions.finish(4.0);
    distances.finish(4.0);
    irradiances.finish(16.0);
}

/// Rays, depths and the size of pixels: some units of the last place of the terms of their sums.
#[test]
fn cameras() {
    let Some(device) = Device::open(Scene::default()) else { return };
    let functions = device.functions(&Settings::default());
    let mut random = Random::new(10);
    let (mut origins, mut directions) =
        (Comparison::new("origins of rays"), Comparison::new("directions of rays"));
    let (mut depths, mut footprints) = (Comparison::new("depths"), Comparison::new("footprints"));
    for i in 0..24 {
        let projection = if i % 3 == 0 {
            Projection::Orthographic { height: random.magnitude(-2.0, 2.0) }
        } else {
            Projection::Perspective { vertical_fov: random.between(0.05, 2.8) }
        };
        let (width, height) = (1 + random.below(300) as u32, 1 + random.below(200) as u32);
        let eye = random.vector(-1.0, 1.0) * random.magnitude(-2.0, 3.0);
        let camera = Camera::new(eye, random.direction(), random.direction(), projection, width, height);
        let arguments: Vec<_> = (0..500)
            .map(|_| {
                let pixel = [random.below(width as usize) as u32, random.below(height as usize) as u32];
                (
                    pixel,
                    eye + random.vector(-1.0, 1.0) * random.magnitude(-2.0, 3.0),
                    random.magnitude(-3.0, 4.0),
                )
            })
            .collect();
        let calls: Vec<_> = (arguments.iter())
            .map(|&([x, y], point, depth)| Call::default().word(x).word(y).vector(point).number(depth))
            .collect();
        let all = functions.call(FUNCTION_CAMERA, &View { camera, ..view() }, &calls);
        for (&([x, y], point, depth), values) in arguments.iter().zip(all) {
            let ray = camera.primary_ray(x, y, 0);
            let what = || format!("{x}, {y} of {camera:?}");
            let extent = camera.half_height() * (1.0 + width as f32 / height as f32);
            origins.add_vector(ray.origin, values.vector(0), eye.abs().max_element() + extent, what);
            directions.add_vector(ray.direction, values.vector(3), 1.0, what);
            depths.add(camera.depth(point), values.number(6), (point - eye).length(), what);
            let footprint = camera.footprint(depth);
            footprints.add(footprint, values.number(7), footprint, what);
        }
    }
    origins.finish(4.0);
    directions.finish(4.0);
    depths.finish(4.0);
    footprints.finish(6.0);
}
