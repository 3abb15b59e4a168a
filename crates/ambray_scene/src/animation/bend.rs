//! Deforms whole meshes, on all threads.

use glam::Affine3A;
use rayon::prelude::*;

use super::Deformer;
use crate::Mesh;

/// Vertices that a thread deforms at a time.
const CHUNK: usize = 4096;

impl Deformer {
    /// Writes the shape for these morph weights and joint matrices into `mesh`, which has the attributes of the shape at
    /// rest. Triangles, texture coordinates and colours stay.
    pub(crate) fn bend(&self, mesh: &mut Mesh, weights: &[f32], joints: &[Affine3A]) {
        let Mesh { positions, normals, tangents, .. } = mesh;
        let normals = slices(normals, positions.len());
        let tangents = slices(tangents, positions.len());
        let firsts = (0..positions.len()).step_by(CHUNK);
        let parts: Vec<_> =
            firsts.zip(positions.chunks_mut(CHUNK)).zip(normals.into_iter().zip(tangents)).collect();
        parts.into_par_iter().for_each(|((first, positions), (normals, tangents))| {
            for (i, position) in positions.iter_mut().enumerate() {
                let vertex = self.vertex(first + i, weights, joints);
                *position = vertex.position;
                if let Some(normal) = normals.get_mut(i) {
                    *normal = vertex.normal;
                }
                if let Some(tangent) = tangents.get_mut(i) {
                    *tangent = vertex.tangent;
                }
            }
        });
    }
}

/// Chunks of an attribute of `count` vertices; empty ones if the mesh does not have it.
fn slices<T>(attribute: &mut [T], count: usize) -> Vec<&mut [T]> {
    let missing = if attribute.is_empty() { count.div_ceil(CHUNK) } else { 0 };
    attribute.chunks_mut(CHUNK).chain((0..missing).map(|_| <&mut [T]>::default())).collect()
}
