//! The files of Ambray's programs, for whoever shows pictures and lets people choose settings.
//!
//! In: [`scene_source`] loads a scene by path or by the name of a built-in one, [`settings_file`] reads settings from TOML
//! and from pictures, [`planes`] the values of pictures, [`rays`] those of a frame. Out: a [`Plan`] decides which files a frame becomes and writes them
//! as PNG or OpenEXR, [`video`] makes videos, [`command_line`] spells the call of `ambray render` that makes the same
//! picture. All files appear complete or not at all ([`atomic`]), also where the program ends early ([`temporary`],
//! [`interruption`]).
//!
//! Nothing here speaks to people. Errors are chains of `anyhow` that read as one line, with advice beside them ([`hint_of`]).
#![forbid(unsafe_code)]

pub mod atomic;
pub mod command_line;
mod exr;
pub mod folder;
mod format;
pub mod head;
pub mod interruption;
pub mod numbering;
mod plan;
pub mod planes;
mod png;
mod problem;
mod rate;
pub mod rays;
pub mod scene_source;
pub mod settings_file;
pub mod temporary;
pub mod video;
mod whole;

pub use format::Format;
pub use interruption::Interrupted;
pub use plan::Plan;
pub use png::{Bits, write as write_png};
pub use problem::{Problems, hint_of, with_hint};
pub use rate::Rate;
