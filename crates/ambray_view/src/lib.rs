//! Ambray's window: ambient light seen and tuned live.
//!
//! [`Model`](model::Model) is everything that the user decides, plain data. The [`Engine`](engine::Engine) loads, renders
//! and exports on threads of its own, and answers with [`Event`](engine::Event)s. [`App`](app::App) joins the two with the
//! [`canvas`] (the picture, the camera, the divider) and the [`panels`] around it; it knows no window, and is tested
//! without one. The [`shell`] gives it a window.
#![deny(unsafe_code)]

pub mod app;
pub mod camera;
pub mod canvas;
pub mod engine;
pub mod memory;
pub mod model;
pub mod panels;
pub mod shell;

pub use shell::{Stop, ViewOptions, run};
