//! What each device is and can do.

use std::ffi::{CStr, c_char};

use ash::{khr, vk};

use super::instance::Instance;
use crate::error::Result;

/// A Vulkan device and whether Ambray can use it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceReport {
    /// Position in the loader's list, from 0: the number that [`DeviceOptions::device`](super::DeviceOptions) takes.
    pub number: usize,
    /// Name that the driver gives.
    pub name: String,
    /// What sort of device it is.
    pub kind: DeviceKind,
    /// Who made it, or the vendor's number in hexadecimal.
    pub vendor: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Vulkan version that the device offers.
    pub api: String,
    /// Size of the device's own memory, bytes.
    pub memory: u64,
    /// Everything that Ambray asks for, present or not.
    pub capabilities: Vec<Capability>,
    /// What is missing, in words; empty if Ambray can use the device.
    pub missing: Vec<&'static str>,
    /// Whether ray-tracing pipelines can run.
    pub pipeline: bool,
    /// Whether ray queries in compute shaders can run.
    pub query: bool,
}

impl DeviceReport {
    /// Whether nothing is missing.
    #[must_use]
    pub const fn is_usable(&self) -> bool {
        self.missing.is_empty()
    }
}

/// Something that a device may offer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capability {
    /// Vulkan's name of it.
    pub name: &'static str,
    /// Whether Ambray runs without it.
    pub need: Need,
    /// Whether the device offers it.
    pub present: bool,
}

/// How much Ambray depends on a [`Capability`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Nothing runs without it.
    Required,
    /// One way of tracing rays, of which one must be there.
    Either,
}

/// Sort of device, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DeviceKind {
    /// A graphics card.
    Discrete,
    /// Graphics within the processor.
    Integrated,
    /// A device of a virtual machine.
    Virtual,
    /// Something else.
    Other,
    /// The processor, posing as a device.
    Software,
}

impl DeviceKind {
    /// One word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::Integrated => "integrated",
            Self::Virtual => "virtual",
            Self::Other => "other",
            Self::Software => "software",
        }
    }
}

/// Lists all Vulkan devices of this machine, usable or not.
pub fn probe() -> Result<Vec<DeviceReport>> {
    let instance = Instance::new(false, None)?;
    let devices = instance.physical_devices()?;
    devices.iter().enumerate().map(|(number, &device)| report(&instance.raw, number, device)).collect()
}

/// Number of the queue family to use: one with compute, and graphics too if there is one.
pub(super) fn queue_family(instance: &ash::Instance, device: vk::PhysicalDevice) -> Option<(u32, u32)> {
    // SAFETY: the handle came from this instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(device) };
    let with = |flags| families.iter().position(move |f| f.queue_flags.contains(flags) && f.queue_count > 0);
    let family =
        with(vk::QueueFlags::COMPUTE | vk::QueueFlags::GRAPHICS).or_else(|| with(vk::QueueFlags::COMPUTE))?;
    Some((family as u32, families[family].timestamp_valid_bits))
}

/// Whether `device` offers the extension `name`.
pub(super) fn extensions(
    instance: &ash::Instance,
    device: vk::PhysicalDevice,
) -> Result<impl Fn(&CStr) -> bool> {
    // SAFETY: the handle came from this instance.
    let list = unsafe { instance.enumerate_device_extension_properties(device) }
        .map_err(crate::VulkanError::of("vkEnumerateDeviceExtensionProperties"))?;
    Ok(move |name: &CStr| list.iter().any(|e| e.extension_name_as_c_str() == Ok(name)))
}

/// Looks at `device`, which has the number `number`.
pub(super) fn report(
    instance: &ash::Instance,
    number: usize,
    device: vk::PhysicalDevice,
) -> Result<DeviceReport> {
    // SAFETY: the handle came from this instance.
    let properties = unsafe { instance.get_physical_device_properties(device) };
    let is_recent = properties.api_version >= vk::API_VERSION_1_2;
    let capabilities = capabilities(instance, device, is_recent)?;
    let is_present = |name| capabilities.iter().any(|c| c.name == name && c.present);
    let (pipeline, query) = (is_present("rayTracingPipeline"), is_present("rayQuery"));
    let mut missing: Vec<_> =
        capabilities.iter().filter(|c| c.need == Need::Required && !c.present).map(|c| c.name).collect();
    if !pipeline && !query {
        missing.push("rayTracingPipeline or rayQuery");
    }
    let version = properties.api_version;
    Ok(DeviceReport {
        number,
        name: text(&properties.device_name),
        kind: match properties.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
            vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
            vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
            vk::PhysicalDeviceType::CPU => DeviceKind::Software,
            _ => DeviceKind::Other,
        },
        vendor: vendor(properties.vendor_id),
        driver: driver(instance, device, is_recent),
        api: format!(
            "{}.{}.{}",
            vk::api_version_major(version),
            vk::api_version_minor(version),
            vk::api_version_patch(version)
        ),
        memory: device_memory(instance, device),
        capabilities,
        missing,
        pipeline,
        query,
    })
}

/// Everything Ambray asks for. Structures of version 1.2 and of extensions go only to devices that know them.
fn capabilities(
    instance: &ash::Instance,
    device: vk::PhysicalDevice,
    is_recent: bool,
) -> Result<Vec<Capability>> {
    let has = extensions(instance, device)?;
    let structures = has(khr::acceleration_structure::NAME) && has(khr::deferred_host_operations::NAME);
    let (pipelines, queries) = (has(khr::ray_tracing_pipeline::NAME), has(khr::ray_query::NAME));
    let mut twelve = vk::PhysicalDeviceVulkan12Features::default();
    let mut structure = vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default();
    let mut pipeline = vk::PhysicalDeviceRayTracingPipelineFeaturesKHR::default();
    let mut query = vk::PhysicalDeviceRayQueryFeaturesKHR::default();
    let mut base = vk::PhysicalDeviceFeatures2::default();
    if is_recent {
        base = base.push_next(&mut twelve);
        if structures {
            base = base.push_next(&mut structure);
        }
        if pipelines {
            base = base.push_next(&mut pipeline);
        }
        if queries {
            base = base.push_next(&mut query);
        }
        // SAFETY: the device offers version 1.2 and the extensions whose structures are chained, all of which are locals.
        unsafe { instance.get_physical_device_features2(device, &mut base) };
    }
    let int64 = base.features.shader_int64;
    let required = |name, present| Capability { name, need: Need::Required, present };
    let either = |name, present| Capability { name, need: Need::Either, present };
    let on = |flag: vk::Bool32| flag == vk::TRUE;
    Ok(vec![
        required("Vulkan 1.2", is_recent),
        required("compute queue", queue_family(instance, device).is_some()),
        required("bufferDeviceAddress", on(twelve.buffer_device_address)),
        required("scalarBlockLayout", on(twelve.scalar_block_layout)),
        required("shaderInt64", on(int64)),
        required("accelerationStructure", on(structure.acceleration_structure)),
        either("rayTracingPipeline", on(pipeline.ray_tracing_pipeline)),
        either("rayQuery", on(query.ray_query)),
    ])
}

fn driver(instance: &ash::Instance, device: vk::PhysicalDevice, is_recent: bool) -> String {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut base = vk::PhysicalDeviceProperties2::default();
    if is_recent {
        base = base.push_next(&mut driver);
        // SAFETY: the device offers version 1.2, which has the structure that is chained, a local.
        unsafe { instance.get_physical_device_properties2(device, &mut base) };
    }
    format!("{} {}", text(&driver.driver_name), text(&driver.driver_info)).trim().to_owned()
}

/// Size of the device's largest memory of its own, bytes.
fn device_memory(instance: &ash::Instance, device: vk::PhysicalDevice) -> u64 {
    // SAFETY: the handle came from this instance.
    let memory = unsafe { instance.get_physical_device_memory_properties(device) };
    let local = |h: &&vk::MemoryHeap| h.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL);
    memory.memory_heaps_as_slice().iter().filter(local).map(|h| h.size).max().unwrap_or(0)
}

fn vendor(id: u32) -> String {
    match id {
        0x1002 => "AMD".into(),
        0x1010 => "Imagination".into(),
        0x106b => "Apple".into(),
        0x10de => "NVIDIA".into(),
        0x13b5 => "ARM".into(),
        0x5143 => "Qualcomm".into(),
        0x8086 => "Intel".into(),
        0x10005 => "Mesa".into(),
        _ => format!("{id:#06x}"),
    }
}

/// Text of a field of fixed length, as far as it goes.
fn text(field: &[c_char]) -> String {
    let bytes: Vec<u8> = field.iter().map(|&c| c as u8).take_while(|&c| c != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
