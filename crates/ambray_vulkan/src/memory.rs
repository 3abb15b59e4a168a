//! Buffers and the memory behind them.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use ash::vk;
use bytemuck::Pod;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use gpu_allocator::{AllocationError, MemoryLocation};

use crate::Context;
use crate::commands::Work;
use crate::error::{MemorySide, Result, VulkanError};

/// Alignment that shaders rely on, bytes: that of a vector of four numbers.
const VECTOR: u64 = 16;

/// Largest staging buffer of an upload, bytes.
const STAGING: u64 = 64 << 20;

/// Where a buffer lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// In the device's own memory, out of reach of the host.
    Device,
    /// Where the host writes and the device reads.
    Upload,
    /// Where the device writes and the host reads.
    Readback,
}

/// A buffer with its memory, given back when dropped. The device must be done with it by then: whoever submits work waits
/// for it before dropping what it uses.
pub struct Buffer {
    context: Arc<Context>,
    name: String,
    size: u64,
    handle: vk::Buffer,
    /// Taken when dropped.
    allocation: Allocation,
    address: vk::DeviceAddress,
}

impl Context {
    /// Makes a buffer of `size` bytes; an empty one gets a few, since Vulkan has none of size 0. Its content is undefined.
    pub fn buffer(
        self: &Arc<Self>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: Location,
    ) -> Result<Buffer> {
        Buffer::new(self, name, size, usage, location)
    }

    /// Makes a buffer on the device that holds `content`, and waits until it is there.
    pub fn upload<T: Pod>(
        self: &Arc<Self>,
        name: &str,
        usage: vk::BufferUsageFlags,
        content: &[T],
    ) -> Result<Buffer> {
        let bytes: &[u8] = bytemuck::cast_slice(content);
        let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = self.buffer(name, bytes.len() as u64, usage, Location::Device)?;
        if bytes.is_empty() {
            return Ok(buffer);
        }
        let chunk = STAGING.min(bytes.len() as u64);
        let mut staging =
            self.buffer("staging", chunk, vk::BufferUsageFlags::TRANSFER_SRC, Location::Upload)?;
        for (index, part) in bytes.chunks(STAGING as usize).enumerate() {
            staging.write(0, part);
            self.run(|recorder| {
                recorder.barrier(Work::HostWrite, Work::Transfer);
                recorder.copy(&staging, 0, &buffer, index as u64 * STAGING, part.len() as u64);
                recorder.barrier(Work::Transfer, Work::Everything);
                Ok(())
            })?;
        }
        Ok(buffer)
    }
}

impl Buffer {
    fn new(
        context: &Arc<Context>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: Location,
    ) -> Result<Self> {
        let limits = context.limits();
        let fits_heap = location != Location::Device || size <= limits.heap;
        if size > limits.allocation || !fits_heap {
            let what = name.to_owned();
            return Err(VulkanError::OutOfMemory { side: MemorySide::Device, what, bytes: size });
        }
        let device = &context.device;
        let info = vk::BufferCreateInfo::default()
            .size(size.max(16))
            .usage(usage)
            .sharing_mode(vk::SharingMode::EXCLUSIVE);
        // SAFETY: the device is alive; the buffer is destroyed once, below on failure or in `Drop`.
        let handle = unsafe { device.create_buffer(&info, None) }
            .map_err(|r| VulkanError::at("vkCreateBuffer", name, size, r))?;
        match allocate(context, name, size, handle, location) {
            Ok(allocation) => {
                let address = if usage.contains(vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS) {
                    let info = vk::BufferDeviceAddressInfo::default().buffer(handle);
                    // SAFETY: the buffer has the usage that this needs and is bound to memory that was allocated with
                    // addresses, as the allocator was told.
                    unsafe { device.get_buffer_device_address(&info) }
                } else {
                    0
                };
                context.name(handle, name);
                let live = context.counters();
                live.buffers.fetch_add(1, Ordering::Relaxed);
                live.bytes.fetch_add(allocation.size(), Ordering::Relaxed);
                Ok(Self {
                    context: Arc::clone(context),
                    name: name.to_owned(),
                    size,
                    handle,
                    allocation,
                    address,
                })
            }
            Err(error) => {
                // SAFETY: nobody else has seen the handle.
                unsafe { device.destroy_buffer(handle, None) };
                Err(error)
            }
        }
    }

    /// The handle, valid as long as `self`.
    #[must_use]
    pub const fn handle(&self) -> vk::Buffer {
        self.handle
    }

    /// Address on the device; 0 without the usage `SHADER_DEVICE_ADDRESS`.
    #[must_use]
    pub const fn address(&self) -> vk::DeviceAddress {
        self.address
    }

    /// Size as it was asked for, bytes.
    #[must_use]
    pub const fn size(&self) -> u64 {
        self.size
    }

    /// What it is for.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Writes `content` at `offset` bytes. The device must not be using the buffer.
    ///
    /// # Panics
    /// If the content does not fit, or if the buffer is not [`Location::Upload`] or [`Location::Readback`].
    pub fn write<T: Pod>(&mut self, offset: u64, content: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(content);
        let start = self.checked_range(offset, bytes.len());
        let mapped = self.allocation.mapped_slice_mut().expect("the buffer is visible to the host");
        mapped[start..start + bytes.len()].copy_from_slice(bytes);
    }

    /// Reads `count` values at `offset` bytes. The device must be done with writing, and a barrier to
    /// [`Work::HostRead`] behind it.
    ///
    /// # Panics
    /// If they are not within the buffer, or if it is not [`Location::Upload`] or [`Location::Readback`].
    #[must_use]
    pub fn read<T: Pod>(&self, offset: u64, count: usize) -> Vec<T> {
        let mut values = vec![T::zeroed(); count];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut values);
        let start = self.checked_range(offset, bytes.len());
        let mapped = self.allocation.mapped_slice().expect("the buffer is visible to the host");
        bytes.copy_from_slice(&mapped[start..start + bytes.len()]);
        values
    }

    fn checked_range(&self, offset: u64, len: usize) -> usize {
        let fits = offset.checked_add(len as u64).is_some_and(|end| end <= self.size);
        assert!(fits, "{len} bytes at {offset} do not fit '{}' of {} bytes", self.name, self.size);
        offset as usize
    }
}

/// Allocates memory for `buffer` and binds it.
///
/// Memory that the host sees is coherent: the allocator asks for it, and has no fallback without. So nothing is flushed or
/// invalidated.
fn allocate(
    context: &Context,
    name: &str,
    size: u64,
    buffer: vk::Buffer,
    location: Location,
) -> Result<Allocation> {
    // SAFETY: the buffer is of this device and alive.
    let mut requirements = unsafe { context.device.get_buffer_memory_requirements(buffer) };
    // Shaders read vectors of four from the start of buffers.
    requirements.alignment = requirements.alignment.max(VECTOR);
    let mut allocator = context.allocator();
    let description = AllocationCreateDesc {
        name,
        requirements,
        location: match location {
            Location::Device => MemoryLocation::GpuOnly,
            Location::Upload => MemoryLocation::CpuToGpu,
            Location::Readback => MemoryLocation::GpuToCpu,
        },
        linear: true,
        allocation_scheme: AllocationScheme::GpuAllocatorManaged,
    };
    let allocation = allocator.allocate(&description).map_err(|e| failure(e, name, size, location))?;
    debug_assert!(
        location == Location::Device
            || allocation.memory_properties().contains(vk::MemoryPropertyFlags::HOST_COHERENT)
    );
    // SAFETY: buffer and memory are of this device, the range was allocated for the buffer's requirements, and the buffer
    // is bound to nothing yet.
    let bound =
        unsafe { context.device.bind_buffer_memory(buffer, allocation.memory(), allocation.offset()) };
    if let Err(result) = bound {
        // An allocation that was just made is known to its allocator, so this cannot fail.
        let _ = allocator.free(allocation);
        return Err(VulkanError::at("vkBindBufferMemory", name, size, result));
    }
    Ok(allocation)
}

fn failure(error: AllocationError, name: &str, size: u64, location: Location) -> VulkanError {
    let out_of_memory = |side| VulkanError::OutOfMemory { side, what: name.to_owned(), bytes: size };
    match error {
        AllocationError::OutOfMemory if location == Location::Device => out_of_memory(MemorySide::Device),
        AllocationError::OutOfMemory | AllocationError::FailedToMap(_) => out_of_memory(MemorySide::Host),
        // The allocator keeps other results of the driver as text only.
        AllocationError::Internal(text) if text.contains("OUT_OF_HOST_MEMORY") => {
            out_of_memory(MemorySide::Host)
        }
        AllocationError::Internal(text) if text.contains("DEVICE_LOST") => VulkanError::DeviceLost,
        other => {
            log::error!("allocating '{name}': {other}");
            VulkanError::Driver { call: "vkAllocateMemory", result: vk::Result::ERROR_UNKNOWN }
        }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        let allocation = std::mem::take(&mut self.allocation);
        let live = self.context.counters();
        live.buffers.fetch_sub(1, Ordering::Relaxed);
        live.bytes.fetch_sub(allocation.size(), Ordering::Relaxed);
        // SAFETY: the device is done with the buffer, as the type demands of its users; the handle is not used again.
        unsafe { self.context.device.destroy_buffer(self.handle, None) };
        if let Err(error) = self.context.allocator().free(allocation) {
            log::error!("freeing '{}': {error}", self.name);
        }
    }
}

impl std::fmt::Debug for Buffer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Buffer").field("name", &self.name).field("size", &self.size).finish_non_exhaustive()
    }
}
