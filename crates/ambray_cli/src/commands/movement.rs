//! What moves in a scene, for `ambray info`.

use ambray::scene::{
    Motion, Scene,
    animation::{Clip, Deformer, Property, Rig},
};
use serde::Serialize;

use super::info::{entries, named};
use crate::report::{counted, grouped};

/// What moves in a scene.
#[derive(Debug, Default, Serialize)]
pub(super) struct Movement {
    animations: Vec<AnimationInfo>,
    deforming_meshes: Vec<DeformingInfo>,
    skins: Vec<SkinInfo>,
    /// Instances that move, turn or scale as wholes, shapes too.
    rigid_instances: usize,
    /// Instances whose vertices move against each other.
    deforming_instances: usize,
}

/// An animation of the file; its place in the list is its number.
#[derive(Debug, Serialize)]
struct AnimationInfo {
    name: String,
    duration_s: f32,
    channels: usize,
    /// Keyframes of all channels.
    keyframes: usize,
    /// Nodes that each property moves.
    moves: Vec<MovesInfo>,
}

#[derive(Debug, Serialize)]
struct MovesInfo {
    property: &'static str,
    nodes: usize,
}

/// A mesh whose vertices move against each other.
#[derive(Debug, Serialize)]
struct DeformingInfo {
    /// Its number in the list of meshes.
    mesh: u32,
    name: String,
    vertices: usize,
    /// Joints of its skin; null without one.
    joints: Option<usize>,
    influences_per_vertex: usize,
    morph_targets: usize,
}

#[derive(Debug, Serialize)]
struct SkinInfo {
    joints: usize,
    /// Deforming meshes that follow it.
    meshes: usize,
}

impl Movement {
    /// What moves in `scene`; nothing without a rig.
    pub(super) fn of(scene: &Scene) -> Self {
        let Some(rig) = &scene.rig else { return Self::default() };
        let motions = scene.instances.iter().map(|instance| instance.motion);
        let motions = motions.chain(scene.shape_instances.iter().map(|instance| instance.motion));
        let count = |motion| motions.clone().filter(|&found| found == motion).count();
        let skins = rig.skins.iter().enumerate().map(|(i, skin)| SkinInfo {
            joints: skin.joints.len(),
            meshes: rig.deformers.iter().filter(|deformer| deformer.skin == Some(i as u32)).count(),
        });
        Self {
            animations: rig.clips.iter().map(animation).collect(),
            deforming_meshes: rig.deformers.iter().map(|deformer| deforming(deformer, rig, scene)).collect(),
            skins: skins.collect(),
            rigid_instances: count(Motion::Rigid),
            deforming_instances: count(Motion::Deforming),
        }
    }

    /// For people: pairs of a heading, which may be empty, and what follows it.
    pub(super) fn lines(&self) -> Vec<(&'static str, String)> {
        if self.animations.is_empty() {
            return Vec::new();
        }
        let mut lines = vec![("animated", counted(self.animations.len() as u64, "animation"))];
        let numbered: Vec<_> = self.animations.iter().enumerate().collect();
        lines.extend(entries(&numbered, |(number, info)| info.line(*number)).map(|entry| ("", entry)));
        if !self.deforming_meshes.is_empty() {
            let count = self.deforming_meshes.len();
            let meshes = if count == 1 { "mesh" } else { "meshes" };
            lines
                .push(("deforms", format!("{count} {meshes}, {}", counted(self.skins.len() as u64, "skin"))));
            lines.extend(entries(&self.deforming_meshes, DeformingInfo::line).map(|entry| ("", entry)));
        }
        let (rigid, deforming) = (self.rigid_instances as u64, self.deforming_instances as u64);
        lines.push((
            "moves",
            format!("{} as a whole, {} deforming", counted(rigid, "instance"), grouped(deforming)),
        ));
        lines
    }
}

fn animation(clip: &Clip) -> AnimationInfo {
    let properties = [
        (Property::Translation, "translation"),
        (Property::Rotation, "rotation"),
        (Property::Scale, "scale"),
        (Property::Weights, "weights"),
    ];
    let moves = properties.into_iter().filter_map(|(property, name)| {
        let nodes = clip.channels.iter().filter(|channel| channel.property == property).count();
        (nodes > 0).then_some(MovesInfo { property: name, nodes })
    });
    AnimationInfo {
        name: clip.name.clone(),
        duration_s: clip.duration,
        channels: clip.channels.len(),
        keyframes: clip.channels.iter().map(|channel| channel.times.len()).sum(),
        moves: moves.collect(),
    }
}

fn deforming(deformer: &Deformer, rig: &Rig, scene: &Scene) -> DeformingInfo {
    DeformingInfo {
        mesh: deformer.mesh,
        name: scene.meshes[deformer.mesh as usize].name.clone(),
        vertices: deformer.positions.len(),
        joints: deformer.skin.map(|skin| rig.skins[skin as usize].joints.len()),
        influences_per_vertex: if deformer.skin.is_some() { deformer.influences_per_vertex } else { 0 },
        morph_targets: deformer.targets.len(),
    }
}

impl AnimationInfo {
    fn line(&self, number: usize) -> String {
        let (name, seconds) = (named(&self.name), self.duration_s);
        let of = |MovesInfo { property, nodes }: &MovesInfo| {
            format!("{property} of {}", counted(*nodes as u64, "node"))
        };
        let moves: Vec<_> = self.moves.iter().map(of).collect();
        format!("{number} {name}: {seconds:.2} s, {}", moves.join(", "))
    }
}

impl DeformingInfo {
    fn line(&self) -> String {
        let mut parts = vec![format!("{} vertices", grouped(self.vertices as u64))];
        parts.extend(self.joints.map(|joints| {
            format!("{} ({} a vertex)", counted(joints as u64, "joint"), self.influences_per_vertex)
        }));
        parts.extend((self.morph_targets > 0).then(|| counted(self.morph_targets as u64, "morph target")));
        format!("{}: {}", named(&self.name), parts.join(", "))
    }
}
