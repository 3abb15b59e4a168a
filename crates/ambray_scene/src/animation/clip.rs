//! Keyframes and what lies between them (glTF 2.0, §3.11 and appendix C).

use glam::{DQuat, DVec3};

use super::rig::Trs;

/// An animation of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip {
    /// Name in the file, may be empty.
    pub name: String,
    /// Time of the last keyframe of all channels, seconds. A clip begins at 0, whenever its first keyframe is.
    pub duration: f32,
    /// What it moves.
    pub channels: Vec<Channel>,
}

/// Keyframes of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index into [`Rig::nodes`](super::Rig::nodes).
    pub node: u32,
    /// What the values are.
    pub property: Property,
    /// What lies between the keyframes.
    pub interpolation: Interpolation,
    /// Times of the keyframes in seconds: at least one, finite, none negative, each later than the one before.
    pub times: Vec<f32>,
    /// Values of the keyframes, one after the other: [`Self::width`] numbers each, three times as many with
    /// [`Interpolation::Cubic`] (tangent that arrives, value, tangent that leaves).
    pub values: Vec<f32>,
}

/// What a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Property {
    /// Place within the parent, 3 numbers.
    Translation,
    /// Unit quaternion x, y, z, w.
    Rotation,
    /// Scale along the axes, 3 numbers.
    Scale,
    /// Morph weights of the node, one a target.
    Weights,
}

/// What lies between two keyframes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// The value of the earlier one.
    Step,
    /// A straight line; for rotations the shorter great arc at constant speed.
    #[default]
    Linear,
    /// The cubic of both values and tangents (Hermite); rotations are normalised.
    Cubic,
}

/// Where a time lies between two keyframes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Between {
    /// The earlier keyframe.
    first: usize,
    /// Share of the way to the next one, in `[0, 1)`; 0 at the ends.
    share: f64,
    /// Seconds between both.
    gap: f64,
}

impl Channel {
    /// Numbers of a value.
    #[must_use]
    pub fn width(&self) -> usize {
        let elements = if self.interpolation == Interpolation::Cubic { 3 } else { 1 };
        self.values.len() / (elements * self.times.len())
    }

    /// Overwrites the property in `local`, or in `weights`, by its value at `time`. Before the first and after the last
    /// keyframe their values hold.
    pub(super) fn apply(&self, time: f64, local: &mut Trs, weights: &mut [f32]) {
        let at = self.between(time);
        let triple = || DVec3::from_array(std::array::from_fn(|i| self.component(at, i)));
        match self.property {
            Property::Translation => local.translation = triple(),
            Property::Scale => local.scale = triple(),
            Property::Rotation => local.rotation = self.rotation(at),
            Property::Weights => {
                let width = self.width();
                for (i, weight) in weights.iter_mut().enumerate().take(width) {
                    *weight = self.component(at, i) as f32;
                }
            }
        }
    }

    fn between(&self, time: f64) -> Between {
        // The first keyframe that is later.
        let next = self.times.partition_point(|&t| f64::from(t) <= time);
        if next == 0 || next == self.times.len() {
            return Between { first: next.saturating_sub(1), share: 0.0, gap: 0.0 };
        }
        let (start, end) = (f64::from(self.times[next - 1]), f64::from(self.times[next]));
        Between { first: next - 1, share: (time - start) / (end - start), gap: end - start }
    }

    /// Number `i` of the element `element` (of three with [`Interpolation::Cubic`]) of a keyframe.
    fn number(&self, keyframe: usize, element: usize, i: usize) -> f64 {
        let width = self.width();
        let elements = if self.interpolation == Interpolation::Cubic { 3 } else { 1 };
        f64::from(self.values[(keyframe * elements + element) * width + i])
    }

    /// Number `i` of the value there.
    fn component(&self, at: Between, i: usize) -> f64 {
        let Between { first, share: s, gap } = at;
        match self.interpolation {
            Interpolation::Cubic if s > 0.0 => {
                let (p, leaving) = (self.number(first, 1, i), gap * self.number(first, 2, i));
                let (arriving, q) = (gap * self.number(first + 1, 0, i), self.number(first + 1, 1, i));
                let (s2, s3) = (s * s, s * s * s);
                (2.0 * s3 - 3.0 * s2 + 1.0) * p
                    + (s3 - 2.0 * s2 + s) * leaving
                    + (3.0 * s2 - 2.0 * s3) * q
                    + (s3 - s2) * arriving
            }
            Interpolation::Cubic => self.number(first, 1, i),
            Interpolation::Linear if s > 0.0 => {
                let (p, q) = (self.number(first, 0, i), self.number(first + 1, 0, i));
                p + s * (q - p)
            }
            Interpolation::Linear | Interpolation::Step => self.number(first, 0, i),
        }
    }

    fn rotation(&self, at: Between) -> DQuat {
        let value =
            |keyframe: usize| unit(DQuat::from_array(std::array::from_fn(|i| self.number(keyframe, 0, i))));
        match self.interpolation {
            // glam's slerp takes the shorter arc.
            Interpolation::Linear if at.share > 0.0 => value(at.first).slerp(value(at.first + 1), at.share),
            Interpolation::Linear | Interpolation::Step => value(at.first),
            Interpolation::Cubic => unit(DQuat::from_array(std::array::from_fn(|i| self.component(at, i)))),
        }
    }
}

/// `q` scaled to length 1; no rotation where it has none.
fn unit(q: DQuat) -> DQuat {
    let length = q.length();
    if length > 0.0 && length.is_finite() { q * (1.0 / length) } else { DQuat::IDENTITY }
}
