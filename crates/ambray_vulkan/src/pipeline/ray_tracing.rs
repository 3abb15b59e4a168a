//! The ray-tracing pipeline (paper, section 3): ray generation, closest-hit, any-hit, intersection, miss and callable
//! shaders, and the groups that the shader binding table is made of.

use std::sync::Arc;

use ash::{khr, vk};

use super::{
    TracePass,
    interface::{Interface, Module, map_entries, push_stages},
    shader_table::ShaderTable,
};
use crate::{
    Context, Recorder, Result, VulkanError,
    layout::{self, Push, Specialization},
    shaders,
};

/// A shader of the pipeline, by its place among the stages.
#[derive(Clone, Copy, Debug)]
enum Stage {
    Primary,
    Direct,
    Ambient,
    Rays,
    Miss,
    ClosestHit,
    MaskedAnyHit,
    ShapeAnyHit,
    ShapeIntersection,
    Lit,
    Unlit,
    Emissive,
    Checker,
}

/// All stages with their shaders, in the order of [`Stage`].
const STAGES: [(vk::ShaderStageFlags, &[u8]); 13] = [
    (vk::ShaderStageFlags::RAYGEN_KHR, shaders::PRIMARY_RAYGEN),
    (vk::ShaderStageFlags::RAYGEN_KHR, shaders::DIRECT_RAYGEN),
    (vk::ShaderStageFlags::RAYGEN_KHR, shaders::AMBIENT_RAYGEN),
    (vk::ShaderStageFlags::RAYGEN_KHR, shaders::RAYS_RAYGEN),
    (vk::ShaderStageFlags::MISS_KHR, shaders::MISS),
    (vk::ShaderStageFlags::CLOSEST_HIT_KHR, shaders::CLOSEST_HIT),
    (vk::ShaderStageFlags::ANY_HIT_KHR, shaders::MASKED_ANY_HIT),
    (vk::ShaderStageFlags::ANY_HIT_KHR, shaders::SHAPE_ANY_HIT),
    (vk::ShaderStageFlags::INTERSECTION_KHR, shaders::SHAPE_INTERSECTION),
    (vk::ShaderStageFlags::CALLABLE_KHR, shaders::LIT),
    (vk::ShaderStageFlags::CALLABLE_KHR, shaders::UNLIT),
    (vk::ShaderStageFlags::CALLABLE_KHR, shaders::EMISSIVE),
    (vk::ShaderStageFlags::CALLABLE_KHR, shaders::CHECKER),
];

/// Groups in the order of the shader binding table: ray generation by pass; miss by ray type; hits by kind of geometry,
/// then by ray type, so that an instance's offset is its kind times the number of ray types; callables by kind of material.
fn groups() -> Vec<vk::RayTracingShaderGroupCreateInfoKHR<'static>> {
    let general = |stage: Stage| {
        empty_group().ty(vk::RayTracingShaderGroupTypeKHR::GENERAL).general_shader(stage as u32)
    };
    let raygen = [Stage::Primary, Stage::Direct, Stage::Ambient, Stage::Rays].map(general);
    let miss = (0..layout::RAY_TYPES).map(|_| general(Stage::Miss));
    let kinds = [layout::GEOMETRY_OPAQUE, layout::GEOMETRY_MASKED, layout::GEOMETRY_SHAPE];
    let hits = kinds.into_iter().flat_map(|kind| (0..layout::RAY_TYPES).map(move |ray| hit_group(kind, ray)));
    let callables = [Stage::Lit, Stage::Unlit, Stage::Emissive, Stage::Checker].map(general);
    raygen.into_iter().chain(miss).chain(hits).chain(callables).collect()
}

fn hit_group(kind: u32, ray_type: u32) -> vk::RayTracingShaderGroupCreateInfoKHR<'static> {
    use vk::RayTracingShaderGroupTypeKHR as Type;
    let group = match kind {
        layout::GEOMETRY_OPAQUE => empty_group().ty(Type::TRIANGLES_HIT_GROUP),
        layout::GEOMETRY_MASKED => {
            empty_group().ty(Type::TRIANGLES_HIT_GROUP).any_hit_shader(Stage::MaskedAnyHit as u32)
        }
        _ => empty_group()
            .ty(Type::PROCEDURAL_HIT_GROUP)
            .any_hit_shader(Stage::ShapeAnyHit as u32)
            .intersection_shader(Stage::ShapeIntersection as u32),
    };
    // Shadow rays want to know whether there is anything, not what.
    if ray_type == layout::RAY_SHADOW { group } else { group.closest_hit_shader(Stage::ClosestHit as u32) }
}

fn empty_group() -> vk::RayTracingShaderGroupCreateInfoKHR<'static> {
    vk::RayTracingShaderGroupCreateInfoKHR::default()
        .general_shader(vk::SHADER_UNUSED_KHR)
        .closest_hit_shader(vk::SHADER_UNUSED_KHR)
        .any_hit_shader(vk::SHADER_UNUSED_KHR)
        .intersection_shader(vk::SHADER_UNUSED_KHR)
}

/// The pipeline with its table.
#[derive(Debug)]
pub(super) struct RayTracingPipeline {
    handle: Handle,
    table: ShaderTable,
}

/// Destroys the pipeline when dropped.
struct Handle {
    context: Arc<Context>,
    raw: vk::Pipeline,
}

impl RayTracingPipeline {
    pub(super) fn new(interface: &Interface, specialization: &Specialization) -> Result<Self> {
        let context = &interface.context;
        let extension = extension(context);
        let modules =
            STAGES.iter().map(|(_, spirv)| Module::new(context, spirv)).collect::<Result<Vec<_>>>()?;
        let entries = map_entries();
        let special =
            vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::bytes_of(specialization));
        let stages: Vec<_> = (STAGES.iter().zip(&modules))
            .map(|(&(stage, _), module)| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(stage)
                    .module(module.handle)
                    .name(c"main")
                    .specialization_info(&special)
            })
            .collect();
        let groups = groups();
        // Rays are traced from ray generation shaders alone, in loops.
        let info = vk::RayTracingPipelineCreateInfoKHR::default()
            .stages(&stages)
            .groups(&groups)
            .max_pipeline_ray_recursion_depth(1)
            .layout(interface.layout);
        // SAFETY: modules and layout are of this device, and everything described lives until the call returns.
        let made = unsafe {
            extension.create_ray_tracing_pipelines(
                vk::DeferredOperationKHR::null(),
                vk::PipelineCache::null(),
                &[info],
                None,
            )
        };
        let raw = made.map_err(|(_, result)| VulkanError::of("vkCreateRayTracingPipelinesKHR")(result))?[0];
        let handle = Handle { context: Arc::clone(context), raw };
        let counts = [
            TracePass::ALL.len() as u32,
            layout::RAY_TYPES,
            layout::GEOMETRY_KINDS * layout::RAY_TYPES,
            layout::MATERIAL_KINDS,
        ];
        let size = groups.len() * context.limits().group_handle_size as usize;
        // SAFETY: the pipeline has this many groups, and the size is that of their handles.
        let handles =
            unsafe { extension.get_ray_tracing_shader_group_handles(raw, 0, groups.len() as u32, size) }
                .map_err(VulkanError::of("vkGetRayTracingShaderGroupHandlesKHR"))?;
        let table = ShaderTable::new(context, &handles, counts)?;
        Ok(Self { handle, table })
    }

    pub(super) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        interface: &Interface,
        pass: TracePass,
        push: Push,
    ) {
        let context = &self.handle.context;
        // SAFETY: the buffer is being recorded; pipeline, table, set and layout belong together and outlive the
        // submission; the caller kept the extent within what the device dispatches.
        unsafe {
            let buffer = recorder.raw();
            let point = vk::PipelineBindPoint::RAY_TRACING_KHR;
            context.device.cmd_bind_pipeline(buffer, point, self.handle.raw);
            context.device.cmd_bind_descriptor_sets(
                buffer,
                point,
                interface.layout,
                0,
                &[interface.set],
                &[],
            );
            let bytes = bytemuck::bytes_of(&push);
            context.device.cmd_push_constants(buffer, interface.layout, push_stages(context), 0, bytes);
            let [raygen, miss, hit, callable] = self.table.regions(pass as u32);
            let [width, height] = push.extent;
            extension(context).cmd_trace_rays(buffer, &raygen, &miss, &hit, &callable, width, height, 1);
        }
    }
}

fn extension(context: &Context) -> &khr::ray_tracing_pipeline::Device {
    context.pipelines.as_ref().expect("the trace mode was resolved against the device")
}

impl std::fmt::Debug for Handle {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Handle").field(&self.raw).finish()
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: ours; whoever submitted work with it has waited.
        unsafe { self.context.device.destroy_pipeline(self.raw, None) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_where_the_table_expects_them() {
        let groups = groups();
        let hits = TracePass::ALL.len() + layout::RAY_TYPES as usize;
        let hit = |kind: u32, ray: u32| groups[hits + (kind * layout::RAY_TYPES + ray) as usize];
        assert_eq!(hit(layout::GEOMETRY_OPAQUE, layout::RAY_AMBIENT).any_hit_shader, vk::SHADER_UNUSED_KHR);
        assert_eq!(
            hit(layout::GEOMETRY_MASKED, layout::RAY_PRIMARY).any_hit_shader,
            Stage::MaskedAnyHit as u32
        );
        let shadow_of_shape = hit(layout::GEOMETRY_SHAPE, layout::RAY_SHADOW);
        assert_eq!(shadow_of_shape.intersection_shader, Stage::ShapeIntersection as u32);
        assert_eq!(shadow_of_shape.closest_hit_shader, vk::SHADER_UNUSED_KHR);
        let callables = groups.len() - layout::MATERIAL_KINDS as usize;
        let callable = |kind: u32| groups[callables + kind as usize].general_shader;
        assert_eq!(callable(layout::MATERIAL_LIT), Stage::Lit as u32);
        assert_eq!(callable(layout::MATERIAL_UNLIT), Stage::Unlit as u32);
        assert_eq!(callable(layout::MATERIAL_EMISSIVE), Stage::Emissive as u32);
        assert_eq!(callable(layout::MATERIAL_CHECKER), Stage::Checker as u32);
    }
}
