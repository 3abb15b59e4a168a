//! Tangents for meshes that have a normal map but no tangents, by MikkTSpace as glTF demands.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::Vec4;

use crate::Mesh;

/// Gives `mesh` tangents along the texture coordinates of `uv_set`, where it has these and normals.
///
/// Vertices on whose tangent their triangles disagree are split. Without normals nothing is done: the surface is flat
/// then, and its tangents follow from each triangle.
///
/// Returns the vertices that were split, one for each vertex that was appended.
pub(crate) fn generate(mesh: &mut Mesh, uv_set: u32) -> Vec<u32> {
    let usable = mesh.tangents.is_empty() && !mesh.normals.is_empty() && !mesh.triangles.is_empty();
    if !usable || mesh.uvs.len() <= uv_set as usize {
        return Vec::new();
    }
    let mut faces =
        Faces { mesh, uv_set: uv_set as usize, tangents: vec![[FALLBACK; 3]; mesh.triangles.len()] };
    if generate_tangents(&mut faces).is_err() {
        return Vec::new();
    }
    let tangents = faces.tangents;
    attach(mesh, &tangents)
}

/// Tangent where MikkTSpace has none: some corner of a triangle without area.
const FALLBACK: Vec4 = Vec4::new(1.0, 0.0, 0.0, 1.0);

/// MikkTSpace's view of a mesh.
struct Faces<'m> {
    mesh: &'m Mesh,
    uv_set: usize,
    tangents: Vec<[Vec4; 3]>,
}

impl Faces<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

impl Geometry for Faces<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].into()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].into()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.mesh.uvs[self.uv_set][self.vertex(face, corner)].into()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(space) = space {
            let [x, y, z, w] = space.tangent_encoded();
            // MikkTSpace's v points up, glTF's down.
            self.tangents[face][corner] = Vec4::new(x, y, z, -w);
        }
    }
}

/// Stores the tangents of the triangles' corners at the vertices, splitting these where corners disagree. Returns which.
fn attach(mesh: &mut Mesh, corners: &[[Vec4; 3]]) -> Vec<u32> {
    const UNSET: Vec4 = Vec4::ZERO;
    let mut split = Vec::new();
    mesh.tangents = vec![UNSET; mesh.positions.len()];
    let mut copies: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    for (triangle, tangents) in corners.iter().enumerate() {
        for (corner, &tangent) in tangents.iter().enumerate() {
            let vertex = mesh.triangles[triangle][corner];
            let stored = mesh.tangents[vertex as usize];
            if stored == UNSET {
                mesh.tangents[vertex as usize] = tangent;
            } else if stored != tangent {
                let key = (vertex, tangent.to_array().map(f32::to_bits));
                let copy = *copies.entry(key).or_insert_with(|| {
                    split.push(vertex);
                    copy_vertex(mesh, vertex, tangent)
                });
                mesh.triangles[triangle][corner] = copy;
            }
        }
    }
    for tangent in mesh.tangents.iter_mut().filter(|t| **t == UNSET) {
        *tangent = FALLBACK;
    }
    split
}

/// Appends a copy of `vertex` that has another tangent, and returns its index.
fn copy_vertex(mesh: &mut Mesh, vertex: u32, tangent: Vec4) -> u32 {
    let i = vertex as usize;
    mesh.positions.push(mesh.positions[i]);
    mesh.normals.push(mesh.normals[i]);
    mesh.tangents.push(tangent);
    mesh.uvs.iter_mut().for_each(|uv| uv.push(uv[i]));
    if !mesh.colors.is_empty() {
        mesh.colors.push(mesh.colors[i]);
    }
    (mesh.positions.len() - 1) as u32 // at most three copies a triangle, far from 2³²
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};

    #[test]
    fn tangent_points_along_u_and_bitangent_along_v() {
        // A square in the xy plane, texture upright as glTF has it: v grows downwards.
        let mut mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y],
            normals: vec![Vec3::Z; 4],
            uvs: vec![vec![Vec2::new(0.0, 1.0), Vec2::ONE, Vec2::new(1.0, 0.0), Vec2::ZERO]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        assert!(generate(&mut mesh, 0).is_empty(), "nothing to split");
        mesh.validate().expect("still a mesh");
        assert_eq!(mesh.positions.len(), 4);
        for tangent in &mesh.tangents {
            assert!(tangent.truncate().abs_diff_eq(Vec3::X, 1e-6));
            // glTF's bitangent is cross(normal, tangent) · w and is the direction of the map's green: up, against v.
            let bitangent = Vec3::Z.cross(tangent.truncate()) * tangent.w;
            assert!(bitangent.abs_diff_eq(Vec3::Y, 1e-6), "{bitangent}");
        }
    }

    #[test]
    fn mirrored_halves_are_split_at_the_seam() {
        // u runs outwards on both sides of the edge 0-1.
        let mut mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::NEG_X],
            normals: vec![Vec3::Z; 4],
            uvs: vec![vec![Vec2::new(0.0, 1.0), Vec2::ZERO, Vec2::ONE, Vec2::ONE]],
            triangles: vec![[0, 2, 1], [0, 1, 3]],
            ..Mesh::default()
        };
        let mut split = generate(&mut mesh, 0);
        mesh.validate().expect("still a mesh");
        assert_eq!(mesh.positions.len(), 6);
        split.sort_unstable();
        assert_eq!(split, [0, 1]);
        assert!(mesh.triangles[0].iter().all(|&i| mesh.tangents[i as usize].x > 0.9));
        assert!(mesh.triangles[1].iter().all(|&i| mesh.tangents[i as usize].x < -0.9));
    }
}
