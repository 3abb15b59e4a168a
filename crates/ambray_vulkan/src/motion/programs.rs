//! The compute shaders that deform meshes and measure their structures.

use std::sync::Arc;

use ambray_core::settings::Settings;

use crate::{
    Recorder, Result,
    layout::{MOTION_WIDTH, Push, Specialization},
    pipeline::{ComputePipeline, Interface},
    points::folded,
    shaders,
};

/// The programs of motion: none depends on settings.
#[derive(Debug)]
pub(crate) struct MotionPrograms {
    /// Lives as long as what was made with it.
    interface: Arc<Interface>,
    deform: ComputePipeline,
    assign: ComputePipeline,
    measure: ComputePipeline,
    cost: ComputePipeline,
}

/// Which program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Vertices and their box.
    Deform,
    /// Triangles to clusters.
    Assign,
    /// Boxes of clusters.
    Measure,
    /// Their surface-area cost.
    Cost,
}

impl MotionPrograms {
    /// Compiles them.
    pub(crate) fn new(interface: &Arc<Interface>) -> Result<Self> {
        let specialization = Specialization::of(&Settings::default(), false, false);
        let compute = |spirv: &[u8]| ComputePipeline::new(interface, spirv, &specialization);
        Ok(Self {
            interface: Arc::clone(interface),
            deform: compute(shaders::DEFORM)?,
            assign: compute(shaders::ASSIGN)?,
            measure: compute(shaders::MEASURE)?,
            cost: compute(shaders::COST)?,
        })
    }

    /// Records a step over `count` vertices or triangles with the arguments at this address.
    pub(super) fn record(&self, recorder: &mut Recorder<'_>, step: Step, arguments: u64, count: u32) {
        let (pipeline, extent) = match step {
            Step::Deform => (&self.deform, folded(count as usize)),
            Step::Assign => (&self.assign, folded(count as usize)),
            Step::Measure => (&self.measure, folded(count as usize)),
            // One workgroup.
            Step::Cost => (&self.cost, [MOTION_WIDTH, 1]),
        };
        let push = Push { scene: 0, view: arguments, origin: [0; 2], extent };
        pipeline.record(recorder, &self.interface, [MOTION_WIDTH, 1], push);
    }
}
