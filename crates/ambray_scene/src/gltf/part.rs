//! A primitive that has been read, and the deformers that nodes make of it.

use crate::animation::{Deformer, Influence, MorphTarget};
use crate::repair::repair;
use crate::warnings::Warnings;
use crate::{Material, Mesh, tangents};
use glam::Vec3;

/// A primitive at rest, and what could deform it.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// Undeformed, in object space.
    pub(super) rest: Mesh,
    /// Displacements, added by weight.
    pub(super) targets: Vec<MorphTarget>,
    /// Joints of each vertex: glTF's sets of four, flattened. Empty if it cannot be skinned.
    pub(super) influences: Vec<Influence>,
    /// Influences of one vertex: they lie one after the other.
    pub(super) influences_per_vertex: usize,
}

impl Part {
    /// Makes the data sound and adds the tangents that `material` needs. Deformed shapes keep what is found at rest: their
    /// vertices are the same ones.
    pub(super) fn finish(&mut self, material: &Material, warnings: &mut Warnings) {
        // Displacements apply to what the file has, not to what is generated.
        let (no_normals, no_tangents) = (self.rest.normals.is_empty(), self.rest.tangents.is_empty());
        repair(&mut self.rest, warnings);
        let mut broken = 0;
        for MorphTarget { positions, normals, tangents } in &mut self.targets {
            if no_normals {
                normals.clear();
            }
            if no_tangents {
                tangents.clear();
            }
            for delta in positions.iter_mut().chain(normals).chain(tangents).filter(|d| !d.is_finite()) {
                *delta = Vec3::ZERO;
                broken += 1;
            }
        }
        warnings.tally("displacements of morph targets that are not finite are left out", broken);
        let refs = [&material.base_color_texture, &material.normal_texture, &material.emission_texture];
        let lacks_uvs =
            refs.into_iter().flatten().any(|texture| texture.uv_set as usize >= self.rest.uvs.len());
        warnings
            .tally("primitives lack the texture coordinates that their material asks for", lacks_uvs.into());
        if let Some(texture) = &material.normal_texture {
            let split = tangents::generate(&mut self.rest, texture.uv_set);
            self.follow(&split);
        }
    }

    /// Copies the data of the vertices in `split` to their copies, which the mesh has already.
    fn follow(&mut self, split: &[u32]) {
        for vertex in split.iter().map(|&vertex| vertex as usize) {
            for MorphTarget { positions, normals, tangents } in &mut self.targets {
                for list in [positions, normals, tangents].into_iter().filter(|list| !list.is_empty()) {
                    list.push(list[vertex]);
                }
            }
            let first = vertex * self.influences_per_vertex;
            self.influences.extend_from_within(first..first + self.influences_per_vertex);
        }
    }

    /// Whether a skin or these weights could change the rest shape.
    pub(super) fn is_deformed_by(&self, weights: &[f32], skinned: bool) -> bool {
        let morphed = self.targets.iter().zip(weights).any(|(_, &weight)| weight != 0.0);
        morphed || (skinned && !self.influences.is_empty())
    }

    /// What deforms a mesh of its own that is at rest like this one; by joints only if `skinned`. Mesh, node and skin are
    /// left to be filled in.
    pub(super) fn deformer(&self, skinned: bool) -> Deformer {
        let Self { rest, targets, influences, influences_per_vertex } = self;
        Deformer {
            mesh: 0,
            node: 0,
            skin: None,
            positions: rest.positions.clone(),
            normals: rest.normals.clone(),
            tangents: rest.tangents.clone(),
            targets: targets.clone(),
            influences: if skinned { influences.clone() } else { Vec::new() },
            influences_per_vertex: *influences_per_vertex,
        }
    }

    /// Bytes of such a deformer and of its mesh.
    pub(super) fn bytes(&self) -> u64 {
        let Mesh { positions, uvs, triangles, .. } = &self.rest;
        // Positions, normals and tangents twice, and colours.
        let vertex = 2 * (12 + 12 + 16) + 16 + 8 * uvs.len();
        let deltas: usize =
            self.targets.iter().map(|t| t.positions.len() + t.normals.len() + t.tangents.len()).sum();
        let influences = size_of::<Influence>() * self.influences.len();
        (vertex * positions.len() + 12 * (triangles.len() + deltas) + influences) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TextureRef;
    use glam::{Affine2, Vec2};

    #[test]
    fn split_vertices_keep_their_targets_and_joints() {
        // Mirrored halves of a texture: both vertices of the seam are split.
        let delta = |i: usize| Vec3::splat(i as f32);
        let mut part = Part {
            rest: Mesh {
                positions: vec![Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::NEG_X],
                normals: vec![Vec3::Z; 4],
                uvs: vec![vec![Vec2::new(0.0, 1.0), Vec2::ZERO, Vec2::ONE, Vec2::ONE]],
                triangles: vec![[0, 2, 1], [0, 1, 3]],
                ..Mesh::default()
            },
            targets: vec![MorphTarget {
                positions: (0..4).map(delta).collect(),
                normals: vec![Vec3::NAN; 4],
                tangents: vec![Vec3::X; 4],
            }],
            influences: (0..16).map(|i| Influence { joint: i / 4, weight: i as f32 }).collect(),
            influences_per_vertex: 4,
        };
        let normal_texture = Some(TextureRef { texture: 0, uv_set: 0, transform: Affine2::IDENTITY });
        let mut warnings = Warnings::default();
        part.finish(&Material { normal_texture, ..Material::default() }, &mut warnings);
        assert_eq!(part.rest.positions.len(), 6);
        assert_eq!(part.influences.len(), 24);
        for (i, position) in part.rest.positions.iter().enumerate() {
            let vertex = part.rest.positions[..4].iter().position(|p| p == position).expect("a copy");
            assert_eq!(part.targets[0].positions[i], delta(vertex));
            assert_eq!(part.influences[4 * i].joint, vertex as u32);
            assert_eq!(part.influences[4 * i + 3].weight, (4 * vertex + 3) as f32);
        }
        assert_eq!(part.targets[0].normals, [Vec3::ZERO; 6]);
        assert!(part.targets[0].tangents.is_empty(), "they belong to other tangents");
        assert_eq!(warnings.into_lines().len(), 1);
    }
}
