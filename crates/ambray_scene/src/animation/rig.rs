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

    /// Whether what rays can hit is the same at two poses of this rig: only cameras and lights may differ.
    #[must_use]
    pub fn shows_the_same(&self, a: &Pose, b: &Pose) -> bool {
        let stays = |attachment: &Attachment| {
            attachment.node.is_none_or(|node| a.world[node as usize] == b.world[node as usize])
        };
        self.instances.iter().chain(&self.shape_instances).all(stays)
            && a.joints == b.joints
            && a.weights == b.weights
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::{Channel, Interpolation, MorphTarget, Property};
    use glam::{Affine3A, Vec3};

    fn at(translation: DVec3, parent: Option<u32>) -> Node {
        let local = Local::Trs(Trs { translation, ..Trs::default() });
        Node { name: String::new(), parent, local, weights: Vec::new() }
    }

    fn channel(node: u32, property: Property, times: &[f32], values: &[f32]) -> Channel {
        let interpolation = Interpolation::Linear;
        Channel { node, property, interpolation, times: times.to_vec(), values: values.to_vec() }
    }

    /// An arm of two links along x that turns about z in its elbow, a quarter turn in a second; a second clip moves its
    /// root up by 4 in 2 s.
    fn arm() -> Rig {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let bend = channel(1, Property::Rotation, &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half]);
        let lift = channel(0, Property::Translation, &[0.0, 2.0], &[0.0, 0.0, 0.0, 0.0, 4.0, 0.0]);
        Rig {
            nodes: vec![at(DVec3::ZERO, None), at(DVec3::X, Some(0)), at(DVec3::X, Some(1))],
            clips: vec![
                Clip { name: "bend".to_owned(), duration: 1.0, channels: vec![bend] },
                Clip { name: "lift".to_owned(), duration: 2.0, channels: vec![lift] },
            ],
            ..Rig::default()
        }
    }

    /// Where the hand is.
    fn hand(rig: &Rig, moment: Option<Moment>) -> DVec3 {
        rig.pose(moment.as_ref()).world[2].translation
    }

    #[test]
    fn children_follow_their_parents() {
        let rig = arm();
        let bent = |time| hand(&rig, Some(Moment { clips: Clips::One(0), time, repeat: false }));
        assert_eq!(hand(&rig, None), DVec3::X * 2.0);
        assert!(bent(1.0).abs_diff_eq(DVec3::new(1.0, 1.0, 0.0), 1e-7));
        let eighth = DVec3::new(1.0 + 0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0);
        assert!(bent(0.5).abs_diff_eq(eighth, 1e-7));
        assert_eq!(bent(7.0), bent(1.0), "the last pose holds");
    }

    #[test]
    fn clips_repeat() {
        let rig = arm();
        let hand = |clips, time, repeat| hand(&rig, Some(Moment { clips, time, repeat }));
        assert_eq!(hand(Clips::One(0), 3.25, true), hand(Clips::One(0), 0.25, false));
        assert_eq!(hand(Clips::One(0), 1.0, true), DVec3::X * 2.0, "the end is the beginning");
        // All at once, each by its own duration: 1.5 s are half of the bend and three quarters of the lift.
        let both = hand(Clips::All, 1.5, true);
        let expected = hand(Clips::One(0), 0.5, false) + DVec3::Y * 3.0;
        assert!(both.abs_diff_eq(expected, 1e-12), "{both}");
        assert_eq!((rig.duration(Clips::One(0)), rig.duration(Clips::All)), (1.0, 2.0));
    }

    #[test]
    fn a_clip_without_duration_is_a_pose() {
        let mut rig = arm();
        rig.clips[1] = Clip {
            channels: vec![channel(0, Property::Translation, &[0.0], &[0.0, 5.0, 0.0])],
            ..Clip::default()
        };
        for (time, repeat) in [(0.0, true), (3.0, true), (3.0, false)] {
            let moment = Moment { clips: Clips::One(1), time, repeat };
            assert_eq!(hand(&rig, Some(moment)), DVec3::new(2.0, 5.0, 0.0));
        }
    }

    #[test]
    fn where_clips_move_the_same_the_last_one_counts() {
        let mut rig = arm();
        let away = channel(0, Property::Translation, &[0.0], &[9.0, 0.0, 0.0]);
        rig.clips.push(Clip { channels: vec![away], ..Clip::default() });
        let moment = Moment { clips: Clips::All, time: 0.0, repeat: false };
        assert_eq!(hand(&rig, Some(moment)), DVec3::X * 11.0);
        assert_eq!(
            (rig.clip("lift"), rig.clip("2"), rig.clip("3"), rig.clip("walk")),
            (Some(1), Some(2), None, None)
        );
    }

    #[test]
    fn matrices_stay_and_weights_move() {
        let mut rig = arm();
        rig.nodes[1].local = Local::Matrix(DAffine3::from_translation(DVec3::Z));
        rig.nodes[2].weights = vec![0.5, 0.25];
        rig.clips[0].channels.push(channel(2, Property::Weights, &[0.0, 1.0], &[0.0, 0.0, 1.0, 3.0]));
        rig.deformers =
            vec![Deformer { node: 2, targets: vec![MorphTarget::default(); 2], ..Deformer::default() }];
        assert_eq!(rig.pose(None).weights, [[0.5, 0.25]]);
        let pose = rig.pose(Some(&Moment { clips: Clips::One(0), time: 0.5, repeat: true }));
        assert_eq!(pose.weights, [[0.5, 1.5]]);
        assert_eq!(pose.world[2].translation, DVec3::new(1.0, 0.0, 1.0));
    }

    #[test]
    fn joints_are_world_from_bind_space() {
        let mut rig = arm();
        rig.skins = vec![Skin {
            joints: vec![2, 1],
            inverse_binds: vec![DAffine3::from_translation(DVec3::NEG_X * 2.0), DAffine3::IDENTITY],
        }];
        let joints = &rig.pose(None).joints[0];
        assert_eq!(joints[0], Affine3A::IDENTITY);
        assert_eq!(joints[1], Affine3A::from_translation(Vec3::X));
    }
}
