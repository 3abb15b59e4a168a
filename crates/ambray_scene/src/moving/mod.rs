//! Built-in scenes that move, made by code alone: for benchmarks, tests and first steps with animations.
//!
//! | Scene | What moves |
//! |---|---|
//! | [`banner`] | one large mesh that deforms strongly, by morph targets |
//! | [`flock`] | two thousand instances of four meshes, each rigid, on paths of their own |
//!
//! Each has one clip that ends as it begins. Units are metres, y points up. Like the [`atrium`](crate::atrium), they are the
//! same on every machine, bit for bit.

mod banner;
mod cloth;
mod flock;
mod hall;
mod paths;

#[cfg(test)]
mod tests;

pub use banner::banner;
pub use flock::flock;
