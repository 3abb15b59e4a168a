//! Ambray: real-time ambient lighting by ray tracing.
#![forbid(unsafe_code)]

mod aov;
mod frame;
mod query;
mod renderer;
mod view;

pub use ambray_core::settings;
pub use ambray_scene as scene;
pub use aov::{Aov, AovKind};
pub use frame::{Frame, FrameStats, GBufferPixel, RayCounts, StageTimes};
pub use query::{QueryPoint, QueryResult};
pub use renderer::{BuildStats, Control, RenderError, Renderer};
pub use view::View;
