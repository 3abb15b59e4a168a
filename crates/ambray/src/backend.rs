//! Which backend renders, and what happens when a device fails.

use std::{
    str::FromStr,
    sync::{Arc, Mutex, OnceLock, PoisonError},
    time::Duration,
};

use ambray_core::{control::Control, frame::PoseStats, settings::Method};
use ambray_cpu::{BuildOptions, CpuBackend};
use ambray_scene::{Scene, animation::Pose, surface::Surfaces};
use ambray_vulkan::{
    AccelerationOptions, Context, Device, DeviceOptions, TraceMode, VulkanBackend, VulkanError, VulkanOptions,
};

use crate::RenderError;

/// Who renders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BackendChoice {
    /// A graphics card that traces rays, if there is one; else the processor.
    #[default]
    Auto,
    /// A Vulkan device. An error if there is none.
    Vulkan,
    /// The processor.
    Cpu,
}

impl FromStr for BackendChoice {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "auto" => Ok(Self::Auto),
            "vulkan" => Ok(Self::Vulkan),
            "cpu" => Ok(Self::Cpu),
            _ => Err("expected auto, vulkan or cpu".to_owned()),
        }
    }
}

/// How a scene is made ready. None of it changes a picture beyond rounding.
#[derive(Clone, Debug, Default)]
pub struct RendererOptions {
    /// Who renders.
    pub backend: BackendChoice,
    /// Trees of the CPU backend.
    pub build: BuildOptions,
    /// Which Vulkan device, unless one is [shared](Self::shared).
    pub device: DeviceOptions,
    /// A Vulkan device that is open already, which other renderers may be using, also in other threads. With
    /// [`BackendChoice::Cpu`] it is left alone.
    pub shared: Option<Device>,
    /// How it traces rays.
    pub trace: TraceMode,
    /// Its acceleration structures.
    pub acceleration: AccelerationOptions,
    /// How long a frame may keep the device from other work at a time, such as the drawing of a window; `None` is a tenth of a
    /// second, a whole one where the device is the processor.
    pub submission: Option<Duration>,
}

/// The backends of a renderer. The CPU backend is made when it is first needed.
#[derive(Debug)]
pub(crate) struct Backends {
    scene: Arc<Scene>,
    /// What the scene shows; `None` if it does not move, or if nobody knows since a move has failed.
    pose: Option<Pose>,
    build: BuildOptions,
    /// Threads that build trees, 0 for one a core.
    threads: usize,
    vulkan: Option<VulkanBackend>,
    cpu: OnceLock<CpuBackend>,
    /// What rays of the device hit, as the host sees it, with the pose that it shows. Made when it is first needed.
    surfaces: Mutex<Option<(Option<Pose>, Arc<Surfaces>)>>,
    /// The processor beside a device, for methods that run there only, with the pose that it shows.
    aside: Mutex<Option<(Option<Pose>, Arc<CpuBackend>)>>,
    /// Whether the processor steps in for a device that fails.
    steps_in: bool,
    /// Why the processor renders although a device might.
    reason: OnceLock<String>,
}

/// The backend in use.
#[derive(Debug)]
pub(crate) enum Backend<'a> {
    Vulkan(&'a VulkanBackend),
    Cpu(&'a CpuBackend),
}

/// The backend in use, to be changed.
#[derive(Debug)]
pub(crate) enum BackendMut<'a> {
    Vulkan(&'a mut VulkanBackend),
    Cpu(&'a mut CpuBackend),
}

impl Backends {
    /// Makes `scene` ready.
    pub(crate) fn new(
        scene: Arc<Scene>,
        options: &RendererOptions,
        control: &Control<'_>,
    ) -> Result<Self, VulkanError> {
        let mut backends = Self {
            pose: scene.rig.as_ref().map(|rig| rig.pose(None)),
            scene,
            build: options.build,
            threads: control.threads,
            vulkan: None,
            cpu: OnceLock::new(),
            surfaces: Mutex::default(),
            aside: Mutex::default(),
            steps_in: options.backend == BackendChoice::Auto,
            reason: OnceLock::new(),
        };
        if options.backend != BackendChoice::Cpu {
            match vulkan(&backends.scene, options, control) {
                Ok(backend) => backends.vulkan = Some(backend),
                Err(error) => backends.step_in(error)?,
            }
        }
        if backends.vulkan.is_none() {
            backends.cpu();
        }
        Ok(backends)
    }

    /// The same backend with another scene.
    pub(crate) fn with_scene(&self, scene: Arc<Scene>, control: &Control<'_>) -> Result<Self, VulkanError> {
        let mut backends = Self {
            pose: scene.rig.as_ref().map(|rig| rig.pose(None)),
            scene,
            build: self.build,
            threads: control.threads,
            vulkan: None,
            cpu: OnceLock::new(),
            surfaces: Mutex::default(),
            aside: Mutex::default(),
            steps_in: self.steps_in,
            reason: self.reason.clone(),
        };
        if let Backend::Vulkan(vulkan) = self.current() {
            match vulkan.with_scene(&backends.scene, control) {
                Ok(backend) => backends.vulkan = Some(backend),
                Err(error) => backends.step_in(error)?,
            }
        }
        if backends.vulkan.is_none() {
            backends.cpu();
        }
        Ok(backends)
    }

    /// Who renders now.
    pub(crate) fn current(&self) -> Backend<'_> {
        match &self.vulkan {
            Some(backend) if self.reason.get().is_none() => Backend::Vulkan(backend),
            _ => Backend::Cpu(self.cpu()),
        }
    }

    /// Who renders now.
    pub(crate) fn current_mut(&mut self) -> BackendMut<'_> {
        let on_device = matches!(self.current(), Backend::Vulkan(_));
        match (&mut self.vulkan, self.cpu.get_mut()) {
            (Some(vulkan), _) if on_device => BackendMut::Vulkan(vulkan),
            (_, Some(cpu)) => BackendMut::Cpu(cpu),
            (_, None) => unreachable!("the processor was just made ready"),
        }
    }

    /// Moves the scene to `pose`, for the current backend. Nothing happens where it is there already.
    pub(crate) fn pose(&mut self, pose: &Pose, control: &Control<'_>) -> Result<PoseStats, RenderError> {
        let still = PoseStats { decay: 1.0, ..PoseStats::default() };
        let rig = self.scene.rig.clone();
        // Unknown until it is there: after a failure the next move starts from wherever this one ended.
        if let (Some(now), Some(rig)) = (self.pose.take(), rig)
            && rig.shows_the_same(&now, pose)
        {
            if now != *pose {
                Arc::make_mut(&mut self.scene).place(pose);
            }
            self.pose = Some(pose.clone());
            return Ok(still);
        }
        // Made ready before the scene is taken: nobody else may hold it, or it would be copied.
        self.current();
        let mut scene = std::mem::take(&mut self.scene);
        let moved = match self.current_mut() {
            BackendMut::Cpu(cpu) => {
                let moved = cpu.pose(pose, control.threads);
                scene = Arc::clone(cpu.world().surfaces().scene());
                moved.map_err(RenderError::from)
            }
            BackendMut::Vulkan(vulkan) => {
                Arc::make_mut(&mut scene).place(pose);
                vulkan.pose(&scene, pose, control).map_err(RenderError::from)
            }
        };
        self.scene = scene;
        let moved = moved?;
        self.pose = Some(pose.clone());
        Ok(moved)
    }

    /// The scene at its pose. On a device the vertices of what deforms are as they were when it was opened.
    pub(crate) const fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Why the processor renders although a device might.
    pub(crate) fn reason(&self) -> Option<&str> {
        self.reason.get().map(String::as_str)
    }

    /// Lets the processor take over after `error` of the device, if that is wanted; else the error comes back.
    pub(crate) fn step_in(&self, error: VulkanError) -> Result<(), VulkanError> {
        if !self.steps_in || matches!(error, VulkanError::Cancelled(_)) {
            return Err(error);
        }
        let is_absent = matches!(
            error,
            VulkanError::NoLoader { .. } | VulkanError::NoDriver | VulkanError::NoDevice { .. }
        );
        // Nobody expects anything of a device that is not there; one that fails is news.
        let level = if is_absent { log::Level::Info } else { log::Level::Warn };
        log::log!(level, "rendering on the processor: {error}");
        // The first reason counts: a race of two calls that fail alike.
        let _ = self.reason.set(error.to_string());
        Ok(())
    }

    /// The processor beside the device that renders, for `method`, which runs there only. Made when it is first needed, and
    /// moved to where the scene is by then.
    ///
    /// # Errors
    /// If only the device was wanted.
    pub(crate) fn beside(&self, method: Method, threads: usize) -> Result<Arc<CpuBackend>, RenderError> {
        if !self.steps_in {
            return Err(RenderError::Method { method, reason: "runs on the processor only" });
        }
        // Whole or empty at any time, so a panic of another thread does not matter.
        let mut slot = self.aside.lock().unwrap_or_else(PoisonError::into_inner);
        let build = || Arc::new(CpuBackend::with_threads(self.posed_scene(), self.build, threads));
        let cpu = match (slot.take(), &self.pose) {
            (Some((pose, cpu)), now) if pose == *now => cpu,
            (Some((_, mut cpu)), Some(now)) => match Arc::get_mut(&mut cpu) {
                Some(alone) => {
                    alone.pose(now, threads)?;
                    cpu
                }
                None => build(),
            },
            _ => build(),
        };
        *slot = Some((self.pose.clone(), Arc::clone(&cpu)));
        Ok(cpu)
    }

    /// The scene at its pose, with the vertices of what deforms there too.
    fn posed_scene(&self) -> Arc<Scene> {
        let mut scene = Arc::clone(&self.scene);
        if let Some(pose) = &self.pose {
            Arc::make_mut(&mut scene).deform(pose);
        }
        scene
    }

    /// What rays of the device hit, as the host sees it.
    pub(crate) fn surfaces(&self) -> Arc<Surfaces> {
        // Whole or empty at any time, so a panic of another thread does not matter.
        let mut slot = self.surfaces.lock().unwrap_or_else(PoisonError::into_inner);
        let surfaces = match slot.take() {
            Some((pose, surfaces)) if pose == self.pose => surfaces,
            Some((_, surfaces)) => Arc::new(surfaces.moved_to(self.posed_scene())),
            None => Arc::new(Surfaces::new(self.posed_scene())),
        };
        *slot = Some((self.pose.clone(), Arc::clone(&surfaces)));
        surfaces
    }

    fn cpu(&self) -> &CpuBackend {
        self.cpu.get_or_init(|| CpuBackend::with_threads(self.posed_scene(), self.build, self.threads))
    }
}

fn vulkan(
    scene: &Arc<Scene>,
    options: &RendererOptions,
    control: &Control<'_>,
) -> Result<VulkanBackend, VulkanError> {
    let device = match &options.shared {
        Some(device) => device.clone(),
        None => {
            // A device that is really the processor is slower than the CPU backend, but better than an error.
            let software = options.device.software || options.backend == BackendChoice::Vulkan;
            Device::of(Context::new(&DeviceOptions { software, ..options.device.clone() })?)
        }
    };
    let RendererOptions { trace, acceleration, submission, .. } = *options;
    VulkanBackend::on(&device, scene, VulkanOptions { trace, acceleration, submission }, control)
}
