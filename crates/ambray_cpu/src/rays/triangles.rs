//! What rays meet, as any tracer takes it: triangles in world space.

use std::sync::Arc;

use ambray_scene::{Instance, Material, Mesh, Scene};
use glam::{Affine3A, Vec3};

use crate::{AlphaTest, bvh::build::is_hittable};

/// The opaque triangles of a scene in world space, instance after instance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Corners.
    pub positions: Vec<Vec3>,
    /// Corners of each triangle, as indices.
    pub indices: Vec<[u32; 3]>,
}

/// What of a scene is not among its [`Triangles`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Triangles that the alpha test decides on.
    pub masked: u64,
    /// Placed shapes.
    pub shapes: u64,
}

impl Triangles {
    /// Those of `scene` that a ray can hit. Positions are those that a [`Tracer`](crate::Tracer) traces where it bakes.
    ///
    /// `None` if there are more than 2³² corners.
    #[must_use]
    pub fn of(scene: &Scene, alpha: &dyn AlphaTest) -> Option<(Self, LeftOut)> {
        let mut triangles = Self::default();
        let mut left_out = LeftOut { shapes: scene.shape_instances.len() as u64, ..LeftOut::default() };
        for instance in &scene.instances {
            let mesh = &scene.meshes[instance.mesh as usize];
            if !alpha.is_opaque(instance.mesh) {
                left_out.masked += mesh.triangles.len() as u64;
                continue;
            }
            let first = u32::try_from(triangles.positions.len()).ok()?;
            first.checked_add(u32::try_from(mesh.positions.len()).ok()?)?;
            let place = |&position: &Vec3| instance.world_from_object.transform_point3(position);
            triangles.positions.extend(mesh.positions.iter().map(place));
            let moved = mesh.triangles.iter().map(|corners| corners.map(|corner| first + corner));
            let positions = &triangles.positions;
            let is_hittable =
                |corners: &[u32; 3]| is_hittable(&corners.map(|corner| positions[corner as usize]));
            triangles.indices.extend(moved.filter(is_hittable));
        }
        Some((triangles, left_out))
    }

    /// A scene of nothing else.
    #[must_use]
    pub fn into_scene(self) -> Scene {
        let mesh = Mesh { positions: self.positions, triangles: self.indices, ..Mesh::default() };
        let instance = Instance { mesh: 0, world_from_object: Affine3A::IDENTITY, ..Instance::default() };
        Scene {
            meshes: vec![Arc::new(mesh)],
            instances: vec![instance],
            materials: vec![Material::default()],
            ..Scene::default()
        }
    }
}
