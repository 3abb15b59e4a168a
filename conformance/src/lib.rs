//! What the tests of whole pictures share: where the scenes are, and the views of spec §11.

pub mod backends;
pub mod browser;
pub mod moving;
pub mod parity;
pub mod scenes;
pub mod shared;
pub mod views;
