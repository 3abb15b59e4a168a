//! The top-level structure: built anew for each frame, since what is in it depends on the view.

use std::sync::Arc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::Affine3A;

use super::cull::View;
use super::structure::{Scratch, Structure};
use super::{Acceleration, Culling};
use crate::commands::Work;
use crate::error::Result;
use crate::layout::RAY_TYPES;
use crate::{Buffer, Context, Location, Recorder};

/// Triangles are seen from both sides.
const FLAGS: vk::GeometryInstanceFlagsKHR = vk::GeometryInstanceFlagsKHR::TRIANGLE_FACING_CULL_DISABLE;

/// An entry as Vulkan reads it: `VkAccelerationStructureInstanceKHR`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Record {
    /// Rows of 4.
    transform: [f32; 12],
    /// Index of the placement in the low 24 bits, mask in the high 8.
    custom_and_mask: u32,
    /// Offset into the shader binding table in the low 24 bits, flags in the high 8.
    offset_and_flags: u32,
    structure: u64,
}

/// The top-level structure of one frame at a time. Frames in flight at once need one each.
#[derive(Debug)]
pub struct TopLevel {
    structure: Structure,
    scratch: Scratch,
    records: Buffer,
    capacity: u32,
}

impl TopLevel {
    /// Makes one that has room for all placements of `acceleration`. It must be [built](Self::build) before use.
    pub fn new(context: &Arc<Context>, acceleration: &Acceleration) -> Result<Self> {
        let capacity = acceleration.placements().len() as u32;
        let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let size = u64::from(capacity) * size_of::<Record>() as u64;
        // Records must begin at multiples of 16, which buffers do that hold more than a few bytes; see `base`.
        let records = context.buffer("instances", size + 16, usage, Location::Upload)?;
        let geometry = [geometry(0)];
        let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
        // SAFETY: sizes follow the count; addresses are not read.
        unsafe {
            context.acceleration.get_acceleration_structure_build_sizes(
                vk::AccelerationStructureBuildTypeKHR::DEVICE,
                &build_info(&geometry),
                &[capacity],
                &mut sizes,
            );
        }
        let structure = Structure::new(
            context,
            "top-level structure",
            vk::AccelerationStructureTypeKHR::TOP_LEVEL,
            sizes.acceleration_structure_size.max(256),
        )?;
        let scratch = Scratch::new(context, sizes.build_scratch_size)?;
        Ok(Self { structure, scratch, records, capacity })
    }

    /// Records the build of what the rays of `culling` can meet, or of everything; returns the number of entries. All
    /// earlier traces through it in the queue are waited for, and later ones wait for the build.
    ///
    /// The device must be done with the last build: its input is overwritten at once. `acceleration` must be the one that
    /// this was made for, and both must live until the commands have run.
    ///
    /// # Panics
    /// If there is no room for all placements.
    pub fn build(
        &mut self,
        recorder: &mut Recorder<'_>,
        acceleration: &Acceleration,
        culling: Option<&Culling<'_>>,
    ) -> u32 {
        assert!(acceleration.placements().len() <= self.capacity as usize);
        let records = records(acceleration, culling);
        let address = self.records.address().next_multiple_of(16);
        self.records.write(address - self.records.address(), &records);
        let geometry = [geometry(address)];
        let info = build_info(&geometry)
            .dst_acceleration_structure(self.structure.handle())
            .scratch_data(vk::DeviceOrHostAddressKHR { device_address: self.scratch.address() });
        let count = records.len() as u32;
        let range = [vk::AccelerationStructureBuildRangeInfoKHR::default().primitive_count(count)];
        // Earlier frames may be tracing through what is overwritten, or building in the scratch memory.
        recorder.barrier(Work::TraceRays, Work::BuildStructure);
        recorder.barrier(Work::Compute, Work::BuildStructure);
        recorder.barrier(Work::BuildStructure, Work::BuildStructure);
        recorder.barrier(Work::HostWrite, Work::BuildStructure);
        // SAFETY: records, scratch and structure have room for all placements and live until this has run, as the caller
        // promises; the records refer to structures of `acceleration`, which live as long.
        unsafe {
            let commands = &recorder.context().acceleration;
            commands.cmd_build_acceleration_structures(recorder.raw(), &[info], &[&range]);
        }
        recorder.barrier(Work::BuildStructure, Work::TraceRays);
        recorder.barrier(Work::BuildStructure, Work::Compute);
        count
    }

    /// The handle, for descriptors; the same for the life of `self`.
    #[must_use]
    pub const fn handle(&self) -> vk::AccelerationStructureKHR {
        self.structure.handle()
    }

    /// Size of the structure without its input and scratch memory, bytes.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        self.structure.size()
    }
}

/// Entries for everything that rays can meet, in the spatial order of the placements.
fn records(acceleration: &Acceleration, culling: Option<&Culling<'_>>) -> Vec<Record> {
    let view = View::new(culling, acceleration.extent());
    let record = |(index, placed): (u32, &super::Placed)| {
        let mask = view.mask(placed.bounds?);
        (mask != 0).then(|| Record {
            transform: rows(&placed.transform),
            custom_and_mask: index | (u32::from(mask) << 24),
            offset_and_flags: (placed.kind as u32 * RAY_TYPES) | (FLAGS.as_raw() << 24),
            structure: acceleration.structure_address(placed.structure),
        })
    };
    (0_u32..).zip(acceleration.placed()).filter_map(record).collect()
}

fn rows(transform: &Affine3A) -> [f32; 12] {
    let (m, t) = (transform.matrix3, transform.translation);
    let row = |i: usize| [m.x_axis[i], m.y_axis[i], m.z_axis[i], t[i]];
    bytemuck::cast([row(0), row(1), row(2)])
}

fn geometry(address: vk::DeviceAddress) -> vk::AccelerationStructureGeometryKHR<'static> {
    let instances = vk::AccelerationStructureGeometryInstancesDataKHR::default()
        .data(vk::DeviceOrHostAddressConstKHR { device_address: address });
    vk::AccelerationStructureGeometryKHR::default()
        .geometry_type(vk::GeometryTypeKHR::INSTANCES)
        .geometry(vk::AccelerationStructureGeometryDataKHR { instances })
}

/// For fast tracing: a frame sends millions of rays through at most some thousand entries, whose build is a small part of
/// it either way.
fn build_info<'a>(
    geometry: &'a [vk::AccelerationStructureGeometryKHR<'a>],
) -> vk::AccelerationStructureBuildGeometryInfoKHR<'a> {
    vk::AccelerationStructureBuildGeometryInfoKHR::default()
        .ty(vk::AccelerationStructureTypeKHR::TOP_LEVEL)
        .flags(vk::BuildAccelerationStructureFlagsKHR::PREFER_FAST_TRACE)
        .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
        .geometries(geometry)
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Vec3};

    use super::*;

    #[test]
    fn transforms_are_stored_by_rows() {
        let transform = Affine3A::from_mat3_translation(
            Mat3::from_cols_array(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]),
            Vec3::new(10.0, 11.0, 12.0),
        );
        assert_eq!(rows(&transform), [1.0, 4.0, 7.0, 10.0, 2.0, 5.0, 8.0, 11.0, 3.0, 6.0, 9.0, 12.0]);
        assert_eq!(size_of::<Record>(), size_of::<vk::AccelerationStructureInstanceKHR>());
    }
}
