//! Albedos of whole batches of hits: what bounced light asks for most.

use std::sync::Arc;

use ambray_core::trace::{Hit, Ray};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::{
    Surfaces,
    at::{Mapping, Placed},
    weigh,
};
use crate::{
    Instance, Material, MaterialKind, Mesh, Motion, Scene,
    texture::{Place, PreparedTexture},
};

/// Placed triangles whose [`Edges`] are kept, at most: 64 MB.
const EDGES: usize = 16_000_000;

/// What the albedos of a scene take, ready to be read.
#[derive(Debug, Default)]
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
        let is_textured = |material: &Material| {
            material.base_color_texture.is_some() && material.kind() != MaterialKind::Checker
        };
        let textures: Vec<Option<Arc<PreparedTexture>>> = scene
            .materials
            .par_iter()
            .map(|material| {
                let texture = material.base_color_texture.filter(|_| is_textured(material))?;
                let read = scene.textures[texture.texture as usize];
                Some(Arc::new(PreparedTexture::new(&scene.images[read.image as usize], read.sampler)))
            })
            .collect();
        let prepared =
            |mesh: &Arc<Mesh>| mesh.colors.is_empty() && textures[mesh.material as usize].is_some();
        let mappings: Vec<Option<Arc<[Mapping]>>> = scene
            .meshes
            .par_iter()
            .map(|mesh| prepared(mesh).then(|| mapping(mesh, &scene.materials[mesh.material as usize])))
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
                (None, _) if mesh.colors.is_empty() => plain(material),
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
    /// Albedos at the `hits` of `rays`, each averaged over a footprint of `cone` times its distance: the bits of
    /// [`diffuse_at`](Self::diffuse_at), for a fraction of the time. Zero for misses.
    ///
    /// # Panics
    /// If the lengths differ.
    #[inline(always)]
    pub fn albedos_at(&self, rays: &[Ray], hits: &[Hit], cone: f32, albedos: &mut [Vec3]) {
        assert!(rays.len() == hits.len() && hits.len() == albedos.len(), "one albedo for each hit");
        let mut lookups: Vec<Lookup<'_>> = Vec::with_capacity(BLOCK);
        let blocks = rays.chunks(BLOCK).zip(hits.chunks(BLOCK)).zip(albedos.chunks_mut(BLOCK));
        for ((rays, hits), albedos) in blocks {
            // Triangles first, then places, then texels: so many are on their way from memory at once.
            lookups.clear();
            for (i, hit) in hits.iter().enumerate() {
                albedos[i] = match self.albedos.paints.get(hit.instance as usize) {
                    None => Vec3::ZERO,
                    Some(Paint::Uniform(albedo)) => *albedo,
                    Some(Paint::Textured { base, texture, mapping, edges }) => {
                        let triangle = hit.triangle as usize;
                        let (mapping, edge) = (&mapping[triangle], edges[triangle]);
                        let uv = weigh(mapping.uvs, [1.0 - hit.u - hit.v, hit.u, hit.v]);
                        let width = hit.t * cone / edge * mapping.edge;
                        lookups.push(Lookup { i, uv, width, texture, place: Place::Value(Vec4::ZERO) });
                        *base
                    }
                    Some(Paint::ByPoint) => self.diffuse_at(&rays[i], hit, hit.t * cone).albedo,
                };
            }
            for lookup in &mut lookups {
                lookup.place = lookup.texture.locate(lookup.uv, lookup.width);
            }
            for Lookup { i, texture, place, .. } in &lookups {
                albedos[*i] *= texture.value(place).truncate();
            }
        }
    }
}

/// A look into a texture, for hit `i` of a block.
struct Lookup<'a> {
    i: usize,
    uv: Vec2,
    width: f32,
    texture: &'a PreparedTexture,
    /// Found after `uv` and `width`.
    place: Place,
}

/// Hits that are worked on at once.
const BLOCK: usize = 64;

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
