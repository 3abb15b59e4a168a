//! The Vulkan backend: a scene on a device, from which frames, points and batches of rays are evaluated.

use std::{
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

use ambray_core::{
    control::Control,
    frame::{Frame, FrameStats, PoseStats, StageTimes},
    query::{QueryPoint, QueryResult},
    settings::{NearRadiance, RadianceSource, Sampling, Settings, Temporal, Thin},
    trace::{Hit, Ray},
    view::View,
};
use ambray_scene::{Scene, animation::Pose, surface::Surfaces};

use crate::{
    Acceleration, AccelerationOptions, AccelerationStats, Context, Culling, Device, DeviceKind, Result,
    TraceMode, VulkanError,
    layout::{Push, Specialization},
    motion::{Motion, Move},
    pipeline::TracePass,
    points, rays, readback,
    schedule::{Pass, Step, StepWork, cost_of, submissions},
    state::{Drawn, Inputs, State},
    tables::Tables,
};

/// Time that a submission should take: far below the two seconds after which some systems take a device for hung, and long
/// against the wait between two.
const SUBMISSION_ON_HARDWARE: Duration = Duration::from_millis(100);
/// The same where the device is the processor, which nobody watches: progress should still be seen.
const SUBMISSION_IN_SOFTWARE: Duration = Duration::from_secs(1);
/// Most rays a pixel for which pairs are searched.
const MOST_SEARCHED: u64 = 4096;

/// How a scene is put on a device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VulkanOptions {
    /// How rays are traced.
    pub trace: TraceMode,
    /// How acceleration structures are built.
    pub acceleration: AccelerationOptions,
    /// How long a submission of a frame should take at most; `None` is a tenth of a second, a whole one where the device is
    /// the processor. Shorter ones let other work on the device, such as the drawing of a window, come in between; each costs
    /// a little more.
    pub submission: Option<Duration>,
}

/// A scene made ready for rendering on a device.
#[derive(Debug)]
pub struct VulkanBackend {
    /// Dropped first: its commands use the rest.
    state: Mutex<State>,
    /// Made for the first pose.
    motion: Option<Motion>,
    acceleration: Acceleration,
    tables: Tables,
    context: Arc<Context>,
    mode: TraceMode,
    options: VulkanOptions,
    device: Device,
}

impl VulkanBackend {
    /// Uploads `scene` and builds its acceleration structures.
    ///
    /// # Panics
    /// If an index in the scene is out of range.
    pub fn new(
        context: &Arc<Context>,
        scene: &Arc<Scene>,
        options: VulkanOptions,
        control: &Control<'_>,
    ) -> Result<Self> {
        Self::on(&Device::of(Arc::clone(context)), scene, options, control)
    }

    /// The same for another scene on the same device. Programs that are compiled stay so.
    ///
    /// # Panics
    /// If an index in the scene is out of range.
    pub fn with_scene(&self, scene: &Arc<Scene>, control: &Control<'_>) -> Result<Self> {
        Self::on(&self.device, scene, self.options, control)
    }

    /// The same on a device that other backends may be using.
    ///
    /// # Panics
    /// If an index in the scene is out of range.
    pub fn on(
        device: &Device,
        scene: &Arc<Scene>,
        options: VulkanOptions,
        control: &Control<'_>,
    ) -> Result<Self> {
        let context = device.context();
        let mode = options.trace.resolve(context)?;
        let surfaces = Surfaces::new(Arc::clone(scene));
        let opaque: Vec<bool> = (0..scene.meshes.len() as u32).map(|mesh| surfaces.is_opaque(mesh)).collect();
        let acceleration = Acceleration::build(context, scene, &opaque, &options.acceleration, control)?;
        let tables = Tables::new(context, scene, acceleration.placements(), acceleration.refs())?;
        let mut state = State::new(device, &acceleration, mode)?;
        state.budget.bound(options.submission, usual_submission(context));
        Ok(Self {
            state: Mutex::new(state),
            motion: None,
            acceleration,
            tables,
            context: Arc::clone(context),
            mode,
            options,
            device: device.clone(),
        })
    }

    /// Moves the scene to `pose`: `scene` is the one on the device, with its instances [placed](Scene::place) there. Its
    /// meshes stay as they were; the device bends its own.
    ///
    /// An error leaves a backend that can render and be moved on, at the old pose or at the new one.
    ///
    /// # Panics
    /// If `scene` or `pose` has other instances, meshes or deformers than the scene on the device.
    pub fn pose(&mut self, scene: &Arc<Scene>, pose: &Pose, control: &Control<'_>) -> Result<PoseStats> {
        let start = Instant::now();
        control.check()?;
        let state = self.state.get_mut().unwrap_or_else(PoisonError::into_inner);
        let motion = match &mut self.motion {
            Some(motion) => motion,
            none => {
                let programs = self.device.programs().motion(&state.interface)?;
                none.insert(Motion::new(&self.context, scene, &self.acceleration, &self.tables, &programs)?)
            }
        };
        let (moved, rendered) = (Move { scene, pose }, &mut state.rendered);
        let mut stats = motion.pose(&moved, rendered, &mut self.acceleration, &mut self.tables, control)?;
        stats.total = start.elapsed();
        Ok(stats)
    }

    /// The device, for other backends to share.
    #[must_use]
    pub const fn device(&self) -> &Device {
        &self.device
    }

    /// The connection to the device.
    #[must_use]
    pub const fn context(&self) -> &Arc<Context> {
        &self.context
    }

    pub(crate) const fn tables(&self) -> &Tables {
        &self.tables
    }

    /// How rays are traced: [`TraceMode::Pipeline`] or [`TraceMode::Query`].
    #[must_use]
    pub const fn trace_mode(&self) -> TraceMode {
        self.mode
    }

    /// The acceleration structures in numbers.
    #[must_use]
    pub const fn acceleration(&self) -> &AccelerationStats {
        self.acceleration.stats()
    }

    /// Bytes of the planes of a frame, a pixel; what `Temporal::On` keeps for the next frame comes on top.
    #[must_use]
    pub fn bytes_per_pixel() -> u64 {
        crate::planes::Plane::ALL.iter().map(|plane| plane.stride()).sum()
    }

    /// Renders a frame and copies it to the host.
    pub fn render(&self, settings: &Settings, view: &View, control: Control<'_>) -> Result<Frame> {
        let start = Instant::now();
        let mut state = self.state();
        let mut times = self.passes(&mut state, settings, view, control)?;
        let transfer = Instant::now();
        let mut frame = readback::frame(&self.context, &state, settings, view)?;
        times.transfer = transfer.elapsed();
        times.total = start.elapsed();
        frame.stats.times = times;
        if let Some(drawn) = &mut state.drawn {
            drawn.stats = frame.stats;
        }
        Ok(frame)
    }

    /// Evaluates ambient light at `points`; result `i` belongs to point `i`.
    pub fn query(
        &self,
        settings: &Settings,
        view: &View,
        points: &[QueryPoint],
        control: Control<'_>,
    ) -> Result<Vec<QueryResult>> {
        // Points belong to no sequence.
        let settings = &Settings { temporal: Temporal::Off, ..settings.clone() };
        let mut state = self.state();
        let mut results = Vec::with_capacity(points.len());
        for chunk in points.chunks(points::MOST) {
            let size = points::folded(chunk.len());
            let inputs = Inputs { settings, view, size, count: chunk.len() as u32 };
            let constants = state.prepare(&inputs)?;
            points::write(&self.context, &mut state, settings, chunk)?;
            state.write_view(&constants);
            let passes =
                [Pass { work: StepWork::Trace(TracePass::Ambient), cost: ambient_cost(settings, view) }];
            let share = chunk.len() as f32 / points.len() as f32;
            let done = results.len() as f32 / points.len() as f32;
            let progress = |part: f32| (control.progress)(done + share * part);
            let control = Control { progress: &progress, ..control };
            self.run(&mut state, settings, &passes, size, None, control)?;
            points::read(&self.context, &state, settings, view, chunk.len(), &mut results)?;
        }
        Ok(results)
    }

    /// The closest hit of each of `rays`.
    pub fn closest_hits(&self, rays: &[Ray]) -> Result<Vec<Hit>> {
        self.trace(rays, false)
    }

    /// Whether each of `rays` hits anything.
    pub fn any_hits(&self, rays: &[Ray]) -> Result<Vec<bool>> {
        Ok(self.trace(rays, true)?.iter().map(Hit::is_hit).collect())
    }

    fn trace(&self, rays: &[Ray], any: bool) -> Result<Vec<Hit>> {
        let mut state = self.state();
        let settings = Settings::default();
        let mut hits = Vec::with_capacity(rays.len());
        for chunk in rays.chunks(points::MOST) {
            let size = points::folded(chunk.len());
            let batch = rays::Batch::new(&self.context, chunk)?;
            let mut constants = rays::constants(size, chunk.len(), any);
            batch.address(&mut constants);
            state.write_view(&constants);
            let passes = [Pass { work: StepWork::Trace(TracePass::Rays), cost: 1 }];
            self.run(&mut state, &settings, &passes, size, None, Control::default())?;
            batch.read(&mut hits);
        }
        Ok(hits)
    }

    /// Both passes of a frame, on the device, which has drawn it then.
    pub(crate) fn passes(
        &self,
        state: &mut State,
        settings: &Settings,
        view: &View,
        control: Control<'_>,
    ) -> Result<StageTimes> {
        let (width, height) = view.camera.size();
        let inputs = Inputs { settings, view, size: [width, height], count: width * height };
        let mut constants = state.prepare(&inputs)?;
        let scene_moved = !state.rendered;
        state.begin(&inputs, scene_moved, &mut constants)?;
        state.write_view(&constants);
        let passes = [
            Pass { work: StepWork::Trace(TracePass::Primary), cost: 1 },
            Pass { work: StepWork::Trace(TracePass::Direct), cost: view.lights.len().max(1) as u64 },
            Pass { work: StepWork::Trace(TracePass::Ambient), cost: ambient_cost(settings, view) },
            Pass { work: StepWork::Filter, cost: 1 },
        ];
        let culling = Culling {
            camera: &view.camera,
            reach: view.openness.reach().max(view.radius),
            has_lights: !view.lights.is_empty(),
        };
        let times = self.run(state, settings, &passes, [width, height], Some(&culling), control)?;
        state.end(&inputs);
        state.drawn = Some(Drawn {
            settings: settings.clone(),
            view: view.clone(),
            constants,
            stats: FrameStats { times, ..FrameStats::default() },
        });
        Ok(times)
    }

    /// Device address of the tables of the scene, for a frame after those so far.
    pub(crate) fn scene_address(&self, state: &State) -> u64 {
        let address = |motion: &Motion| motion.address(&self.tables, state.rendered);
        self.motion.as_ref().map_or(self.tables.address(), address)
    }

    /// Runs `passes` over `size` pixels in one or more submissions.
    fn run(
        &self,
        state: &mut State,
        settings: &Settings,
        passes: &[Pass],
        size: [u32; 2],
        culling: Option<&Culling<'_>>,
        control: Control<'_>,
    ) -> Result<StageTimes> {
        control.check()?;
        check_search(settings)?;
        let [_, masked, shapes] = self.acceleration.stats().by_kind.map(|count| count > 0);
        let programs = state.programs(&Specialization::of(settings, masked, shapes))?;
        let submissions = submissions(passes, size, state.budget);
        let mut times = StageTimes::default();
        let scene = self.scene_address(state);
        for (index, steps) in submissions.iter().enumerate() {
            let State { commands, top, view_buffer, interface, budget, adapts, .. } = &mut *state;
            let start = Instant::now();
            commands.submit(|recorder| {
                if index == 0 {
                    top.build(recorder, &self.acceleration, culling);
                    recorder.timestamp("structures");
                }
                let work = programs.tracing_work();
                let mut last = None;
                for &Step { work: step, origin, extent } in steps {
                    if last.is_some_and(|last| last != step) {
                        recorder.timestamp(label(last.unwrap_or(step)));
                        recorder.barrier(
                            work,
                            if step == StepWork::Filter { crate::Work::Compute } else { work },
                        );
                    }
                    last = Some(step);
                    let push = Push { scene, view: view_buffer.address(), origin, extent };
                    match step {
                        StepWork::Trace(pass) => programs.trace(recorder, interface, pass, push),
                        StepWork::Filter => programs.filter(recorder, interface, push),
                    }
                }
                if let Some(last) = last {
                    recorder.timestamp(label(last));
                }
                // Later submissions and copies see what was written, and the host the hits of batches.
                recorder.barrier(work, crate::Work::Everything);
                recorder.barrier(crate::Work::Compute, crate::Work::Everything);
                recorder.barrier(work, crate::Work::HostRead);
                Ok(())
            })?;
            for timing in commands.wait()? {
                *stage(&mut times, timing.label) += timing.duration.unwrap_or_default();
            }
            if *adapts {
                let target = self.options.submission.unwrap_or(usual_submission(&self.context));
                budget.learn(cost_of(steps, passes), start.elapsed(), target);
            }
            (control.progress)((index + 1) as f32 / submissions.len() as f32);
            control.check()?;
        }
        Ok(times)
    }

    /// Forgets earlier frames: the next one begins a sequence.
    pub fn forget_frames(&self) {
        self.state().forget_frames();
    }

    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        // Everything in the state is made anew or overwritten for each frame, so a panic of another thread does not matter.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Rays a pixel of the ambient pass, at most.
fn ambient_cost(settings: &Settings, view: &View) -> u64 {
    let spp = u64::from(settings.spp);
    let chords = match settings.thin {
        Thin::Off => 0,
        Thin::Paper => spp * (spp - 1) / 2,
        Thin::Sheet => spp / 2,
    };
    let is_lit =
        settings.near_radiance != NearRadiance::Off && settings.radiance_source == RadianceSource::Lit;
    let shadows = if is_lit { view.lights.len() as u64 } else { 0 };
    let searched = if searches(settings) { spp * spp / 8 } else { 0 };
    (spp + chords) * (1 + shadows) + searched
}

/// Whether the pairs of the sheet mode are found by a search: there is no table of azimuths for sets of their own.
fn searches(settings: &Settings) -> bool {
    settings.thin == Thin::Sheet && matches!(settings.sampling, Sampling::Random | Sampling::Independent)
}

/// The search takes the square of N: one pixel must not keep a device for seconds.
fn check_search(settings: &Settings) -> Result<()> {
    let (asked, limit) = (u64::from(settings.spp), MOST_SEARCHED);
    if searches(settings) && asked > limit {
        let what = "rays a pixel with thin sheet and a sample set for each pixel".to_owned();
        return Err(VulkanError::Limit { what, asked, limit });
    }
    Ok(())
}

/// Time that a submission should take unless the caller says otherwise.
fn usual_submission(context: &Context) -> Duration {
    match context.report().kind {
        DeviceKind::Software => SUBMISSION_IN_SOFTWARE,
        _ => SUBMISSION_ON_HARDWARE,
    }
}

const fn label(work: StepWork) -> &'static str {
    match work {
        StepWork::Trace(TracePass::Primary) => "primary",
        StepWork::Trace(TracePass::Direct) => "direct",
        StepWork::Trace(TracePass::Ambient) => "ambient",
        StepWork::Trace(TracePass::Rays) => "rays",
        StepWork::Filter => "filter",
    }
}

fn stage<'a>(times: &'a mut StageTimes, label: &str) -> &'a mut Duration {
    match label {
        "structures" => &mut times.top_level,
        "primary" => &mut times.primary,
        "direct" => &mut times.direct,
        "filter" => &mut times.filter,
        _ => &mut times.ambient,
    }
}
