//! Ambray: real-time ambient lighting by ray tracing.
#![forbid(unsafe_code)]

mod framing;
mod renderer;
mod resolve;

pub use ambray_core::{
    aov::{Aov, AovKind},
    control::Control,
    frame::{Frame, FrameStats, GBufferPixel, RayCounts, StageTimes},
    query::{QueryPoint, QueryResult},
    settings,
    view::View,
};
pub use ambray_scene as scene;
pub use renderer::{BuildStats, RenderError, Renderer};
