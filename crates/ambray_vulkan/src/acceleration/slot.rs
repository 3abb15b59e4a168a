//! The structures of one group of primitives.

use super::structure::Structure;

/// The structure of a group, or several of the same mesh, each built in another pose, of which one is shown.
#[derive(Debug)]
pub(super) struct Slot {
    pub(super) kept: Vec<Structure>,
    pub(super) shown: usize,
}

impl Slot {
    pub(super) fn new(structure: Structure) -> Self {
        Self { kept: vec![structure], shown: 0 }
    }

    /// The one that rays meet.
    pub(super) fn shown(&self) -> &Structure {
        &self.kept[self.shown]
    }

    /// Bytes of all.
    pub(super) fn size(&self) -> u64 {
        self.kept.iter().map(Structure::size).sum()
    }
}
