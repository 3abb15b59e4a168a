//! Ambray's Vulkan backend: the same picture by hardware ray tracing.

mod commands;
mod context;
mod error;
mod memory;

pub use commands::{CommandSet, Recorder, Timing, Work};
pub use context::{Capability, Context, DeviceKind, DeviceOptions, DeviceReport, Limits, Live, Need, probe};
pub use error::{MemorySide, Result, VulkanError};
pub use memory::{Buffer, Location};
