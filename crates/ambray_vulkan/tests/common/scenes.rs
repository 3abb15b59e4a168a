//! Small scenes, and views of them.
#![allow(dead_code, unreachable_pub, reason = "each test file uses its own part of it")]

use ambray_core::{
    camera::{Camera, Projection},
    frame::Frame,
    light::Light,
    offset::RayOffset,
    openness::Openness,
    settings::{Falloff, Settings},
    shape::Shape,
    view::View,
};
use ambray_scene::{AlphaMode, Instance, Material, Mesh, Scene, ShapeInstance};
use glam::{Affine3A, Vec3, Vec4};

/// A floor, walls of `walls` quads that let some rays through, and a sphere.
pub fn room(walls: u32) -> Scene {
    let quad = |material: u32| Mesh {
        positions: vec![
            Vec3::new(-1.0, 0.0, -1.0),
            Vec3::new(1.0, 0.0, -1.0),
            Vec3::new(1.0, 0.0, 1.0),
            Vec3::new(-1.0, 0.0, 1.0),
        ],
        triangles: vec![[0, 2, 1], [0, 3, 2]],
        material,
        ..Mesh::default()
    };
    let leafy = Material {
        alpha_mode: AlphaMode::Blend,
        base_color: Vec4::new(0.2, 0.6, 0.1, 0.7),
        ..Material::default()
    };
    let place =
        |mesh: u32, world_from_object: Affine3A| Instance { mesh, world_from_object, ..Instance::default() };
    let mut instances = vec![place(0, Affine3A::from_scale(Vec3::splat(3.0)))];
    instances.extend((0..walls).map(|i| {
        let turn = Affine3A::from_rotation_z(1.2 + 0.3 * i as f32);
        place(1, Affine3A::from_translation(Vec3::new(-0.5, 0.6, -0.1 * i as f32)) * turn)
    }));
    Scene {
        meshes: vec![quad(0).into(), quad(1).into()],
        instances,
        shapes: vec![Shape::Sphere { radius: 0.4 }],
        shape_instances: vec![ShapeInstance {
            world_from_object: Affine3A::from_translation(Vec3::new(0.5, 0.4, 0.2)),
            ..ShapeInstance::default()
        }],
        materials: vec![Material::default(), leafy],
        ..Scene::default()
    }
}

/// The view of a [`room`], or of another scene around (0, ½, 0).
pub fn view(settings: &Settings, width: u32, height: u32) -> View {
    let radius = 1.0;
    let sigma = 3.0;
    let projection = Projection::Perspective { vertical_fov: 0.9 };
    let forward = Vec3::new(0.0, -0.35, -1.0).normalize();
    View {
        camera: Camera::new(Vec3::new(0.0, 1.2, 2.6), forward, Vec3::Y, projection, width, height),
        camera_origin: String::new(),
        radius,
        openness: match settings.falloff {
            Falloff::Power => Openness::Power { radius, exponent: 1.0 },
            Falloff::Exponential => Openness::Exponential { sigma },
            Falloff::ExponentialTruncated => Openness::ExponentialTruncated { radius, sigma },
            Falloff::Step => Openness::Step { radius },
        },
        near_limit: radius,
        ambient: Vec3::new(0.6, 0.8, 1.0),
        background: Vec3::new(0.1, 0.2, 0.3),
        offset: RayOffset::UNIT,
        lights: vec![
            Light::Directional {
                to_light: Vec3::new(0.3, 0.9, 0.3).normalize(),
                irradiance: Vec3::splat(2.0),
            },
            Light::Point {
                position: Vec3::new(-1.0, 2.0, 1.0),
                intensity: Vec3::ONE,
                range: f32::INFINITY,
                cone: None,
            },
        ],
    }
}

/// Fails unless both frames are equal in all bits.
#[track_caller]
pub fn assert_same(a: &Frame, b: &Frame, what: &str) {
    assert_eq!((a.width, a.height), (b.width, b.height), "{what}");
    let first = |equal: &dyn Fn(usize) -> bool| (0..a.gbuffer.len()).find(|&i| !equal(i));
    let check = |plane: &str, equal: &dyn Fn(usize) -> bool| {
        assert_eq!(first(equal), None, "{what}: the {plane} of this pixel");
    };
    check("surface", &|i| a.gbuffer[i] == b.gbuffer[i]);
    check("openness", &|i| a.ambient_raw[i] == b.ambient_raw[i]);
    check("filtered openness", &|i| a.ambient[i] == b.ambient[i]);
    check("bent normal", &|i| a.bent[i] == b.bent[i]);
    check("picture", &|i| a.beauty[i] == b.beauty[i]);
    assert_eq!(a.stats.rays, b.stats.rays, "{what}");
}
