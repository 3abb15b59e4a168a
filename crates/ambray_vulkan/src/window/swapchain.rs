//! The images of the window.

use std::sync::Arc;

use ash::{khr, vk};

use super::missing;
use crate::context::Surface;
use crate::{Context, Result, VulkanError, image};

/// Images of the window, made anew when its size changes.
pub(super) struct Swapchain {
    context: Arc<Context>,
    loader: khr::swapchain::Device,
    format: vk::SurfaceFormatKHR,
    render_pass: vk::RenderPass,
    /// Size of the window, pixels.
    size: [u32; 2],
    /// Null, and without images, until there is something to show.
    handle: vk::SwapchainKHR,
    images: Vec<Image>,
    extent: vk::Extent2D,
    can_be_copied: bool,
    /// Whether it no longer fits the window.
    is_stale: bool,
}

/// An image of the window.
struct Image {
    image: vk::Image,
    view: vk::ImageView,
    framebuffer: vk::Framebuffer,
    /// Signalled when it is drawn.
    drawn: vk::Semaphore,
}

/// An image to draw into.
#[derive(Clone, Copy, Debug)]
pub(super) struct Acquired {
    pub(super) index: u32,
    /// Whether the window has changed since.
    pub(super) is_stale: bool,
}

/// Where a frame is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) image: vk::Image,
    pub(super) framebuffer: vk::Framebuffer,
    pub(super) drawn: vk::Semaphore,
    pub(super) extent: vk::Extent2D,
    pub(super) can_be_copied: bool,
    pub(super) is_bgra: bool,
}

/// A format of the window of `context` that holds display values of 8 bits as they are.
pub(super) fn format(context: &Context) -> Result<vk::SurfaceFormatKHR> {
    let surface = surface(context)?;
    // SAFETY: surface and device came from one instance, and the device can present to it.
    let formats = unsafe {
        surface.loader().get_physical_device_surface_formats(context.physical_device(), surface.handle())
    };
    let formats = formats.map_err(VulkanError::of("vkGetPhysicalDeviceSurfaceFormatsKHR"))?;
    let wanted = [vk::Format::B8G8R8A8_UNORM, vk::Format::R8G8B8A8_UNORM];
    let found = formats.into_iter().find(|format| {
        wanted.contains(&format.format) && format.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR
    });
    found.ok_or_else(|| missing("a format with 8 bits a channel and no conversion"))
}

fn surface(context: &Context) -> Result<&Surface> {
    context.surface().ok_or_else(|| missing("a device that was opened for it"))
}

impl Swapchain {
    pub(super) fn new(
        context: &Arc<Context>,
        format: vk::SurfaceFormatKHR,
        render_pass: vk::RenderPass,
        size: [u32; 2],
    ) -> Result<Self> {
        surface(context)?;
        Ok(Self {
            loader: khr::swapchain::Device::new(context.instance(), context.device()),
            context: Arc::clone(context),
            format,
            render_pass,
            size,
            handle: vk::SwapchainKHR::null(),
            images: Vec::new(),
            extent: vk::Extent2D::default(),
            can_be_copied: false,
            is_stale: true,
        })
    }

    pub(super) fn resize(&mut self, size: [u32; 2]) {
        if size != self.size {
            self.size = size;
            self.is_stale = true;
        }
    }

    /// The next image to draw into, waiting until there is one; `signal` tells when it may be written. `None` if the window
    /// has no area.
    pub(super) fn acquire(&mut self, signal: vk::Semaphore) -> Result<Option<Acquired>> {
        // The window may change again while its images are made: every call of the second round is late then, too.
        for _ in 0..8 {
            if self.is_stale && !self.make()? {
                return Ok(None);
            }
            // SAFETY: the swapchain is ours; the semaphore is not in use: the frame that waits for it was waited for.
            let acquired =
                unsafe { self.loader.acquire_next_image(self.handle, u64::MAX, signal, vk::Fence::null()) };
            match acquired {
                Ok((index, is_stale)) => return Ok(Some(Acquired { index, is_stale })),
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => self.is_stale = true,
                Err(error) => return Err(VulkanError::of("vkAcquireNextImageKHR")(error)),
            }
        }
        Ok(None)
    }

    pub(super) fn target(&self, index: u32) -> Target {
        let image = &self.images[index as usize];
        Target {
            image: image.image,
            framebuffer: image.framebuffer,
            drawn: image.drawn,
            extent: self.extent,
            can_be_copied: self.can_be_copied,
            is_bgra: self.format.format == vk::Format::B8G8R8A8_UNORM,
        }
    }

    /// Shows image `index` when it is drawn.
    pub(super) fn present(&mut self, index: u32, is_stale: bool) -> Result<()> {
        let (handles, indices) = ([self.handle], [index]);
        let drawn = [self.images[index as usize].drawn];
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&drawn)
            .swapchains(&handles)
            .image_indices(&indices);
        // SAFETY: the image was acquired, and the semaphore is signalled by the submission that draws it; the queue is locked
        // while it takes the call.
        let presented = unsafe { self.loader.queue_present(*self.context.queue(), &info) };
        self.is_stale |= is_stale;
        match presented {
            Ok(is_suboptimal) => self.is_stale |= is_suboptimal,
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => self.is_stale = true,
            Err(error) => return Err(VulkanError::of("vkQueuePresentKHR")(error)),
        }
        Ok(())
    }

    /// Makes the images for the window as it is; says whether it has an area.
    fn make(&mut self) -> Result<bool> {
        let context = Arc::clone(&self.context);
        let surface = surface(&context)?;
        let (loader, physical) = (surface.loader(), context.physical_device());
        // SAFETY: surface and device came from one instance, and the device can present to it.
        let able = unsafe { loader.get_physical_device_surface_capabilities(physical, surface.handle()) }
            .map_err(VulkanError::of("vkGetPhysicalDeviceSurfaceCapabilitiesKHR"))?;
        let extent = extent(&able, self.size);
        if extent.width == 0 || extent.height == 0 {
            return Ok(false);
        }
        self.wait();
        let most = if able.max_image_count == 0 { u32::MAX } else { able.max_image_count };
        let copies = able.supported_usage_flags.contains(vk::ImageUsageFlags::TRANSFER_SRC);
        let usage = if copies { vk::ImageUsageFlags::TRANSFER_SRC } else { vk::ImageUsageFlags::empty() };
        let alphas = [
            vk::CompositeAlphaFlagsKHR::OPAQUE,
            vk::CompositeAlphaFlagsKHR::INHERIT,
            vk::CompositeAlphaFlagsKHR::PRE_MULTIPLIED,
        ];
        let alpha = alphas.into_iter().find(|&alpha| able.supported_composite_alpha.contains(alpha));
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.handle())
            .min_image_count((able.min_image_count + 1).min(most))
            .image_format(self.format.format)
            .image_color_space(self.format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | usage)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(able.current_transform)
            .composite_alpha(alpha.unwrap_or(vk::CompositeAlphaFlagsKHR::POST_MULTIPLIED))
            // Every device has it, and a still window costs nothing.
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(false)
            .old_swapchain(self.handle);
        // SAFETY: the surface is alive and the old swapchain is ours, or null.
        let made = unsafe { self.loader.create_swapchain(&info, None) };
        self.clear();
        self.handle = made.map_err(VulkanError::of("vkCreateSwapchainKHR"))?;
        self.extent = extent;
        self.can_be_copied = copies;
        self.is_stale = false;
        // SAFETY: the swapchain is ours.
        let images = unsafe { self.loader.get_swapchain_images(self.handle) }
            .map_err(VulkanError::of("vkGetSwapchainImagesKHR"))?;
        for image in images {
            // Known before it is complete, so that what there is of it is destroyed if a call fails.
            self.images.push(Image::empty(image));
            let made = self.images.len() - 1;
            self.images[made].make(&context, self.format.format, self.render_pass, extent)?;
        }
        Ok(true)
    }

    /// Waits until nothing uses the images.
    fn wait(&self) {
        if self.handle != vk::SwapchainKHR::null() {
            let queue = self.context.queue();
            // SAFETY: the queue is locked. Only a lost device fails here, and it uses nothing any more.
            let _ = unsafe { self.context.device.queue_wait_idle(*queue) };
        }
    }

    /// Destroys everything; nothing may be in use.
    fn clear(&mut self) {
        let device = &self.context.device;
        // SAFETY: the handles are ours or null, and nothing uses them, as was waited for.
        unsafe {
            for image in self.images.drain(..) {
                device.destroy_framebuffer(image.framebuffer, None);
                device.destroy_image_view(image.view, None);
                device.destroy_semaphore(image.drawn, None);
            }
            self.loader.destroy_swapchain(self.handle, None);
        }
        self.handle = vk::SwapchainKHR::null();
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        self.wait();
        self.clear();
    }
}

impl std::fmt::Debug for Swapchain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let images = self.images.len();
        f.debug_struct("Swapchain")
            .field("extent", &self.extent)
            .field("images", &images)
            .finish_non_exhaustive()
    }
}

impl Image {
    const fn empty(image: vk::Image) -> Self {
        Self {
            image,
            view: vk::ImageView::null(),
            framebuffer: vk::Framebuffer::null(),
            drawn: vk::Semaphore::null(),
        }
    }

    fn make(
        &mut self,
        context: &Context,
        format: vk::Format,
        render_pass: vk::RenderPass,
        extent: vk::Extent2D,
    ) -> Result<()> {
        self.view = image::view(context, self.image, format)?;
        let views = [self.view];
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(render_pass)
            .attachments(&views)
            .width(extent.width)
            .height(extent.height)
            .layers(1);
        // SAFETY: device, render pass and view are alive, and of one format; what is made is destroyed by the swapchain.
        unsafe {
            self.framebuffer = (context.device.create_framebuffer(&info, None))
                .map_err(VulkanError::of("vkCreateFramebuffer"))?;
            self.drawn = (context.device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None))
                .map_err(VulkanError::of("vkCreateSemaphore"))?;
        }
        Ok(())
    }
}

/// Size of the images for a window of `size`: the surface's own, unless it leaves the choice.
fn extent(able: &vk::SurfaceCapabilitiesKHR, size: [u32; 2]) -> vk::Extent2D {
    if able.current_extent.width != u32::MAX {
        return able.current_extent;
    }
    let (least, most) = (able.min_image_extent, able.max_image_extent);
    vk::Extent2D {
        width: size[0].clamp(least.width, most.width.max(least.width)),
        height: size[1].clamp(least.height, most.height.max(least.height)),
    }
}
