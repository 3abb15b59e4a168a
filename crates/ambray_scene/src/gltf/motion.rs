//! What animations move: acceleration structures keep it apart from what stays.

use crate::Motion;
use crate::animation::{Clip, Node, Property, Skin};

/// What the clips of a file reach. Nodes are those of the rig.
#[derive(Debug)]
pub(super) struct Moved {
    /// One a node: whether its place in the world changes.
    places: Vec<bool>,
    /// One a node: whether its morph weights change.
    weights: Vec<bool>,
}

impl Moved {
    /// Follows all channels of all clips, whether or not a node shows anything.
    pub(super) fn by_clips(nodes: &[Node], clips: &[Clip]) -> Self {
        let mut moved = Self { places: vec![false; nodes.len()], weights: vec![false; nodes.len()] };
        for channel in clips.iter().flat_map(|clip| &clip.channels) {
            let list = match channel.property {
                Property::Translation | Property::Rotation | Property::Scale => &mut moved.places,
                Property::Weights => &mut moved.weights,
            };
            list[channel.node as usize] = true;
        }
        // Parents stand before their children.
        for (i, node) in nodes.iter().enumerate() {
            moved.places[i] |= node.parent.is_some_and(|parent| moved.places[parent as usize]);
        }
        moved
    }

    /// Motion of what `node` carries with it.
    pub(super) fn node(&self, node: u32) -> Motion {
        if self.places[node as usize] { Motion::Rigid } else { Motion::Static }
    }

    /// Motion of a primitive of `node`. If it has a `skin`, joints place it, and the node does not (glTF 2.0 §3.7.3.3).
    pub(super) fn primitive(&self, node: u32, skin: Option<&Skin>, morphs: bool) -> Motion {
        if morphs && self.weights[node as usize] {
            return Motion::Deforming;
        }
        match skin {
            Some(skin) if skin.joints.iter().any(|&joint| self.places[joint as usize]) => Motion::Deforming,
            Some(_) => Motion::Static,
            None => self.node(node),
        }
    }
}
