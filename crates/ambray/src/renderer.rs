//! The renderer: a scene made ready for tracing, from which frames and points are evaluated.

use std::{
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use ambray_core::settings::{Settings, SettingsError};
use ambray_scene::Scene;

use crate::{Frame, QueryPoint, QueryResult};

/// Why nothing was rendered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// Settings outside their range.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Settings(Vec<SettingsError>),
    /// The scene has no camera of this name or number.
    #[error("camera {name} is not in the scene: {known}")]
    UnknownCamera {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// A camera that sees nothing, such as one whose target is its position.
    #[error("{0}")]
    Camera(String),
    /// A query point that cannot be evaluated.
    #[error("point {index}: {reason}")]
    Point {
        /// Its place in the list, from 0.
        index: usize,
        /// What is wrong.
        reason: String,
    },
    /// The threads could not be started.
    #[error("threads could not be started: {0}")]
    Threads(String),
    /// [`Control::cancel`] was set.
    #[error("cancelled")]
    Cancelled,
}

/// How the caller follows and stops long work.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Called from any thread with the share done, in `[0, 1]`, never decreasing by much.
    pub progress: &'a (dyn Fn(f32) + Sync),
    /// Work stops soon after this is set.
    pub cancel: &'a AtomicBool,
    /// Number of threads, 0 for all cores. The result does not depend on it.
    pub threads: usize,
}

impl std::fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Control").field("cancel", self.cancel).field("threads", &self.threads).finish()
    }
}

static NEVER: AtomicBool = AtomicBool::new(false);

impl Default for Control<'_> {
    fn default() -> Self {
        Self { progress: &|_| (), cancel: &NEVER, threads: 0 }
    }
}

impl Control<'_> {
    /// Whether the caller wants to stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

/// What the scene became when it was made ready.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildStats {
    /// Triangles, instances counted each time.
    pub triangles: u64,
    /// Instances.
    pub instances: u64,
    /// Bytes of the acceleration structures.
    pub acceleration_bytes: u64,
    /// Wall time to build them.
    pub build_time: Duration,
}

/// A scene made ready for tracing.
#[derive(Debug)]
pub struct Renderer {
    scene: Scene,
}

impl Renderer {
    /// Builds the acceleration structures of `scene`.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        Self { scene }
    }

    /// The scene.
    #[must_use]
    pub const fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What building took.
    #[must_use]
    pub fn build_stats(&self) -> BuildStats {
        BuildStats::default()
    }

    /// Renders a frame. The same settings and scene give the same frame, bit for bit, for any number of threads.
    pub fn render(&self, settings: &Settings, control: Control<'_>) -> Result<Frame, RenderError> {
        let _ = (settings, control);
        unimplemented!()
    }

    /// Evaluates ambient light at `points`; result `i` belongs to point `i`.
    pub fn query(
        &self,
        settings: &Settings,
        points: &[QueryPoint],
        control: Control<'_>,
    ) -> Result<Vec<QueryResult>, RenderError> {
        let _ = (settings, points, control);
        unimplemented!()
    }
}
