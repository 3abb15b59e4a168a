//! Frames where they were rendered.

use ambray_core::{
    frame::{Frame, FrameStats},
    view::View,
};

/// A frame, where it was rendered.
#[derive(Clone, Debug)]
pub enum Drawn {
    /// On the processor.
    Host(Box<Frame>),
    /// On a device, where it stays: see [`Renderer::show`](crate::Renderer::show) and
    /// [`Renderer::read_frame`](crate::Renderer::read_frame).
    Device(Box<DeviceFrame>),
}

/// What is known on the host about a frame that stays on a device.
#[derive(Clone, Debug)]
pub struct DeviceFrame {
    /// The view with everything chosen: camera, radius, lights.
    pub view: View,
    /// What it took.
    pub stats: FrameStats,
}

impl Drawn {
    /// The view with everything chosen.
    #[must_use]
    pub const fn view(&self) -> &View {
        match self {
            Self::Host(frame) => &frame.view,
            Self::Device(frame) => &frame.view,
        }
    }

    /// What it took.
    #[must_use]
    pub const fn stats(&self) -> &FrameStats {
        match self {
            Self::Host(frame) => &frame.stats,
            Self::Device(frame) => &frame.stats,
        }
    }

    pub(crate) const fn stats_mut(&mut self) -> &mut FrameStats {
        match self {
            Self::Host(frame) => &mut frame.stats,
            Self::Device(frame) => &mut frame.stats,
        }
    }
}
