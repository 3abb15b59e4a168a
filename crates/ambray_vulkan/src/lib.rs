//! Ambray's Vulkan backend: the same picture by hardware ray tracing.

mod acceleration;
mod backend;
mod bandwidth;
mod commands;
mod constants;
mod context;
pub mod cost;
mod device;
mod display;
mod drawing;
mod error;
mod history;
mod image;
pub mod layout;
mod memory;
mod motion;
mod picture;
mod pipeline;
mod planes;
mod points;
mod rays;
mod readback;
mod reduce;
mod schedule;
mod shaders;
mod state;
mod tables;
#[doc(hidden)]
pub mod testing;
pub mod window;

pub use acceleration::{
    Acceleration, AccelerationOptions, AccelerationStats, Bounds, Culling, GeometryKind, Grouping, Placement,
    TopLevel,
};
pub use backend::{VulkanBackend, VulkanOptions};
pub use commands::{CommandSet, Recorder, Timing, Work};
pub use context::{
    Capability, Context, DeviceKind, DeviceOptions, DeviceReport, Limits, Live, NativeWindow, Need,
    VALIDATION_LOG, ValidationLog, choose, probe,
};
pub use device::Device;
pub use error::{MemorySide, Result, VulkanError};
pub use memory::{Buffer, Location};
pub use picture::Picture;
pub use pipeline::TraceMode;
