//! Ambray's CPU backend: acceleration structures and batched ray tracing without a driver.
//!
//! [`Tracer`] implements [`Trace`](ambray_core::trace::Trace). Its results are pure functions of the ray and the scene,
//! the same bits for every tree, width, instruction set and batch; [`Stats`] tell what was built.

mod alpha;
mod backend;
mod bvh;
mod isa;
mod kernel;
mod levels;
mod motion;
mod options;
mod parts;
pub mod rays;
mod shapes;
mod speeds;
mod stats;
mod tracer;

pub use alpha::{AlphaTest, Opaque};
pub use backend::{BackendError, CpuBackend, CpuWorld};
pub use isa::Isa;
pub use options::{BuildOptions, Packets, Quality, Width};
pub use stats::Stats;
pub use tracer::Tracer;
