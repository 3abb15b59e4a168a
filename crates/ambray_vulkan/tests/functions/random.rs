//! Arguments to try.

use std::f32::consts::TAU;

use ambray_core::sampling::{pcg, unit_float};
use glam::Vec3;

/// A reproducible stream of numbers.
pub(crate) struct Random(u32);

impl Random {
    pub(crate) fn new(seed: u32) -> Self {
        Self(pcg(seed))
    }

    pub(crate) fn word(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        pcg(self.0)
    }

    /// Below `count`.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        self.word() as usize % count
    }

    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + unit_float(self.word()) * (high - low)
    }

    /// Positive, of every magnitude from 10^`low` to 10^`high`.
    pub(crate) fn magnitude(&mut self, low: f32, high: f32) -> f32 {
        10_f32.powf(self.between(low, high))
    }

    /// As [`magnitude`](Self::magnitude), of either sign.
    pub(crate) fn signed(&mut self, low: f32, high: f32) -> f32 {
        let magnitude = self.magnitude(low, high);
        if self.word() & 1 == 0 { magnitude } else { -magnitude }
    }

    pub(crate) fn vector(&mut self, low: f32, high: f32) -> Vec3 {
        Vec3::new(self.between(low, high), self.between(low, high), self.between(low, high))
    }

    /// Unit vectors, one in eight along an axis or within a plane of two.
    pub(crate) fn direction(&mut self) -> Vec3 {
        let (z, turn) = (self.between(-1.0, 1.0), TAU * self.between(0.0, 1.0));
        let r = (1.0 - z * z).sqrt();
        let mut v = Vec3::new(r * turn.cos(), r * turn.sin(), z);
        if self.word() & 7 == 0 {
            v[self.below(3)] = 0.0;
            if self.word() & 1 == 0 {
                v[self.below(3)] = 0.0;
            }
        }
        v.try_normalize().unwrap_or(Vec3::NEG_Z)
    }
}
