//! Bits of the rays in the masks of instances.

use crate::layout::{RAY_AMBIENT, RAY_CHORD, RAY_PRIMARY, RAY_SHADOW};

pub(super) const PRIMARY: u8 = 1 << RAY_PRIMARY;
pub(super) const AMBIENT: u8 = 1 << RAY_AMBIENT;
pub(super) const CHORD: u8 = 1 << RAY_CHORD;
pub(super) const SHADOW: u8 = 1 << RAY_SHADOW;

/// All of them.
#[cfg(test)]
pub(super) const ALL: u8 = PRIMARY | AMBIENT | CHORD | SHADOW;
