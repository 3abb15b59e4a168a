//! Values of several types one after the other, to be copied to the device at once.

use bytemuck::Pod;

/// Alignment of every part: that of a vector of four numbers.
const ALIGNMENT: usize = 16;

/// Parts that follow each other.
#[derive(Debug, Default)]
pub(super) struct Bytes(Vec<u8>);

impl Bytes {
    /// Appends `values`; returns where they begin.
    pub(super) fn push<T: Pod>(&mut self, values: &[T]) -> u64 {
        let start = self.0.len().next_multiple_of(ALIGNMENT);
        self.0.resize(start, 0);
        self.0.extend_from_slice(bytemuck::cast_slice(values));
        start as u64
    }

    pub(super) fn all(&self) -> &[u8] {
        &self.0
    }

    pub(super) const fn len(&self) -> u64 {
        self.0.len() as u64
    }
}
