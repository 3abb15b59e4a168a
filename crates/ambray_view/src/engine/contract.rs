//! What the window and the engine tell each other.

use std::{fmt, path::PathBuf, sync::Arc, time::Duration};

use ambray::{
    Aov, BuildStats, Frame, FrameStats, Inspection, Machine, RendererOptions, View, settings::Settings,
    vulkan::Picture,
};
use glam::Vec3;

use crate::model::{Comparison, SceneRef, Side};

/// Called when there are new events.
#[derive(Clone)]
pub struct Wake(pub Arc<dyn Fn() + Send + Sync>);

impl fmt::Debug for Wake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Wake")
    }
}

/// How the engine runs.
#[derive(Clone, Debug)]
pub struct EngineOptions {
    /// Who renders.
    pub renderer: RendererOptions,
    /// Threads of the processor, 0 for all cores.
    pub threads: usize,
    /// Whether pictures stay on the device that renders them.
    pub keeps_on_device: bool,
    /// Called when there are new events.
    pub wake: Wake,
}

/// What is wanted. The latest order counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// Settings of the sides that are shown; A always is.
    pub sides: [Option<Settings>; 2],
    /// The plane that is shown.
    pub aov: Aov,
    /// How the sides are compared.
    pub comparison: Comparison,
    /// Whether quick pictures are worth more than fine ones: something is dragged, or time goes on.
    pub is_moving: bool,
    /// Whether each frame continues the last one, as in a sequence: an animation plays, or light is accumulated.
    pub is_playing: bool,
}

/// How far a picture is refined. Coarse pictures are quick; the last one is what `ambray render` makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Size relative to the one asked for, 1 at the end.
    pub scale: f32,
    /// Rays a pixel; 0 with a method that takes none.
    pub spp: u32,
    /// Whether this is the picture that was asked for.
    pub is_final: bool,
}

/// Display values, RGBA with 8 bits a channel, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
}

/// The picture itself.
#[derive(Clone, Debug)]
pub enum Content {
    /// In the memory of the processor.
    Host {
        /// All planes.
        frame: Arc<Frame>,
        /// The plane that is shown.
        pixels: Arc<Pixels>,
    },
    /// In the memory of the device that renders; what stands still follows as [`Event::Copied`].
    Device {
        /// The plane that is shown. Whoever holds it has waited for the device to be done with it before it is dropped.
        picture: Arc<Picture>,
        /// All planes, once they are [copied](Event::Copied).
        frame: Option<Arc<Frame>>,
    },
}

/// The values of the plane that is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Pixels in each of equal steps from `low` to `high`, for each channel.
    pub histogram: Vec<Vec<u32>>,
    /// Smallest finite value.
    pub low: f32,
    /// Largest finite value.
    pub high: f32,
    /// Mean of the finite values, for each channel.
    pub mean: Vec<f32>,
}

/// A picture of one side.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// Which side.
    pub side: Side,
    /// What it was rendered with: the settings asked for, coarser where the level says so.
    pub settings: Settings,
    /// The plane that is shown.
    pub aov: Aov,
    /// The view with everything chosen.
    pub view: View,
    /// Who rendered it: with some methods the processor, whatever device the scene is open on.
    pub machine: Machine,
    /// How far it is refined.
    pub level: Level,
    /// Frames of the sequence so far, where light is accumulated; 1 otherwise.
    pub frames: u32,
    /// The picture.
    pub content: Content,
    /// Its values, where they are known.
    pub statistics: Option<Arc<Statistics>>,
    /// What it took.
    pub stats: FrameStats,
    /// Bytes of the frame, which is kept; on a device both sides share them.
    pub frame_bytes: u64,
}

/// A − B of the plane that is shown.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Picture of the difference.
    pub pixels: Arc<Pixels>,
    /// Root of the mean squared difference, over all channels of all pixels where both are finite.
    pub rmse: f64,
    /// Mean of A − B.
    pub bias: f64,
    /// Largest absolute difference.
    pub largest: f32,
}

/// What a pixel did.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspected {
    /// In the picture of which side.
    pub side: Side,
    /// The pixel that was asked for.
    pub pixel: (u32, u32),
    /// Everything that it did.
    pub inspection: Inspection,
}

/// A camera of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CameraInfo {
    /// Its name, or its number where it has none.
    pub name: String,
}

/// An animation of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct AnimationInfo {
    /// Its name, or its number where it has none.
    pub name: String,
    /// Its length, seconds.
    pub duration: f32,
}

/// A scene that is ready.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What was asked for.
    pub scene: SceneRef,
    /// What the loader had to say.
    pub warnings: Vec<String>,
    /// Time to read it.
    pub load_time: Duration,
    /// What building took.
    pub build: BuildStats,
    /// Who renders it; a picture may be [someone else's](Rendered::machine).
    pub machine: Machine,
    /// Its cameras, in the order of the file.
    pub cameras: Vec<CameraInfo>,
    /// Its animations, in the order of the file.
    pub animations: Vec<AnimationInfo>,
    /// Box around it, world space.
    pub bounds: (Vec3, Vec3),
    /// Whether this is the scene that was open before, read again.
    pub is_reload: bool,
}

/// Something to write.
#[derive(Clone, Debug, PartialEq)]
pub enum Export {
    /// The picture of a side, as `ambray render` would write it.
    Screenshot {
        /// Where to: `.png` or `.exr`.
        path: PathBuf,
        /// Settings at full quality.
        settings: Settings,
        /// The plane, in PNG.
        aov: Aov,
    },
    /// A turn of the camera around its target.
    Turntable {
        /// Where to: a numbered picture (`turn_####.png`) or a video.
        path: PathBuf,
        /// Settings of the first frame.
        settings: Settings,
        /// The plane.
        aov: Aov,
        /// Frames of the whole turn.
        frames: u32,
        /// Frames a second of a video.
        fps: f32,
    },
}

/// What has happened.
#[derive(Clone, Debug)]
pub enum Event {
    /// A scene is being read or built.
    Loading {
        /// Which.
        scene: SceneRef,
        /// What is being done, in words.
        stage: &'static str,
        /// Share that is done, 0 to 1; `None` where nobody knows.
        share: Option<f32>,
    },
    /// A scene is ready; pictures from now on show it.
    Opened(Arc<Opened>),
    /// A scene could not be opened; the old one stays.
    OpenFailed {
        /// Which.
        scene: SceneRef,
        /// Why, one line.
        message: String,
    },
    /// A picture.
    Picture(Box<Rendered>),
    /// The planes of the picture on the device that came last of its side, copied to the host.
    Copied {
        /// Of which side.
        side: Side,
        /// All planes.
        frame: Arc<Frame>,
        /// The plane that is shown.
        aov: Aov,
        /// Its values.
        statistics: Arc<Statistics>,
    },
    /// The pictures of both sides compared.
    Difference(Box<Difference>),
    /// What a pixel did, that [`Engine::inspect`](super::Engine::inspect) asked for.
    Inspected(Box<Inspected>),
    /// The picture under way: share of its final level, 0 to 1.
    Progress {
        /// Of which side.
        side: Side,
        /// Share.
        share: f32,
    },
    /// What a pixel did cannot be told.
    InspectFailed {
        /// Of which side.
        side: Side,
        /// Why, one line.
        message: String,
    },
    /// Nothing can be rendered with the settings of a side.
    Refused {
        /// Which side.
        side: Side,
        /// Why, a line for each reason.
        messages: Vec<String>,
    },
    /// An export goes on.
    Exporting {
        /// Share that is done.
        share: f32,
    },
    /// An export is written.
    Exported {
        /// Where.
        path: PathBuf,
    },
    /// An export failed, or was stopped.
    ExportFailed {
        /// Where to.
        path: PathBuf,
        /// Why, one line.
        message: String,
    },
}
