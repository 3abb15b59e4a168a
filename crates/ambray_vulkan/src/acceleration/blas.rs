//! Building of bottom-level structures in batches.

use std::sync::Arc;

use ash::vk;

use super::build::{self, Manner};
use super::input::{Input, Primitives};
use super::size_queries::SizeQueries;
use super::structure::{Scratch, Structure};
use crate::commands::Work;
use crate::error::{Result, VulkanError};
use crate::{Buffer, Context};

/// Builds structures, several at a time.
pub(super) struct Builder<'c> {
    context: &'c Arc<Context>,
    /// Whether what does not deform is copied to the size it needs.
    compact: bool,
    /// Scratch memory and input of a batch at most, bytes each, unless a single structure needs more.
    batch: u64,
    pending: Vec<Pending>,
    /// Scratch and input of what is pending, bytes.
    scratch: u64,
    input: u64,
    done: Vec<Structure>,
    pub(super) bytes_before: u64,
    pub(super) largest_scratch: u64,
}

/// A structure of the next batch.
struct Pending {
    primitives: Primitives,
    manner: Manner,
    structure: Structure,
    scratch: u64,
}

impl<'c> Builder<'c> {
    pub(super) const fn new(context: &'c Arc<Context>, compact: bool, batch: u64) -> Self {
        Self {
            context,
            compact,
            batch,
            pending: Vec::new(),
            scratch: 0,
            input: 0,
            done: Vec::new(),
            bytes_before: 0,
            largest_scratch: 0,
        }
    }

    /// Adds a structure with the primitives of `input`, which must have some; it is built now or later.
    pub(super) fn push(&mut self, input: Input, manner: Manner) -> Result<()> {
        let primitives = input.primitives;
        let (count, vertices) = primitives.counts();
        let limits = self.context.limits();
        if count > limits.primitives.min(u64::from(u32::MAX)) || vertices > u64::from(u32::MAX) {
            return Err(VulkanError::Limit {
                what: "primitives in one acceleration structure".into(),
                asked: count.max(vertices),
                limit: limits.primitives,
            });
        }
        let geometry = primitives.geometry(0, 0, manner);
        let sizes = build::sizes(self.context, geometry, count as u32, manner.flags(self.compact));
        let scratch = sizes.build_scratch_size.next_multiple_of(u64::from(limits.scratch_alignment));
        let is_full = self.scratch + scratch > self.batch || self.input + primitives.bytes() > self.batch;
        if is_full && !self.pending.is_empty() {
            self.flush()?;
        }
        let structure = Structure::new(
            self.context,
            "bottom-level structure",
            vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL,
            sizes.acceleration_structure_size,
        )?;
        self.scratch += scratch;
        self.input += primitives.bytes();
        self.pending.push(Pending { primitives, manner, structure, scratch });
        Ok(())
    }

    /// Builds what is left; all structures in the order in which they were added.
    pub(super) fn finish(&mut self) -> Result<Vec<Structure>> {
        self.flush()?;
        Ok(std::mem::take(&mut self.done))
    }

    /// Builds what is pending, and waits for it; then its input is freed.
    fn flush(&mut self) -> Result<()> {
        let batch = std::mem::take(&mut self.pending);
        if batch.is_empty() {
            return Ok(());
        }
        let inputs = Uploaded::new(self.context, &batch)?;
        let scratch = Scratch::new(self.context, std::mem::take(&mut self.scratch))?;
        self.input = 0;
        self.largest_scratch = self.largest_scratch.max(scratch.size());
        self.bytes_before += batch.iter().map(|p| p.structure.size()).sum::<u64>();

        let geometries: Vec<_> = batch
            .iter()
            .zip(&inputs.offsets)
            .map(|(p, &(first, second))| {
                [p.primitives.geometry(
                    inputs.first.address() + first,
                    inputs.second.address() + second,
                    p.manner,
                )]
            })
            .collect();
        let mut at = scratch.address();
        let infos: Vec<_> = (batch.iter().zip(&geometries))
            .map(|(p, geometry)| {
                let scratch_data = vk::DeviceOrHostAddressKHR { device_address: at };
                at += p.scratch;
                build::info(geometry, p.manner.flags(self.compact))
                    .dst_acceleration_structure(p.structure.handle())
                    .scratch_data(scratch_data)
            })
            .collect();
        let range = |p: &Pending| {
            [vk::AccelerationStructureBuildRangeInfoKHR::default()
                .primitive_count(p.primitives.counts().0 as u32)]
        };
        let ranges: Vec<_> = batch.iter().map(range).collect();
        let ranges: Vec<&[_]> = ranges.iter().map(|r| &r[..]).collect();
        let compactable: Vec<_> = batch
            .iter()
            .filter(|p| self.compact && p.manner.follows.is_none())
            .map(|p| p.structure.handle())
            .collect();
        let queries = SizeQueries::new(self.context, compactable.len() as u32)?;
        self.context.run(|recorder| {
            // SAFETY: addresses are of buffers that live until this has run, with ranges inside them; scratch ranges are
            // aligned and disjoint; the structures are as large as the driver asked for, and new.
            unsafe {
                let commands = &recorder.context().acceleration;
                commands.cmd_build_acceleration_structures(recorder.raw(), &infos, &ranges);
            }
            recorder.barrier(Work::BuildStructure, Work::BuildStructure);
            queries.record(recorder.raw(), &compactable);
            recorder.barrier(Work::BuildStructure, Work::Everything);
            Ok(())
        })?;
        drop((inputs, scratch));
        let mut sizes = queries.read()?.into_iter();
        let mut compacted = Vec::new();
        let mut copies = Vec::new();
        for pending in batch {
            if !self.compact || pending.manner.follows.is_some() {
                compacted.push(pending.structure);
                continue;
            }
            let size = sizes.next().unwrap_or(pending.structure.size());
            let small = Structure::new(
                self.context,
                "bottom-level structure",
                vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL,
                size,
            )?;
            copies.push((pending.structure, small.handle()));
            compacted.push(small);
        }
        self.compact(&copies)?;
        self.done.append(&mut compacted);
        Ok(())
    }

    /// Copies structures to smaller ones.
    fn compact(&self, copies: &[(Structure, vk::AccelerationStructureKHR)]) -> Result<()> {
        if copies.is_empty() {
            return Ok(());
        }
        self.context.run(|recorder| {
            for (from, to) in copies {
                let info = vk::CopyAccelerationStructureInfoKHR::default()
                    .src(from.handle())
                    .dst(*to)
                    .mode(vk::CopyAccelerationStructureModeKHR::COMPACT);
                // SAFETY: both live until this has run, the source was built with the flag for it, and the target has the
                // size that was asked from the source.
                unsafe {
                    let commands = &recorder.context().acceleration;
                    commands.cmd_copy_acceleration_structure(recorder.raw(), &info);
                }
            }
            recorder.barrier(Work::BuildStructure, Work::Everything);
            Ok(())
        })
    }
}

/// The input of a batch on the device.
struct Uploaded {
    /// Vertices and boxes.
    first: Buffer,
    /// Vertex numbers.
    second: Buffer,
    /// Of each structure, bytes.
    offsets: Vec<(u64, u64)>,
}

impl Uploaded {
    fn new(context: &Arc<Context>, batch: &[Pending]) -> Result<Self> {
        let (mut first, mut second, mut offsets) = (Vec::<u8>::new(), Vec::<u8>::new(), Vec::new());
        for pending in batch {
            // Boxes must begin at multiples of 8.
            first.resize(first.len().next_multiple_of(8), 0);
            offsets.push((first.len() as u64, second.len() as u64));
            match &pending.primitives {
                Primitives::Triangles { positions, triangles } => {
                    first.extend_from_slice(bytemuck::cast_slice(positions));
                    second.extend_from_slice(bytemuck::cast_slice(triangles));
                }
                Primitives::Boxes(boxes) => first.extend_from_slice(bytemuck::cast_slice(boxes)),
            }
        }
        let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        Ok(Self {
            first: context.upload("vertices and boxes of builds", usage, &first)?,
            second: context.upload("vertex numbers of builds", usage, &second)?,
            offsets,
        })
    }
}
