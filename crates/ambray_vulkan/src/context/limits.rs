//! Limits of a device.

use ash::vk;

/// Alignment of shader binding tables, bytes, where a driver asks for less. Software drivers do, and would hide a mistake
/// that graphics cards punish.
const TABLE_ALIGNMENT: u32 = 64;

/// Alignment of scratch memory, bytes, where a driver asks for less.
const SCRATCH_ALIGNMENT: u32 = 256;

/// What a device allows. Sizes are in bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Size of a shader group's handle.
    pub group_handle_size: u32,
    /// Alignment of a record in a shader binding table.
    pub group_handle_alignment: u32,
    /// Alignment of a shader binding table: what the device reports, at least 64.
    pub group_base_alignment: u32,
    /// Largest distance of two records of a shader binding table.
    pub group_stride: u32,
    /// Most rays that one call may trace.
    pub ray_invocations: u32,
    /// Most levels of tracing rays from hit and miss shaders.
    pub ray_recursion: u32,
    /// Alignment of scratch memory: what the device reports, at least 256.
    pub scratch_alignment: u32,
    /// Most instances of a top-level structure.
    pub instances: u64,
    /// Most primitives of a bottom-level structure.
    pub primitives: u64,
    /// Largest range of a buffer that a descriptor makes visible.
    pub storage_range: u32,
    /// Shared memory of a workgroup.
    pub shared_memory: u32,
    /// Most invocations of a workgroup.
    pub workgroup: u32,
    /// Most workgroups of a dispatch along each axis.
    pub workgroup_count: [u32; 3],
    /// Size of the push constants.
    pub push_constants: u32,
    /// Invocations of a subgroup.
    pub subgroup: u32,
    /// Nanoseconds a tick of timestamps.
    pub timestamp_period: f32,
    /// Bits of a timestamp that count; 0 where the queue has none.
    pub timestamp_bits: u32,
    /// Largest single allocation.
    pub allocation: u64,
    /// Size of the largest heap that is local to the device.
    pub heap: u64,
    /// Most pixels along a side of an image.
    pub image_side: u32,
    /// Granularity with which memory that is not coherent is flushed.
    pub atom: u64,
}

impl Limits {
    /// Asks `device`, which must offer Vulkan 1.2 and acceleration structures, and ray-tracing pipelines if `pipelines`.
    pub(super) fn of(
        instance: &ash::Instance,
        device: vk::PhysicalDevice,
        pipelines: bool,
        timestamp_bits: u32,
        heap: u64,
    ) -> Self {
        let mut structure = vk::PhysicalDeviceAccelerationStructurePropertiesKHR::default();
        let mut pipeline = vk::PhysicalDeviceRayTracingPipelinePropertiesKHR::default();
        let mut eleven = vk::PhysicalDeviceVulkan11Properties::default();
        let mut base =
            vk::PhysicalDeviceProperties2::default().push_next(&mut structure).push_next(&mut eleven);
        if pipelines {
            base = base.push_next(&mut pipeline);
        }
        // SAFETY: the device offers the version and the extensions whose structures are chained, all of which are locals.
        unsafe { instance.get_physical_device_properties2(device, &mut base) };
        let limits = base.properties.limits;
        Self {
            group_handle_size: pipeline.shader_group_handle_size,
            group_handle_alignment: pipeline.shader_group_handle_alignment,
            group_base_alignment: pipeline.shader_group_base_alignment.max(TABLE_ALIGNMENT),
            group_stride: pipeline.max_shader_group_stride,
            ray_invocations: pipeline.max_ray_dispatch_invocation_count,
            ray_recursion: pipeline.max_ray_recursion_depth,
            scratch_alignment: structure
                .min_acceleration_structure_scratch_offset_alignment
                .max(SCRATCH_ALIGNMENT),
            instances: structure.max_instance_count,
            primitives: structure.max_primitive_count,
            storage_range: limits.max_storage_buffer_range,
            shared_memory: limits.max_compute_shared_memory_size,
            workgroup: limits.max_compute_work_group_invocations,
            workgroup_count: limits.max_compute_work_group_count,
            push_constants: limits.max_push_constants_size,
            subgroup: eleven.subgroup_size,
            timestamp_period: limits.timestamp_period,
            timestamp_bits,
            allocation: eleven.max_memory_allocation_size,
            heap,
            image_side: limits.max_image_dimension2_d,
            atom: limits.non_coherent_atom_size.max(1),
        }
    }
}
