//! The surface of a window: what a device must be able to draw into.

use std::ffi::c_char;
use std::sync::Arc;

use ash::{khr, vk};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};

use super::probe;
use crate::error::{Result, VulkanError};

/// A window of the system.
pub trait NativeWindow: HasDisplayHandle + HasWindowHandle + Send + Sync {}

impl<W: HasDisplayHandle + HasWindowHandle + Send + Sync> NativeWindow for W {}

/// Extensions of the instance that drawing into `window` takes.
pub(super) fn extensions(window: &dyn NativeWindow) -> Result<&'static [*const c_char]> {
    let display = window.display_handle().map_err(|_| no_window())?;
    ash_window::enumerate_required_extensions(display.as_raw())
        .map_err(VulkanError::of("vkEnumerateInstanceExtensionProperties"))
}

/// The surface of a window, which it keeps.
pub(crate) struct Surface {
    loader: khr::surface::Instance,
    handle: vk::SurfaceKHR,
    /// Last: the surface is destroyed first.
    _window: Arc<dyn NativeWindow>,
}

impl Surface {
    /// The surface of `window`. It must be dropped before `instance` is destroyed.
    pub(super) fn new(
        entry: &ash::Entry,
        instance: &ash::Instance,
        window: Arc<dyn NativeWindow>,
    ) -> Result<Self> {
        let display = window.display_handle().map_err(|_| no_window())?.as_raw();
        let native = window.window_handle().map_err(|_| no_window())?.as_raw();
        // SAFETY: the instance was made with the extensions of this display; both handles are of one window, which lives as
        // long as the surface, in the field below.
        let handle = unsafe { ash_window::create_surface(entry, instance, display, native, None) }
            .map_err(VulkanError::of("vkCreateSurfaceKHR"))?;
        Ok(Self { loader: khr::surface::Instance::new(entry, instance), handle, _window: window })
    }

    pub(crate) const fn loader(&self) -> &khr::surface::Instance {
        &self.loader
    }

    pub(crate) const fn handle(&self) -> vk::SurfaceKHR {
        self.handle
    }

    /// What `device` lacks to draw into the window.
    pub(super) fn missing(
        &self,
        instance: &ash::Instance,
        device: vk::PhysicalDevice,
    ) -> Result<Option<&'static str>> {
        if !probe::extensions(instance, device)?(khr::swapchain::NAME) {
            return Ok(Some("VK_KHR_swapchain"));
        }
        let Some((family, _)) = probe::queue_family(instance, device) else { return Ok(None) };
        // SAFETY: device and surface came from this instance, and the family is one of the device's.
        let (draws, presents) = unsafe {
            let families = instance.get_physical_device_queue_family_properties(device);
            let draws = families[family as usize].queue_flags.contains(vk::QueueFlags::GRAPHICS);
            (draws, self.loader.get_physical_device_surface_support(device, family, self.handle))
        };
        let presents = presents.map_err(VulkanError::of("vkGetPhysicalDeviceSurfaceSupportKHR"))?;
        Ok((!draws || !presents).then_some("a queue that draws into the window"))
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: the surface is ours; swapchains hold the context, which drops the instance with this surface after them.
        unsafe { self.loader.destroy_surface(self.handle, None) };
    }
}

impl std::fmt::Debug for Surface {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Surface").field("handle", &self.handle).finish_non_exhaustive()
    }
}

fn no_window() -> VulkanError {
    VulkanError::Missing { device: "the window".into(), feature: "a handle".into() }
}
