//! Triangle meshes.

use glam::{Vec2, Vec3, Vec4};

/// Indexed triangles of one material, in object space: one glTF primitive.
///
/// Every attribute present has one entry a vertex; every index is below `positions.len()`; positions are finite. [`Mesh::validate`] checks this.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Name in the file, may be empty.
    pub name: String,
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Unit vertex normals; empty for flat shading.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the bitangent's sign in w; empty if there are none.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates, one list a UV set.
    pub uvs: Vec<Vec<Vec2>>,
    /// Linear RGBA vertex colours; empty for white.
    pub colors: Vec<Vec4>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Index into [`Scene::materials`](crate::Scene::materials).
    pub material: u32,
}

impl Mesh {
    /// Corners of triangle `triangle`, object space.
    #[must_use]
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|i| self.positions[i as usize])
    }

    /// Checks the invariants of the type; the error says which one is broken.
    pub fn validate(&self) -> Result<(), String> {
        let count = self.positions.len();
        let lengths = [
            ("normals", self.normals.len()),
            ("tangents", self.tangents.len()),
            ("colors", self.colors.len()),
        ];
        for (name, len) in lengths {
            if len != 0 && len != count {
                return Err(format!("{len} {name} for {count} positions"));
            }
        }
        if let Some(set) = self.uvs.iter().position(|uv| uv.len() != count) {
            return Err(format!(
                "{} texture coordinates in set {set} for {count} positions",
                self.uvs[set].len()
            ));
        }
        if let Some(triangle) = self.triangles.iter().position(|t| t.iter().any(|&i| i as usize >= count)) {
            return Err(format!("triangle {triangle} refers to a vertex beyond the {count} there are"));
        }
        if let Some(vertex) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(format!("position {vertex} is not finite"));
        }
        Ok(())
    }
}
