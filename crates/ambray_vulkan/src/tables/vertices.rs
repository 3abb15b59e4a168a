//! Vertex attributes and triangles of all meshes.

use ambray_scene::{Motion, Scene};

use super::{place, place_of};
use crate::{
    Result,
    layout::{self, NONE},
};

/// Vertex attributes and triangles of all meshes, one after the other.
#[derive(Default)]
pub(super) struct Vertices {
    pub(super) meshes: Vec<layout::Mesh>,
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) tangents: Vec<[f32; 4]>,
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Vertices {
    pub(super) fn of(scene: &Scene) -> Result<Self> {
        let mut all = Self::default();
        let deforms = deforming_meshes(scene);
        // Entries of the tables of the last frame: those of deforming meshes alone.
        let (mut previous_vertices, mut previous_normals) = (0, 0);
        for (mesh, deforms) in scene.meshes.iter().zip(deforms) {
            let (vertices, normals) = (mesh.positions.len() as u32, mesh.normals.len() as u32);
            all.meshes.push(layout::Mesh {
                first_triangle: place("triangles", &all.triangles)?,
                first_vertex: place("vertices", &all.positions)?,
                vertices,
                first_normal: place_of("normals", &all.normals, mesh.normals.is_empty())?,
                first_tangent: place_of("tangents", &all.tangents, mesh.tangents.is_empty())?,
                first_color: place_of("vertex colours", &all.colors, mesh.colors.is_empty())?,
                first_uv: place("texture coordinates", &all.uvs)?,
                uv_sets: mesh.uvs.len() as u32,
                material: mesh.material,
                previous_vertex: if deforms { previous_vertices } else { NONE },
                previous_normal: if deforms && normals > 0 { previous_normals } else { NONE },
            });
            if deforms {
                // Within the limits that hold for the tables of all meshes.
                previous_vertices += vertices;
                previous_normals += normals;
            }
            all.positions.extend(mesh.positions.iter().map(|v| v.to_array()));
            all.normals.extend(mesh.normals.iter().map(|v| v.to_array()));
            all.tangents.extend(mesh.tangents.iter().map(|v| v.to_array()));
            all.uvs.extend(mesh.uvs.iter().flatten().map(|v| v.to_array()));
            all.colors.extend(mesh.colors.iter().map(|v| v.to_array()));
            all.triangles.extend(&mesh.triangles);
        }
        Ok(all)
    }
}

/// Whether the vertices of each mesh may move against each other.
pub(crate) fn deforming_meshes(scene: &Scene) -> Vec<bool> {
    let mut deforms = vec![false; scene.meshes.len()];
    for instance in scene.instances.iter().filter(|instance| instance.motion == Motion::Deforming) {
        deforms[instance.mesh as usize] = true;
    }
    for deformer in scene.rig.iter().flat_map(|rig| &rig.deformers) {
        deforms[deformer.mesh as usize] = true;
    }
    deforms
}
