//! The planes of a frame on the device, kept from frame to frame while the size stays.

use std::sync::Arc;

use ash::vk::BufferUsageFlags;
use bytemuck::Pod;

use crate::{
    Buffer, Context, Location, Recorder, Result,
    layout::{Tally, View},
};

/// A plane: an array of one entry a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plane {
    Positions,
    Geometric,
    Shading,
    SmoothNormals,
    Albedo,
    Emission,
    Direct,
    Ambient,
    Second,
    Bent,
    Tallies,
    Filtered,
    FilteredBent,
    Beauty,
}

impl Plane {
    pub(crate) const ALL: [Self; 14] = [
        Self::Positions,
        Self::Geometric,
        Self::Shading,
        Self::SmoothNormals,
        Self::Albedo,
        Self::Emission,
        Self::Direct,
        Self::Ambient,
        Self::Second,
        Self::Bent,
        Self::Tallies,
        Self::Filtered,
        Self::FilteredBent,
        Self::Beauty,
    ];

    /// Bytes a pixel.
    pub(crate) const fn stride(self) -> u64 {
        match self {
            Self::Tallies => size_of::<Tally>() as u64,
            _ => 16,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Positions => "positions of pixels",
            Self::Geometric => "geometric normals",
            Self::Shading => "shading normals",
            Self::SmoothNormals => "smooth normals",
            Self::Albedo => "albedo",
            Self::Emission => "emission",
            Self::Direct => "direct light",
            Self::Ambient => "openness and near radiance",
            Self::Second => "second batch",
            Self::Bent => "bent normals",
            Self::Tallies => "ray counts",
            Self::Filtered => "filtered openness and near radiance",
            Self::FilteredBent => "filtered bent normals",
            Self::Beauty => "picture",
        }
    }
}

/// All planes of a frame of up to `capacity` pixels.
#[derive(Debug)]
pub(crate) struct Planes {
    buffers: Vec<Buffer>,
    capacity: u64,
}

impl Planes {
    /// Planes for `pixels` pixels, with undefined content.
    pub(crate) fn new(context: &Arc<Context>, pixels: u64) -> Result<Self> {
        let usage = BufferUsageFlags::STORAGE_BUFFER
            | BufferUsageFlags::SHADER_DEVICE_ADDRESS
            | BufferUsageFlags::TRANSFER_SRC
            | BufferUsageFlags::TRANSFER_DST;
        let buffer =
            |plane: Plane| context.buffer(plane.name(), pixels * plane.stride(), usage, Location::Device);
        let buffers = Plane::ALL.into_iter().map(buffer).collect::<Result<_>>()?;
        Ok(Self { buffers, capacity: pixels })
    }

    /// Whether a frame of `pixels` pixels fits, without wasting more than half of the memory.
    pub(crate) const fn suits(&self, pixels: u64) -> bool {
        pixels <= self.capacity && self.capacity <= 2 * pixels
    }

    pub(crate) fn buffer(&self, plane: Plane) -> &Buffer {
        &self.buffers[plane as usize]
    }

    /// Writes the addresses of all planes to `view`.
    pub(crate) fn address(&self, view: &mut View) {
        let at = |plane: Plane| self.buffer(plane).address();
        view.positions = at(Plane::Positions);
        view.geometric = at(Plane::Geometric);
        view.shading = at(Plane::Shading);
        view.smooth_normals = at(Plane::SmoothNormals);
        view.albedo = at(Plane::Albedo);
        view.emission = at(Plane::Emission);
        view.direct = at(Plane::Direct);
        view.ambient = at(Plane::Ambient);
        view.second = at(Plane::Second);
        view.bent = at(Plane::Bent);
        view.tallies = at(Plane::Tallies);
        view.filtered = at(Plane::Filtered);
        view.filtered_bent = at(Plane::FilteredBent);
        view.beauty = at(Plane::Beauty);
    }
}

/// Memory through which the host writes and reads planes, a bounded part at a time.
#[derive(Debug)]
pub(crate) struct Transfer {
    buffer: Buffer,
}

/// Bytes that are moved at once.
const CHUNK: u64 = 32 << 20;

impl Transfer {
    /// For planes of up to `bytes` bytes.
    pub(crate) fn new(context: &Arc<Context>, bytes: u64, location: Location) -> Result<Self> {
        let usage = BufferUsageFlags::TRANSFER_SRC | BufferUsageFlags::TRANSFER_DST;
        Ok(Self { buffer: context.buffer("transfer", bytes.min(CHUNK), usage, location)? })
    }

    /// The first `count` entries of `plane`.
    pub(crate) fn read<T: Pod>(
        &self,
        context: &Arc<Context>,
        plane: &Buffer,
        count: usize,
    ) -> Result<Vec<T>> {
        let mut values = vec![T::zeroed(); count];
        let mut offset = 0;
        for part in bytemuck::cast_slice_mut::<T, u8>(&mut values).chunks_mut(self.buffer.size() as usize) {
            context.run(|recorder: &mut Recorder<'_>| {
                use crate::Work::{Everything, HostRead, Transfer};
                recorder.barrier(Everything, Transfer);
                recorder.copy(plane, offset, &self.buffer, 0, part.len() as u64);
                recorder.barrier(Transfer, HostRead);
                Ok(())
            })?;
            part.copy_from_slice(&self.buffer.read::<u8>(0, part.len()));
            offset += part.len() as u64;
        }
        Ok(values)
    }

    /// Writes `values` to the beginning of `plane`.
    pub(crate) fn write<T: Pod>(
        &mut self,
        context: &Arc<Context>,
        plane: &Buffer,
        values: &[T],
    ) -> Result<()> {
        let mut offset = 0;
        for part in bytemuck::cast_slice::<T, u8>(values).chunks(self.buffer.size() as usize) {
            self.buffer.write(0, part);
            context.run(|recorder: &mut Recorder<'_>| {
                use crate::Work::{Everything, HostWrite, Transfer};
                recorder.barrier(HostWrite, Transfer);
                recorder.copy(&self.buffer, 0, plane, offset, part.len() as u64);
                recorder.barrier(Transfer, Everything);
                Ok(())
            })?;
            offset += part.len() as u64;
        }
        Ok(())
    }
}
