//! Moves a scene to a pose.

use std::cell::OnceCell;
use std::sync::Arc;

use ambray_core::light::Light;
use glam::{Affine3A, DAffine3, DVec3, Mat3A, Vec3, Vec3A};

use super::pose::single;
use super::{Attachment, LARGEST_COORDINATE, Pose};
use crate::{Motion, Scene, SceneCamera};

impl Scene {
    /// Moves what nodes carry to `pose`, which is of this scene's rig: instances, shapes, cameras and lights. Cameras and
    /// lights that have no direction at `pose` are where they are at rest, whatever was shown before.
    ///
    /// Instances may become singular, such as those scaled to nothing: no ray hits them then. Those whose transform has a
    /// number beyond [`LARGEST_COORDINATE`] are scaled to nothing at the origin.
    pub fn place(&mut self, pose: &Pose) {
        let Some(rig) = self.rig.clone() else { return };
        let place = |world_from_object: &mut Affine3A, motion: Motion, attachment: &Attachment| {
            if let Some(node) = attachment.node.filter(|_| motion != Motion::Static) {
                *world_from_object = placed(pose.world[node as usize] * attachment.local);
            }
        };
        for (instance, attachment) in self.instances.iter_mut().zip(&rig.instances) {
            place(&mut instance.world_from_object, instance.motion, attachment);
        }
        for (instance, attachment) in self.shape_instances.iter_mut().zip(&rig.shape_instances) {
            place(&mut instance.world_from_object, instance.motion, attachment);
        }
        let rest = OnceCell::new();
        let at_rest = |node: u32| rest.get_or_init(|| rig.pose(None)).world[node as usize];
        for (camera, &node) in self.cameras.iter_mut().zip(&rig.cameras) {
            let _ = place_camera(camera, pose.world[node as usize]) || place_camera(camera, at_rest(node));
        }
        for (light, &node) in self.lights.iter_mut().zip(&rig.lights) {
            let _ = place_light(light, pose.world[node as usize]) || place_light(light, at_rest(node));
        }
    }

    /// Bends the deforming meshes to `pose`, which is of this scene's rig, on all threads of the current pool. Meshes that
    /// other scenes share are copied first.
    pub fn deform(&mut self, pose: &Pose) {
        let Some(rig) = self.rig.clone() else { return };
        for (deformer, weights) in rig.deformers.iter().zip(&pose.weights) {
            let joints = deformer.skin.map_or(&[][..], |skin| &pose.joints[skin as usize]);
            deformer.bend(Arc::make_mut(&mut self.meshes[deformer.mesh as usize]), weights, joints);
        }
    }
}

/// `world` in single precision, or nothing at the origin where numbers are out of range.
pub(crate) fn placed(world: DAffine3) -> Affine3A {
    const HIDDEN: Affine3A = Affine3A { matrix3: Mat3A::ZERO, translation: Vec3A::ZERO };
    let largest = f64::from(LARGEST_COORDINATE);
    let within = world.to_cols_array().iter().all(|number| number.abs() <= largest);
    if within { single(world) } else { HIDDEN }
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

#[cfg(test)]
mod tests {
    use ambray_core::camera::Projection;

    use super::*;
    use crate::animation::{Channel, Clip, Clips, Interpolation, Local, Moment, Node, Property, Rig, Trs};

    /// A camera and a sun turn with their node, which has no size from 1 s on.
    fn scene() -> Scene {
        let mut scene = Scene::default();
        scene.cameras.push(SceneCamera {
            name: String::new(),
            position: Vec3::ZERO,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            projection: Projection::Orthographic { height: 1.0 },
        });
        scene.lights.push(Light::Directional { to_light: Vec3::Z, irradiance: Vec3::ONE });
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let channel = |property, interpolation, values: Vec<f32>| Channel {
            node: 0,
            property,
            interpolation,
            times: vec![0.0, 1.0],
            values,
        };
        let turn = vec![0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half];
        let channels = vec![
            channel(Property::Rotation, Interpolation::Linear, turn),
            channel(Property::Scale, Interpolation::Step, vec![1.0, 1.0, 1.0, 0.0, 0.0, 0.0]),
        ];
        scene.rig = Some(Arc::new(Rig {
            nodes: vec![Node {
                name: String::new(),
                parent: None,
                local: Local::Trs(Trs::default()),
                weights: Vec::new(),
            }],
            clips: vec![Clip { name: String::new(), duration: 1.0, channels }],
            cameras: vec![0],
            lights: vec![0],
            ..Rig::default()
        }));
        scene
    }

    #[test]
    fn what_loses_its_direction_does_not_remember_others() {
        let rest = scene();
        let place = |scene: &mut Scene, time: f64| {
            let rig = scene.rig.clone().unwrap();
            scene.place(&rig.pose(Some(&Moment { clips: Clips::One(0), time, repeat: false })));
        };
        let mut direct = scene();
        place(&mut direct, 1.0);
        let mut by_another = scene();
        place(&mut by_another, 0.7);
        assert!(by_another.cameras[0].forward.x < -0.5, "{}", by_another.cameras[0].forward);
        place(&mut by_another, 1.0);
        assert_eq!((&direct.cameras, &direct.lights), (&rest.cameras, &rest.lights));
        assert_eq!((&by_another.cameras, &by_another.lights), (&rest.cameras, &rest.lights));
    }
}
