//! Ambient occlusion as others do it, to compare Ambray with: each method after its publication, with the filter that it is
//! usually shown with, for the same camera and G-buffer.
//!
//! A method is a struct of its published parameters: its `estimate` is the openness of every pixel (1 = open) before its
//! filter, `filter` what its filter makes of that. All are pure functions of the [`Screen`], the seed and the frame number: the
//! same bits for any number of threads. [`rival`] finds the one that settings ask for; [`Hybrid`] traces rays besides, and is
//! filtered as Ambray is.
#![forbid(unsafe_code)]

mod bitmask;
mod blur;
mod gtao;
mod hbao;
mod hybrid;
mod rival;
mod screen;
mod ssao;
mod tile;

pub use bitmask::Bitmask;
pub use gtao::{Gtao, SliceSampling};
pub use hbao::Hbao;
pub use hybrid::{Hybrid, HybridEstimate};
pub use rival::{Rival, rival};
pub use screen::Screen;
pub use ssao::Ssao;
