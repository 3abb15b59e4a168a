//! The renderer: a scene made ready for tracing, from which frames and points are evaluated.

use std::{
    sync::{Arc, OnceLock},
    time::{Duration, Instant},
};

use ambray_core::{
    aov::Aov,
    control::Control,
    frame::{Frame, FrameStats, PoseStats, StageTimes},
    inspect::{Inspection, OutsidePicture, inspect},
    query::{QueryPoint, QueryResult},
    settings::{Method, Settings, SettingsError},
    trace::{Hit, Ray, Trace},
    view::View,
};
use ambray_cpu::{BackendError, BuildOptions, Isa, rays::FrameRays};
use ambray_scene::Scene;
use ambray_vulkan::{AccelerationStats, DeviceReport, Picture, TraceMode, VulkanError};
use glam::Vec3;

use crate::{
    BackendChoice, Device, DeviceFrame, Drawn, RendererOptions,
    backend::{Backend, Backends},
    device::{DeviceTrace, DeviceWorld},
    framing::Framing,
    resolve,
};

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
    /// The scene has no animation of this name or number.
    #[error("animation {name} is not in the scene: {known}")]
    UnknownAnimation {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// A camera that sees nothing, such as one whose target is its position.
    #[error("{0}")]
    Camera(String),
    /// A screen-space method was asked for where there is no picture, or on a device.
    #[error("the method {method} {reason}")]
    Method {
        /// Which method.
        method: Method,
        /// Why it cannot do that.
        reason: &'static str,
    },
    /// A query point that cannot be evaluated.
    #[error("point {index}: {reason}")]
    Point {
        /// Its place in the list, from 0.
        index: usize,
        /// What is wrong.
        reason: &'static str,
    },
    /// A pixel outside the picture was to be inspected.
    #[error(transparent)]
    Pixel(#[from] OutsidePicture),
    /// More rays were to be recorded than there are tags for.
    #[error("{0}")]
    TooManyRays(String),
    /// The threads could not be started.
    #[error("the threads could not be started: {0}")]
    Threads(String),
    /// The Vulkan device could not be used, or failed.
    #[error("{0}")]
    Vulkan(VulkanError),
    /// No frame is on a device to be shown or read: draw one first.
    #[error("no frame has been drawn on a device")]
    NothingDrawn,
    /// [`Control::cancel`] was set.
    #[error("cancelled")]
    Cancelled,
}

impl From<BackendError> for RenderError {
    fn from(error: BackendError) -> Self {
        match error {
            BackendError::Cancelled(_) => Self::Cancelled,
            BackendError::TooManyRays => Self::TooManyRays(error.to_string()),
            other => Self::Threads(other.to_string()),
        }
    }
}

impl From<VulkanError> for RenderError {
    fn from(error: VulkanError) -> Self {
        match error {
            VulkanError::Cancelled(_) => Self::Cancelled,
            VulkanError::NothingDrawn => Self::NothingDrawn,
            other => Self::Vulkan(other),
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
}

/// Who renders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Machine {
    /// The processor.
    Cpu {
        /// Instruction set of the kernels.
        isa: &'static str,
        /// Why no device renders, where one was looked for.
        reason: Option<String>,
    },
    /// A Vulkan device.
    Vulkan {
        /// Name of the device.
        device: String,
        /// How it traces rays.
        trace: TraceMode,
    },
}

/// A scene made ready for tracing.
#[derive(Debug)]
pub struct Renderer {
    backends: Backends,
    /// Box around the scene as it was opened.
    bounds: (Vec3, Vec3),
    /// How the scene, as it was opened, is looked at; found when it is first needed.
    framing: OnceLock<Framing>,
}

impl Renderer {
    /// Makes `scene` ready for the processor, which needs no driver and cannot fail.
    ///
    /// # Panics
    /// If indices within the scene are out of range; scenes that were loaded are sound.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        Self::on_cpu(scene, BuildOptions::default())
    }

    /// As [`new`](Self::new), with a choice of effort, memory and instruction set.
    ///
    /// # Panics
    /// As [`new`](Self::new), and if the machine lacks the instruction set asked for.
    #[must_use]
    pub fn on_cpu(scene: Scene, build: BuildOptions) -> Self {
        let options = RendererOptions { backend: BackendChoice::Cpu, build, ..RendererOptions::default() };
        match Self::open(scene, &options, Control::default()) {
            Ok(renderer) => renderer,
            Err(error) => unreachable!("the processor is always there: {error}"),
        }
    }

    /// Makes `scene` ready for the backend that `options` ask for.
    ///
    /// # Errors
    /// If a Vulkan device is asked for and cannot be used. By default the processor steps in, and [`machine`](Self::machine)
    /// says why.
    ///
    /// # Panics
    /// As [`on_cpu`](Self::on_cpu).
    pub fn open(scene: Scene, options: &RendererOptions, control: Control<'_>) -> Result<Self, RenderError> {
        let scene = Arc::new(scene);
        Ok(Self::with_backends(Backends::new(scene, options, &control)?))
    }

    fn with_backends(backends: Backends) -> Self {
        // An empty scene is looked at as if a box of two units were there.
        let bounds = backends.scene().bounds().unwrap_or((Vec3::NEG_ONE, Vec3::ONE));
        Self { backends, bounds, framing: OnceLock::new() }
    }

    /// Makes another scene ready for the same backend. A device keeps its compiled programs.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    ///
    /// # Panics
    /// As [`on_cpu`](Self::on_cpu).
    pub fn with_scene(&self, scene: Scene, control: Control<'_>) -> Result<Self, RenderError> {
        let scene = Arc::new(scene);
        Ok(Self::with_backends(self.backends.with_scene(scene, &control)?))
    }

    /// Who renders with `settings`: the processor where a [`method`](Settings::method) needs it, else [`machine`](Self::machine).
    #[must_use]
    pub fn machine_for(&self, settings: &Settings) -> Machine {
        match self.machine() {
            Machine::Vulkan { .. } if settings.method.is_screen_space() => Machine::Cpu {
                isa: Isa::detect().name(),
                reason: Some(format!("the method {} runs there only", settings.method)),
            },
            machine => machine,
        }
    }

    /// Who renders. May change from a device to the processor when the device fails.
    #[must_use]
    pub fn machine(&self) -> Machine {
        match self.backends.current() {
            Backend::Cpu(cpu) => Machine::Cpu {
                isa: cpu.world().tracer().stats().isa.name(),
                reason: self.backends.reason().map(str::to_owned),
            },
            Backend::Vulkan(vulkan) => {
                Machine::Vulkan { device: vulkan.context().report().name.clone(), trace: vulkan.trace_mode() }
            }
        }
    }

    /// The Vulkan device that renders, for other renderers to [share](RendererOptions::shared); `None` on the processor.
    #[must_use]
    pub fn shared(&self) -> Option<Device> {
        match self.backends.current() {
            Backend::Vulkan(vulkan) => Some(vulkan.device().clone()),
            Backend::Cpu(_) => None,
        }
    }

    /// What is known about the Vulkan device that renders; `None` on the processor.
    #[must_use]
    pub fn device(&self) -> Option<&DeviceReport> {
        match self.backends.current() {
            Backend::Vulkan(vulkan) => Some(vulkan.context().report()),
            Backend::Cpu(_) => None,
        }
    }

    /// Bytes a second that a large copy within the memory of the Vulkan device reads and writes, measured; `None` on the
    /// processor and where the device has no clock.
    ///
    /// # Errors
    /// If the device fails. The processor does not step in.
    pub fn copy_bandwidth(&self) -> Result<Option<f64>, RenderError> {
        match self.backends.current() {
            Backend::Vulkan(vulkan) => Ok(vulkan.copy_bandwidth()?),
            Backend::Cpu(_) => Ok(None),
        }
    }

    /// The acceleration structures of the Vulkan device in numbers; `None` on the processor.
    #[must_use]
    pub fn acceleration_stats(&self) -> Option<AccelerationStats> {
        match self.backends.current() {
            Backend::Vulkan(vulkan) => Some(*vulkan.acceleration()),
            Backend::Cpu(_) => None,
        }
    }

    /// What Vulkan's validation layer had to say so far; empty unless it was asked for.
    #[must_use]
    pub fn validation_messages(&self) -> Vec<String> {
        match self.backends.current() {
            Backend::Vulkan(vulkan) => vulkan.context().validation_messages(),
            Backend::Cpu(_) => Vec::new(),
        }
    }

    /// The scene at the moment that it shows. On a device, the vertices of what deforms stay as they were when it was opened.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        self.backends.scene()
    }

    /// What building took.
    #[must_use]
    pub fn build_stats(&self) -> BuildStats {
        let (bytes, build_time) = match self.backends.current() {
            Backend::Cpu(cpu) => {
                let stats = cpu.world().tracer().stats();
                (stats.bytes as u64, stats.build_time)
            }
            Backend::Vulkan(vulkan) => {
                let stats = vulkan.acceleration();
                (stats.bytes + stats.top_bytes, stats.build_time)
            }
        };
        BuildStats {
            triangles: self.scene().triangle_count(),
            instances: (self.scene().instances.len() + self.scene().shape_instances.len()) as u64,
            acceleration_bytes: bytes,
            build_time,
        }
    }

    /// Shows the scene at the time that `settings` ask for. The calls that evaluate light do so by themselves; a call before
    /// them shows what the move takes.
    ///
    /// # Errors
    /// If the scene has no such animation, or the device fails.
    pub fn pose(&mut self, settings: &Settings, control: Control<'_>) -> Result<PoseStats, RenderError> {
        let start = Instant::now();
        let moment = resolve::moment(settings, self.scene())?;
        let Some(rig) = self.scene().rig.clone() else {
            return Ok(PoseStats { decay: 1.0, ..PoseStats::default() });
        };
        if resolve::needs_framing(settings, self.scene()) {
            self.framing()?;
        }
        let pose = rig.pose(moment.as_ref());
        let mut stats = match self.backends.pose(&pose, &control) {
            Err(RenderError::Vulkan(error)) => {
                self.backends.step_in(error)?;
                self.backends.pose(&pose, &control)?
            }
            done => done?,
        };
        stats.total = start.elapsed();
        Ok(stats)
    }

    /// Checks `settings` and replaces every `auto` by a value of the scene: of its cameras and lights at the time asked for,
    /// else of the scene as it was opened, so that nothing automatic changes while an animation plays.
    pub fn view(&mut self, settings: &Settings) -> Result<View, RenderError> {
        self.prepare(&settings.by_method(), Control::default()).map(|(view, _)| view)
    }

    /// Renders a frame. On the processor the same settings and scene give the same frame, bit for bit, for any number of
    /// threads; devices round differently.
    pub fn render(&mut self, settings: &Settings, control: Control<'_>) -> Result<Frame, RenderError> {
        let settings = &*settings.by_method();
        let (view, moved) = self.prepare(settings, control)?;
        let mut frame = self.stepping_in(|backend| match backend {
            Backend::Cpu(cpu) => Ok(cpu.render(settings, &view, control)?),
            Backend::Vulkan(_) if settings.method.is_screen_space() => Ok(self
                .backends
                .beside(settings.method, control.threads)?
                .render(settings, &view, control)?),
            Backend::Vulkan(vulkan) => Ok(vulkan.render(settings, &view, control)?),
        })?;
        add(&mut frame.stats.times, &moved);
        Ok(frame)
    }

    /// Renders a frame and leaves it where it was rendered: nothing but its ray counts is copied from a device.
    pub fn draw(&mut self, settings: &Settings, control: Control<'_>) -> Result<Drawn, RenderError> {
        let settings = &*settings.by_method();
        if settings.method.is_screen_space() {
            return self.render(settings, control).map(|frame| Drawn::Host(Box::new(frame)));
        }
        let (view, moved) = self.prepare(settings, control)?;
        let mut drawn = self.stepping_in(|backend| match backend {
            Backend::Cpu(cpu) => Ok(Drawn::Host(Box::new(cpu.render(settings, &view, control)?))),
            Backend::Vulkan(vulkan) => {
                let stats = vulkan.draw(settings, &view, control)?;
                Ok(Drawn::Device(Box::new(DeviceFrame { view: view.clone(), stats })))
            }
        })?;
        add(&mut drawn.stats_mut().times, &moved);
        Ok(drawn)
    }

    /// Forgets earlier frames: with [`Temporal::On`](ambray_core::settings::Temporal::On) the next one begins a sequence.
    pub fn forget_frames(&mut self) {
        match self.backends.current() {
            Backend::Cpu(cpu) => cpu.forget_frames(),
            Backend::Vulkan(vulkan) => vulkan.forget_frames(),
        }
    }

    /// Renders a frame and throws it away, without copying it from a device: what it took is what counts.
    pub fn measure(&mut self, settings: &Settings, control: Control<'_>) -> Result<FrameStats, RenderError> {
        let drawn = self.draw(settings, control)?;
        let stats = *drawn.stats();
        if let Drawn::Host(frame) = drawn {
            self.recycle(*frame);
        }
        Ok(stats)
    }

    /// Takes back a frame that is not needed any more. The processor writes the next one of its size to its memory, which
    /// saves the system the work of mapping and clearing it; for a device it does nothing.
    pub fn recycle(&mut self, frame: Frame) {
        if let Backend::Cpu(cpu) = self.backends.current() {
            cpu.recycle(frame);
        }
    }

    /// The plane `aov` of the last frame on the device as a picture that windows can draw, with the exposure, tone map, ramp and
    /// range of `settings`: the bytes that [`display::show`](crate::display::show) makes of [`read_frame`](Self::read_frame),
    /// up to the rounding of the device. It is finished when the call returns, and stays as it is until the last holder drops
    /// it, who must have waited for the device to be done with it. As many are made as are held at once; up to three are kept.
    ///
    /// # Errors
    /// [`RenderError::NothingDrawn`] on the processor, where the frame is the caller's ([`Drawn::Host`]); before the first
    /// frame; after a query, and after a frame that failed or was cancelled; and when the processor has just stepped in for a
    /// device that failed.
    pub fn show(&mut self, aov: Aov, settings: &Settings) -> Result<Arc<Picture>, RenderError> {
        let errors = settings.validate();
        if !errors.is_empty() {
            return Err(RenderError::Settings(errors));
        }
        self.stepping_in(|backend| match backend {
            Backend::Cpu(_) => Err(RenderError::NothingDrawn),
            Backend::Vulkan(vulkan) => Ok(vulkan.show(aov, settings)?),
        })
    }

    /// Copies the last frame on the device to the host, without rendering it again.
    ///
    /// # Errors
    /// As [`show`](Self::show).
    pub fn read_frame(&mut self) -> Result<Frame, RenderError> {
        self.stepping_in(|backend| match backend {
            Backend::Cpu(_) => Err(RenderError::NothingDrawn),
            Backend::Vulkan(vulkan) => Ok(vulkan.read()?),
        })
    }

    /// Evaluates ambient light at `points`; result `i` belongs to point `i`.
    pub fn query(
        &mut self,
        settings: &Settings,
        points: &[QueryPoint],
        control: Control<'_>,
    ) -> Result<Vec<QueryResult>, RenderError> {
        let settings = &*settings.by_method();
        needs_no_picture(settings.method)?;
        let (view, _) = self.prepare(settings, control)?;
        for (index, point) in points.iter().enumerate() {
            check_point(point).map_err(|reason| RenderError::Point { index, reason })?;
        }
        self.stepping_in(|backend| match backend {
            Backend::Cpu(cpu) => Ok(cpu.query(settings, &view, points, control)?),
            Backend::Vulkan(vulkan) => Ok(vulkan.query(settings, &view, points, control)?),
        })
    }

    /// Everything that pixel (x, y) of `frame` did: its rays, chords, shadow rays and the taps of the filter. `frame` was
    /// rendered by this renderer with these `settings`; the scene is moved to their time.
    ///
    /// On the processor [`Inspection::raw`] is what the frame has, bit for bit. A device traces the rays of an inspection,
    /// but the rest is computed on the host: there they agree up to rounding.
    ///
    /// # Errors
    /// If the pixel is outside the picture, and as [`render`](Self::render).
    pub fn inspect(
        &mut self,
        settings: &Settings,
        frame: &Frame,
        pixel: (u32, u32),
        control: Control<'_>,
    ) -> Result<Inspection, RenderError> {
        let settings = &*settings.by_method();
        needs_no_picture(settings.method)?;
        self.prepare(settings, control)?;
        control.check().map_err(|_| RenderError::Cancelled)?;
        self.stepping_in(|backend| match backend {
            Backend::Cpu(cpu) => Ok(inspect(cpu.world(), settings, frame, pixel)?),
            Backend::Vulkan(vulkan) => {
                let world = DeviceWorld::new(vulkan, self.backends.surfaces());
                let inspection = inspect(&world, settings, frame, pixel)?;
                world.finish()?;
                Ok(inspection)
            }
        })
    }

    /// The rays that the processor traces for a frame with `settings`, shadow rays aside. Beside a device it is made ready
    /// first.
    ///
    /// # Errors
    /// As [`render`](Self::render), and [`RenderError::TooManyRays`].
    pub fn record_rays(
        &mut self,
        settings: &Settings,
        control: Control<'_>,
    ) -> Result<FrameRays, RenderError> {
        needs_no_picture(settings.method)?;
        let (view, _) = self.prepare(settings, control)?;
        match self.backends.current() {
            Backend::Cpu(cpu) => Ok(cpu.record_rays(settings, &view, control)?),
            Backend::Vulkan(_) => {
                let cpu = self.backends.beside(settings.method, control.threads)?;
                Ok(cpu.record_rays(settings, &view, control)?)
            }
        }
    }

    /// The scene at its moment, and the view of it.
    fn prepare(
        &mut self,
        settings: &Settings,
        control: Control<'_>,
    ) -> Result<(View, PoseStats), RenderError> {
        let errors = settings.validate();
        if !errors.is_empty() {
            return Err(RenderError::Settings(errors));
        }
        let moved = self.pose(settings, control)?;
        let view = resolve::view(settings, self.scene(), self.bounds, &|| self.framing())?;
        Ok((view, moved))
    }

    /// How a scene without cameras is looked at. Found once: [`pose`](Self::pose) sees to it that it is found in the scene as
    /// it was opened.
    fn framing(&self) -> Result<Framing, RenderError> {
        if let Some(&framing) = self.framing.get() {
            return Ok(framing);
        }
        let framing = self.stepping_in(|backend| match backend {
            Backend::Cpu(cpu) => Ok(Framing::of(self.scene(), self.bounds, cpu.world())),
            Backend::Vulkan(vulkan) => {
                let trace = DeviceTrace::new(vulkan);
                let framing = Framing::of(self.scene(), self.bounds, &trace);
                trace.finish()?;
                Ok(framing)
            }
        })?;
        Ok(*self.framing.get_or_init(|| framing))
    }

    /// The closest hit of each of `rays`.
    pub fn closest_hits(&self, rays: &[Ray]) -> Result<Vec<Hit>, RenderError> {
        self.stepping_in(|backend| match backend {
            Backend::Cpu(cpu) => {
                let mut hits = vec![Hit::MISS; rays.len()];
                cpu.world().closest_hits(rays, &mut hits);
                Ok(hits)
            }
            Backend::Vulkan(vulkan) => Ok(vulkan.closest_hits(rays)?),
        })
    }

    /// Runs `work` on the current backend, and once more on the processor if the device fails and that is wanted.
    fn stepping_in<T>(&self, work: impl Fn(Backend<'_>) -> Result<T, RenderError>) -> Result<T, RenderError> {
        match work(self.backends.current()) {
            Err(RenderError::Vulkan(error)) => {
                self.backends.step_in(error)?;
                work(self.backends.current())
            }
            done => done,
        }
    }
}

/// Adds what moving the scene took to a frame.
fn add(times: &mut StageTimes, moved: &PoseStats) {
    times.deformation += moved.deformation;
    times.bottom_level += moved.bottom_level;
    times.top_level += moved.top_level;
    times.total += moved.total;
}

/// Refuses methods that look for blockers in the depth buffer of a picture.
const fn needs_no_picture(method: Method) -> Result<(), RenderError> {
    if method.is_screen_space() {
        return Err(RenderError::Method { method, reason: "works on whole pictures only" });
    }
    Ok(())
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
