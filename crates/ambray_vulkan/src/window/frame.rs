//! A frame of the window in the making, with what it uses until the device is done with it.

use std::sync::Arc;

use ash::vk;

use super::{
    Copy, Painting,
    painter::Painter,
    swapchain::Target,
    textures::{Keep, Textures},
};
use crate::{
    Buffer, CommandSet, Context, Location, Recorder, Result, VulkanError, Work,
    image::{transition, whole_layer},
};

/// A frame that the device may be drawing.
pub(super) struct InFlight {
    commands: CommandSet,
    context: Arc<Context>,
    /// Signalled when the window's image may be written.
    acquired: vk::Semaphore,
    corners: Option<Buffer>,
    indices: Option<Buffer>,
    copy: Option<Buffer>,
    /// Used by the frame, and by those before it.
    keep: Vec<Keep>,
}

impl InFlight {
    pub(super) fn new(context: &Arc<Context>) -> Result<Self> {
        let commands = CommandSet::new(context)?;
        // SAFETY: the device is alive; the semaphore is destroyed by dropping the frame.
        let acquired = unsafe { context.device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None) }
            .map_err(VulkanError::of("vkCreateSemaphore"))?;
        let context = Arc::clone(context);
        Ok(Self { commands, context, acquired, corners: None, indices: None, copy: None, keep: Vec::new() })
    }

    pub(super) const fn acquired(&self) -> vk::Semaphore {
        self.acquired
    }

    /// Waits until the device is done with it; what it used is let go.
    pub(super) fn wait(&mut self) -> Result<()> {
        self.commands.wait()?;
        self.keep.clear();
        Ok(())
    }

    /// Draws `painting` into `target`, and copies the pixels if `wants_copy`. The device must be done with this frame.
    pub(super) fn draw(
        &mut self,
        painter: &Painter,
        textures: &mut Textures,
        painting: &Painting,
        target: &Target,
        wants_copy: bool,
    ) -> Result<()> {
        let vertex = vk::BufferUsageFlags::VERTEX_BUFFER;
        let corners = fill(&self.context, &mut self.corners, "corners", vertex, &painting.corners)?;
        let index = vk::BufferUsageFlags::INDEX_BUFFER;
        let indices = fill(&self.context, &mut self.indices, "numbers of corners", index, &painting.indices)?;
        self.copy = if wants_copy {
            let bytes = u64::from(target.extent.width) * u64::from(target.extent.height) * 4;
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            Some(self.context.buffer("pixels of the window", bytes, usage, Location::Readback)?)
        } else {
            None
        };
        let (keep, copy) = (&mut self.keep, self.copy.as_ref());
        self.commands.submit_between(Some(self.acquired), Some(target.drawn), |recorder| {
            textures.record(recorder, keep);
            record(recorder, painter, textures, painting, target, [corners, indices]);
            if let Some(copy) = copy {
                record_copy(recorder, target, copy);
            }
            Ok(())
        })?;
        textures.leave(&mut self.keep);
        Ok(())
    }

    /// The pixels that were copied; the frame was waited for.
    pub(super) fn copy(&mut self, target: &Target) -> Option<Copy> {
        let copy = self.copy.take()?;
        let size = [target.extent.width, target.extent.height];
        let mut rgba: Vec<u8> = copy.read(0, copy.size() as usize);
        for pixel in rgba.chunks_exact_mut(4) {
            if target.is_bgra {
                pixel.swap(0, 2);
            }
            pixel[3] = 255; // what is behind the window is not part of it
        }
        Some(Copy { size, rgba })
    }
}

impl Drop for InFlight {
    fn drop(&mut self) {
        // Only a lost device fails here, and it uses nothing any more.
        let _ = self.commands.wait();
        // SAFETY: the semaphore is ours; the submission that waits for it is through.
        unsafe { self.context.device.destroy_semaphore(self.acquired, None) };
    }
}

/// Writes `content` into `buffer`, which grows if it has to; the device must not be using it.
fn fill<'a, T: bytemuck::Pod>(
    context: &Arc<Context>,
    buffer: &'a mut Option<Buffer>,
    name: &str,
    usage: vk::BufferUsageFlags,
    content: &[T],
) -> Result<&'a Buffer> {
    let bytes = size_of_val(content) as u64;
    let buffer = match buffer.take().filter(|buffer| buffer.size() >= bytes) {
        Some(large_enough) => buffer.insert(large_enough),
        None => {
            // With room to grow, so that it seldom does.
            let size = bytes.next_power_of_two().max(1 << 16);
            buffer.insert(context.buffer(name, size, usage, Location::Upload)?)
        }
    };
    buffer.write(0, content);
    Ok(buffer)
}

fn record(
    recorder: &mut Recorder<'_>,
    painter: &Painter,
    textures: &Textures,
    painting: &Painting,
    target: &Target,
    [corners, indices]: [&Buffer; 2],
) {
    // Pictures come from other submissions of this queue.
    recorder.barrier(Work::Everything, Work::Draw);
    let (device, buffer) = (&recorder.context().device, recorder.raw());
    let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: target.extent };
    let black = [vk::ClearValue { color: vk::ClearColorValue { float32: [0.0, 0.0, 0.0, 1.0] } }];
    let begin = vk::RenderPassBeginInfo::default()
        .render_pass(painter.render_pass())
        .framebuffer(target.framebuffer)
        .render_area(area)
        .clear_values(&black);
    let viewport = vk::Viewport {
        width: target.extent.width as f32,
        height: target.extent.height as f32,
        max_depth: 1.0,
        ..vk::Viewport::default()
    };
    let (graphics, vertex) = (vk::PipelineBindPoint::GRAPHICS, vk::ShaderStageFlags::VERTEX);
    // SAFETY: the buffer is being recorded; everything named here is alive until the submission is through: the screen keeps
    // pipeline and textures, the frame its buffers. What is drawn is checked against the buffers below.
    unsafe {
        device.cmd_begin_render_pass(buffer, &begin, vk::SubpassContents::INLINE);
        device.cmd_bind_pipeline(buffer, graphics, painter.pipeline());
        device.cmd_set_viewport(buffer, 0, &[viewport]);
        device.cmd_push_constants(buffer, painter.layout(), vertex, 0, bytemuck::bytes_of(&painting.size));
        device.cmd_bind_vertex_buffers(buffer, 0, &[corners.handle()], &[0]);
        device.cmd_bind_index_buffer(buffer, indices.handle(), 0, vk::IndexType::UINT32);
        for mesh in &painting.meshes {
            let (Some(texture), Some(clip)) = (textures.get(mesh.texture), clip(mesh.clip, target.extent))
            else {
                continue;
            };
            let Some(used) = painting.indices.get(mesh.indices.start as usize..mesh.indices.end as usize)
            else {
                continue;
            };
            let end = used.iter().max().map_or(0, |&most| u64::from(most) + u64::from(mesh.first_corner) + 1);
            if end > painting.corners.len() as u64 || i32::try_from(mesh.first_corner).is_err() {
                continue;
            }
            device.cmd_set_scissor(buffer, 0, &[clip]);
            device.cmd_bind_descriptor_sets(buffer, graphics, painter.layout(), 0, &[texture.set()], &[]);
            let (first, corner) = (mesh.indices.start, mesh.first_corner as i32);
            device.cmd_draw_indexed(buffer, used.len() as u32, 1, first, corner, 0);
        }
        device.cmd_end_render_pass(buffer);
    }
}

/// The part of `clip` within the window, if any.
fn clip([x, y, width, height]: [u32; 4], extent: vk::Extent2D) -> Option<vk::Rect2D> {
    let (x, y) = (x.min(extent.width), y.min(extent.height));
    let (width, height) = (width.min(extent.width - x), height.min(extent.height - y));
    (width > 0 && height > 0).then_some(vk::Rect2D {
        offset: vk::Offset2D { x: x as i32, y: y as i32 },
        extent: vk::Extent2D { width, height },
    })
}

/// Records a copy of the window's pixels to `copy`, which has room for them.
fn record_copy(recorder: &mut Recorder<'_>, target: &Target, copy: &Buffer) {
    use vk::{AccessFlags as Access, ImageLayout as Layout, PipelineStageFlags as Stage};
    let (device, buffer) = (&recorder.context().device, recorder.raw());
    let shown = Layout::PRESENT_SRC_KHR;
    let source = Layout::TRANSFER_SRC_OPTIMAL;
    let before =
        transition(target.image, [shown, source], [Access::COLOR_ATTACHMENT_WRITE, Access::TRANSFER_READ]);
    let after = transition(target.image, [source, shown], [Access::TRANSFER_READ, Access::empty()]);
    let region =
        vk::BufferImageCopy::default().image_subresource(whole_layer()).image_extent(target.extent.into());
    let none = vk::DependencyFlags::empty();
    // SAFETY: the buffer is being recorded, outside of render passes; the image can be copied, and the buffer has room for all
    // of its pixels; both live until the submission is through.
    unsafe {
        let drawn = Stage::COLOR_ATTACHMENT_OUTPUT | Stage::TRANSFER;
        device.cmd_pipeline_barrier(buffer, drawn, Stage::TRANSFER, none, &[], &[], &[before]);
        device.cmd_copy_image_to_buffer(buffer, target.image, source, copy.handle(), &[region]);
        device.cmd_pipeline_barrier(buffer, Stage::TRANSFER, drawn, none, &[], &[], &[after]);
    }
    recorder.barrier(Work::Transfer, Work::HostRead);
}
