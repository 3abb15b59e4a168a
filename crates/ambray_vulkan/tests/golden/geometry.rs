//! The worlds of golden cases as scenes.

use std::f32::consts::TAU;

use ambray_core::shape::Shape;
use ambray_scene::{Instance, Material, Mesh, Scene, ShapeInstance};
use glam::{Affine3A, DVec3, Vec3, Vec4};
use serde_json::Value;

/// Triangles of a disc: the polygon is smaller than the circle by 2π²/3 over the square of this, 6e-6.
const FAN: u32 = 1024;

pub(crate) fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn dvec3(value: &Value) -> DVec3 {
    DVec3::from_slice(&list(value).iter().map(number).collect::<Vec<_>>())
}

pub(crate) fn vec3(value: &Value) -> Vec3 {
    dvec3(value).as_vec3()
}

/// The `geometry` of a case, seen from `point`, from which nothing farther than `reach` matters: planes end there. The
/// radiance of a surface is its albedo.
pub(crate) fn scene(geometry: &Value, point: Vec3, reach: f32) -> Scene {
    let mut scene = Scene::default();
    for (i, shape) in list(geometry).iter().enumerate() {
        let radiance = shape.get("radiance").map_or(Vec3::ONE, vec3);
        scene.materials.push(Material { base_color: Vec4::from((radiance, 1.0)), ..Material::default() });
        if shape["type"] == "sphere" {
            scene.shape_instances.push(ShapeInstance {
                shape: scene.shapes.len() as u32,
                material: i as u32,
                world_from_object: Affine3A::from_translation(vec3(&shape["center"])),
                ..ShapeInstance::default()
            });
            scene.shapes.push(Shape::Sphere { radius: number(&shape["radius"]) as f32 });
        } else {
            let mesh = Mesh { material: i as u32, ..mesh(shape, point.as_dvec3(), f64::from(reach)) };
            scene.instances.push(Instance { mesh: scene.meshes.len() as u32, ..Instance::default() });
            scene.meshes.push(mesh.into());
        }
    }
    scene
}

fn mesh(shape: &Value, point: DVec3, reach: f64) -> Mesh {
    let v = |name: &str| dvec3(&shape[name]);
    let (corners, triangles): (Vec<DVec3>, _) = match shape["type"].as_str().expect("a type") {
        "plane" => {
            let normal = v("normal").normalize();
            let foot = point - normal * (point - v("point")).dot(normal);
            let (t, b) = normal.any_orthonormal_pair();
            (square(foot - (t + b) * reach, t * (2.0 * reach), b * (2.0 * reach)), HALVES.to_vec())
        }
        "quad" => (square(v("origin"), v("edge_u"), v("edge_v")), HALVES.to_vec()),
        "triangle" => (vec![v("a"), v("b"), v("c")], vec![[0, 1, 2]]),
        "disc" => {
            let (t, b) = v("normal").normalize().any_orthonormal_pair();
            let rim = (0..FAN).map(|i| {
                let angle = f64::from(TAU) * f64::from(i) / f64::from(FAN);
                v("center") + (t * angle.cos() + b * angle.sin()) * number(&shape["radius"])
            });
            let fan = (0..FAN).map(|i| [0, 1 + i, 1 + (i + 1) % FAN]);
            (std::iter::once(v("center")).chain(rim).collect(), fan.collect())
        }
        other => panic!("unknown shape {other}"),
    };
    Mesh { positions: corners.iter().map(|corner| corner.as_vec3()).collect(), triangles, ..Mesh::default() }
}

const HALVES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn square(origin: DVec3, u: DVec3, v: DVec3) -> Vec<DVec3> {
    vec![origin, origin + u, origin + u + v, origin + v]
}
