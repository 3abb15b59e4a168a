//! Memory of the submissions that move a scene.

use std::sync::Arc;

use ash::vk::BufferUsageFlags;
use glam::Vec3;

use super::bytes::Bytes;
use super::mesh::RESULT;
use crate::{
    Bounds, Buffer, Context, Location, Recorder, Result, Work,
    acceleration::Scratch,
    layout::{BOX_WORDS, ordered, unordered},
};

const USAGE: BufferUsageFlags = BufferUsageFlags::from_raw(
    BufferUsageFlags::STORAGE_BUFFER.as_raw()
        | BufferUsageFlags::SHADER_DEVICE_ADDRESS.as_raw()
        | BufferUsageFlags::TRANSFER_SRC.as_raw()
        | BufferUsageFlags::TRANSFER_DST.as_raw(),
);

/// Words of a result.
const WORDS: usize = (RESULT / 4) as usize;

/// Buffers that all meshes share.
#[derive(Debug)]
pub(super) struct Memory {
    context: Arc<Context>,
    /// What a submission reads, written by the host.
    pub(super) staging: Buffer,
    /// A copy of its beginning, read by shaders.
    pub(super) arguments: Buffer,
    /// Boxes of clusters.
    pub(super) boxes: Buffer,
    /// [`RESULT`] bytes a mesh, and a copy for the host.
    pub(super) results: Buffer,
    readback: Buffer,
    pub(super) scratch: Scratch,
    /// Bytes of scratch memory that were asked for.
    pub(super) room: u64,
}

/// What the device found out about a mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Box of its vertices.
    pub(super) bounds: Bounds,
    /// Surface-area cost of the clusters of its structure.
    pub(super) cost: f32,
    /// The same of clusters made for the pose.
    pub(super) fresh_cost: f32,
}

impl Memory {
    /// For `meshes` meshes whose clusters take `boxes` bytes, and builds that take `room`.
    pub(super) fn new(context: &Arc<Context>, meshes: usize, boxes: u64, room: u64) -> Result<Self> {
        let results = RESULT * meshes as u64;
        let buffer = |name: &str, size: u64, location: Location| context.buffer(name, size, USAGE, location);
        Ok(Self {
            staging: buffer("arguments of a pose", 0, Location::Upload)?,
            arguments: buffer("arguments of a pose", 0, Location::Device)?,
            boxes: buffer("boxes of clusters", boxes, Location::Device)?,
            results: buffer("results of a pose", results, Location::Device)?,
            readback: buffer("results of a pose", results, Location::Readback)?,
            scratch: Scratch::new(context, room)?,
            room,
            context: Arc::clone(context),
        })
    }

    /// Makes room for arguments of so many bytes. Nothing may be under way.
    pub(super) fn reserve(&mut self, bytes: u64) -> Result<()> {
        if self.arguments.size() >= bytes && self.staging.size() >= bytes {
            return Ok(());
        }
        let bytes = bytes.next_power_of_two();
        let buffer = |location: Location| self.context.buffer("arguments of a pose", bytes, USAGE, location);
        (self.staging, self.arguments) = (buffer(Location::Upload)?, buffer(Location::Device)?);
        Ok(())
    }

    /// Writes what the next submission reads.
    pub(super) fn write(&mut self, bytes: &Bytes) {
        self.staging.write(0, bytes.all());
    }

    /// Sets the boxes of all meshes, and waits.
    pub(super) fn set_bounds(&mut self, bounds: impl Iterator<Item = Bounds>) -> Result<()> {
        let words: Vec<[u32; WORDS]> = bounds
            .map(|bounds| {
                let [low, high] = [bounds.lo, -bounds.hi].map(|corner| corner.to_array().map(ordered));
                [low[0], low[1], low[2], high[0], high[1], high[2], 0, 0]
            })
            .collect();
        self.readback.write(0, &words);
        self.context.run(|recorder| {
            recorder.barrier(Work::HostWrite, Work::Transfer);
            recorder.copy(&self.readback, 0, &self.results, 0, self.results.size());
            recorder.barrier(Work::Transfer, Work::Everything);
            Ok(())
        })
    }

    /// Records the copy of the results to the host.
    pub(super) fn read_back(&self, recorder: &mut Recorder<'_>) {
        recorder.barrier(Work::Compute, Work::Transfer);
        recorder.copy(&self.results, 0, &self.readback, 0, self.results.size());
        recorder.barrier(Work::Transfer, Work::HostRead);
    }

    /// What the last submission that was read back found out about each mesh.
    pub(super) fn found(&self) -> Vec<Found> {
        let words: Vec<[u32; WORDS]> = self.readback.read(0, (self.results.size() / RESULT) as usize);
        let of = |words: &[u32; WORDS]| {
            let corner =
                |first: usize| Vec3::from_array([0, 1, 2].map(|axis| unordered(words[first + axis])));
            Found {
                bounds: Bounds { lo: corner(0), hi: -corner(3) },
                cost: f32::from_bits(words[BOX_WORDS as usize]),
                fresh_cost: f32::from_bits(words[BOX_WORDS as usize + 1]),
            }
        };
        words.iter().map(of).collect()
    }
}
