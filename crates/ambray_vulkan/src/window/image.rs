//! Images as Vulkan names their parts.

use ash::vk;

use crate::{
    Context,
    error::{Result, VulkanError},
};

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
