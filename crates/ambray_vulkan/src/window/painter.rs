//! The pipeline that draws textured triangles, and the descriptors of their textures.

use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

use super::{Corner, Filter, Sampling};
use crate::{Context, Result, VulkanError, shaders};

/// Most textures at a time.
const MOST_TEXTURES: u32 = 1024;

/// What describes textures to the pipeline. Descriptors hold it, since they go back to its pool.
struct Descriptors {
    context: Arc<Context>,
    layout: vk::DescriptorSetLayout,
    pool: Mutex<vk::DescriptorPool>,
    /// For each [`Sampling`]; null until they are made.
    samplers: [vk::Sampler; 4],
}

/// Describes a texture; the device must be done with it when it is dropped.
pub(super) struct Descriptor {
    from: Arc<Descriptors>,
    set: vk::DescriptorSet,
}

/// Draws textured triangles into images of one format.
pub(super) struct Painter {
    descriptors: Arc<Descriptors>,
    render_pass: vk::RenderPass,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

impl Painter {
    pub(super) fn new(context: &Arc<Context>, format: vk::Format) -> Result<Self> {
        let descriptors = Arc::new(Descriptors::new(context)?);
        let mut painter = Self {
            descriptors,
            render_pass: vk::RenderPass::null(),
            layout: vk::PipelineLayout::null(),
            pipeline: vk::Pipeline::null(),
        };
        painter.render_pass = render_pass(context, format)?;
        let push = [vk::PushConstantRange::default().stage_flags(vk::ShaderStageFlags::VERTEX).size(8)];
        let sets = [painter.descriptors.layout];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(&push);
        // SAFETY: the device and the layout of the set are alive; what is made is destroyed by dropping the painter.
        painter.layout = unsafe { context.device.create_pipeline_layout(&info, None) }
            .map_err(VulkanError::of("vkCreatePipelineLayout"))?;
        painter.pipeline = pipeline(context, painter.render_pass, painter.layout)?;
        Ok(painter)
    }

    pub(super) const fn render_pass(&self) -> vk::RenderPass {
        self.render_pass
    }

    pub(super) const fn layout(&self) -> vk::PipelineLayout {
        self.layout
    }

    pub(super) const fn pipeline(&self) -> vk::Pipeline {
        self.pipeline
    }

    /// Describes `view`, which must live as long as the descriptor is in use.
    pub(super) fn descriptor(&self, view: vk::ImageView, sampling: Sampling) -> Result<Descriptor> {
        let from = &self.descriptors;
        let device = &from.context.device;
        let layouts = [from.layout];
        let pool = from.pool.lock().unwrap_or_else(PoisonError::into_inner);
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(*pool).set_layouts(&layouts);
        // SAFETY: pool and layout are alive, and the pool is locked.
        let set = unsafe { device.allocate_descriptor_sets(&info) }
            .map_err(VulkanError::of("vkAllocateDescriptorSets"))?[0];
        drop(pool);
        let images = [vk::DescriptorImageInfo::default()
            .sampler(from.samplers[index(sampling)])
            .image_view(view)
            .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .image_info(&images);
        // SAFETY: the set is new, hence not in use; sampler and view are alive.
        unsafe { device.update_descriptor_sets(&[write], &[]) };
        Ok(Descriptor { from: Arc::clone(from), set })
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        let device = &self.descriptors.context.device;
        // SAFETY: the handles are ours or null, and the screen has waited for the frames that use them.
        unsafe {
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_render_pass(self.render_pass, None);
        }
    }
}

impl Descriptor {
    pub(super) const fn set(&self) -> vk::DescriptorSet {
        self.set
    }
}

impl Drop for Descriptor {
    fn drop(&mut self) {
        let pool = self.from.pool.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the set came from this pool, which is locked, and the device is done with it, as the type demands. It
        // cannot fail.
        let _ = unsafe { self.from.context.device.free_descriptor_sets(*pool, &[self.set]) };
    }
}

impl Descriptors {
    fn new(context: &Arc<Context>) -> Result<Self> {
        let device = &context.device;
        let mut made = Self {
            context: Arc::clone(context),
            layout: vk::DescriptorSetLayout::null(),
            pool: Mutex::default(),
            samplers: [vk::Sampler::null(); 4],
        };
        let kind = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::FRAGMENT)];
        let layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let sizes = [vk::DescriptorPoolSize { ty: kind, descriptor_count: MOST_TEXTURES }];
        let pool = vk::DescriptorPoolCreateInfo::default()
            .flags(vk::DescriptorPoolCreateFlags::FREE_DESCRIPTOR_SET)
            .max_sets(MOST_TEXTURES)
            .pool_sizes(&sizes);
        // SAFETY: the device is alive; what is made is destroyed by dropping `made`, also when a later call fails.
        unsafe {
            made.layout = device
                .create_descriptor_set_layout(&layout, None)
                .map_err(VulkanError::of("vkCreateDescriptorSetLayout"))?;
            *made.pool.get_mut().unwrap_or_else(PoisonError::into_inner) = device
                .create_descriptor_pool(&pool, None)
                .map_err(VulkanError::of("vkCreateDescriptorPool"))?;
        }
        for magnified in [Filter::Nearest, Filter::Linear] {
            for minified in [Filter::Nearest, Filter::Linear] {
                let info = vk::SamplerCreateInfo::default()
                    .mag_filter(filter(magnified))
                    .min_filter(filter(minified))
                    .address_mode_u(vk::SamplerAddressMode::CLAMP_TO_EDGE)
                    .address_mode_v(vk::SamplerAddressMode::CLAMP_TO_EDGE)
                    .address_mode_w(vk::SamplerAddressMode::CLAMP_TO_EDGE);
                // SAFETY: as above.
                made.samplers[index(Sampling { magnified, minified })] =
                    unsafe { device.create_sampler(&info, None) }
                        .map_err(VulkanError::of("vkCreateSampler"))?;
            }
        }
        Ok(made)
    }
}

impl Drop for Descriptors {
    fn drop(&mut self) {
        let device = &self.context.device;
        let pool = *self.pool.get_mut().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the handles are ours or null, and no descriptor is left, since each holds `self`.
        unsafe {
            for sampler in self.samplers {
                device.destroy_sampler(sampler, None);
            }
            device.destroy_descriptor_pool(pool, None);
            device.destroy_descriptor_set_layout(self.layout, None);
        }
    }
}

const fn filter(filter: Filter) -> vk::Filter {
    match filter {
        Filter::Nearest => vk::Filter::NEAREST,
        Filter::Linear => vk::Filter::LINEAR,
    }
}

const fn index(sampling: Sampling) -> usize {
    2 * sampling.magnified as usize + sampling.minified as usize
}

/// A pass that clears an image to black, is drawn into, and leaves it to be shown.
fn render_pass(context: &Context, format: vk::Format) -> Result<vk::RenderPass> {
    let attachments = [vk::AttachmentDescription::default()
        .format(format)
        .samples(vk::SampleCountFlags::TYPE_1)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .store_op(vk::AttachmentStoreOp::STORE)
        .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
        .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
        .initial_layout(vk::ImageLayout::UNDEFINED)
        .final_layout(vk::ImageLayout::PRESENT_SRC_KHR)];
    let colours = [vk::AttachmentReference::default().layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)];
    let subpasses = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colours)];
    let stage = vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT;
    let write = vk::AccessFlags::COLOR_ATTACHMENT_WRITE;
    let dependencies = [
        // The image is there when the semaphore says so, which is waited for at this stage.
        vk::SubpassDependency::default()
            .src_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(stage)
            .dst_stage_mask(stage)
            .dst_access_mask(write | vk::AccessFlags::COLOR_ATTACHMENT_READ),
        // It may be copied after.
        vk::SubpassDependency::default()
            .dst_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(stage)
            .src_access_mask(write)
            .dst_stage_mask(vk::PipelineStageFlags::TRANSFER)
            .dst_access_mask(vk::AccessFlags::TRANSFER_READ),
    ];
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&dependencies);
    // SAFETY: every pointer in `info` is to a local that lives until the call returns.
    unsafe { context.device.create_render_pass(&info, None) }.map_err(VulkanError::of("vkCreateRenderPass"))
}

fn pipeline(
    context: &Arc<Context>,
    render_pass: vk::RenderPass,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline> {
    let vertex = crate::pipeline::Module::new(context, shaders::PAINT_VERTEX)?;
    let fragment = crate::pipeline::Module::new(context, shaders::PAINT_FRAGMENT)?;
    let stage = |stage, module| {
        vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
    };
    let stages = [
        stage(vk::ShaderStageFlags::VERTEX, vertex.handle),
        stage(vk::ShaderStageFlags::FRAGMENT, fragment.handle),
    ];
    let bindings = [vk::VertexInputBindingDescription::default().stride(size_of::<Corner>() as u32)];
    let attribute = |location, format, offset: usize| vk::VertexInputAttributeDescription {
        location,
        binding: 0,
        format,
        offset: offset as u32,
    };
    let attributes = [
        attribute(0, vk::Format::R32G32_SFLOAT, std::mem::offset_of!(Corner, position)),
        attribute(1, vk::Format::R32G32_SFLOAT, std::mem::offset_of!(Corner, uv)),
        attribute(2, vk::Format::R8G8B8A8_UNORM, std::mem::offset_of!(Corner, colour)),
    ];
    let input = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&bindings)
        .vertex_attribute_descriptions(&attributes);
    let assembly =
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let samples =
        vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let blends = [vk::PipelineColorBlendAttachmentState::default()
        .blend_enable(true)
        .src_color_blend_factor(vk::BlendFactor::ONE)
        .dst_color_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
        .src_alpha_blend_factor(vk::BlendFactor::ONE_MINUS_DST_ALPHA)
        .dst_alpha_blend_factor(vk::BlendFactor::ONE)
        .color_write_mask(vk::ColorComponentFlags::RGBA)];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .render_pass(render_pass);
    // SAFETY: every pointer in `info` is to a local that lives until the call returns; layout and render pass are alive, and
    // fit the shaders.
    unsafe { context.device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) }
        .map(|pipelines| pipelines[0])
        .map_err(|(_, result)| VulkanError::of("vkCreateGraphicsPipelines")(result))
}
