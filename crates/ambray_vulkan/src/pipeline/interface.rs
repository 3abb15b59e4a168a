//! What all programs have in common: the structure they trace and the constants that are pushed.

use std::sync::Arc;

use ash::vk;

use crate::{Context, Result, VulkanError, layout::Push};

/// Descriptor set and pipeline layout. Everything but the top-level structure goes by device addresses.
#[derive(Debug)]
pub(crate) struct Interface {
    pub(crate) context: Arc<Context>,
    set_layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    pub(crate) set: vk::DescriptorSet,
    pub(crate) layout: vk::PipelineLayout,
}

impl Interface {
    pub(crate) fn new(context: &Arc<Context>) -> Result<Arc<Self>> {
        let mut interface = Self {
            context: Arc::clone(context),
            set_layout: vk::DescriptorSetLayout::null(),
            pool: vk::DescriptorPool::null(),
            set: vk::DescriptorSet::null(),
            layout: vk::PipelineLayout::null(),
        };
        // Filled step by step, so that a failure destroys what was made.
        interface.fill()?;
        Ok(Arc::new(interface))
    }

    fn fill(&mut self) -> Result<()> {
        let device = &self.context.device;
        let kind = vk::DescriptorType::ACCELERATION_STRUCTURE_KHR;
        let binding = vk::DescriptorSetLayoutBinding::default()
            .binding(0)
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(tracing_stages(&self.context));
        let bindings = [binding];
        let sizes = [vk::DescriptorPoolSize { ty: kind, descriptor_count: 1 }];
        let ranges = [vk::PushConstantRange {
            stage_flags: push_stages(&self.context),
            offset: 0,
            size: size_of::<Push>() as u32,
        }];
        // SAFETY: the descriptions live until the calls return and refer to objects of this device.
        unsafe {
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            self.set_layout = device
                .create_descriptor_set_layout(&info, None)
                .map_err(VulkanError::of("vkCreateDescriptorSetLayout"))?;
            let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
            self.pool = device
                .create_descriptor_pool(&info, None)
                .map_err(VulkanError::of("vkCreateDescriptorPool"))?;
            let layouts = [self.set_layout];
            let info =
                vk::DescriptorSetAllocateInfo::default().descriptor_pool(self.pool).set_layouts(&layouts);
            self.set = device
                .allocate_descriptor_sets(&info)
                .map_err(VulkanError::of("vkAllocateDescriptorSets"))?[0];
            let info =
                vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&ranges);
            self.layout = device
                .create_pipeline_layout(&info, None)
                .map_err(VulkanError::of("vkCreatePipelineLayout"))?;
        }
        Ok(())
    }

    /// Makes the shaders trace `tlas`. No submission that uses the set may be under way.
    pub(crate) fn bind(&self, tlas: vk::AccelerationStructureKHR) {
        let structures = [tlas];
        let mut write =
            vk::WriteDescriptorSetAccelerationStructureKHR::default().acceleration_structures(&structures);
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.set)
            .descriptor_type(vk::DescriptorType::ACCELERATION_STRUCTURE_KHR)
            .descriptor_count(1)
            .push_next(&mut write);
        // SAFETY: set and structure are of this device, and the caller saw to it that the set is not in use.
        unsafe { self.context.device.update_descriptor_sets(&[write], &[]) };
    }
}

impl Drop for Interface {
    fn drop(&mut self) {
        let device = &self.context.device;
        // SAFETY: programs hold a reference, so no program uses these; null handles are ignored.
        unsafe {
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_pool(self.pool, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}

/// Stages that trace rays.
fn tracing_stages(context: &Context) -> vk::ShaderStageFlags {
    let mut stages = vk::ShaderStageFlags::empty();
    if context.has_pipelines() {
        stages |= vk::ShaderStageFlags::RAYGEN_KHR;
    }
    if context.has_queries() {
        stages |= vk::ShaderStageFlags::COMPUTE;
    }
    stages
}

/// Stages that read the push constants.
pub(super) fn push_stages(context: &Context) -> vk::ShaderStageFlags {
    let mut stages = vk::ShaderStageFlags::COMPUTE;
    if context.has_pipelines() {
        stages |= vk::ShaderStageFlags::RAYGEN_KHR
            | vk::ShaderStageFlags::ANY_HIT_KHR
            | vk::ShaderStageFlags::INTERSECTION_KHR
            | vk::ShaderStageFlags::CALLABLE_KHR;
    }
    stages
}

/// A shader module, destroyed with the value: pipelines do not need it once they are made.
pub(crate) struct Module<'a> {
    context: &'a Context,
    pub(crate) handle: vk::ShaderModule,
}

impl<'a> Module<'a> {
    pub(crate) fn new(context: &'a Context, spirv: &[u8]) -> Result<Self> {
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(spirv);
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: the words are a module that was compiled for Vulkan 1.2, and live until the call returns.
        let handle = unsafe { context.device.create_shader_module(&info, None) }
            .map_err(VulkanError::of("vkCreateShaderModule"))?;
        Ok(Self { context, handle })
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: ours, and used by no call that is under way.
        unsafe { self.context.device.destroy_shader_module(self.handle, None) };
    }
}

/// Where each specialisation constant is.
pub(super) fn map_entries() -> Vec<vk::SpecializationMapEntry> {
    (0..crate::layout::Specialization::COUNT)
        .map(|id| vk::SpecializationMapEntry { constant_id: id, offset: 4 * id, size: 4 })
        .collect()
}
