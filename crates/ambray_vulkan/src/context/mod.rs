//! The connection to a device: everything else of this crate is made from a [`Context`].

mod choose;
mod device;
mod instance;
mod limits;
mod probe;
mod surface;

use std::mem::ManuallyDrop;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::Allocator;

pub use self::choose::choose;
use self::instance::Instance;
pub use self::instance::{VALIDATION_LOG, ValidationLog};
pub use self::limits::Limits;
pub use self::probe::{Capability, DeviceKind, DeviceReport, Need, probe};
pub use self::surface::NativeWindow;
pub(crate) use self::surface::Surface;
use crate::error::Result;

/// Which device to use, and how.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceOptions {
    /// Number of the device as [`probe`] counts, or a part of its name in any case. By default the best one.
    pub device: Option<String>,
    /// Whether a device that is really the processor may be chosen when none is named. By default not: the CPU backend is
    /// faster.
    pub software: bool,
    /// Whether Vulkan's validation layer watches, which is slow. By default not.
    pub validation: bool,
}

/// A device, opened. It closes when the last thing made from it is dropped.
///
/// Threads may share it: submissions and allocations wait for each other.
pub struct Context {
    pub(crate) device: ash::Device,
    pub(crate) acceleration: khr::acceleration_structure::Device,
    pub(crate) pipelines: Option<khr::ray_tracing_pipeline::Device>,
    names: Option<ext::debug_utils::Device>,
    queue: Mutex<vk::Queue>,
    queue_family: u32,
    /// Dropped by hand, before the device.
    allocator: ManuallyDrop<Mutex<Allocator>>,
    limits: Limits,
    report: DeviceReport,
    physical: vk::PhysicalDevice,
    live: LiveCounters,
    /// Last: the device is destroyed first.
    instance: Instance,
}

/// What has been made from a context and not been dropped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Live {
    /// Number of buffers.
    pub buffers: u64,
    /// Number of images.
    pub images: u64,
    /// Memory of the buffers and images, bytes.
    pub bytes: u64,
    /// Number of acceleration structures.
    pub acceleration_structures: u64,
}

/// [`Live`], counted by several threads.
#[derive(Debug, Default)]
pub(crate) struct LiveCounters {
    pub(crate) buffers: AtomicU64,
    pub(crate) images: AtomicU64,
    pub(crate) bytes: AtomicU64,
    pub(crate) acceleration_structures: AtomicU64,
}

impl Context {
    /// Opens the device that `options` mean.
    pub fn new(options: &DeviceOptions) -> Result<Arc<Self>> {
        Self::open(options, None)
    }

    /// Opens the device that `options` mean, to draw into `window` as well: it must be able to. The window is kept as long as
    /// the context.
    pub fn for_window(options: &DeviceOptions, window: Arc<dyn NativeWindow>) -> Result<Arc<Self>> {
        Self::open(options, Some(window))
    }

    fn open(options: &DeviceOptions, window: Option<Arc<dyn NativeWindow>>) -> Result<Arc<Self>> {
        let instance = Instance::new(options.validation, window)?;
        let devices = instance.physical_devices()?;
        let mut reports = (devices.iter().enumerate())
            .map(|(number, &device)| probe::report(&instance.raw, number, device))
            .collect::<Result<Vec<_>>>()?;
        if let Some(surface) = instance.surface() {
            for (report, &device) in reports.iter_mut().zip(&devices) {
                report.missing.extend(surface.missing(&instance.raw, device)?);
            }
        }
        let index = choose::choose(&reports, options)?;
        device::open(instance, devices[index], reports[index].clone()).map(Arc::new)
    }

    /// The device that was chosen.
    #[must_use]
    pub const fn report(&self) -> &DeviceReport {
        &self.report
    }

    /// What the device allows.
    #[must_use]
    pub const fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Whether ray-tracing pipelines can be made.
    #[must_use]
    pub const fn has_pipelines(&self) -> bool {
        self.pipelines.is_some()
    }

    /// Whether compute shaders can trace rays.
    #[must_use]
    pub const fn has_queries(&self) -> bool {
        self.report.query
    }

    /// Family of the queue: it computes, and draws where the device has such a family.
    #[must_use]
    pub const fn queue_family(&self) -> u32 {
        self.queue_family
    }

    /// The device's handle.
    #[must_use]
    pub const fn physical_device(&self) -> vk::PhysicalDevice {
        self.physical
    }

    /// Functions of the device.
    #[must_use]
    pub const fn device(&self) -> &ash::Device {
        &self.device
    }

    /// Functions of the instance.
    #[must_use]
    pub const fn instance(&self) -> &ash::Instance {
        &self.instance.raw
    }

    /// The queue, for as long as the guard lives: Vulkan wants one thread at a time.
    pub fn queue(&self) -> MutexGuard<'_, vk::Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Warnings and errors of the validation layer so far, one line each; at most 1000 are kept.
    #[must_use]
    pub fn validation_messages(&self) -> Vec<String> {
        self.instance.log().messages()
    }

    /// The messages of the validation layer, to be read when the context is gone.
    #[must_use]
    pub fn validation_log(&self) -> ValidationLog {
        self.instance.log().clone()
    }

    /// What has been made and not been dropped.
    #[must_use]
    pub fn live(&self) -> Live {
        let read = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        Live {
            buffers: read(&self.live.buffers),
            images: read(&self.live.images),
            bytes: read(&self.live.bytes),
            acceleration_structures: read(&self.live.acceleration_structures),
        }
    }

    /// The surface of the window that the context was opened for.
    pub(crate) const fn surface(&self) -> Option<&Surface> {
        self.instance.surface()
    }

    pub(crate) const fn counters(&self) -> &LiveCounters {
        &self.live
    }

    pub(crate) fn allocator(&self) -> MutexGuard<'_, Allocator> {
        self.allocator.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Tells the validation layer what `handle` is called, if it watches.
    pub(crate) fn name<H: vk::Handle>(&self, handle: H, name: &str) {
        let Some(names) = &self.names else { return };
        let Ok(name) = std::ffi::CString::new(name) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle is of this device, and the name lives until the call returns. A name that cannot be stored
        // is no loss.
        let _ = unsafe { names.set_debug_utils_object_name(&info) };
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: everything made from the context holds a reference to it, so all of it is gone; waiting covers work
        // that was submitted and not waited for, and fails only for a lost device. The allocator gives back its memory
        // before the device goes, and is not used again. The instance follows as a field.
        unsafe {
            let _ = self.device.device_wait_idle();
            ManuallyDrop::drop(&mut self.allocator);
            self.device.destroy_device(None);
        }
    }
}

impl std::fmt::Debug for Context {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Context")
            .field("device", &self.report.name)
            .field("live", &self.live())
            .finish_non_exhaustive()
    }
}
