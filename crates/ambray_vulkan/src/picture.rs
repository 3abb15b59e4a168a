//! Pictures on the device: images that show a plane of a frame, for windows to draw.

use std::sync::{Arc, atomic::Ordering};

use ash::vk;
use gpu_allocator::{
    MemoryLocation,
    vulkan::{Allocation, AllocationCreateDesc, AllocationScheme},
};

use crate::{Buffer, Context, Recorder, Result, VulkanError, Work, error::MemorySide, image};

/// An image with 8 bits each of red, green, blue and alpha, as display values (`R8G8B8A8_UNORM`, one level, one layer), in the
/// layout `SHADER_READ_ONLY_OPTIMAL`. It can be sampled, and copied from by those who put the layout back.
///
/// The backend that made it paints it anew once nobody else holds it, and its memory goes with the last holder. So whoever
/// drops it must have waited for their own work on the device that uses it.
#[derive(Debug)]
pub struct Picture {
    context: Arc<Context>,
    image: vk::Image,
    view: vk::ImageView,
    /// Taken when dropped; `None` until there is memory.
    allocation: Option<Allocation>,
    size: (u32, u32),
}

const NAME: &str = "picture for a window";
const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;

impl Picture {
    /// A picture with undefined content, in no layout yet.
    pub(crate) fn new(context: &Arc<Context>, size: (u32, u32)) -> Result<Self> {
        let (side, limit) = (size.0.max(size.1), context.limits().image_side);
        if side > limit {
            let what = "pixels along a side of a picture".to_owned();
            return Err(VulkanError::Limit { what, asked: side.into(), limit: limit.into() });
        }
        context.counters().images.fetch_add(1, Ordering::Relaxed);
        let mut picture = Self {
            context: Arc::clone(context),
            image: vk::Image::null(),
            view: vk::ImageView::null(),
            allocation: None,
            size,
        };
        // Filled step by step, so that a failure destroys what was made.
        picture.fill()?;
        Ok(picture)
    }

    fn fill(&mut self) -> Result<()> {
        let device = &self.context.device;
        let (width, height) = self.size;
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(FORMAT)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(
                vk::ImageUsageFlags::SAMPLED
                    | vk::ImageUsageFlags::TRANSFER_SRC
                    | vk::ImageUsageFlags::TRANSFER_DST,
            )
            .sharing_mode(vk::SharingMode::EXCLUSIVE)
            .initial_layout(vk::ImageLayout::UNDEFINED);
        let bytes = 4 * u64::from(width) * u64::from(height);
        // SAFETY: the device is alive, every device has this format for these usages, and the size is within its limit; the
        // image is destroyed by dropping the picture.
        self.image = unsafe { device.create_image(&info, None) }
            .map_err(|result| VulkanError::at("vkCreateImage", NAME, bytes, result))?;
        // SAFETY: the image is of this device and alive.
        let requirements = unsafe { device.get_image_memory_requirements(self.image) };
        let description = AllocationCreateDesc {
            name: NAME,
            requirements,
            location: MemoryLocation::GpuOnly,
            linear: false,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let allocation = self.context.allocator().allocate(&description).map_err(|error| {
            log::error!("allocating '{NAME}': {error}");
            VulkanError::OutOfMemory { side: MemorySide::Device, what: NAME.to_owned(), bytes }
        })?;
        self.context.counters().bytes.fetch_add(allocation.size(), Ordering::Relaxed);
        let allocation = self.allocation.insert(allocation);
        // SAFETY: image and memory are of this device, the range was allocated for the image's requirements, and the image is
        // bound to nothing yet.
        unsafe { device.bind_image_memory(self.image, allocation.memory(), allocation.offset()) }
            .map_err(|result| VulkanError::at("vkBindImageMemory", NAME, bytes, result))?;
        self.view = image::view(&self.context, self.image, FORMAT)?;
        self.context.name(self.image, NAME);
        self.context.name(self.view, NAME);
        Ok(())
    }

    /// The image, valid as long as `self`.
    #[must_use]
    pub const fn image(&self) -> vk::Image {
        self.image
    }

    /// A view of all of it, valid as long as `self`.
    #[must_use]
    pub const fn view(&self) -> vk::ImageView {
        self.view
    }

    /// Width and height, pixels.
    #[must_use]
    pub const fn size(&self) -> (u32, u32) {
        self.size
    }
}

impl Drop for Picture {
    fn drop(&mut self) {
        self.context.counters().images.fetch_sub(1, Ordering::Relaxed);
        // SAFETY: the device is done with the image, as the type demands of its holders; the handles are ours or null.
        unsafe {
            self.context.device.destroy_image_view(self.view, None);
            self.context.device.destroy_image(self.image, None);
        }
        if let Some(allocation) = self.allocation.take() {
            self.context.counters().bytes.fetch_sub(allocation.size(), Ordering::Relaxed);
            if let Err(error) = self.context.allocator().free(allocation) {
                log::error!("freeing '{NAME}': {error}");
            }
        }
    }
}

impl Recorder<'_> {
    /// Fills `picture`, which nothing is using, from `pixels` that a compute shader wrote: 4 bytes each, row by row from the
    /// top. Later work on the queue may sample it.
    pub(crate) fn paint(&mut self, pixels: &Buffer, picture: &Picture) {
        self.barrier(Work::Compute, Work::Transfer);
        let (before, during, after) = (
            vk::ImageLayout::UNDEFINED,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
            vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        );
        self.relayout(picture, (Work::Transfer, before), (Work::Transfer, during));
        // SAFETY: buffer and image are alive, the image in this layout, and the region is within both.
        unsafe {
            let device = &self.context().device;
            device.cmd_copy_buffer_to_image(
                self.raw(),
                pixels.handle(),
                picture.image,
                during,
                &[whole(picture)],
            );
        }
        self.relayout(picture, (Work::Transfer, during), (Work::Everything, after));
    }

    /// Copies `picture` to `pixels`, for the host to read once that has waited.
    pub(crate) fn fetch(&mut self, picture: &Picture, pixels: &Buffer) {
        let (shown, during) =
            (vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        self.relayout(picture, (Work::Everything, shown), (Work::Transfer, during));
        // SAFETY: buffer and image are alive, the image in this layout, and the region is within both.
        unsafe {
            let device = &self.context().device;
            device.cmd_copy_image_to_buffer(
                self.raw(),
                picture.image,
                during,
                pixels.handle(),
                &[whole(picture)],
            );
        }
        self.relayout(picture, (Work::Transfer, during), (Work::Everything, shown));
        self.barrier(Work::Transfer, Work::HostRead);
    }

    /// Lets `after` wait for `before`, with the picture in another layout from then on.
    fn relayout(
        &mut self,
        picture: &Picture,
        before: (Work, vk::ImageLayout),
        after: (Work, vk::ImageLayout),
    ) {
        let context = self.context();
        let (pipelines, queries) = (context.has_pipelines(), context.has_queries());
        let (from, wrote) = before.0.mask(pipelines, queries);
        let (to, touches) = after.0.mask(pipelines, queries);
        let barrier = image::transition(picture.image, [before.1, after.1], [wrote, touches]);
        // SAFETY: the buffer is being recorded, outside of render passes; the image is alive and in the old layout.
        unsafe {
            context.device.cmd_pipeline_barrier(
                self.raw(),
                from,
                to,
                vk::DependencyFlags::empty(),
                &[],
                &[],
                &[barrier],
            );
        }
    }
}

/// All of a picture, tightly packed in a buffer.
fn whole(picture: &Picture) -> vk::BufferImageCopy {
    let (width, height) = picture.size;
    vk::BufferImageCopy::default().image_subresource(image::whole_layer()).image_extent(vk::Extent3D {
        width,
        height,
        depth: 1,
    })
}

/// Pictures of one size, painted again when their holders are done with them.
#[derive(Debug, Default)]
pub(crate) struct Pictures {
    pictures: Vec<Arc<Picture>>,
}

/// Pictures that are kept although nobody holds them: with one on the screen, one in the queue and one being painted none is
/// made anew.
const SPARE: usize = 3;

impl Pictures {
    /// A picture of this size that nobody holds.
    pub(crate) fn free(&mut self, context: &Arc<Context>, size: (u32, u32)) -> Result<Arc<Picture>> {
        self.pictures.retain(|picture| picture.size == size);
        // Only what nobody else holds can be had mutably.
        let mut spare = 0;
        self.pictures.retain_mut(|picture| {
            spare += usize::from(Arc::get_mut(picture).is_some());
            spare <= SPARE || Arc::get_mut(picture).is_none()
        });
        if let Some(index) = self.pictures.iter_mut().position(|picture| Arc::get_mut(picture).is_some()) {
            return Ok(Arc::clone(&self.pictures[index]));
        }
        let picture = Arc::new(Picture::new(context, size)?);
        self.pictures.push(Arc::clone(&picture));
        Ok(picture)
    }
}
