//! The engine as the window uses it, against the library.

mod common;
mod device;
mod exports;
mod orders;
mod scenes;
mod sequences;
