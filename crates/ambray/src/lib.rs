//! Ambray: real-time ambient lighting by ray tracing.
//!
//! Every visible surface point gets an *openness* O (ambient occlusion with a fuzzy measure of the distance to the
//! first hit) and a *near-field radiance* I (colour bleeding from the hits of the same rays), so that
//! L = a·(L_a·O + I) + direct light. A handful of rays a pixel is enough.
//!
//! ```
//! use ambray::{Control, Renderer, scene::atrium, settings::{Settings, Size}};
//!
//! let mut renderer = Renderer::new(atrium::atrium());
//! let settings = Settings { size: Size { width: 64, height: 36 }, ..Settings::default() };
//! let frame = renderer.render(&settings, Control::default())?;
//! assert!(frame.ambient.iter().all(|v| (0.0..=1.0).contains(&v.x)));
//! # Ok::<(), ambray::RenderError>(())
//! ```
//!
//! [`Settings`](settings::Settings) hold everything that decides a picture; [`scene::load`] reads glTF and OBJ files;
//! [`Renderer::query`] evaluates arbitrary points instead of pixels.
#![forbid(unsafe_code)]

mod backend;
mod device;
mod drawn;
mod framing;
mod renderer;
mod resolve;

pub use ambray_core::{
    aov::{Aov, AovKind},
    camera,
    compose::compose,
    control::Control,
    display, filter,
    frame::{Frame, FrameStats, GBufferPixel, PoseStats, RayCounts, StageTimes},
    inspect::{self, Inspection},
    light,
    query::{QueryPoint, QueryResult},
    settings, shape, trace,
    view::View,
};
pub use ambray_cpu as cpu;
pub use ambray_cpu::{BuildOptions, Isa, Packets, Quality, Width};
pub use ambray_scene as scene;
pub use ambray_vulkan as vulkan;
pub use ambray_vulkan::Device;
pub use backend::{BackendChoice, RendererOptions};
pub use drawn::{DeviceFrame, Drawn};
pub use renderer::{BuildStats, Machine, RenderError, Renderer};

/// The code in the README compiles.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
