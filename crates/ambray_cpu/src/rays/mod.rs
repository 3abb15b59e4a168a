//! The rays of a frame, kept to be traced again: by a benchmark, by other kernels, by other tracers.

mod batch;
mod resize;
mod triangles;

pub use batch::{Order, RayBatch, RayKind};
pub use triangles::{LeftOut, Triangles};

/// The rays of a frame. Chords are those that the frame would have had with each kind of thin detection.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameRays {
    /// From the camera, one a pixel.
    pub primary: RayBatch,
    /// First batch: the N rays of each point, but for those below the horizon.
    pub ambient: RayBatch,
    /// Second batch with [`Thin::Paper`](ambray_core::settings::Thin::Paper), where any hit will do.
    pub paper_chords: RayBatch,
    /// Second batch with [`Thin::Sheet`](ambray_core::settings::Thin::Sheet).
    pub sheet_chords: RayBatch,
}
