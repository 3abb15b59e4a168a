//! The passes as programs of the device: ray-tracing pipelines with their shader binding table, or compute shaders.

mod cache;
mod compute;
mod interface;
mod ray_tracing;
mod shader_table;

use std::sync::Arc;

use crate::{
    Context, Recorder, Result, VulkanError, Work,
    layout::{self, Push, Specialization},
};

pub(crate) use cache::ProgramCache;
pub(crate) use compute::ComputePipeline;
pub(crate) use interface::{Interface, Module};

use ray_tracing::RayTracingPipeline;

/// How rays are traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TraceMode {
    /// By pipeline where the device has it, else by query.
    #[default]
    Auto,
    /// By the ray-tracing pipeline: hit, miss and callable shaders of a shader binding table (VK_KHR_ray_tracing_pipeline).
    Pipeline,
    /// By ray queries in compute shaders (VK_KHR_ray_query).
    Query,
}

impl TraceMode {
    /// What is used on the device of `context`; an error if it lacks what is asked for.
    pub(crate) fn resolve(self, context: &Context) -> Result<Self> {
        let missing = |feature: &str| {
            let device = context.report().name.clone();
            Err(VulkanError::Missing { device, feature: feature.to_owned() })
        };
        match self {
            Self::Auto if context.has_pipelines() => Ok(Self::Pipeline),
            Self::Auto => Ok(Self::Query),
            Self::Pipeline if !context.has_pipelines() => missing("VK_KHR_ray_tracing_pipeline"),
            Self::Query if !context.has_queries() => missing("VK_KHR_ray_query"),
            chosen => Ok(chosen),
        }
    }
}

/// A pass that traces rays, by its place among the ray generation shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TracePass {
    /// What each pixel sees.
    Primary,
    /// Direct light.
    Direct,
    /// Openness and near radiance.
    Ambient,
    /// A batch of rays.
    Rays,
}

impl TracePass {
    pub(crate) const ALL: [Self; 4] = [Self::Primary, Self::Direct, Self::Ambient, Self::Rays];
}

/// The programs of all passes for one choice of settings.
#[derive(Debug)]
pub(crate) struct Programs {
    /// Lives as long as what was made with it.
    _interface: Arc<Interface>,
    tracing: Tracing,
    filter: ComputePipeline,
}

#[derive(Debug)]
enum Tracing {
    Pipeline(Box<RayTracingPipeline>),
    Query(Vec<ComputePipeline>),
}

impl Programs {
    /// Compiles the programs; `mode` is resolved.
    pub(crate) fn new(
        interface: &Arc<Interface>,
        mode: TraceMode,
        specialization: &Specialization,
    ) -> Result<Self> {
        let compute = |spirv: &[u8]| ComputePipeline::new(interface, spirv, specialization);
        let tracing = if mode == TraceMode::Pipeline {
            Tracing::Pipeline(Box::new(RayTracingPipeline::new(interface, specialization)?))
        } else {
            Tracing::Query(
                TracePass::ALL.into_iter().map(|p| compute(compute::query(p))).collect::<Result<_>>()?,
            )
        };
        Ok(Self { _interface: Arc::clone(interface), tracing, filter: compute(crate::shaders::FILTER)? })
    }

    /// The kind of work that tracing is, for barriers.
    pub(crate) const fn tracing_work(&self) -> Work {
        match self.tracing {
            Tracing::Pipeline(_) => Work::TraceRays,
            Tracing::Query(_) => Work::Compute,
        }
    }

    /// Records a pass over `push.extent` pixels from `push.origin`, through the structure that `interface` is bound to.
    pub(crate) fn trace(
        &self,
        recorder: &mut Recorder<'_>,
        interface: &Interface,
        pass: TracePass,
        push: Push,
    ) {
        match &self.tracing {
            Tracing::Pipeline(pipeline) => pipeline.record(recorder, interface, pass, push),
            Tracing::Query(pipelines) => {
                let workgroup = [layout::QUERY_WIDTH, layout::QUERY_HEIGHT];
                pipelines[pass as usize].record_tracing(recorder, interface, workgroup, push);
            }
        }
    }

    /// Records the filter and composition over `push.extent` pixels from `push.origin`.
    pub(crate) fn filter(&self, recorder: &mut Recorder<'_>, interface: &Interface, push: Push) {
        let workgroup = [layout::FILTER_WIDTH, layout::FILTER_HEIGHT];
        self.filter.record(recorder, interface, workgroup, push);
    }
}
