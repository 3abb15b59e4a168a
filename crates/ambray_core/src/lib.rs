//! The method on one page (written in full once the modules stand).
#![forbid(unsafe_code)]

pub mod camera;
pub mod light;
pub mod offset;
pub mod sampling;
pub mod trace;
