//! The method on one page (written in full once the modules stand).
#![forbid(unsafe_code)]

pub mod aov;
pub mod basis;
pub mod camera;
pub mod compose;
pub mod control;
pub mod direct;
pub mod filter;
pub mod frame;
pub mod gather;
pub mod light;
pub mod offset;
pub mod openness;
pub mod query;
pub mod sampling;
pub mod settings;
pub mod trace;
pub mod view;
