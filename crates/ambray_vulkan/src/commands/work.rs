//! What barriers order, by name.

use ash::vk;

/// A kind of work that touches memory: what a barrier orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// The host writes mapped memory.
    HostWrite,
    /// The host reads mapped memory.
    HostRead,
    /// Copies and fills.
    Transfer,
    /// Acceleration structures are built, copied, or asked for their size.
    BuildStructure,
    /// A ray-tracing pipeline runs. Nothing where the device has none.
    TraceRays,
    /// A compute shader runs, with ray queries where the device has them.
    Compute,
    /// Arguments of indirect calls are read.
    Indirect,
    /// Shaders that draw sample images.
    Draw,
    /// All of the above on the device: for places that are not worth a thought.
    Everything,
}

impl Work {
    /// Stages that do the work, and what they may do there.
    pub(crate) fn mask(self, pipelines: bool, queries: bool) -> (vk::PipelineStageFlags, vk::AccessFlags) {
        use vk::{AccessFlags as A, PipelineStageFlags as S};
        let shader = A::SHADER_READ | A::SHADER_WRITE | A::UNIFORM_READ;
        match self {
            Self::HostWrite => (S::HOST, A::HOST_WRITE),
            Self::HostRead => (S::HOST, A::HOST_READ),
            Self::Transfer => (S::TRANSFER, A::TRANSFER_READ | A::TRANSFER_WRITE),
            // Builds read their vertices, indices, boxes and instances as shaders do.
            Self::BuildStructure => (
                S::ACCELERATION_STRUCTURE_BUILD_KHR,
                A::ACCELERATION_STRUCTURE_READ_KHR | A::ACCELERATION_STRUCTURE_WRITE_KHR | A::SHADER_READ,
            ),
            // Shader binding tables are read as shaders read.
            Self::TraceRays if pipelines => {
                (S::RAY_TRACING_SHADER_KHR, shader | A::ACCELERATION_STRUCTURE_READ_KHR)
            }
            Self::TraceRays => (S::TOP_OF_PIPE, A::empty()),
            // Without ray queries a compute shader may not be said to read structures.
            Self::Compute if queries => (S::COMPUTE_SHADER, shader | A::ACCELERATION_STRUCTURE_READ_KHR),
            Self::Compute => (S::COMPUTE_SHADER, shader),
            Self::Indirect => (S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ),
            Self::Draw => (S::FRAGMENT_SHADER, A::SHADER_READ),
            Self::Everything => (S::ALL_COMMANDS, A::MEMORY_READ | A::MEMORY_WRITE),
        }
    }
}
