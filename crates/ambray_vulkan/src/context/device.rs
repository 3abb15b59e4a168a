//! From a physical device to an open one.

use std::mem::ManuallyDrop;
use std::sync::Mutex;

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings};

use super::instance::Instance;
use super::probe::{self, DeviceReport};
use super::{Context, Limits};
use crate::error::{Result, VulkanError};

/// Memory taken from the driver at once, bytes, for things that share it: on the device, and visible to the host.
const BLOCKS: (u64, u64) = (64 << 20, 16 << 20);

/// Opens `physical`, which must be usable by its `report`.
pub(super) fn open(
    instance: Instance,
    physical: vk::PhysicalDevice,
    report: DeviceReport,
) -> Result<Context> {
    let Some((queue_family, timestamp_bits)) = probe::queue_family(&instance.raw, physical) else {
        return Err(VulkanError::Missing { device: report.name, feature: "compute queue".into() });
    };
    let device = create(&instance, physical, &report, queue_family)?;
    let heap = report.memory;
    let allocator = Allocator::new(&AllocatorCreateDesc {
        instance: instance.raw.clone(),
        device: device.clone(),
        physical_device: physical,
        debug_settings: AllocatorDebugSettings::default(),
        buffer_device_address: true,
        allocation_sizes: AllocationSizes::new(BLOCKS.0, BLOCKS.1),
    })
    .map_err(|_| {
        // SAFETY: nothing has been made from the device yet, and it is not used again.
        unsafe { device.destroy_device(None) };
        VulkanError::Driver { call: "memory allocator", result: vk::Result::ERROR_INITIALIZATION_FAILED }
    })?;
    // SAFETY: the device was made with one queue of that family.
    let queue = unsafe { device.get_device_queue(queue_family, 0) };
    Ok(Context {
        acceleration: khr::acceleration_structure::Device::new(&instance.raw, &device),
        pipelines: report.pipeline.then(|| khr::ray_tracing_pipeline::Device::new(&instance.raw, &device)),
        names: instance.has_debug_utils.then(|| ext::debug_utils::Device::new(&instance.raw, &device)),
        queue: Mutex::new(queue),
        queue_family,
        allocator: ManuallyDrop::new(Mutex::new(allocator)),
        limits: Limits::of(&instance.raw, physical, report.pipeline, timestamp_bits, heap),
        report,
        physical,
        live: Default::default(),
        device,
        instance,
    })
}

/// Makes the device with exactly the features that are needed, which `report` says are there, and what drawing into the
/// window takes if the instance has one.
fn create(
    with: &Instance,
    physical: vk::PhysicalDevice,
    report: &DeviceReport,
    queue_family: u32,
) -> Result<ash::Device> {
    let instance = &with.raw;
    let has = probe::extensions(instance, physical)?;
    let mut names =
        vec![khr::deferred_host_operations::NAME.as_ptr(), khr::acceleration_structure::NAME.as_ptr()];
    let mut twelve =
        vk::PhysicalDeviceVulkan12Features::default().buffer_device_address(true).scalar_block_layout(true);
    let mut structure =
        vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default().acceleration_structure(true);
    let mut pipeline = vk::PhysicalDeviceRayTracingPipelineFeaturesKHR::default().ray_tracing_pipeline(true);
    let mut query = vk::PhysicalDeviceRayQueryFeaturesKHR::default().ray_query(true);
    let core = vk::PhysicalDeviceFeatures::default().shader_int64(true);
    let priorities = [1.0];
    let queues =
        [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&priorities)];
    let mut info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_features(&core)
        .push_next(&mut twelve)
        .push_next(&mut structure);
    if report.pipeline {
        names.push(khr::ray_tracing_pipeline::NAME.as_ptr());
        info = info.push_next(&mut pipeline);
    }
    if report.query {
        names.push(khr::ray_query::NAME.as_ptr());
        info = info.push_next(&mut query);
    }
    if with.surface().is_some() {
        names.push(khr::swapchain::NAME.as_ptr());
    }
    // A device that offers it must be given it.
    if has(khr::portability_subset::NAME) {
        names.push(khr::portability_subset::NAME.as_ptr());
    }
    let info = info.enabled_extension_names(&names);
    // SAFETY: every pointer in `info` is to a local that lives until the call returns; the report says that the device
    // has all of these extensions and features.
    unsafe { instance.create_device(physical, &info, None) }.map_err(VulkanError::of("vkCreateDevice"))
}
