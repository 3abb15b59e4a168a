//! What is rendered next: pure decisions, without renderer, threads or clock.

mod levels;
mod pace;
mod rate;
mod schedule;
mod work;

pub(super) use schedule::{Schedule, Step};
pub use work::MOST_FRAMES;
pub(super) use work::{frame_settings, is_same};
