//! Albedos of whole batches of hits: what bounced light asks for most.

use std::sync::Arc;

use ambray_core::trace::{Hit, Ray};
use glam::Vec3;
use rayon::prelude::*;

use super::{
    Surfaces,
    at::{Mapping, Placed},
    weigh,
};
use crate::{
    Instance, Material, MaterialKind, Mesh, Motion, Scene, Texture,
    texture::{Looks, PreparedImage, PreparedTexture},
};

/// Placed triangles whose [`Edges`] are kept, at most: 64 MB.
const EDGES: usize = 16_000_000;

/// What the albedos of a scene take, ready to be read.
#[derive(Debug)]
pub(super) struct Albedos {
    /// One an instance, shapes after meshes.
    paints: Vec<Paint>,
}

/// What the albedo at a point of an instance takes.
#[derive(Debug)]
enum Paint {
    /// Nothing.
    Uniform(Vec3),
    /// A look into a texture.
    Textured { base: Vec3, texture: Arc<PreparedTexture>, mapping: Arc<[Mapping]>, edges: Edges },
    /// All that [`Surfaces::diffuse_at`] computes: checkers, vertex colours, what moves.
    ByPoint,
}

/// Root of twice the area of each placed triangle, world space; infinite where it has none.
type Edges = Box<[f32]>;

impl Albedos {
    /// Prepares what is read through `surfaces`.
    pub(super) fn new(surfaces: &Surfaces) -> Self {
        let scene = &*surfaces.scene;
        let is_read = meshes_read(scene);
        let textures = textures(scene, &is_read);
        let mappings: Vec<Option<Arc<[Mapping]>>> = (scene.meshes.par_iter().zip(&is_read))
            .map(|(mesh, is_read)| is_read.then(|| mapping(mesh, &scene.materials[mesh.material as usize])))
            .collect();

        let mut left = EDGES;
        let mut affordable = |instance: &Instance| {
            let mesh = instance.mesh as usize;
            let triangles = scene.meshes[mesh].triangles.len();
            let is = mappings[mesh].is_some() && instance.motion == Motion::Static && triangles <= left;
            left -= if is { triangles } else { 0 };
            is
        };
        let affordable: Vec<bool> = scene.instances.iter().map(&mut affordable).collect();
        let of_mesh = |(i, instance): (usize, &Instance)| {
            let mesh = &scene.meshes[instance.mesh as usize];
            let material = &scene.materials[mesh.material as usize];
            match (&textures[mesh.material as usize], &mappings[instance.mesh as usize]) {
                (Some(texture), Some(mapping)) if affordable[i] => Paint::Textured {
                    base: material.base_color.truncate(),
                    texture: Arc::clone(texture),
                    mapping: Arc::clone(mapping),
                    edges: mesh.triangles.iter().map(|&corners| edge(surfaces, i, corners)).collect(),
                },
                _ if mesh.colors.is_empty() && !is_textured(material) => plain(material),
                _ => Paint::ByPoint,
            }
        };
        let meshes = scene.instances.par_iter().enumerate().map(of_mesh);
        let shapes = scene.shape_instances.par_iter();
        let shapes = shapes.map(|shape| plain(&scene.materials[shape.material as usize]));
        Self { paints: meshes.chain(shapes).collect() }
    }
}

impl Surfaces {
    /// Prepares the tables of [`albedos_at`](Self::albedos_at), for these surfaces and those that are
    /// [moved](Self::moved_to) from them. Done once: it decodes textures and looks at each triangle, in parallel.
    pub fn prepare_albedos(&self) {
        if self.albedos.get().is_none() {
            // Made before it is put there: a thread that waits for others within may come here once more.
            let _ = self.albedos.set(Albedos::new(self));
        }
    }

    /// Albedos at the `hits` of `rays`, each averaged over a footprint of `cone` times its distance: the bits of
    /// [`diffuse_at`](Self::diffuse_at). For a fraction of its time after [`prepare_albedos`](Self::prepare_albedos), else
    /// point by point. Zero for misses.
    ///
    /// # Panics
    /// If the lengths differ.
    #[inline(always)]
    pub fn albedos_at(&self, rays: &[Ray], hits: &[Hit], cone: f32, albedos: &mut [Vec3]) {
        assert!(rays.len() == hits.len() && hits.len() == albedos.len(), "one albedo for each hit");
        let Some(Albedos { paints }) = self.albedos.get() else {
            return self.albedos_by_point(rays, hits, cone, albedos);
        };
        let mut looks = Looks::new();
        for (i, hit) in hits.iter().enumerate() {
            albedos[i] = match paints.get(hit.instance as usize) {
                None => Vec3::ZERO,
                Some(Paint::Uniform(albedo)) => *albedo,
                Some(Paint::Textured { base, texture, mapping, edges }) => {
                    let triangle = hit.triangle as usize;
                    let (mapping, edge) = (&mapping[triangle], edges[triangle]);
                    let uv = weigh(mapping.uvs, [1.0 - hit.u - hit.v, hit.u, hit.v]);
                    looks.push(texture, uv, hit.t * cone / edge * mapping.edge, i as u32);
                    *base
                }
                Some(Paint::ByPoint) => self.diffuse_at(&rays[i], hit, hit.t * cone).albedo,
            };
            if looks.is_full() || i + 1 == hits.len() {
                looks.take(|i, value| albedos[i as usize] *= value.truncate());
            }
        }
    }

    /// [`albedos_at`](Self::albedos_at) without tables.
    #[inline(never)]
    fn albedos_by_point(&self, rays: &[Ray], hits: &[Hit], cone: f32, albedos: &mut [Vec3]) {
        for ((ray, hit), albedo) in rays.iter().zip(hits).zip(albedos) {
            let is_hit = hit.is_hit();
            *albedo = if is_hit { self.diffuse_at(ray, hit, hit.t * cone).albedo } else { Vec3::ZERO };
        }
    }
}

/// Whether the base colour of `material` is read from a texture.
fn is_textured(material: &Material) -> bool {
    material.base_color_texture.is_some() && material.kind() != MaterialKind::Checker
}

/// Which meshes are read through prepared textures: those that have nothing but a texture to read, and are seen where they
/// always are.
fn meshes_read(scene: &Scene) -> Vec<bool> {
    let mut is_read = vec![false; scene.meshes.len()];
    for instance in scene.instances.iter().filter(|instance| instance.motion == Motion::Static) {
        let mesh = &scene.meshes[instance.mesh as usize];
        is_read[instance.mesh as usize] =
            mesh.colors.is_empty() && is_textured(&scene.materials[mesh.material as usize]);
    }
    is_read
}

/// The base colour textures of the materials of the meshes that are read. Each image is decoded once, since a file may have
/// millions of materials of one image, and only if it is read.
fn textures(scene: &Scene, is_read: &[bool]) -> Vec<Option<Arc<PreparedTexture>>> {
    let mut read: Vec<Option<Texture>> = vec![None; scene.materials.len()];
    let mut is_decoded = vec![false; scene.images.len()];
    for (mesh, _) in scene.meshes.iter().zip(is_read).filter(|(_, is_read)| **is_read) {
        let texture = scene.materials[mesh.material as usize].base_color_texture;
        let texture = texture.map(|texture| scene.textures[texture.texture as usize]);
        read[mesh.material as usize] = texture;
        texture.iter().for_each(|texture| is_decoded[texture.image as usize] = true);
    }
    let images = scene.images.par_iter().zip(is_decoded);
    let images: Vec<Option<PreparedImage>> =
        images.map(|(image, is_decoded)| is_decoded.then(|| PreparedImage::new(image))).collect();
    let prepare = |texture: Texture| {
        let image = images[texture.image as usize].as_ref()?;
        Some(Arc::new(PreparedTexture::new(image, &texture.sampler)))
    };
    read.into_iter().map(|texture| texture.and_then(prepare)).collect()
}

/// The paint of a material where no texture is read.
fn plain(material: &Material) -> Paint {
    if material.kind() == MaterialKind::Checker {
        Paint::ByPoint
    } else {
        Paint::Uniform(material.base_color.truncate())
    }
}

/// Where the triangles of `mesh` are in the base colour texture of `material`, which has one.
fn mapping(mesh: &Mesh, material: &Material) -> Arc<[Mapping]> {
    let texture = material.base_color_texture.as_ref().expect("only meshes that read one are mapped");
    mesh.triangles.iter().map(|&corners| Mapping::new(mesh, texture, corners)).collect()
}

/// Root of twice the area of a triangle of `instance`, infinite if it has none.
fn edge(surfaces: &Surfaces, instance: usize, corners: [u32; 3]) -> f32 {
    let scene: &Scene = &surfaces.scene;
    let (placement, frame) = (&scene.instances[instance], &surfaces.frames[instance]);
    let placed = Placed::new(placement, &scene.meshes[placement.mesh as usize], corners);
    if placed.normal(frame.side).is_finite() { placed.edge() } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Image, Sampler, TextureRef, Wrap};
    use glam::{Affine2, Vec2};

    /// Meshes with a material each, and one more that no mesh has; each material reads the one image through a texture of its
    /// own. One of the meshes has no instance.
    fn scene(count: u32) -> Scene {
        let image = Image::new(String::new(), 64, 64, vec![[7, 8, 9, 255]; 64 * 64], true);
        let wrap = |i: u32| if i.is_multiple_of(2) { Wrap::Repeat } else { Wrap::Clamp };
        let texture = |i| Texture { image: 0, sampler: Sampler { wrap: [wrap(i); 2], ..Sampler::default() } };
        let material = |texture| Material {
            base_color_texture: Some(TextureRef { texture, uv_set: 0, transform: Affine2::IDENTITY }),
            ..Material::default()
        };
        let mesh = |material| {
            Arc::new(Mesh {
                positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
                uvs: vec![vec![Vec2::ZERO, Vec2::X, Vec2::Y]],
                triangles: vec![[0, 1, 2]],
                material,
                ..Mesh::default()
            })
        };
        Scene {
            meshes: (0..count).map(mesh).collect(),
            instances: (1..count).map(|mesh| Instance { mesh, ..Instance::default() }).collect(),
            materials: (0..=count).map(material).collect(),
            textures: (0..=count).map(texture).collect(),
            images: vec![Arc::new(image)],
            ..Scene::default()
        }
    }

    #[test]
    fn an_image_is_decoded_once_for_all_materials_that_are_seen() {
        let scene = scene(100);
        let textures = textures(&scene, &meshes_read(&scene));
        let is_prepared: Vec<bool> = textures.iter().map(Option::is_some).collect();
        let is_seen: Vec<bool> = (0..=100).map(|material| (1..100).contains(&material)).collect();
        assert_eq!(is_prepared, is_seen);
        share_texels(&textures.iter().flatten().collect::<Vec<_>>());

        let Albedos { paints } = Albedos::new(&Surfaces::new(Arc::new(scene)));
        let read = paints.iter().map(|paint| match paint {
            Paint::Textured { texture, .. } => texture,
            other => panic!("{other:?} reads no texture"),
        });
        share_texels(&read.collect::<Vec<_>>());
    }

    #[track_caller]
    fn share_texels(textures: &[&Arc<PreparedTexture>]) {
        assert_eq!(textures.len(), 99);
        assert!(textures.iter().all(|texture| texture.shares_texels(textures[0])));
    }

    #[test]
    fn tables_are_made_when_they_are_asked_for() {
        let surfaces = Surfaces::new(Arc::new(scene(2)));
        assert!(surfaces.albedos.get().is_none());
        let moved = surfaces.moved_to(Arc::clone(surfaces.scene()));
        moved.prepare_albedos();
        assert!(surfaces.albedos.get().is_some());
    }
}
