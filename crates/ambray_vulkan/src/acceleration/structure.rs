//! Acceleration structures and the memory behind them.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use ash::vk;

use crate::error::{Result, VulkanError};
use crate::{Buffer, Context, Location};

/// An acceleration structure in a buffer of its own. The device must be done with it when it is dropped.
#[derive(Debug)]
pub(super) struct Structure {
    context: Arc<Context>,
    handle: vk::AccelerationStructureKHR,
    address: vk::DeviceAddress,
    /// Dropped after the handle that lives in it.
    buffer: Buffer,
}

impl Structure {
    /// Makes a structure of `size` bytes with nothing in it.
    pub(super) fn new(
        context: &Arc<Context>,
        name: &str,
        kind: vk::AccelerationStructureTypeKHR,
        size: u64,
    ) -> Result<Self> {
        let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let buffer = context.buffer(name, size, usage, Location::Device)?;
        let info =
            vk::AccelerationStructureCreateInfoKHR::default().buffer(buffer.handle()).size(size).ty(kind);
        // SAFETY: the buffer is large enough, has the usage for it, and lives as long as the structure.
        let handle = unsafe { context.acceleration.create_acceleration_structure(&info, None) }
            .map_err(|r| VulkanError::at("vkCreateAccelerationStructureKHR", name, size, r))?;
        let info = vk::AccelerationStructureDeviceAddressInfoKHR::default().acceleration_structure(handle);
        // SAFETY: the structure was just made.
        let address = unsafe { context.acceleration.get_acceleration_structure_device_address(&info) };
        context.name(handle, name);
        context.counters().acceleration_structures.fetch_add(1, Ordering::Relaxed);
        Ok(Self { context: Arc::clone(context), handle, address, buffer })
    }

    pub(super) const fn handle(&self) -> vk::AccelerationStructureKHR {
        self.handle
    }

    pub(super) const fn address(&self) -> vk::DeviceAddress {
        self.address
    }

    /// Bytes.
    pub(super) const fn size(&self) -> u64 {
        self.buffer.size()
    }
}

impl Drop for Structure {
    fn drop(&mut self) {
        self.context.counters().acceleration_structures.fetch_sub(1, Ordering::Relaxed);
        // SAFETY: the device is done with the structure, as the type demands of its users; the buffer follows as a field.
        unsafe { self.context.acceleration.destroy_acceleration_structure(self.handle, None) };
    }
}

/// Scratch memory for builds: aligned as the device wants it, which buffers alone need not be.
#[derive(Debug)]
pub(crate) struct Scratch {
    buffer: Buffer,
    address: vk::DeviceAddress,
}

impl Scratch {
    /// Makes one of at least `size` bytes.
    pub(crate) fn new(context: &Arc<Context>, size: u64) -> Result<Self> {
        let alignment = u64::from(context.limits().scratch_alignment);
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let buffer = context.buffer("scratch of builds", size + alignment, usage, Location::Device)?;
        let address = buffer.address().next_multiple_of(alignment);
        Ok(Self { buffer, address })
    }

    /// Where it begins, aligned.
    pub(super) const fn address(&self) -> vk::DeviceAddress {
        self.address
    }

    /// Bytes it takes, alignment included.
    pub(super) const fn size(&self) -> u64 {
        self.buffer.size()
    }
}
