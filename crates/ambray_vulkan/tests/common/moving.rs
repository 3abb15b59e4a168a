//! Scenes that move, and poses of them.
#![allow(dead_code, unreachable_pub, reason = "each test file uses its own part of it")]

use std::sync::Arc;

use ambray_core::{
    sampling::{pcg, unit_float},
    shape::Shape,
};
use ambray_scene::{
    AlphaMode, Instance, Material, Mesh, Motion, Scene, ShapeInstance,
    animation::{Attachment, Deformer, Influence, Local, MorphTarget, Node, Pose, Rig, Skin, Trs},
};
use glam::{Affine3A, DAffine3, DQuat, DVec3, Vec3, Vec4};

/// A reproducible stream of numbers.
pub struct Random(pub u32);

impl Random {
    /// In `[low, high)`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        low + unit_float(pcg(self.0)) * (high - low)
    }

    pub fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.between(-size, size)))
    }

    fn turn(&mut self) -> DQuat {
        let axis = self.vector(1.0).as_dvec3().try_normalize().unwrap_or(DVec3::Y);
        DQuat::from_axis_angle(axis, f64::from(self.between(-1.0, 1.0)))
    }
}

/// Nodes of the scenes.
pub const BANNER: usize = 0;
pub const BOX: usize = 1;
pub const BALL: usize = 2;
pub const BONES: std::ops::Range<usize> = 3..6;
/// Instances of the scenes.
pub const BOX_INSTANCE: u32 = 1;
pub const BANNER_INSTANCE: u32 = 2;
/// Meshes of the scenes.
pub const BANNER_MESH: usize = 2;
pub const TUBE_MESH: usize = 3;

/// A wavy square of 2 × `n` × `n` triangles with normals and tangents.
fn square(n: u32, material: u32) -> Mesh {
    let at = |i: u32| ((i % (n + 1)) as f32 / n as f32, (i / (n + 1)) as f32 / n as f32);
    let point = |i: u32| {
        let (x, y) = at(i);
        Vec3::new(2.0 * x - 1.0, 2.0 * y - 1.0, 0.1 * (5.0 * x).sin() * (4.0 * y).cos())
    };
    let cell = |i: u32| {
        let corner = i / n * (n + 1) + i % n;
        [[corner, corner + 1, corner + n + 2], [corner, corner + n + 2, corner + n + 1]]
    };
    let count = (n + 1) * (n + 1);
    Mesh {
        positions: (0..count).map(point).collect(),
        normals: vec![Vec3::Z; count as usize],
        tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); count as usize],
        uvs: vec![(0..count).map(|i| at(i).into()).collect()],
        triangles: (0..n * n).flat_map(cell).collect(),
        material,
        ..Mesh::default()
    }
}

/// The same cut into its squares, which can go each its own way: four vertices each.
fn leaves(n: u32, material: u32) -> Mesh {
    let whole = square(n, material);
    let corners = |cell: &[[u32; 3]]| [cell[0][0], cell[0][1], cell[0][2], cell[1][2]].map(|i| i as usize);
    let cells: Vec<usize> = whole.triangles.chunks(2).flat_map(corners).collect();
    let count = cells.len() as u32;
    Mesh {
        positions: cells.iter().map(|&i| whole.positions[i]).collect(),
        normals: vec![Vec3::Z; cells.len()],
        tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); cells.len()],
        uvs: vec![cells.iter().map(|&i| whole.uvs[0][i]).collect()],
        triangles: (0..count).step_by(4).flat_map(|i| [[i, i + 1, i + 2], [i, i + 2, i + 3]]).collect(),
        ..whole
    }
}

/// What deforms `mesh`, which is of [`leaves`]: displacements of all sizes, and the pull of three joints if `influences` is not 0.
fn deformer(random: &mut Random, mesh: &Mesh, index: usize, node: usize, influences: usize) -> Deformer {
    let count = mesh.positions.len();
    let waves = MorphTarget {
        positions: mesh.positions.iter().map(|p| Vec3::Z * (6.0 * p.x + p.y).sin() * 0.5).collect(),
        normals: (0..count).map(|_| random.vector(0.5)).collect(),
        tangents: Vec::new(),
    };
    let centre = |leaf: usize| mesh.positions[4 * leaf] + mesh.positions[4 * leaf + 2];
    // To the place of another one: 37 has no factor in common with the numbers of leaves here.
    let shuffle = |i: usize| 0.5 * (centre((i / 4 * 37 + 5) % (count / 4)) - centre(i / 4));
    let scramble = MorphTarget {
        positions: (0..count).map(shuffle).collect(),
        normals: Vec::new(),
        tangents: (0..count).map(|_| random.vector(0.5)).collect(),
    };
    let pull = |p: &Vec3, k: usize| {
        let weight = (1.0 - (p.y - (k as f32 - 1.0)).abs()).max(0.0);
        Influence { joint: (k % 3) as u32, weight: if k < 3 { weight } else { 0.0 } }
    };
    Deformer {
        mesh: index as u32,
        node: node as u32,
        skin: (influences > 0).then_some(0),
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        tangents: mesh.tangents.clone(),
        targets: vec![waves, MorphTarget::default(), scramble],
        influences: (mesh.positions.iter())
            .flat_map(|p| (0..influences).map(|k| pull(p, k)).collect::<Vec<_>>())
            .collect(),
        influences_per_vertex: influences,
    }
}

/// A floor; a box that moves; a banner with morph weights, twice, one of them moving; a tube with joints that some rays pass;
/// a ball that moves. The meshes that deform have 2 × `n` × `n` triangles each.
pub fn scene(n: u32) -> Scene {
    let mut random = Random(n);
    let mut crate_mesh = square(2, 0);
    crate_mesh.triangles.push([0, 0, 1]);
    let mut banner = leaves(n, 0);
    // The same once more, one without area, and one that has none at rest.
    banner.triangles.extend([banner.triangles[3], [1, 1, 2], [0, 1, 2]]);
    let mut tube = leaves(n, 1);
    tube.tangents.clear();
    // Not where the banner is.
    tube.positions.iter_mut().for_each(|p| *p = Vec3::new(0.8 * p.x, p.y, p.z + 0.7 - 0.5 * p.x * p.x));
    let banner_deformer = deformer(&mut random, &banner, BANNER_MESH, BANNER, 0);
    let tube_deformer = deformer(&mut random, &tube, TUBE_MESH, BANNER, 8);
    let attached = |node: usize| Attachment { node: Some(node as u32), local: DAffine3::IDENTITY };
    let stays = Attachment { node: None, local: DAffine3::IDENTITY };
    let node = |name: &str| Node {
        name: name.into(),
        parent: None,
        local: Local::Trs(Trs::default()),
        weights: Vec::new(),
    };
    let rig = Rig {
        nodes: ["banner", "box", "ball", "bone", "bone", "bone"].map(node).into(),
        skins: vec![Skin {
            joints: BONES.map(|bone| bone as u32).collect(),
            inverse_binds: vec![DAffine3::IDENTITY; BONES.len()],
        }],
        deformers: vec![banner_deformer, tube_deformer],
        instances: vec![stays, attached(BOX), attached(BANNER), stays, stays],
        shape_instances: vec![attached(BALL), stays],
        ..Rig::default()
    };
    let place = |mesh: usize, at: Vec3, motion: Motion| Instance {
        mesh: mesh as u32,
        world_from_object: Affine3A::from_translation(at),
        motion,
    };
    let mut floor = place(0, Vec3::NEG_Y * 2.0, Motion::Static);
    floor.world_from_object *= Affine3A::from_rotation_x(1.5) * Affine3A::from_scale(Vec3::splat(4.0));
    let ball = |at: Vec3, motion: Motion| ShapeInstance {
        world_from_object: Affine3A::from_translation(at),
        motion,
        ..ShapeInstance::default()
    };
    let leafy = Material {
        alpha_mode: AlphaMode::Blend,
        base_color: Vec4::new(0.2, 0.6, 0.1, 0.7),
        ..Material::default()
    };
    Scene {
        name: "moving".into(),
        meshes: [square(1, 0), crate_mesh, banner, tube].map(Arc::new).into(),
        instances: vec![
            floor,
            place(1, Vec3::X, Motion::Rigid),
            place(BANNER_MESH, Vec3::ZERO, Motion::Deforming),
            place(BANNER_MESH, Vec3::new(-2.5, 0.0, -1.0), Motion::Deforming),
            place(TUBE_MESH, Vec3::ZERO, Motion::Deforming),
        ],
        shapes: vec![Shape::Sphere { radius: 0.5 }],
        shape_instances: vec![ball(Vec3::Y, Motion::Rigid), ball(Vec3::new(2.0, -1.0, 0.0), Motion::Static)],
        materials: vec![Material::default(), leafy],
        rig: Some(Arc::new(rig)),
        ..Scene::default()
    }
}

/// The pose in which the scene was made.
pub fn rest(scene: &Scene) -> Pose {
    let rig = scene.rig.as_ref().expect("it moves");
    Pose {
        world: vec![DAffine3::IDENTITY; rig.nodes.len()],
        joints: vec![vec![Affine3A::IDENTITY; BONES.len()]],
        weights: rig.deformers.iter().map(|deformer| vec![0.0; deformer.targets.len()]).collect(),
    }
}

/// Any pose; vertices are scattered by `scatter` at most.
pub fn pose(scene: &Scene, random: &mut Random, scatter: f32) -> Pose {
    let mut pose = rest(scene);
    for world in &mut pose.world {
        let scale = random.vector(0.4).as_dvec3() + 1.0;
        let at = random.vector(1.5).as_dvec3();
        *world = DAffine3::from_scale_rotation_translation(scale, random.turn(), at);
    }
    let world = &pose.world;
    pose.joints = vec![
        BONES
            .map(|bone| {
                let (m, t) = (world[bone].matrix3.as_mat3(), world[bone].translation.as_vec3());
                Affine3A::from_mat3_translation(m, t)
            })
            .collect(),
    ];
    for weights in &mut pose.weights {
        weights.copy_from_slice(&[random.between(-1.0, 1.0), 3.0, scatter * random.between(0.0, 1.0)]);
    }
    pose
}

/// `scene` with its instances at `pose`, and the same with its meshes there.
pub fn posed(scene: &Scene, pose: &Pose) -> [Arc<Scene>; 2] {
    let mut placed = scene.clone();
    placed.place(pose);
    let mut deformed = placed.clone();
    deformed.deform(pose);
    [placed, deformed].map(Arc::new)
}
