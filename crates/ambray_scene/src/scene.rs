//! The scene as the backends see it: flat lists that refer to each other by index.

use std::sync::Arc;

use ambray_core::{light::Light, shape::Shape};
use glam::{Affine3A, Vec3};

use crate::animation::Rig;
use crate::{Image, Material, Mesh, Motion, Texture};

/// Everything that can be rendered. Instances share meshes, meshes share materials, textures share images.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// File stem or built-in name.
    pub name: String,
    /// Meshes in object space. Scenes at different moments share those that do not deform.
    pub meshes: Vec<Arc<Mesh>>,
    /// Placed meshes.
    pub instances: Vec<Instance>,
    /// Shapes given by formulas, in object space.
    pub shapes: Vec<Shape>,
    /// Placed shapes. In hits they are numbered after all of [`instances`](Self::instances).
    pub shape_instances: Vec<ShapeInstance>,
    /// Materials; never empty if there are meshes or placed shapes.
    pub materials: Vec<Material>,
    /// Images with samplers.
    pub textures: Vec<Texture>,
    /// Decoded images.
    pub images: Vec<Arc<Image>>,
    /// The file's own lights, world space.
    pub lights: Vec<Light>,
    /// The file's own cameras, world space.
    pub cameras: Vec<SceneCamera>,
    /// Ambient radiance that the scene was made for, linear RGB.
    pub ambient: Option<Vec3>,
    /// Near-field radius that the scene was made for, scene units.
    pub radius: Option<f32>,
    /// How the scene moves; `None` if it does not.
    pub rig: Option<Arc<Rig>>,
}

/// A mesh placed in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instance {
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Placement; may mirror. What moves may be singular for a while: no ray hits it then.
    pub world_from_object: Affine3A,
    /// What the file's animations do to it.
    pub motion: Motion,
}

/// A shape placed in the world. A hit on the i-th one has the instance `instances.len() + i`, triangle 0 and u = v = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShapeInstance {
    /// Index into [`Scene::shapes`].
    pub shape: u32,
    /// Index into [`Scene::materials`]. Shapes have no texture coordinates: textures are not read.
    pub material: u32,
    /// Placement; may mirror. What moves may be singular for a while: no ray hits it then.
    pub world_from_object: Affine3A,
    /// What the file's animations do to it.
    pub motion: Motion,
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

    /// Takes away all instances whose materials are masked or blended. Nothing that moves stays in the rig's care then: the
    /// scene stands still.
    pub fn remove_transparent(&mut self) {
        let is_opaque =
            |material: u32| self.materials[material as usize].alpha_mode == crate::AlphaMode::Opaque;
        let (meshes, instances) = (&self.meshes, std::mem::take(&mut self.instances));
        let kept = instances.into_iter().filter(|i| is_opaque(meshes[i.mesh as usize].material));
        let instances: Vec<_> = kept.collect();
        let shapes = self.shape_instances.iter().copied().filter(|shape| is_opaque(shape.material)).collect();
        (self.instances, self.shape_instances) = (instances, shapes);
        self.rig = None;
    }

    /// Smallest box around all instances, world space; `None` if nothing is there. Shapes count with the corners of their
    /// own box, points that are not finite do not count.
    #[must_use]
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let points = self.instances.iter().flat_map(|instance| {
            let mesh = &self.meshes[instance.mesh as usize];
            mesh.triangles
                .iter()
                .flatten()
                .map(move |&i| instance.world_from_object.transform_point3(mesh.positions[i as usize]))
        });
        let of_shapes = self.shape_instances.iter().flat_map(|instance| {
            let corners = box_corners(self.shapes[instance.shape as usize].bounds());
            corners.map(|corner| instance.world_from_object.transform_point3(corner))
        });
        points.chain(of_shapes).filter(|p| p.is_finite()).fold(None, |bounds, p| {
            Some(bounds.map_or((p, p), |(lo, hi): (Vec3, Vec3)| (lo.min(p), hi.max(p))))
        })
    }

    /// The shape that instance `index` of a hit is, or `None` if it is a mesh.
    ///
    /// # Panics
    /// If there is no such instance.
    #[must_use]
    pub fn shape_instance(&self, index: u32) -> Option<&ShapeInstance> {
        let index = (index as usize).checked_sub(self.instances.len())?;
        Some(&self.shape_instances[index])
    }
}

/// Corners of a box given by its lower and upper one.
pub(crate) fn box_corners((low, high): (Vec3, Vec3)) -> [Vec3; 8] {
    let pick = |i: usize, bit: usize, low: f32, high: f32| if i >> bit & 1 == 0 { low } else { high };
    std::array::from_fn(|i| {
        Vec3::new(pick(i, 0, low.x, high.x), pick(i, 1, low.y, high.y), pick(i, 2, low.z, high.z))
    })
}
