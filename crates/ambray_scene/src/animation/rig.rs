//! The rig of a scene: nodes, skins, clips, and what hangs on which node.

use glam::{DAffine3, DQuat, DVec3};

use super::{Clip, Deformer, Pose};

/// Everything that another pose of a scene depends on, without the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rig {
    /// Nodes of the file, parents before their children.
    pub nodes: Vec<Node>,
    /// Skins of deforming meshes.
    pub skins: Vec<Skin>,
    /// Animations of the file, in its order; at least one.
    pub clips: Vec<Clip>,
    /// Meshes of the scene whose vertices move against each other.
    pub deformers: Vec<Deformer>,
    /// What carries each of [`Scene::instances`](crate::Scene::instances).
    pub instances: Vec<Attachment>,
    /// What carries each of [`Scene::shape_instances`](crate::Scene::shape_instances).
    pub shape_instances: Vec<Attachment>,
    /// Node of each of [`Scene::cameras`](crate::Scene::cameras); cameras beyond the end of this list stay.
    pub cameras: Vec<u32>,
    /// Node of each of [`Scene::lights`](crate::Scene::lights); lights beyond the end of this list stay.
    pub lights: Vec<u32>,
}

/// A node of the hierarchy as it is at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Name in the file, may be empty.
    pub name: String,
    /// Index of its parent, which stands before it.
    pub parent: Option<u32>,
    /// Place within the parent.
    pub local: Local,
    /// Morph weights, one a target; empty unless the node has a [`Deformer`].
    pub weights: Vec<f32>,
}

/// How a node's place is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Local {
    /// In parts, which clips may overwrite.
    Trs(Trs),
    /// As a whole: no clip moves it.
    Matrix(DAffine3),
}

/// Translation after rotation after scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trs {
    /// Place within the parent.
    pub translation: DVec3,
    /// Unit quaternion.
    pub rotation: DQuat,
    /// Scale along the axes.
    pub scale: DVec3,
}

impl Default for Trs {
    fn default() -> Self {
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
    }
}

/// Joints that pull on vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Indices into [`Rig::nodes`]; at least one.
    pub joints: Vec<u32>,
    /// Joint from bind space, one a joint.
    pub inverse_binds: Vec<DAffine3>,
}

/// What carries an instance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attachment {
    /// Index into [`Rig::nodes`]; `None` where the instance stays, as skinned ones do: joints place them.
    pub node: Option<u32>,
    /// Place within the node.
    pub local: DAffine3,
}

/// A time of one or all clips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// What plays.
    pub clips: Clips,
    /// Seconds since the start; not negative, finite.
    pub time: f64,
    /// Whether a clip starts over after its end; else its last pose holds.
    pub repeat: bool,
}

/// What plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Clips {
    /// This one of [`Rig::clips`].
    One(usize),
    /// All at once, each repeating by its own duration. Where several move the same, the last one counts.
    All,
}

impl Moment {
    /// Time within a clip of `duration` seconds.
    fn within(&self, duration: f32) -> f64 {
        let duration = f64::from(duration);
        if self.repeat && duration > 0.0 { self.time % duration } else { self.time.min(duration) }
    }
}

impl Rig {
    /// The pose at `moment`, or at rest.
    ///
    /// # Panics
    /// If the moment is of a clip that is not there.
    #[must_use]
    pub fn pose(&self, moment: Option<&Moment>) -> Pose {
        let mut locals: Vec<Local> = self.nodes.iter().map(|node| node.local).collect();
        let mut weights: Vec<Vec<f32>> = self.nodes.iter().map(|node| node.weights.clone()).collect();
        if let Some(moment) = moment {
            let clips = match moment.clips {
                Clips::One(index) => &self.clips[index..=index],
                Clips::All => &self.clips[..],
            };
            for clip in clips {
                let time = moment.within(clip.duration);
                for channel in &clip.channels {
                    let node = channel.node as usize;
                    let mut unused = Trs::default();
                    let local = match &mut locals[node] {
                        Local::Trs(trs) => trs,
                        Local::Matrix(_) => &mut unused,
                    };
                    channel.apply(time, local, &mut weights[node]);
                }
            }
        }
        Pose::of(self, &locals, &weights)
    }

    /// The clip of this name, or of this number.
    #[must_use]
    pub fn clip(&self, name: &str) -> Option<usize> {
        let by_name = self.clips.iter().position(|clip| clip.name == name);
        by_name.or_else(|| name.parse().ok().filter(|&index: &usize| index < self.clips.len()))
    }

    /// Seconds that what plays takes until it has been seen whole: the longest clip.
    #[must_use]
    pub fn duration(&self, clips: Clips) -> f32 {
        match clips {
            Clips::One(index) => self.clips[index].duration,
            Clips::All => self.clips.iter().map(|clip| clip.duration).fold(0.0, f32::max),
        }
    }
}

impl Local {
    /// Parent from node.
    pub(crate) fn matrix(&self) -> DAffine3 {
        match self {
            Self::Trs(Trs { translation, rotation, scale }) => {
                DAffine3::from_scale_rotation_translation(*scale, *rotation, *translation)
            }
            Self::Matrix(matrix) => *matrix,
        }
    }
}
