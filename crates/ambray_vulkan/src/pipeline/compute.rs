//! Compute pipelines: the filter, and the passes that trace by ray queries.

use std::sync::Arc;

use ash::vk;

use super::{
    TracePass,
    interface::{Interface, Module, map_entries, push_stages},
};
use crate::{
    Context, Recorder, Result, VulkanError,
    layout::{Push, Specialization},
    shaders,
};

/// SPIR-V of a pass that traces by ray queries.
pub(super) const fn query(pass: TracePass) -> &'static [u8] {
    match pass {
        TracePass::Primary => shaders::PRIMARY_QUERY,
        TracePass::Direct => shaders::DIRECT_QUERY,
        TracePass::Ambient => shaders::AMBIENT_QUERY,
        TracePass::Rays => shaders::RAYS_QUERY,
    }
}

/// A compute shader, compiled.
#[derive(Debug)]
pub(crate) struct ComputePipeline {
    context: Arc<Context>,
    handle: vk::Pipeline,
}

impl ComputePipeline {
    pub(crate) fn new(interface: &Interface, spirv: &[u8], specialization: &Specialization) -> Result<Self> {
        let context = &interface.context;
        let module = Module::new(context, spirv)?;
        let entries = map_entries();
        let special =
            vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::bytes_of(specialization));
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module.handle)
            .name(c"main")
            .specialization_info(&special);
        let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(interface.layout);
        // SAFETY: module and layout are of this device, and everything described lives until the call returns.
        let made =
            unsafe { context.device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
        let handle = made.map_err(|(_, result)| VulkanError::of("vkCreateComputePipelines")(result))?[0];
        Ok(Self { context: Arc::clone(context), handle })
    }

    /// Records the shader, which traces rays, over `push.extent` pixels, in workgroups of the size that it was written for.
    pub(crate) fn record_tracing(
        &self,
        recorder: &mut Recorder<'_>,
        interface: &Interface,
        workgroup: [u32; 2],
        push: Push,
    ) {
        // SAFETY: the buffer is being recorded; set and layout belong together and outlive the submission.
        unsafe {
            self.context.device.cmd_bind_descriptor_sets(
                recorder.raw(),
                vk::PipelineBindPoint::COMPUTE,
                interface.layout,
                0,
                &[interface.set],
                &[],
            );
        }
        self.record(recorder, interface, workgroup, push);
    }

    /// Records the shader, which traces no rays, in the same way. Programs of this kind may be shared by backends: no
    /// structure is bound, which could be another backend's and gone.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        interface: &Interface,
        workgroup: [u32; 2],
        push: Push,
    ) {
        let device = &self.context.device;
        let groups = [0, 1].map(|axis| push.extent[axis].div_ceil(workgroup[axis]));
        // SAFETY: the buffer is being recorded; pipeline and layout belong together and outlive the submission; the caller
        // kept the extent within what the device dispatches.
        unsafe {
            let buffer = recorder.raw();
            device.cmd_bind_pipeline(buffer, vk::PipelineBindPoint::COMPUTE, self.handle);
            let bytes = bytemuck::bytes_of(&push);
            device.cmd_push_constants(buffer, interface.layout, push_stages(&self.context), 0, bytes);
            device.cmd_dispatch(buffer, groups[0], groups[1], 1);
        }
    }
}

impl Drop for ComputePipeline {
    fn drop(&mut self) {
        // SAFETY: ours; whoever submitted work with it has waited.
        unsafe { self.context.device.destroy_pipeline(self.handle, None) };
    }
}
