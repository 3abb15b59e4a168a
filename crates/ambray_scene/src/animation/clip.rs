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
            Interpolation::Linear if at.share > 0.0 => slerp(value(at.first), value(at.first + 1), at.share),
            Interpolation::Linear | Interpolation::Step => value(at.first),
            Interpolation::Cubic => unit(DQuat::from_array(std::array::from_fn(|i| self.component(at, i)))),
        }
    }
}

/// The rotation at `share` of the way along the shorter great arc from `p` to `q`, which have length 1 (glTF 2.0, appendix
/// C.4). Functions are `libm`'s: the same on every machine.
fn slerp(p: DQuat, q: DQuat, share: f64) -> DQuat {
    let q = if p.dot(q) < 0.0 { -q } else { q };
    // By half its tangent: the cosine says little about small angles.
    let angle = 2.0 * libm::atan2((q - p).length(), (q + p).length());
    let sin = libm::sin(angle);
    // An arc that short is a straight line.
    let part = |share: f64| if sin > 1e-9 { libm::sin(share * angle) / sin } else { share };
    unit(p * part(1.0 - share) + q * part(share))
}

/// `q` scaled to length 1; no rotation where it has none.
fn unit(q: DQuat) -> DQuat {
    let length = q.length();
    if length > 0.0 && length.is_finite() { q * (1.0 / length) } else { DQuat::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(property: Property, interpolation: Interpolation, times: &[f32], values: &[f32]) -> Channel {
        Channel { node: 0, property, interpolation, times: times.to_vec(), values: values.to_vec() }
    }

    fn translation(channel: &Channel, time: f64) -> DVec3 {
        let mut local = Trs::default();
        channel.apply(time, &mut local, &mut []);
        local.translation
    }

    fn rotation(channel: &Channel, time: f64) -> DQuat {
        let mut local = Trs::default();
        channel.apply(time, &mut local, &mut []);
        local.rotation
    }

    const UP: [f32; 6] = [0.0, 1.0, 0.0, 0.0, 3.0, 0.0];

    #[test]
    fn steps_and_lines() {
        let step = channel(Property::Translation, Interpolation::Step, &[1.0, 2.0], &UP);
        let line = Channel { interpolation: Interpolation::Linear, ..step.clone() };
        assert_eq!((step.width(), line.width()), (3, 3));
        for (time, stepped, straight) in [
            // Before the first and after the last keyframe their values hold.
            (0.0, 1.0, 1.0),
            (1.0, 1.0, 1.0),
            (1.25, 1.0, 1.5),
            (1.999, 1.0, 2.998),
            (2.0, 3.0, 3.0),
            (1e9, 3.0, 3.0),
        ] {
            assert_eq!(translation(&step, time).y, stepped, "{time}");
            assert!((translation(&line, time).y - straight).abs() < 1e-12, "{time}");
        }
    }

    #[test]
    fn one_keyframe_holds_forever() {
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            let single = channel(Property::Scale, interpolation, &[5.0], &[1.0, 2.0, 3.0]);
            for time in [0.0, 5.0, 9.0] {
                let mut local = Trs::default();
                single.apply(time, &mut local, &mut []);
                assert_eq!(local.scale, DVec3::new(1.0, 2.0, 3.0));
            }
        }
        let values = [9.0, 9.0, 9.0, 1.0, 2.0, 3.0, 9.0, 9.0, 9.0];
        let cubic = channel(Property::Translation, Interpolation::Cubic, &[5.0], &values);
        assert_eq!(translation(&cubic, 5.0), DVec3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn cubics_follow_their_tangents() {
        // x: from 0 to 0 over 2 s, leaving at 4 and arriving at −4 a second. y: flat tangents. z: a straight line.
        let values = [
            [7.0, 7.0, 7.0], // arrives at nothing
            [0.0, 1.0, 0.0],
            [4.0, 0.0, 3.0],
            [-4.0, 0.0, 3.0],
            [0.0, 2.0, 6.0],
            [7.0, 7.0, 7.0], // leaves to nothing
        ];
        let cubic = channel(Property::Translation, Interpolation::Cubic, &[1.0, 3.0], values.as_flattened());
        // The cubic with these ends and slopes is 4·t·(1 − t/2), a parabola.
        let parabola = |t: f64| 4.0 * t * (1.0 - t / 2.0);
        for t in [0.0, 0.25, 0.5, 1.0, 1.7, 2.0] {
            let found = translation(&cubic, 1.0 + t);
            assert!((found.x - parabola(t)).abs() < 1e-12, "{t}: {}", found.x);
            assert!((found.z - 3.0 * t).abs() < 1e-12, "{t}: {}", found.z);
        }
        // With flat tangents: smoothstep.
        assert!((translation(&cubic, 1.5).y - (1.0 + 0.15625)).abs() < 1e-12);
        assert_eq!(translation(&cubic, 0.0), DVec3::new(0.0, 1.0, 0.0));
        assert_eq!(translation(&cubic, 4.0), DVec3::new(0.0, 2.0, 6.0));
    }

    #[test]
    fn rotations_take_the_shorter_way_at_constant_speed() {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        // A quarter turn about y, given by either of both quaternions, and not quite unit.
        for sign in [1.0, -1.0] {
            let to = [0.0, half, 0.0, half].map(|x: f32| x * sign * 1.5);
            let values = [[0.0, 0.0, 0.0, 1.0], to];
            let turn = channel(Property::Rotation, Interpolation::Linear, &[0.0, 1.0], values.as_flattened());
            for share in [0.1, 0.25, 0.5, 0.9] {
                let found = rotation(&turn, share);
                let expected = DQuat::from_rotation_y(share * std::f64::consts::FRAC_PI_2);
                assert!(found.dot(expected).abs() > 1.0 - 1e-12, "{sign} {share}: {found}");
                assert!((found.length() - 1.0).abs() < 1e-12);
            }
        }
        // Tiny arcs neither vanish nor jump.
        let tiny = DQuat::from_rotation_x(1e-10);
        assert!((slerp(DQuat::IDENTITY, tiny, 0.5).x - 0.25e-10).abs() < 1e-20);
        assert_eq!(slerp(tiny, tiny, 0.3), tiny);
        // Half a turn away: both ways are as long, and any is right.
        let opposite = slerp(DQuat::IDENTITY, DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0), 0.5);
        assert!((opposite.x.abs() - 0.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn cubic_rotations_are_normalised() {
        let values = [
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
        ];
        let turn = channel(Property::Rotation, Interpolation::Cubic, &[0.0, 1.0], values.as_flattened());
        let half = 0.5_f64.sqrt();
        assert!((rotation(&turn, 0.5) - DQuat::from_xyzw(half, 0.0, 0.0, half)).length() < 1e-12);
        assert_eq!(rotation(&turn, 2.0), DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0));
        // A curve through zero has no direction there.
        let through = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0; 4], [0.0, 0.0, 0.0, -1.0], [0.0; 4]];
        let turn = channel(Property::Rotation, Interpolation::Cubic, &[0.0, 1.0], through.as_flattened());
        assert_eq!(rotation(&turn, 0.5), DQuat::IDENTITY);
    }

    #[test]
    fn weights_of_several_targets() {
        let mut weights = [9.0, 9.0];
        let line = channel(
            Property::Weights,
            Interpolation::Linear,
            &[0.0, 1.0, 2.0],
            &[0.0, 1.0, 1.0, 0.0, 0.5, 0.5],
        );
        assert_eq!(line.width(), 2);
        line.apply(0.25, &mut Trs::default(), &mut weights);
        assert_eq!(weights, [0.25, 0.75]);
        line.apply(1.5, &mut Trs::default(), &mut weights);
        assert_eq!(weights, [0.75, 0.25]);
        // Each keyframe: both that arrive, both values, both that leave.
        let values = [0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 6.0, 0.0, 0.0];
        let cubic = channel(Property::Weights, Interpolation::Cubic, &[0.0, 4.0], &values);
        assert_eq!(cubic.width(), 2);
        cubic.apply(2.0, &mut Trs::default(), &mut weights);
        assert_eq!(weights, [2.0, 4.0]);
        // Nodes without targets have no weights.
        cubic.apply(2.0, &mut Trs::default(), &mut []);
    }
}
