//! What moves in a scene: clips drive nodes, nodes carry instances, joints and morph weights deform meshes.
//!
//! A [`Scene`](crate::Scene) is always the scene at one moment. Its [`Rig`] says how it looks at another one:
//!
//! 1. [`Rig::pose`] evaluates the clips at a [`Moment`]: the [`Pose`], all nodes in the world, joint matrices, morph weights.
//! 2. [`Scene::place`](crate::Scene::place) moves instances, shapes, cameras and lights there.
//! 3. [`Scene::deform`](crate::Scene::deform) bends the meshes of the rig's [`Deformer`]s. Backends may do that themselves,
//!    vertex by vertex, from the same pose.

mod bend;
mod clip;
mod deform;
mod place;
mod pose;
mod rig;
mod update;

pub(crate) use place::{place_camera, place_light, placed};
pub(crate) use pose::single;

pub use clip::{Channel, Clip, Interpolation, Property};
pub use deform::{Deformer, Influence, LARGEST_COORDINATE, MorphTarget, Vertex};
pub use pose::Pose;
pub use rig::{Attachment, Clips, Local, Moment, Node, Rig, Skin, Trs};
pub use update::{UpdatePolicy, Updates};
