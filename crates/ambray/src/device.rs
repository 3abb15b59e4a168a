//! A Vulkan device as the method sees it, for what is computed on the host with rays of the device.

use std::sync::{Arc, Mutex, PoisonError};

use ambray_core::trace::{Diffuse, Hit, Motion, Ray, Trace, World};
use ambray_scene::surface::Surfaces;
use ambray_vulkan::{VulkanBackend, VulkanError};

/// A device as the method's tracer: the first failure is kept, and everything misses from then on.
pub(crate) struct DeviceTrace<'a> {
    backend: &'a VulkanBackend,
    failure: Mutex<Option<VulkanError>>,
}

impl<'a> DeviceTrace<'a> {
    pub(crate) fn new(backend: &'a VulkanBackend) -> Self {
        Self { backend, failure: Mutex::default() }
    }

    /// The first failure, if any.
    pub(crate) fn finish(self) -> Result<(), VulkanError> {
        self.failure.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }

    fn keep<T>(&self, result: Result<Vec<T>, VulkanError>, into: &mut [T], missed: T)
    where
        T: Copy,
    {
        match result {
            Ok(values) => into.copy_from_slice(&values),
            Err(error) => {
                into.fill(missed);
                self.failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
        }
    }
}

impl Trace for DeviceTrace<'_> {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.keep(self.backend.closest_hits(rays), hits, Hit::MISS);
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
        self.keep(self.backend.any_hits(rays), blocked, false);
    }
}

/// A device that traces, and the host's knowledge of what is hit.
pub(crate) struct DeviceWorld<'a> {
    trace: DeviceTrace<'a>,
    surfaces: Arc<Surfaces>,
}

impl<'a> DeviceWorld<'a> {
    pub(crate) fn new(backend: &'a VulkanBackend, surfaces: Arc<Surfaces>) -> Self {
        Self { trace: DeviceTrace::new(backend), surfaces }
    }

    /// The first failure, if any.
    pub(crate) fn finish(self) -> Result<(), VulkanError> {
        self.trace.finish()
    }
}

impl Trace for DeviceWorld<'_> {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.trace.closest_hits(rays, hits);
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool]) {
        self.trace.any_hits(rays, blocked);
    }
}

impl World for DeviceWorld<'_> {
    fn motion(&self, instance: u32) -> Motion {
        self.surfaces.motion(instance)
    }

    fn diffuse_at(&self, ray: &Ray, hit: &Hit, width: f32) -> Diffuse {
        self.surfaces.diffuse_at(ray, hit, width).facing(ray.direction).into()
    }
}
