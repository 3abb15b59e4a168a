//! The scene as the backends see it: flat lists that refer to each other by index.

use ambray_core::light::Light;
use glam::{Affine3A, Vec3};

use crate::{Image, Material, Mesh, Texture};

/// Everything that can be rendered. Instances share meshes, meshes share materials, textures share images.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// File stem or built-in name.
    pub name: String,
    /// Meshes in object space.
    pub meshes: Vec<Mesh>,
    /// Placed meshes.
    pub instances: Vec<Instance>,
    /// Materials; never empty if there are meshes.
    pub materials: Vec<Material>,
    /// Images with samplers.
    pub textures: Vec<Texture>,
    /// Decoded images.
    pub images: Vec<Image>,
    /// The file's own lights, world space.
    pub lights: Vec<Light>,
    /// The file's own cameras, world space.
    pub cameras: Vec<SceneCamera>,
    /// Ambient radiance that the scene was made for, linear RGB.
    pub ambient: Option<Vec3>,
    /// Near-field radius that the scene was made for, scene units.
    pub radius: Option<f32>,
}

/// A mesh placed in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Placement; may mirror, must be invertible.
    pub world_from_object: Affine3A,
}

/// A camera of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneCamera {
    /// Name of the camera or its node, may be empty.
    pub name: String,
    /// Position, world space.
    pub position: Vec3,
    /// Unit viewing direction.
    pub forward: Vec3,
    /// Unit vector up in the picture, orthogonal to `forward`.
    pub up: Vec3,
    /// Full vertical angle of view in radians, or height of an orthographic view.
    pub projection: ambray_core::camera::Projection,
}

impl Scene {
    /// Number of triangles, instances counted each time.
    #[must_use]
    pub fn triangle_count(&self) -> u64 {
        self.instances.iter().map(|i| self.meshes[i.mesh as usize].triangles.len() as u64).sum()
    }

    /// Smallest box around all instances, world space; `None` if nothing is there.
    #[must_use]
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let points = self.instances.iter().flat_map(|instance| {
            let mesh = &self.meshes[instance.mesh as usize];
            mesh.triangles
                .iter()
                .flatten()
                .map(move |&i| instance.world_from_object.transform_point3(mesh.positions[i as usize]))
        });
        points.fold(None, |bounds, p| {
            Some(bounds.map_or((p, p), |(lo, hi): (Vec3, Vec3)| (lo.min(p), hi.max(p))))
        })
    }
}
