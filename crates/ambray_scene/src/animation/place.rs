//! Moves a scene to a pose.

use std::sync::Arc;

use ambray_core::light::Light;
use glam::{DAffine3, DVec3, Vec3};
use rayon::prelude::*;

use super::pose::single;
use super::{Attachment, Pose};
use crate::{Mesh, Scene, SceneCamera};

/// Vertices that a thread deforms at a time.
const CHUNK: usize = 4096;

impl Scene {
    /// Moves what nodes carry to `pose`, which is of this scene's rig: instances, shapes, cameras and lights. Cameras and
    /// lights that would lose their direction stay.
    ///
    /// Instances may become singular, such as those scaled to nothing: no ray hits them then.
    pub fn place(&mut self, pose: &Pose) {
        let Some(rig) = self.rig.clone() else { return };
        let world = |attachment: &Attachment| {
            attachment.node.map(|node| single(pose.world[node as usize] * attachment.local))
        };
        for (instance, attachment) in self.instances.iter_mut().zip(&rig.instances) {
            instance.world_from_object = world(attachment).unwrap_or(instance.world_from_object);
        }
        for (instance, attachment) in self.shape_instances.iter_mut().zip(&rig.shape_instances) {
            instance.world_from_object = world(attachment).unwrap_or(instance.world_from_object);
        }
        for (camera, &node) in self.cameras.iter_mut().zip(&rig.cameras) {
            place_camera(camera, pose.world[node as usize]);
        }
        for (light, &node) in self.lights.iter_mut().zip(&rig.lights) {
            place_light(light, pose.world[node as usize]);
        }
    }

    /// Bends the deforming meshes to `pose`, which is of this scene's rig, on all threads of the current pool. Meshes that
    /// other scenes share are copied first.
    pub fn deform(&mut self, pose: &Pose) {
        let Some(rig) = self.rig.clone() else { return };
        for (deformer, weights) in rig.deformers.iter().zip(&pose.weights) {
            let joints = deformer.skin.map_or(&[][..], |skin| &pose.joints[skin as usize]);
            let Mesh { positions, normals, tangents, .. } =
                Arc::make_mut(&mut self.meshes[deformer.mesh as usize]);
            // Chunks of an empty list are as good as none.
            let chunks = |count: usize| (0..count).step_by(CHUNK);
            let normals = slices(normals, positions.len());
            let tangents = slices(tangents, positions.len());
            let parts: Vec<_> =
                chunks(positions.len()).zip(positions.chunks_mut(CHUNK)).zip(normals).zip(tangents).collect();
            parts.into_par_iter().for_each(|(((first, positions), normals), tangents)| {
                for (i, position) in positions.iter_mut().enumerate() {
                    let vertex = deformer.vertex(first + i, weights, joints);
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
}

/// Chunks of an attribute of `count` vertices; empty ones if the mesh does not have it.
fn slices<T>(attribute: &mut [T], count: usize) -> impl Iterator<Item = &mut [T]> {
    let missing = if attribute.is_empty() { count.div_ceil(CHUNK) } else { 0 };
    attribute.chunks_mut(CHUNK).chain((0..missing).map(|_| <&mut [T]>::default()))
}

/// Puts `camera` where its node is; `false` if it would have no direction there, and then it stays.
pub(crate) fn place_camera(camera: &mut SceneCamera, world: DAffine3) -> bool {
    let (forward, up) = (direction(world, DVec3::NEG_Z), direction(world, DVec3::Y));
    let position = world.translation.as_vec3();
    let (Some(forward), Some(up), true) = (forward, up, position.is_finite()) else { return false };
    // Sheared nodes tilt one axis against the other.
    let up = up.reject_from_normalized(forward).try_normalize();
    let up = up.unwrap_or_else(|| forward.any_orthonormal_vector());
    (camera.position, camera.forward, camera.up) = (position, forward, up);
    true
}

/// Puts `light` where its node is; `false` if it would have no place or direction there, and then it stays.
pub(crate) fn place_light(light: &mut Light, world: DAffine3) -> bool {
    match light {
        Light::Directional { to_light, .. } => {
            direction(world, DVec3::Z).map(|direction| *to_light = direction).is_some()
        }
        Light::Point { position, cone, .. } => {
            let at = world.translation.as_vec3();
            let axis = direction(world, DVec3::NEG_Z);
            if !at.is_finite() || (cone.is_some() && axis.is_none()) {
                return false;
            }
            *position = at;
            if let (Some(cone), Some(axis)) = (cone, axis) {
                cone.axis = axis;
            }
            true
        }
    }
}

/// Unit image of `axis`, if it has a direction.
fn direction(world: DAffine3, axis: DVec3) -> Option<Vec3> {
    world.transform_vector3(axis).try_normalize().map(|direction| direction.as_vec3())
}
