//! What a bottom-level structure is built from.

use std::collections::HashSet;

use ambray_scene::{Mesh, Scene, animation::LARGEST_COORDINATE};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Vec3};

use super::GeometryKind;
use super::bounds::Bounds;
use super::build::{self, Manner};
use super::duplicates;
use super::geometry::{self, Placed};
use super::plan::{Content, Group};
use super::sort::spatial_order;
use crate::layout::NONE;

/// A box as Vulkan reads it: `VkAabbPositionsKHR`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct ShapeBox {
    lo: Vec3,
    hi: Vec3,
}

/// The primitives of a structure in spatial order, and where each comes from.
#[derive(Debug)]
pub(super) struct Input {
    pub(super) primitives: Primitives,
    /// Instance and triangle of each primitive; [`NONE`] where each placement of the structure is an instance of its own.
    pub(super) refs: Vec<[u32; 2]>,
    /// In the space of the structure.
    pub(super) bounds: Bounds,
    /// Triangles that rays cannot hit, or that never count.
    pub(super) dropped: u64,
}

#[derive(Debug)]
pub(super) enum Primitives {
    Triangles { positions: Vec<Vec3>, triangles: Vec<[u32; 3]> },
    Boxes(Vec<ShapeBox>),
}

impl Input {
    /// Gathers the content of `group`.
    pub(super) fn of(scene: &Scene, group: &Group) -> Self {
        let members = match &group.content {
            Content::World(members) => members,
            // All users are the same in their own space.
            Content::Object(users) => &users[..1],
        };
        let is_world = matches!(group.content, Content::World(_));
        if group.deforms {
            let mesh = scene.instances[members[0] as usize].mesh;
            return Self::deforming(&scene.meshes[mesh as usize], group.opaque);
        }
        match group.kind {
            GeometryKind::Shape => Self::boxes(scene, members, is_world),
            GeometryKind::Opaque => Self::triangles(scene, members, is_world, true),
            // Which of two in one place a ray sees depends on their alphas.
            GeometryKind::Masked => Self::triangles(scene, members, is_world, false),
        }
    }

    /// Triangles of `members`, of which those that equal others may be left out.
    fn triangles(scene: &Scene, members: &[u32], is_world: bool, distinct: bool) -> Self {
        let (mut positions, mut triangles, mut refs) = (Vec::new(), Vec::new(), Vec::new());
        let (mut centres, mut bounds, mut dropped) = (Vec::new(), Bounds::EMPTY, 0);
        for &member in members {
            let instance = &scene.instances[member as usize];
            let mesh = &scene.meshes[instance.mesh as usize];
            let (transform, name) =
                if is_world { (instance.world_from_object, member) } else { (Affine3A::IDENTITY, NONE) };
            let placed = Placed::new(mesh, &transform);
            let first = positions.len() as u32;
            let before = triangles.len();
            for (triangle, vertices, corners) in placed.hittable() {
                let around = Bounds::from_iter(corners);
                bounds = bounds.union(around);
                centres.push(around.centre());
                triangles.push(vertices.map(|i| first + i));
                refs.push([name, triangle]);
            }
            dropped += (mesh.triangles.len() - (triangles.len() - before)) as u64;
            positions.extend(placed.positions);
        }
        let mut order = spatial_order(&centres);
        if distinct {
            let counts = duplicates::counting(&positions, &triangles, &refs);
            order.retain(|&i| counts[i as usize]);
            dropped += (triangles.len() - order.len()) as u64;
        }
        let triangles = order.iter().map(|&i| triangles[i as usize]).collect();
        let refs = order.iter().map(|&i| refs[i as usize]).collect();
        Self { primitives: Primitives::Triangles { positions, triangles }, refs, bounds, dropped }
    }

    /// Triangles of a mesh whose vertices will move: those that no ray can hit now may be hit at another pose. Left out is
    /// what has no area wherever the vertices are, and if `distinct` what has the same vertices as another.
    fn deforming(mesh: &Mesh, distinct: bool) -> Self {
        // A coordinate that is no number would hide its triangles for good, since updates bring nothing back.
        let within = |p: &Vec3| p.abs().cmple(Vec3::splat(LARGEST_COORDINATE)).all();
        let positions: Vec<_> =
            mesh.positions.iter().map(|p| if within(p) { *p } else { Vec3::ZERO }).collect();
        let mut seen = HashSet::new();
        let mut counts = |triangle: [u32; 3]| {
            let [mut a, mut b, mut c] = triangle;
            if a > b {
                (a, b) = (b, a);
            }
            if b > c {
                (b, c) = (c, b);
            }
            if a > b {
                (a, b) = (b, a);
            }
            a < b && b < c && (!distinct || seen.insert([a, b, c]))
        };
        let kept: Vec<u32> =
            (0_u32..).zip(&mesh.triangles).filter(|(_, t)| counts(**t)).map(|(i, _)| i).collect();
        let centre = |&i: &u32| {
            Bounds::from_iter(mesh.triangles[i as usize].map(|vertex| positions[vertex as usize])).centre()
        };
        let order = spatial_order(&kept.iter().map(centre).collect::<Vec<_>>());
        let order: Vec<u32> = order.iter().map(|&i| kept[i as usize]).collect();
        Self {
            refs: order.iter().map(|&i| [NONE, i]).collect(),
            bounds: positions.iter().copied().collect(),
            dropped: (mesh.triangles.len() - order.len()) as u64,
            primitives: Primitives::Triangles {
                triangles: order.iter().map(|&i| mesh.triangles[i as usize]).collect(),
                positions,
            },
        }
    }

    fn boxes(scene: &Scene, members: &[u32], is_world: bool) -> Self {
        let bounds_of = |member: u32| {
            let instance = &scene.shape_instances[member as usize - scene.instances.len()];
            let shape = &scene.shapes[instance.shape as usize];
            if is_world {
                geometry::shape_bounds(shape, instance).expect("only shapes with a place are planned")
            } else {
                geometry::shape_box(shape)
            }
        };
        let all: Vec<Bounds> = members.iter().map(|&m| bounds_of(m)).collect();
        let order = spatial_order(&all.iter().map(|b| b.centre()).collect::<Vec<_>>());
        let boxes = order.iter().map(|&i| all[i as usize]).map(|b| ShapeBox { lo: b.lo, hi: b.hi }).collect();
        let name = |i: u32| if is_world { members[i as usize] } else { NONE };
        let refs = order.iter().map(|&i| [name(i), 0]).collect();
        let bounds = all.into_iter().fold(Bounds::EMPTY, Bounds::union);
        Self { primitives: Primitives::Boxes(boxes), refs, bounds, dropped: 0 }
    }
}

impl Primitives {
    /// Number of primitives, and of vertices.
    pub(super) fn counts(&self) -> (u64, u64) {
        match self {
            Self::Triangles { positions, triangles } => (triangles.len() as u64, positions.len() as u64),
            Self::Boxes(boxes) => (boxes.len() as u64, 0),
        }
    }

    /// Size on the device, bytes.
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Self::Triangles { positions, triangles } => 12 * (positions.len() + triangles.len()) as u64,
            Self::Boxes(boxes) => size_of_val(&boxes[..]) as u64,
        }
    }

    /// The geometry with its data at `first` (vertices or boxes) and `second` (indices).
    pub(super) fn geometry(
        &self,
        first: vk::DeviceAddress,
        second: vk::DeviceAddress,
        manner: Manner,
    ) -> vk::AccelerationStructureGeometryKHR<'static> {
        match self {
            Self::Triangles { positions, .. } => {
                build::triangles(first, positions.len() as u64, second, manner)
            }
            Self::Boxes(_) => {
                let aabbs = vk::AccelerationStructureGeometryAabbsDataKHR::default()
                    .data(vk::DeviceOrHostAddressConstKHR { device_address: first })
                    .stride(size_of::<ShapeBox>() as u64);
                vk::AccelerationStructureGeometryKHR::default()
                    .geometry_type(vk::GeometryTypeKHR::AABBS)
                    .geometry(vk::AccelerationStructureGeometryDataKHR { aabbs })
                    .flags(manner.geometry_flags())
            }
        }
    }
}
