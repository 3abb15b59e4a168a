//! Images that shaders sample.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use crate::error::{MemorySide, Result, VulkanError};
use crate::Context;

/// Format of all images: display values as they are.
pub(super) const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;

/// An image with its memory. The device must be done with it when it is dropped.
pub(super) struct Image {
    context: Arc<Context>,
    handle: vk::Image,
    view: vk::ImageView,
    size: [u32; 2],
    /// Taken when dropped; `None` until there is memory.
    allocation: Option<Allocation>,
}

impl Image {
    /// An image of `size` to copy into and to sample, of undefined content.
    pub(super) fn new(context: &Arc<Context>, size: [u32; 2]) -> Result<Self> {
        let device = &context.device;
        let bytes = u64::from(size[0]) * u64::from(size[1]) * 4;
        let error = |call| move |result| VulkanError::at(call, "texture", bytes, result);
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .format(FORMAT)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::SAMPLED)
            .sharing_mode(vk::SharingMode::EXCLUSIVE)
            .samples(vk::SampleCountFlags::TYPE_1);
        // SAFETY: the device is alive as long as the context that the image holds; what is made here is destroyed by
        // dropping the image, also when a later call fails.
        let handle = unsafe { device.create_image(&info, None) }.map_err(error("vkCreateImage"))?;
        let mut image =
            Self { context: Arc::clone(context), handle, view: vk::ImageView::null(), size, allocation: None };
        // SAFETY: the image is of this device and alive.
        let requirements = unsafe { device.get_image_memory_requirements(handle) };
        let allocation = (context.allocator())
            .allocate(&AllocationCreateDesc {
                name: "texture",
                requirements,
                location: MemoryLocation::GpuOnly,
                linear: false,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|_| VulkanError::OutOfMemory {
                side: MemorySide::Device,
                what: "texture".into(),
                bytes,
            })?;
        let allocation = image.allocation.insert(allocation);
        // SAFETY: image and memory are of this device, the range was allocated for the image's requirements, and the image is
        // bound to nothing yet.
        unsafe { device.bind_image_memory(handle, allocation.memory(), allocation.offset()) }
            .map_err(error("vkBindImageMemory"))?;
        image.view = view(context, handle, FORMAT)?;
        context.name(handle, "texture");
        Ok(image)
    }

    pub(super) const fn handle(&self) -> vk::Image {
        self.handle
    }

    pub(super) const fn view(&self) -> vk::ImageView {
        self.view
    }

    pub(super) const fn size(&self) -> [u32; 2] {
        self.size
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        let device = &self.context.device;
        // SAFETY: the device is done with the image, as the type demands of its users; view and image are ours or null.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.handle, None);
        }
        if let Some(allocation) = self.allocation.take()
            && let Err(error) = self.context.allocator().free(allocation)
        {
            log::error!("freeing a texture: {error}");
        }
    }
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Image").field("size", &self.size).finish_non_exhaustive()
    }
}

/// The only level of a colour image.
pub(super) const fn whole() -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count: 1,
    }
}

/// A view of the whole of `image`, to be destroyed by the caller.
pub(super) fn view(context: &Context, image: vk::Image, format: vk::Format) -> Result<vk::ImageView> {
    let info = vk::ImageViewCreateInfo::default()
        .image(image)
        .view_type(vk::ImageViewType::TYPE_2D)
        .format(format)
        .subresource_range(whole());
    // SAFETY: the image is of this device, alive, and of this format.
    unsafe { context.device.create_image_view(&info, None) }.map_err(VulkanError::of("vkCreateImageView"))
}
