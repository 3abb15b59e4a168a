//! Numbers about all pixels of a frame, found on the device: few bytes are read.

use std::sync::Arc;

use ambray_core::{frame::RayCounts, settings::Settings};
use ash::vk::BufferUsageFlags;

use crate::{
    Buffer, Context, Location, Recorder, Result, Work,
    layout::{Push, REDUCE_WIDTH, Specialization},
    pipeline::{ComputePipeline, Interface},
    shaders,
};

/// Most workgroups that go over the pixels, each over several: enough to fill a device, few enough not to queue for the sums.
const GROUPS: u32 = 1024;

/// Invocations that go over `count` pixels.
pub(crate) fn extent(count: u32) -> [u32; 2] {
    [count.div_ceil(REDUCE_WIDTH).clamp(1, GROUPS) * REDUCE_WIDTH, 1]
}

/// Size of a workgroup.
pub(crate) const WORKGROUP: [u32; 2] = [REDUCE_WIDTH, 1];

/// Words of the sums: two of each.
const WORDS: usize = 6;

/// The program that counts rays: it depends on no settings.
#[derive(Debug)]
pub(crate) struct SumProgram {
    /// Lives as long as what was made with it.
    interface: Arc<Interface>,
    pipeline: ComputePipeline,
}

impl SumProgram {
    /// Compiles it.
    pub(crate) fn new(interface: &Arc<Interface>) -> Result<Self> {
        let specialization = Specialization::of(&Settings::default(), false, false);
        let pipeline = ComputePipeline::new(interface, shaders::SUMS, &specialization)?;
        Ok(Self { interface: Arc::clone(interface), pipeline })
    }
}

/// Where rays are counted.
#[derive(Debug)]
pub(crate) struct Sums {
    sums: Buffer,
    readback: Buffer,
}

impl Sums {
    pub(crate) fn new(context: &Arc<Context>) -> Result<Self> {
        let usage = BufferUsageFlags::STORAGE_BUFFER
            | BufferUsageFlags::SHADER_DEVICE_ADDRESS
            | BufferUsageFlags::TRANSFER_SRC
            | BufferUsageFlags::TRANSFER_DST;
        let buffer =
            |location: Location| context.buffer("ray counts of a frame", 4 * WORDS as u64, usage, location);
        Ok(Self { sums: buffer(Location::Device)?, readback: buffer(Location::Readback)? })
    }

    /// Address of the sums, for the outputs of the view.
    pub(crate) const fn address(&self) -> u64 {
        self.sums.address()
    }

    /// Records the sums over the `count` pixels of the view at this address.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, program: &SumProgram, view: u64, count: u32) {
        recorder.fill(&self.sums, 0);
        recorder.barrier(Work::Transfer, Work::Compute);
        let push = Push { scene: 0, view, origin: [0; 2], extent: extent(count) };
        program.pipeline.record(recorder, &program.interface, WORKGROUP, push);
        recorder.barrier(Work::Compute, Work::Transfer);
        recorder.copy(&self.sums, 0, &self.readback, 0, self.sums.size());
        recorder.barrier(Work::Transfer, Work::HostRead);
    }

    /// What was counted over `count` pixels, by a submission that was waited for.
    pub(crate) fn read(&self, count: u32) -> RayCounts {
        let words: Vec<u32> = self.readback.read(0, WORDS);
        let sum = |index: usize| u64::from(words[2 * index]) | u64::from(words[2 * index + 1]) << 32;
        RayCounts { primary: count.into(), ambient: sum(0), chord: sum(1), shadow: sum(2) }
    }
}
