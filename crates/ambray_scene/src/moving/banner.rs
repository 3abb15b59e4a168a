//! A large cloth in an open hall: it billows, twists, folds and is blown about.

use std::sync::Arc;

use glam::{DAffine3, Vec2, Vec3};

use crate::animation::{Attachment, Channel, Clip, Deformer, Interpolation, Local, Node, Property, Rig, Trs};
use crate::modelling::builder::Builder;
use crate::modelling::camera::look;
use crate::modelling::shapes::Shape;
use crate::{Instance, Motion, Scene};

use super::cloth::{self, TARGETS, cloth};
use super::hall;

/// Seconds between keyframes.
const STEP: f32 = 0.5;
/// Weights of the cloth's shapes at each keyframe: billow, twist, lift, gather, surge, swing. The last is the first again.
const WEIGHTS: [[f32; TARGETS]; 9] = [
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.9, 0.0, 0.0, 0.0, 0.2, 0.0],
    [0.3, 0.5, 0.0, 0.0, 0.5, 0.0],
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.3, 0.7, 0.0, 0.2, 0.0],
    [0.0, 0.0, 0.9, 0.1, 0.0, 0.0],
    [0.2, 0.0, 0.1, 0.9, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.2, 0.5, 0.7],
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
];

/// Builds the scene: about 45 000 triangles, 35 840 of them the cloth's. It loops in 4 s.
#[must_use]
pub fn banner() -> Scene {
    let mut builder = Builder::default();
    build_hall(&mut builder);
    let material = builder.scene.materials.len() as u32;
    hall::paint(&mut builder, "cloth", [1.0; 3]);
    let mut scene = builder.scene;
    let (mesh, targets) = cloth(material);
    let deformer = Deformer {
        mesh: scene.meshes.len() as u32,
        node: 0,
        skin: None,
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        targets: targets.into(),
        ..Deformer::default()
    };
    scene.meshes.push(Arc::new(mesh));
    let instance = Instance { mesh: deformer.mesh, motion: Motion::Deforming, ..Instance::default() };
    scene.instances.push(instance);
    scene.name = "banner".to_owned();
    hall::light(&mut scene, Vec3::new(0.55, 0.75, 0.62));
    scene.radius = Some(1.0);
    scene.cameras = vec![
        look("hall", Vec3::new(0.75, 1.6, 4.9), Vec3::new(-0.05, 1.52, 0.0), 45.0),
        look("hem", Vec3::new(1.1, 0.5, 1.9), Vec3::new(-0.1, 0.35, 0.0), 50.0),
    ];
    let rig = rig(deformer, scene.instances.len());
    let pose = rig.pose(None);
    scene.rig = Some(Arc::new(rig));
    scene.deform(&pose);
    scene
}

/// Columns around the cloth, a beam that it hangs from, and a wall behind.
fn build_hall(builder: &mut Builder) {
    hall::floor(builder, Vec2::new(4.0, 4.0), 0.8);
    let stone = hall::paint(builder, "stone", [0.76, 0.70, 0.60]);
    let plaster = hall::paint(builder, "plaster", [0.84, 0.82, 0.78]);
    let rows = [-1.9, 0.0, 1.9];
    let places = rows.map(|z| [Vec2::new(-1.75, z), Vec2::new(1.75, z)]);
    hall::columns(builder, places.as_flattened(), 3.0, stone);
    let mut beams = Shape::default();
    for x in [-1.75, 1.75] {
        beams.append(Shape::cuboid(Vec3::new(x - 0.24, 3.0, -2.3), Vec3::new(x + 0.24, 3.34, 2.3)));
    }
    for z in rows {
        beams.append(Shape::cuboid(Vec3::new(-1.51, 3.02, z - 0.16), Vec3::new(1.51, 3.3, z + 0.16)));
    }
    builder.flat_once("beams", &beams, stone);
    let wall = Shape::cuboid(Vec3::new(-3.2, 0.0, -3.2), Vec3::new(3.2, 2.6, -3.0));
    builder.flat_once("wall", &wall, plaster);
    let wood = hall::paint(builder, "rod", [0.32, 0.2, 0.11]);
    let rod = [Vec3::new(-1.6, cloth::TOP, 0.0), Vec3::new(1.6, cloth::TOP, 0.0)];
    builder.smooth_once("rod", &Shape::tube(&rod, 0.025, 12), wood);
}

/// A node with the cloth, which alone moves, and the clip.
fn rig(deformer: Deformer, instances: usize) -> Rig {
    let cloth = Node {
        name: "cloth".to_owned(),
        parent: None,
        local: Local::Trs(Trs::default()),
        weights: vec![0.0; TARGETS],
    };
    let mut attachments = vec![Attachment { node: None, local: DAffine3::IDENTITY }; instances];
    attachments[instances - 1].node = Some(0);
    Rig {
        nodes: vec![cloth],
        clips: vec![clip()],
        deformers: vec![deformer],
        instances: attachments,
        ..Rig::default()
    }
}

/// The weights with smooth transitions: each tangent is the slope from the keyframe before to the one after, around the
/// loop.
fn clip() -> Clip {
    let around = WEIGHTS.len() - 1;
    let times: Vec<f32> = (0..WEIGHTS.len()).map(|k| k as f32 * STEP).collect();
    let mut values = Vec::new();
    for k in 0..WEIGHTS.len() {
        let (before, after) = (WEIGHTS[(k + around - 1) % around], WEIGHTS[(k + 1) % around]);
        let slope: [f32; TARGETS] = std::array::from_fn(|i| (after[i] - before[i]) / (2.0 * STEP));
        values.extend(slope.iter().chain(&WEIGHTS[k]).chain(&slope));
    }
    let duration = times[times.len() - 1];
    let channel =
        Channel { node: 0, property: Property::Weights, interpolation: Interpolation::Cubic, times, values };
    Clip { name: "wind".to_owned(), duration, channels: vec![channel] }
}
