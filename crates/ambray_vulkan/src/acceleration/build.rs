//! How builds are described to the device.

use ambray_scene::animation::UpdatePolicy;
use ash::vk;

use crate::Context;

/// How a structure is to be built.
#[derive(Clone, Copy, Debug)]
pub(super) struct Manner {
    pub(super) opaque: bool,
    /// What is done at new poses, if its vertices move.
    pub(super) follows: Option<UpdatePolicy>,
}

impl Manner {
    /// Flags of the builds.
    ///
    /// What is refitted is built once and traced for many frames, with its faults growing: the better tree counts, as for
    /// what stays. What is built anew for each frame is traced for one, and is never updated.
    pub(super) fn flags(self, compact: bool) -> vk::BuildAccelerationStructureFlagsKHR {
        use vk::BuildAccelerationStructureFlagsKHR as Flags;
        match self.follows {
            Some(UpdatePolicy::Rebuild) => Flags::PREFER_FAST_BUILD,
            Some(UpdatePolicy::Auto | UpdatePolicy::Refit | UpdatePolicy::Cache) => {
                Flags::PREFER_FAST_TRACE | Flags::ALLOW_UPDATE
            }
            None if compact => Flags::PREFER_FAST_TRACE | Flags::ALLOW_COMPACTION,
            None => Flags::PREFER_FAST_TRACE,
        }
    }

    /// Flags of the geometry.
    pub(super) fn geometry_flags(self) -> vk::GeometryFlagsKHR {
        if self.opaque { vk::GeometryFlagsKHR::OPAQUE } else { vk::GeometryFlagsKHR::empty() }
    }
}

/// Triangles with their vertices and vertex numbers at these addresses.
pub(super) fn triangles(
    vertices: vk::DeviceAddress,
    vertex_count: u64,
    indices: vk::DeviceAddress,
    manner: Manner,
) -> vk::AccelerationStructureGeometryKHR<'static> {
    let at = |device_address| vk::DeviceOrHostAddressConstKHR { device_address };
    let triangles = vk::AccelerationStructureGeometryTrianglesDataKHR::default()
        .vertex_format(vk::Format::R32G32B32_SFLOAT)
        .vertex_data(at(vertices))
        .vertex_stride(12)
        .max_vertex(vertex_count.saturating_sub(1) as u32)
        .index_type(vk::IndexType::UINT32)
        .index_data(at(indices));
    vk::AccelerationStructureGeometryKHR::default()
        .geometry_type(vk::GeometryTypeKHR::TRIANGLES)
        .geometry(vk::AccelerationStructureGeometryDataKHR { triangles })
        .flags(manner.geometry_flags())
}

/// The build of a bottom-level structure.
pub(super) fn info<'a>(
    geometry: &'a [vk::AccelerationStructureGeometryKHR<'a>],
    flags: vk::BuildAccelerationStructureFlagsKHR,
) -> vk::AccelerationStructureBuildGeometryInfoKHR<'a> {
    vk::AccelerationStructureBuildGeometryInfoKHR::default()
        .ty(vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL)
        .flags(flags)
        .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
        .geometries(geometry)
}

/// Memory that a bottom-level structure of `count` primitives takes.
pub(super) fn sizes(
    context: &Context,
    geometry: vk::AccelerationStructureGeometryKHR<'_>,
    count: u32,
    flags: vk::BuildAccelerationStructureFlagsKHR,
) -> vk::AccelerationStructureBuildSizesInfoKHR<'static> {
    let geometry = [geometry];
    let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
    // SAFETY: sizes follow counts, formats and flags; addresses are not read.
    unsafe {
        context.acceleration.get_acceleration_structure_build_sizes(
            vk::AccelerationStructureBuildTypeKHR::DEVICE,
            &info(&geometry, flags),
            &[count],
            &mut sizes,
        );
    }
    sizes
}
