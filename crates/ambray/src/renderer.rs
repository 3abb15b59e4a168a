//! The renderer: a scene made ready for tracing, from which frames and points are evaluated.

use std::{sync::Arc, time::Duration};

use ambray_core::{
    control::Control,
    frame::Frame,
    query::{QueryPoint, QueryResult},
    settings::{Settings, SettingsError},
    view::View,
};
use ambray_cpu::{BackendError, BuildOptions, CpuBackend};
use ambray_scene::Scene;
use glam::Vec3;

use crate::resolve;

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
        reason: &'static str,
    },
    /// The threads could not be started.
    #[error("the threads could not be started: {0}")]
    Threads(String),
    /// [`Control::cancel`] was set.
    #[error("cancelled")]
    Cancelled,
}

impl From<BackendError> for RenderError {
    fn from(error: BackendError) -> Self {
        match error {
            BackendError::Cancelled(_) => Self::Cancelled,
            other => Self::Threads(other.to_string()),
        }
    }
}

/// What the scene became when it was made ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuildStats {
    /// Triangles, instances counted each time.
    pub triangles: u64,
    /// Instances.
    pub instances: u64,
    /// Bytes of the acceleration structures.
    pub acceleration_bytes: u64,
    /// Wall time to build them.
    pub build_time: Duration,
    /// Instruction set in use.
    pub isa: &'static str,
}

/// A scene made ready for tracing.
#[derive(Debug)]
pub struct Renderer {
    scene: Arc<Scene>,
    /// Box around the scene, found once.
    bounds: Option<(Vec3, Vec3)>,
    backend: CpuBackend,
}

impl Renderer {
    /// Builds the acceleration structures of `scene`.
    ///
    /// # Panics
    /// If indices within the scene are out of range; scenes that were loaded are sound.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        Self::with_options(scene, BuildOptions::default())
    }

    /// As [`new`](Self::new), with a choice of effort, memory and instruction set.
    ///
    /// # Panics
    /// As [`new`](Self::new), and if the machine lacks the instruction set asked for.
    #[must_use]
    pub fn with_options(scene: Scene, options: BuildOptions) -> Self {
        let scene = Arc::new(scene);
        let backend = CpuBackend::new(Arc::clone(&scene), options);
        Self { bounds: scene.bounds(), scene, backend }
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What building took.
    #[must_use]
    pub fn build_stats(&self) -> BuildStats {
        let stats = self.backend.world().tracer().stats();
        BuildStats {
            triangles: self.scene.triangle_count(),
            instances: self.scene.instances.len() as u64,
            acceleration_bytes: stats.bytes as u64,
            build_time: stats.build_time,
            isa: stats.isa.name(),
        }
    }

    /// Checks `settings` and replaces every `auto` by a value of the scene.
    pub fn view(&self, settings: &Settings) -> Result<View, RenderError> {
        let errors = settings.validate();
        if !errors.is_empty() {
            return Err(RenderError::Settings(errors));
        }
        resolve::view(settings, &self.scene, self.bounds, self.backend.world())
    }

    /// Renders a frame. The same settings and scene give the same frame, bit for bit, for any number of threads.
    pub fn render(&self, settings: &Settings, control: Control<'_>) -> Result<Frame, RenderError> {
        let view = self.view(settings)?;
        Ok(self.backend.render(settings, &view, control)?)
    }

    /// Evaluates ambient light at `points`; result `i` belongs to point `i`.
    pub fn query(
        &self,
        settings: &Settings,
        points: &[QueryPoint],
        control: Control<'_>,
    ) -> Result<Vec<QueryResult>, RenderError> {
        let view = self.view(settings)?;
        for (index, point) in points.iter().enumerate() {
            check_point(point).map_err(|reason| RenderError::Point { index, reason })?;
        }
        Ok(self.backend.query(settings, &view, points, control)?)
    }
}

fn check_point(point: &QueryPoint) -> Result<(), &'static str> {
    if !point.position.is_finite() {
        return Err("the position is not finite");
    }
    if point.normal.try_normalize().is_none() {
        return Err("the normal has no direction");
    }
    if u32::from(point.class) >= ambray_core::sampling::CLASS_COUNT {
        return Err("the sample class is not below 16");
    }
    Ok(())
}
