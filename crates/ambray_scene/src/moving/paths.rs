//! Closed paths among pillars, and keyframes along them.

use core::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};

use crate::modelling::noise::Dice;

/// Keyframes of a path; the last is the first again.
const KEYFRAMES: usize = 33;

/// A closed curve around one pillar or two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    /// Middle of the curve.
    centre: DVec3,
    /// Half extents: across its long axis, along it, upwards.
    extent: DVec3,
    /// Direction of its long axis in the plane, radians.
    heading: f64,
    /// Where on it the path begins, radians.
    phase: f64,
    /// Whether it crosses itself in the middle, around two pillars.
    eight: bool,
    /// Rounds in the clip: at least one. Negative: the other way around.
    rounds: f64,
    /// Rises and falls in a round.
    waves: f64,
}

impl Path {
    /// Around the pillar at `pillar`.
    pub(super) fn around(pillar: DVec3, dice: &mut Dice) -> Self {
        let mut between = |lo: f32, hi: f32| f64::from(dice.between(lo, hi));
        let radius = between(0.55, 2.1);
        let extent = DVec3::new(radius, radius * between(0.8, 1.25), between(0.05, 0.35));
        let centre = pillar + DVec3::Y * between(0.55, 3.2);
        let (heading, phase) = (between(0.0, TAU as f32), between(0.0, TAU as f32));
        let direction = if between(0.0, 1.0) < 0.7 { 1.0 } else { -1.0 };
        let rounds = if radius < 1.0 { 2.0 * direction } else { direction };
        Self { centre, extent, heading, phase, eight: false, rounds, waves: 2.0 }
    }

    /// A figure of eight around both pillars.
    pub(super) fn eight(a: DVec3, b: DVec3, dice: &mut Dice) -> Self {
        let mut between = |lo: f32, hi: f32| f64::from(dice.between(lo, hi));
        let axis = b - a;
        let extent =
            DVec3::new(between(0.6, 1.1), 0.5 * axis.length() + between(0.55, 1.0), between(0.1, 0.5));
        let centre = 0.5 * (a + b) + DVec3::Y * between(0.8, 2.9);
        let (heading, phase) = (libm::atan2(axis.x, axis.z), between(0.0, TAU as f32));
        Self { centre, extent, heading, phase, eight: true, rounds: 1.0, waves: 3.0 }
    }

    /// Place at `share` of the clip.
    fn place(&self, share: f64) -> DVec3 {
        let turn = TAU * self.rounds * share + self.phase;
        let (sin, cos) = libm::sincos(turn);
        let across = if self.eight { libm::sin(2.0 * turn) } else { cos };
        let rise = libm::sin(self.waves * turn + 2.0 * self.phase);
        let (x, z) = (self.extent.x * across, self.extent.y * sin);
        let (turn_sin, turn_cos) = libm::sincos(self.heading);
        let along =
            DVec3::new(x * turn_cos + z * turn_sin, self.extent.z * rise, z * turn_cos - x * turn_sin);
        self.centre + along
    }

    /// Rotation at `share` of the clip: z points ahead, and what flies leans into its curves.
    fn attitude(&self, share: f64) -> DQuat {
        const STEP: f64 = 1e-3;
        let at = [share - STEP, share, share + STEP].map(|share| self.place(share));
        let ahead = (at[2] - at[0]).normalize_or(DVec3::Z);
        let bend = (at[2] - 2.0 * at[1] + at[0]) / (STEP * STEP);
        // The clip's seconds and earth's gravity do not matter: this looks right.
        let up = DVec3::Y + 0.006 * bend;
        let side = up.cross(ahead).normalize_or(DVec3::X);
        DQuat::from_mat3(&DMat3::from_cols(side, ahead.cross(side), ahead)).normalize()
    }

    /// Times within `duration`, places and attitudes of the keyframes.
    pub(super) fn keyframes(&self, duration: f32) -> (Vec<f32>, Vec<f32>, Vec<f32>) {
        let (mut times, mut places, mut attitudes) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..KEYFRAMES {
            let share = k as f64 / (KEYFRAMES - 1) as f64;
            times.push((share * f64::from(duration)) as f32);
            // The last one is the first, bit for bit.
            let share = if k + 1 == KEYFRAMES { 0.0 } else { share };
            places.extend(self.place(share).to_array().map(|x| x as f32));
            attitudes.extend(self.attitude(share).to_array().map(|x| x as f32));
        }
        (times, places, attitudes)
    }
}
