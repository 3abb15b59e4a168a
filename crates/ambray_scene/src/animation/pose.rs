//! A rig at one moment.

use glam::{Affine3A, DAffine3};

use super::rig::Local;
use super::{Rig, Skin};

/// Where everything is at one moment: all that moving a scene needs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// World from node, one for each of [`Rig::nodes`], in double precision so that long chains stay exact.
    pub world: Vec<DAffine3>,
    /// Joint matrices, world from bind space: a list for each of [`Rig::skins`], one for each of its joints.
    pub joints: Vec<Vec<Affine3A>>,
    /// Morph weights: a list for each of [`Rig::deformers`], one for each of its targets.
    pub weights: Vec<Vec<f32>>,
}

impl Pose {
    /// Follows the hierarchy of `rig` with these local transforms and morph weights, one each a node.
    pub(super) fn of(rig: &Rig, locals: &[Local], weights: &[Vec<f32>]) -> Self {
        let mut world: Vec<DAffine3> = Vec::with_capacity(locals.len());
        for (node, local) in rig.nodes.iter().zip(locals) {
            let local = local.matrix();
            world.push(node.parent.map_or(local, |parent| world[parent as usize] * local));
        }
        let joints = rig.skins.iter().map(|skin| skin.matrices(&world));
        let weights = rig.deformers.iter().map(|deformer| {
            let mut weights = weights[deformer.node as usize].clone();
            weights.resize(deformer.targets.len(), 0.0);
            weights
        });
        Self { joints: joints.collect(), weights: weights.collect(), world }
    }
}

impl Skin {
    /// Joint matrices, world from bind space, one a joint, for the nodes' places in the world.
    pub(crate) fn matrices(&self, world: &[DAffine3]) -> Vec<Affine3A> {
        let joints = self.joints.iter().zip(&self.inverse_binds);
        joints.map(|(&joint, bind)| single(world[joint as usize] * *bind)).collect()
    }
}

/// Rounds to single precision.
pub(crate) fn single(m: DAffine3) -> Affine3A {
    Affine3A { matrix3: m.matrix3.as_mat3().into(), translation: m.translation.as_vec3a() }
}
