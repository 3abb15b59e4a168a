//! Scenes that move, made by hand: what each of them shows is known at every time.

use std::sync::Arc;

use ambray_scene::{
    Instance, Material, Mesh, Motion, Scene,
    animation::{
        Attachment, Channel, Clip, Deformer, Interpolation, Local, MorphTarget, Node, Property, Rig, Trs,
    },
};
use glam::{Affine3A, DAffine3, DVec3, Vec3, Vec4};

/// Seconds at which the block of [`removed`] leaves.
pub const LEAVES_AT: f32 = 1.0;

/// A scene in the making.
struct Stage {
    scene: Scene,
    rig: Rig,
}

impl Stage {
    /// A floor of 12 × 12 units and a wall behind it.
    fn new() -> Self {
        let mut stage = Self {
            scene: Scene { name: "stage".into(), materials: vec![paint(0.7, 0.7, 0.7)], ..Scene::default() },
            rig: Rig { clips: vec![Clip { name: "clip".into(), ..Clip::default() }], ..Rig::default() },
        };
        stage.add(cuboid(Vec3::new(6.0, 0.5, 6.0)), Vec3::NEG_Y * 0.5, None);
        stage.add(cuboid(Vec3::new(6.0, 2.0, 0.25)), Vec3::new(0.0, 2.0, -1.5), None);
        stage
    }

    /// Shows `mesh` at `at`, within a node if it moves.
    fn add(&mut self, mesh: Mesh, at: Vec3, node: Option<u32>) {
        let motion = if node.is_some() { Motion::Rigid } else { Motion::Static };
        let world_from_object = Affine3A::from_translation(at);
        let local = DAffine3::from_translation(at.as_dvec3());
        self.scene.instances.push(Instance {
            mesh: self.scene.meshes.len() as u32,
            world_from_object,
            motion,
        });
        self.scene.meshes.push(mesh.into());
        self.rig.instances.push(Attachment { node, local });
    }

    /// A node at the origin that moves through `keyframes`: times in seconds and places.
    fn mover(&mut self, interpolation: Interpolation, keyframes: &[(f32, Vec3)]) -> u32 {
        let node = self.node();
        let times = keyframes.iter().map(|&(time, _)| time).collect();
        let values = keyframes.iter().flat_map(|(_, at)| at.to_array()).collect();
        self.play(Channel { node, property: Property::Translation, interpolation, times, values });
        node
    }

    fn node(&mut self) -> u32 {
        let local = Local::Trs(Trs { translation: DVec3::ZERO, ..Trs::default() });
        self.rig.nodes.push(Node { name: String::new(), parent: None, local, weights: Vec::new() });
        self.rig.nodes.len() as u32 - 1
    }

    fn play(&mut self, channel: Channel) {
        let clip = &mut self.rig.clips[0];
        clip.duration = clip.duration.max(channel.times.last().copied().unwrap_or_default());
        clip.channels.push(channel);
    }

    fn finish(self) -> Scene {
        Scene { rig: Some(Arc::new(self.rig)), ..self.scene }
    }
}

/// A block stands on the floor by the wall, and is gone at [`LEAVES_AT`]; the clip goes on for two seconds.
#[must_use]
pub fn removed() -> Scene {
    let mut stage = Stage::new();
    let away = Vec3::Y * 100.0;
    let node = stage.mover(Interpolation::Step, &[(0.0, Vec3::ZERO), (LEAVES_AT, away), (2.0, away)]);
    stage.add(cuboid(Vec3::new(0.5, 0.7, 0.5)), Vec3::new(0.0, 0.7, -0.5), Some(node));
    stage.finish()
}

/// A block and a small roof on a foot slide along the wall, half a unit a second for four seconds.
#[must_use]
pub fn sliding() -> Scene {
    let mut stage = Stage::new();
    let node = stage.mover(Interpolation::Linear, &[(0.0, Vec3::NEG_X), (4.0, Vec3::X)]);
    stage.add(cuboid(Vec3::new(0.4, 0.6, 0.4)), Vec3::new(-0.6, 0.6, -0.6), Some(node));
    stage.add(cuboid(Vec3::new(0.15, 0.4, 0.15)), Vec3::new(0.6, 0.4, -0.2), Some(node));
    stage.add(cuboid(Vec3::new(0.5, 0.05, 0.5)), Vec3::new(0.6, 0.85, -0.2), Some(node));
    stage.finish()
}

/// A cloth stands across the floor and bends over it and back within two seconds, by one morph target.
#[must_use]
pub fn bending() -> Scene {
    const SIDE: usize = 24;
    let mut stage = Stage::new();
    let node = stage.node();
    let grid = |i: usize| (i % (SIDE + 1), i / (SIDE + 1));
    let place = |i: usize| {
        let (column, row) = grid(i);
        Vec3::new(column as f32 / SIDE as f32 * 2.0 - 1.0, row as f32 / SIDE as f32 * 1.6 + 0.05, 0.2)
    };
    // The farther up, the farther forwards and down.
    let displace = |i: usize| {
        let height = place(i).y;
        Vec3::new(0.2 * height, -0.35 * height * height, 0.7 * height * height)
    };
    let count = (SIDE + 1) * (SIDE + 1);
    let positions: Vec<Vec3> = (0..count).map(place).collect();
    let quads = (0..SIDE * SIDE).map(|q| ((q / SIDE) * (SIDE + 1) + q % SIDE) as u32);
    let up = SIDE as u32 + 1;
    let triangles = quads.flat_map(|i| [[i, i + 1, i + up + 1], [i, i + up + 1, i + up]]).collect();
    let mesh = Mesh { name: "cloth".into(), positions: positions.clone(), triangles, ..Mesh::default() };
    stage.add(mesh, Vec3::ZERO, Some(node));
    stage.scene.instances.last_mut().expect("just added").motion = Motion::Deforming;
    stage.rig.nodes[node as usize].weights = vec![0.0];
    stage.rig.deformers.push(Deformer {
        mesh: stage.scene.meshes.len() as u32 - 1,
        node,
        positions,
        targets: vec![MorphTarget {
            positions: (0..count).map(displace).collect(),
            ..MorphTarget::default()
        }],
        ..Deformer::default()
    });
    stage.play(Channel {
        node,
        property: Property::Weights,
        interpolation: Interpolation::Linear,
        times: vec![0.0, 1.0, 2.0],
        values: vec![0.0, 1.0, 0.0],
    });
    stage.finish()
}

fn paint(r: f32, g: f32, b: f32) -> Material {
    Material { base_color: Vec4::new(r, g, b, 1.0), ..Material::default() }
}

/// A box of this half size around the origin, flat faces.
fn cuboid(half: Vec3) -> Mesh {
    let mut mesh = Mesh { name: "box".into(), ..Mesh::default() };
    for axis in 0..3 {
        for sign in [-1.0_f32, 1.0] {
            let first = mesh.positions.len() as u32;
            for [u, v] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
                let mut p = [sign; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (u, v * sign);
                mesh.positions.push(Vec3::from_array(p) * half);
            }
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    mesh
}
