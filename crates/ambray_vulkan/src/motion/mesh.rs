//! A deforming mesh on the device.

use std::sync::Arc;

use ambray_scene::{
    Scene,
    animation::{Deformer, Pose},
};
use ash::vk::BufferUsageFlags;
use glam::{Affine3A, Vec3};

use super::bytes::Bytes;
use super::clusters::{self, Built};
use super::sample;
use crate::{
    Acceleration, Buffer, Context, Result,
    acceleration::Follower,
    layout::{self, BOX_WORDS, CLUSTER_WORDS, NONE},
    tables::Tables,
};

/// Bytes of what is read back of a mesh: its box and two costs.
pub(super) const RESULT: u64 = 4 * (BOX_WORDS as u64 + 2);

/// A mesh at rest with what deforms it, and what is known of its structures.
#[derive(Debug)]
pub(super) struct DeformingMesh {
    /// Index into the rig's deformers.
    pub(super) deformer: usize,
    /// Index into [`Acceleration::followers`].
    pub(super) follower: usize,
    pub(super) vertices: u32,
    pub(super) triangles: u32,
    /// Vertex numbers in the order of the structures.
    pub(super) indices: Buffer,
    /// One for each of its structures.
    pub(super) built: Vec<Built>,
    /// Clusters of the triangles for the pose that was measured last.
    pub(super) fresh: Buffer,
    /// Clusters along each axis.
    pub(super) side: u32,
    /// Bytes before its clusters in the buffer of all.
    first_box: u64,
    /// Attributes, targets and influences at rest.
    _rest: Buffer,
    /// All but what depends on the pose.
    arguments: layout::Deformation,
    /// Targets without weights.
    targets: Vec<layout::Target>,
}

/// Where the device finds what all meshes share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shared {
    /// Boxes of the clusters.
    pub(super) boxes: u64,
    /// [`RESULT`] bytes a mesh.
    pub(super) results: u64,
}

impl DeformingMesh {
    pub(super) fn new(
        context: &Arc<Context>,
        scene: &Scene,
        (deformer, index): (&Deformer, usize),
        (acceleration, follower): (&Acceleration, usize),
        tables: &Tables,
        first_box: u64,
    ) -> Result<Self> {
        let of: &Follower = &acceleration.followers()[follower];
        let mesh = &scene.meshes[deformer.mesh as usize];
        assert_eq!(deformer.positions.len(), mesh.positions.len(), "a deformer has the vertices of its mesh");
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let input = usage | BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR;
        let indices = acceleration.indices(of, &mesh.triangles);
        let (rest, arguments, targets) = rest(context, deformer, tables)?;
        let built = Built { sample: Some(sample::of(&mesh.positions)), ..Built::new(context, of.triangles)? };
        Ok(Self {
            deformer: index,
            follower,
            vertices: mesh.positions.len() as u32,
            triangles: of.triangles,
            indices: context.upload("vertex numbers of a deforming mesh", input, &indices)?,
            built: vec![built],
            fresh: clusters::buffer(context, of.triangles)?,
            side: clusters::side(of.triangles),
            first_box,
            _rest: rest,
            arguments,
            targets,
        })
    }

    /// The structure that was built in the pose nearest to that of `sample`; the first if that is empty.
    pub(super) fn nearest(&self, sample: &[Vec3]) -> usize {
        sample::nearest(self.built.iter().map(|built| built.sample.as_deref()), sample)
    }

    /// Bytes of the boxes of the clusters, of the structure and for the pose.
    pub(super) const fn box_bytes(&self) -> u64 {
        2 * self.half_box_bytes()
    }

    const fn half_box_bytes(&self) -> u64 {
        let count = self.side as u64;
        count * count * count * 4 * CLUSTER_WORDS as u64
    }

    /// Address of the positions that the tables have.
    pub(super) const fn positions(&self) -> u64 {
        self.arguments.positions
    }

    /// Appends what deforms the mesh to `bytes`, which will be at `base`; returns the address of the arguments. `joints` is
    /// the address of the joint matrices of its skin, `result` the index of the mesh among the results.
    pub(super) fn deformation(
        &self,
        bytes: &mut Bytes,
        base: u64,
        weights: &[f32],
        joints: u64,
        (shared, result): (Shared, usize),
    ) -> u64 {
        let weighted = self.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0);
        let targets: Vec<_> =
            weighted.map(|(target, &weight)| layout::Target { weight, ..*target }).collect();
        let arguments = layout::Deformation {
            targets: base + bytes.push(&targets),
            target_count: targets.len() as u32,
            joints,
            bounds: shared.results + RESULT * result as u64,
            ..self.arguments
        };
        base + bytes.push(&[arguments])
    }

    /// Appends what measures clusters to `bytes`, as above: those of the structure `built`, or without one those that are
    /// made for the pose.
    pub(super) fn clusters(
        &self,
        bytes: &mut Bytes,
        base: u64,
        built: Option<usize>,
        (shared, result): (Shared, usize),
    ) -> u64 {
        let clusters = built.map_or(&self.fresh, |built| &self.built[built].clusters);
        let half = u64::from(built.is_none());
        let result = shared.results + RESULT * result as u64;
        let arguments = layout::Clusters {
            positions: self.arguments.positions,
            triangles: self.indices.address(),
            clusters: clusters.address(),
            boxes: shared.boxes + self.first_box + half * self.half_box_bytes(),
            bounds: result,
            cost: result + 4 * (u64::from(BOX_WORDS) + half),
            triangle_count: self.triangles,
            side: self.side,
        };
        base + bytes.push(&[arguments])
    }

    /// Takes note that the structure `built` has been built for the pose that was measured last.
    pub(super) fn accept(&mut self, built: usize, sample: Vec<Vec3>) {
        std::mem::swap(&mut self.built[built].clusters, &mut self.fresh);
        self.built[built].sample = Some(sample);
    }

    /// Joint matrices and morph weights of `pose` for `deformer`, which is this one's.
    pub(super) fn posed<'p>(&self, deformer: &Deformer, pose: &'p Pose) -> (&'p [f32], &'p [Affine3A]) {
        let joints = deformer.skin.map_or(&[][..], |skin| &pose.joints[skin as usize]);
        (&pose.weights[self.deformer], joints)
    }
}

/// Uploads what does not depend on the pose.
fn rest(
    context: &Arc<Context>,
    deformer: &Deformer,
    tables: &Tables,
) -> Result<(Buffer, layout::Deformation, Vec<layout::Target>)> {
    let mut bytes = Bytes::default();
    // Offsets from 1, since 0 says that there is nothing.
    let mut part = |values: &[Vec3]| if values.is_empty() { 0 } else { 1 + bytes.push(values) };
    let (positions, normals) = (part(&deformer.positions), part(&deformer.normals));
    let mut targets: Vec<_> = (deformer.targets.iter())
        .map(|target| layout::Target {
            positions: part(&target.positions),
            normals: part(&target.normals),
            tangents: part(&target.tangents),
            ..layout::Target::default()
        })
        .collect();
    let tangents = if deformer.tangents.is_empty() { 0 } else { 1 + bytes.push(&deformer.tangents) };
    let influences: Vec<_> = (deformer.influences.iter())
        .map(|influence| layout::Influence { joint: influence.joint, weight: influence.weight })
        .collect();
    let influences_at = if influences.is_empty() { 0 } else { 1 + bytes.push(&influences) };
    let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    let buffer = context.upload("a mesh at rest", usage, bytes.all())?;
    let address = |offset: u64| if offset == 0 { 0 } else { buffer.address() + offset - 1 };
    for target in &mut targets {
        for field in [&mut target.positions, &mut target.normals, &mut target.tangents] {
            *field = address(*field);
        }
    }
    let mesh = &tables.meshes[deformer.mesh as usize];
    let written = |table: &Buffer, first: u32, stride: u64| {
        if first == NONE { 0 } else { table.address() + u64::from(first) * stride }
    };
    let arguments = layout::Deformation {
        rest_positions: address(positions),
        rest_normals: address(normals),
        rest_tangents: address(tangents),
        influences: address(influences_at),
        positions: written(&tables.positions, mesh.first_vertex, 12),
        normals: written(&tables.normals, mesh.first_normal, 12),
        tangents: written(&tables.tangents, mesh.first_tangent, 16),
        vertices: mesh.vertices,
        influences_per_vertex: if influences.is_empty() { 0 } else { deformer.influences_per_vertex as u32 },
        ..layout::Deformation::default()
    };
    Ok((buffer, arguments, targets))
}
