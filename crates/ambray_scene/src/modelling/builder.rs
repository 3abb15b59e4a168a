//! Collects shapes, materials and placements into a [`Scene`].

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{Affine2, Vec2, Vec3, Vec4};

use super::pose::Pose;
use super::shapes::{Corner, Shape};
use crate::{Image, Instance, Material, Mesh, Sampler, Scene, Texture, TextureRef};

/// Cosine of the largest angle between faces that are shaded as one smooth surface (40°).
const CREASE_COSINE: f32 = 0.766;

/// A scene in the making.
#[derive(Debug, Default)]
pub(crate) struct Builder {
    pub(crate) scene: Scene,
}

/// Handle of a material.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MaterialId(u32);

/// Handle of a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshId(u32);

impl Builder {
    /// Adds an image; one repeat of it covers `size` metres.
    pub(crate) fn texture(&mut self, image: Image, size: f32) -> TextureRef {
        self.scene.images.push(Arc::new(image));
        let image = self.scene.images.len() as u32 - 1;
        self.scene.textures.push(Texture { image, sampler: Sampler::default() });
        let transform = Affine2::from_scale(Vec2::splat(1.0 / size));
        TextureRef { texture: image, uv_set: 0, transform }
    }

    /// Adds a material.
    pub(crate) fn material(&mut self, material: Material) -> MaterialId {
        self.scene.materials.push(material);
        MaterialId(self.scene.materials.len() as u32 - 1)
    }

    /// Adds a mesh with smooth normals, broken where faces meet at more than 40°.
    pub(crate) fn smooth(&mut self, name: &str, shape: &Shape, material: MaterialId) -> MeshId {
        self.mesh(name, shape, &smooth_normals(shape), material)
    }

    /// Adds a mesh of flat faces, without normals.
    pub(crate) fn flat(&mut self, name: &str, shape: &Shape, material: MaterialId) -> MeshId {
        self.mesh(name, shape, &[], material)
    }

    /// Places a mesh.
    pub(crate) fn place(&mut self, mesh: MeshId, pose: &Pose) {
        self.scene.instances.push(Instance {
            mesh: mesh.0,
            world_from_object: pose.affine(),
            ..Instance::default()
        });
    }

    /// Adds a smooth mesh that is there once, as it stands.
    pub(crate) fn smooth_once(&mut self, name: &str, shape: &Shape, material: MaterialId) {
        let mesh = self.smooth(name, shape, material);
        self.place(mesh, &Pose::at(Vec3::ZERO));
    }

    /// Adds a flat mesh that is there once, as it stands.
    pub(crate) fn flat_once(&mut self, name: &str, shape: &Shape, material: MaterialId) {
        let mesh = self.flat(name, shape, material);
        self.place(mesh, &Pose::at(Vec3::ZERO));
    }

    /// Shares equal vertices; `normals` holds one for each corner or nothing.
    fn mesh(&mut self, name: &str, shape: &Shape, normals: &[[Vec3; 3]], material: MaterialId) -> MeshId {
        let mut mesh = Mesh { name: name.to_owned(), material: material.0, ..Mesh::default() };
        let mut uvs = Vec::new();
        let mut vertices = BTreeMap::new();
        for (t, corners) in shape.triangles.iter().enumerate() {
            mesh.triangles.push(core::array::from_fn(|k| {
                let Corner { position, uv } = corners[k];
                let normal = normals.get(t).map_or(Vec3::ZERO, |n| n[k]);
                let key = (position.to_array(), normal.to_array(), uv.to_array());
                let bits = (key.0.map(f32::to_bits), key.1.map(f32::to_bits), key.2.map(f32::to_bits));
                *vertices.entry(bits).or_insert_with(|| {
                    mesh.positions.push(position);
                    uvs.push(uv);
                    if !normals.is_empty() {
                        mesh.normals.push(normal);
                    }
                    mesh.positions.len() as u32 - 1
                })
            }));
        }
        mesh.uvs = vec![uvs];
        if self.scene.materials[material.0 as usize].normal_texture.is_some() && !mesh.normals.is_empty() {
            mesh.tangents = tangents(&mesh);
        }
        self.scene.meshes.push(Arc::new(mesh));
        MeshId(self.scene.meshes.len() as u32 - 1)
    }
}

/// Normals of all corners: the mean over the faces that meet there at a gentle angle, weighted by area.
fn smooth_normals(shape: &Shape) -> Vec<[Vec3; 3]> {
    let faces: Vec<Vec3> = shape.triangles.iter().map(area_vector).collect();
    let units: Vec<Vec3> = faces.iter().map(|f| f.normalize()).collect();
    let place = |c: &Corner| (c.position + 0.0).to_array().map(f32::to_bits); // + 0.0 makes -0 and 0 the same
    let mut around: BTreeMap<[u32; 3], Vec<usize>> = BTreeMap::new();
    for (t, corners) in shape.triangles.iter().enumerate() {
        corners.iter().for_each(|c| around.entry(place(c)).or_default().push(t));
    }
    let normal = |t: usize, corner: &Corner| {
        let gentle = around[&place(corner)].iter().filter(|&&f| units[t].dot(units[f]) > CREASE_COSINE);
        gentle.map(|&f| faces[f]).sum::<Vec3>().normalize()
    };
    shape.triangles.iter().enumerate().map(|(t, c)| c.each_ref().map(|c| normal(t, c))).collect()
}

fn area_vector([a, b, c]: &[Corner; 3]) -> Vec3 {
    (b.position - a.position).cross(c.position - a.position)
}

/// Tangents along +u; the bitangent is the way up in the picture, -v, as in glTF.
fn tangents(mesh: &Mesh) -> Vec<Vec4> {
    let mut along_u = vec![Vec3::ZERO; mesh.positions.len()];
    let mut along_v = along_u.clone();
    for triangle in &mesh.triangles {
        let [p0, p1, p2] = triangle.map(|i| mesh.positions[i as usize]);
        let [t0, t1, t2] = triangle.map(|i| mesh.uvs[0][i as usize]);
        let (e1, e2, d1, d2) = (p1 - p0, p2 - p0, t1 - t0, t2 - t0);
        let side = if d1.perp_dot(d2) < 0.0 { -1.0 } else { 1.0 };
        for i in triangle {
            along_u[*i as usize] += (e1 * d2.y - e2 * d1.y) * side;
            along_v[*i as usize] += (e2 * d1.x - e1 * d2.x) * side;
        }
    }
    let tangent = |((&n, &u), &v): ((&Vec3, &Vec3), &Vec3)| {
        let t = (u - n * n.dot(u)).try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
        t.extend(if n.cross(t).dot(v) > 0.0 { -1.0 } else { 1.0 })
    };
    mesh.normals.iter().zip(&along_u).zip(&along_v).map(tangent).collect()
}
