//! Alpha tests of meshes, ready to be answered: rays ask one at a time, about any triangle.

use std::sync::Arc;

use ambray_core::trace::alpha_threshold;
use glam::{Affine2, Vec2};
use rayon::prelude::*;

use super::{mesh_uvs, weigh};
use crate::{
    AlphaMode, Mesh, Scene,
    texture::{AlphaPlane, Mask},
};

/// A mesh that rays see in part, by the alpha of a texture.
#[derive(Debug)]
pub(super) struct Cutout {
    alpha_mode: AlphaMode,
    /// Alpha of the base colour.
    base: f32,
    /// Texture coordinates of the corners of each triangle, as the mesh has them.
    uvs: Box<[[Vec2; 3]]>,
    /// From these to those of the texture.
    transform: Affine2,
    mask: Mask,
}

impl Cutout {
    /// Whether a ray with this `seed` sees the point of a `triangle` of `instance`.
    #[inline(always)]
    pub(super) fn accepts(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool {
        let uv = weigh(self.uvs[triangle as usize], [1.0 - u - v, u, v]);
        let alpha = self.base * self.mask.at(self.transform.transform_point2(uv));
        match self.alpha_mode {
            AlphaMode::Opaque => true,
            AlphaMode::Mask(cutoff) => alpha >= cutoff,
            AlphaMode::Blend => alpha > alpha_threshold(seed, instance, triangle),
        }
    }
}

/// The cutouts of the meshes of `scene` that are not `opaque`; none of those that have vertex colours or no texture.
pub(super) fn cutouts(scene: &Scene, opaque: &[bool]) -> Arc<[Option<Cutout>]> {
    let texture_of = |mesh: &Mesh| {
        let texture = scene.materials[mesh.material as usize].base_color_texture.as_ref()?;
        mesh.colors.is_empty().then_some((texture, scene.textures[texture.texture as usize]))
    };
    let mut is_read = vec![false; scene.images.len()];
    for (mesh, _) in scene.meshes.iter().zip(opaque).filter(|(_, is_opaque)| !**is_opaque) {
        texture_of(mesh).iter().for_each(|(_, read)| is_read[read.image as usize] = true);
    }
    let planes = scene.images.par_iter().zip(is_read);
    let planes: Vec<Option<AlphaPlane>> =
        planes.map(|(image, is_read)| is_read.then(|| AlphaPlane::of(image))).collect();
    let cutout = |(mesh, is_opaque): (&Arc<Mesh>, &bool)| {
        let (texture, read) = texture_of(mesh).filter(|_| !is_opaque)?;
        let material = &scene.materials[mesh.material as usize];
        Some(Cutout {
            alpha_mode: material.alpha_mode,
            base: material.base_color.w,
            uvs: mesh.triangles.iter().map(|&corners| mesh_uvs(mesh, texture, corners)).collect(),
            transform: texture.transform,
            mask: Mask::new(planes[read.image as usize].as_ref()?, &read.sampler),
        })
    };
    scene.meshes.par_iter().zip(opaque).map(cutout).collect::<Vec<_>>().into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{atrium::atrium, surface::Surfaces};
    use ambray_core::sampling::{pcg, unit_float};

    #[test]
    fn cutouts_accept_what_their_materials_do() {
        let surfaces = Surfaces::new(Arc::new(atrium()));
        let (scene, mut seen) = (surfaces.scene(), [0; 2]);
        for (i, instance) in scene.instances.iter().enumerate() {
            let mesh = instance.mesh as usize;
            if surfaces.cutouts[mesh].is_none() {
                continue;
            }
            let triangles = scene.meshes[mesh].triangles.len() as u32;
            for k in 0..200 {
                let random = |dimension: u32| pcg(k ^ pcg(dimension ^ pcg(i as u32)));
                let (u, instance, triangle) = (unit_float(random(1)), i as u32, random(2) % triangles);
                let (v, seed) = ((1.0 - u) * unit_float(random(3)), random(4));
                let is_seen = surfaces.accepts(instance, triangle, u, v, seed);
                assert_eq!(is_seen, surfaces.accepts_by_material(instance, triangle, u, v, seed));
                seen[usize::from(is_seen)] += 1;
            }
        }
        assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
    }
}
