//! Images as Vulkan names their parts.

use ash::vk;

use crate::{
    Context,
    error::{Result, VulkanError},
};

/// The only level of a colour image.
pub(crate) const fn whole() -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count: 1,
    }
}

/// The same, to be copied from or to.
pub(crate) const fn whole_layer() -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        mip_level: 0,
        base_array_layer: 0,
        layer_count: 1,
    }
}

/// The way of `image` from a layout and its last access to the next ones, on one queue.
pub(crate) fn transition(
    image: vk::Image,
    layouts: [vk::ImageLayout; 2],
    accesses: [vk::AccessFlags; 2],
) -> vk::ImageMemoryBarrier<'static> {
    vk::ImageMemoryBarrier::default()
        .old_layout(layouts[0])
        .new_layout(layouts[1])
        .src_access_mask(accesses[0])
        .dst_access_mask(accesses[1])
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(image)
        .subresource_range(whole())
}

/// A view of the whole of `image`, to be destroyed by the caller.
pub(crate) fn view(context: &Context, image: vk::Image, format: vk::Format) -> Result<vk::ImageView> {
    let info = vk::ImageViewCreateInfo::default()
        .image(image)
        .view_type(vk::ImageViewType::TYPE_2D)
        .format(format)
        .subresource_range(whole());
    // SAFETY: the image is of this device, alive, and of this format.
    unsafe { context.device.create_image_view(&info, None) }.map_err(VulkanError::of("vkCreateImageView"))
}
