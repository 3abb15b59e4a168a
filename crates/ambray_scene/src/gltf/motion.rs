//! What animations move. They are not played; acceleration structures want to know.

use crate::Motion;

use super::json::{Index, Node, Root};
use super::nodes::parents;
use crate::error::Outcome;

/// What the animations of a file reach.
#[derive(Debug)]
pub(super) struct Moved {
    /// One a node: whether its place in the world changes.
    places: Vec<bool>,
    /// One a node: whether its morph weights change.
    weights: Vec<bool>,
}

impl Moved {
    /// Follows all channels of all animations, whether or not a node shows anything.
    pub(super) fn by_animations(root: &Root) -> Outcome<Self> {
        let mut moved =
            Self { places: vec![false; root.nodes.len()], weights: vec![false; root.nodes.len()] };
        // Animations are not played, so channels without a target in the file do no harm.
        let targets = root.animations.iter().flat_map(|animation| &animation.channels).map(|c| &c.target);
        for target in targets {
            let list = match target.path.as_str() {
                "translation" | "rotation" | "scale" => &mut moved.places,
                "weights" => &mut moved.weights,
                _ => continue,
            };
            if let Some(flag) = target.node.and_then(|node| list.get_mut(node)) {
                *flag = true;
            }
        }
        let parents = parents(root)?;
        let mut pending: Vec<Index> = (0..root.nodes.len()).filter(|&node| parents[node].is_none()).collect();
        while let Some(node) = pending.pop() {
            for &child in &root.nodes[node].children {
                moved.places[child] |= moved.places[node];
                pending.push(child);
            }
        }
        Ok(moved)
    }

    /// Motion of what node `index` carries with it.
    pub(super) fn node(&self, index: Index) -> Motion {
        if self.places[index] { Motion::Rigid } else { Motion::Static }
    }

    /// Motion of a primitive of `node`, which has `index`. Joints place a skinned one, the node itself does not (glTF 2.0
    /// §3.7.3.3).
    pub(super) fn primitive(
        &self,
        root: &Root,
        node: &Node,
        index: Index,
        skinned: bool,
        morphs: bool,
    ) -> Motion {
        if morphs && self.weights[index] {
            return Motion::Deforming;
        }
        match node.skin.filter(|_| skinned) {
            Some(skin) if root.skins[skin].joints.iter().any(|&joint| self.places[joint]) => {
                Motion::Deforming
            }
            Some(_) => Motion::Static,
            None => self.node(index),
        }
    }
}
