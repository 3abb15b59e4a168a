//! The Vulkan instance, with the messages of its validation layer.

use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use ash::{ext, khr, vk};

use super::surface::{self, NativeWindow, Surface};
use crate::error::{Result, VulkanError};

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Most messages that are kept: a mistake in a loop must not fill the memory.
const MOST_MESSAGES: usize = 1000;

/// Target of the log records that are messages of the validation layer.
pub const VALIDATION_LOG: &str = "ambray_vulkan::validation";

/// What the validation layer said.
type Messages = Mutex<Vec<String>>;

/// The messages of the validation layer, also those that come when device and instance are destroyed: then it names
/// everything that was not.
#[derive(Clone, Debug)]
pub struct ValidationLog {
    messages: Arc<Messages>,
}

impl ValidationLog {
    /// Warnings and errors so far, one line each; at most 1000 are kept.
    #[must_use]
    pub fn messages(&self) -> Vec<String> {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A Vulkan 1.2 instance and the library it came from.
pub(crate) struct Instance {
    pub(crate) raw: ash::Instance,
    pub(crate) has_debug_utils: bool,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    surface: Option<Surface>,
    log: ValidationLog,
    /// Unloads the library when dropped, hence after all else.
    _entry: ash::Entry,
}

impl Instance {
    /// Loads Vulkan; with the validation layer and its checks of synchronisation if `validation`, and able to draw into
    /// `window` if there is one.
    pub(crate) fn new(validation: bool, window: Option<Arc<dyn NativeWindow>>) -> Result<Self> {
        // SAFETY: running the initialisers of the system's Vulkan loader is what every Vulkan program does. The library
        // stays loaded as long as the entry, which the returned value keeps beyond everything loaded through it.
        let entry = unsafe { ash::Entry::load() }
            .map_err(|e| VulkanError::NoLoader { why: one_line(&e.to_string()) })?;
        let extensions = extension_names(&entry, None)?;
        let has = |list: &[vk::ExtensionProperties], name: &CStr| {
            list.iter().any(|e| e.extension_name_as_c_str() == Ok(name))
        };
        let (portability, debug_utils) = (
            has(&extensions, khr::portability_enumeration::NAME),
            validation && has(&extensions, ext::debug_utils::NAME),
        );
        let mut names = Vec::new();
        let mut flags = vk::InstanceCreateFlags::empty();
        if portability {
            names.push(khr::portability_enumeration::NAME.as_ptr());
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }
        if debug_utils {
            names.push(ext::debug_utils::NAME.as_ptr());
        }
        let for_window = window.as_deref().map(surface::extensions).transpose()?.unwrap_or_default();
        for &name in for_window {
            // SAFETY: the names are constants of the library, terminated.
            let name = unsafe { CStr::from_ptr(name) };
            if !has(&extensions, name) {
                let feature = name.to_string_lossy().into_owned();
                return Err(VulkanError::Missing { device: "this installation of Vulkan".into(), feature });
            }
        }
        names.extend(for_window);
        let mut layers = Vec::new();
        let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut checks = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
        let application = vk::ApplicationInfo::default()
            .application_name(c"Ambray")
            .engine_name(c"Ambray")
            .api_version(vk::API_VERSION_1_2);
        let mut info = vk::InstanceCreateInfo::default().application_info(&application).flags(flags);
        if validation {
            let of_layer = validation_extensions(&entry)?;
            layers.push(VALIDATION_LAYER.as_ptr());
            if has(&of_layer, ext::validation_features::NAME) {
                names.push(ext::validation_features::NAME.as_ptr());
                info = info.push_next(&mut checks);
            }
        }
        let log = ValidationLog { messages: Arc::default() };
        // Chained to the instance's, it listens while that is made and destroyed.
        let mut at_the_ends = listener(&log);
        if debug_utils {
            info = info.push_next(&mut at_the_ends);
        }
        let info = info.enabled_extension_names(&names).enabled_layer_names(&layers);
        // SAFETY: every pointer in `info` is to a local that lives until the call returns, and the layers and extensions
        // named in it were found above. The list of messages, which is used later, outlives the instance (see `Drop`).
        let raw =
            unsafe { entry.create_instance(&info, None) }.map_err(VulkanError::of("vkCreateInstance"))?;
        let mut instance =
            Self { raw, has_debug_utils: debug_utils, messenger: None, surface: None, log, _entry: entry };
        if debug_utils {
            instance.listen()?;
        }
        if let Some(window) = window {
            instance.surface = Some(Surface::new(&instance._entry, &instance.raw, window)?);
        }
        Ok(instance)
    }

    /// Collects warnings and errors from now on.
    ///
    /// The messenger has a create-info of its own: one that was chained to the instance's would carry its chain along.
    fn listen(&mut self) -> Result<()> {
        let loader = ext::debug_utils::Instance::new(&self._entry, &self.raw);
        let info = listener(&self.log);
        // SAFETY: the user data is the shared list, which is dropped after the messenger is destroyed (see `Drop`); the
        // callback only forms a shared reference to it.
        let messenger = unsafe { loader.create_debug_utils_messenger(&info, None) }
            .map_err(VulkanError::of("vkCreateDebugUtilsMessengerEXT"))?;
        self.messenger = Some((loader, messenger));
        Ok(())
    }

    /// The surface of the window that it was made for.
    pub(crate) const fn surface(&self) -> Option<&Surface> {
        self.surface.as_ref()
    }

    /// What the validation layer says.
    pub(crate) const fn log(&self) -> &ValidationLog {
        &self.log
    }

    /// All physical devices, in the order of the loader: a device's number is its index.
    pub(crate) fn physical_devices(&self) -> Result<Vec<vk::PhysicalDevice>> {
        // SAFETY: the instance is alive.
        unsafe { self.raw.enumerate_physical_devices() }.map_err(|result| match result {
            // What loaders return where no driver works.
            vk::Result::ERROR_INITIALIZATION_FAILED => VulkanError::NoDriver,
            result => VulkanError::of("vkEnumeratePhysicalDevices")(result),
        })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        self.surface = None;
        // SAFETY: devices of the instance are destroyed before: contexts drop theirs before this field, and nothing else
        // makes devices. Surface and messenger go first since they belong to the instance.
        unsafe {
            if let Some((loader, messenger)) = self.messenger.take() {
                loader.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

/// Collects warnings and errors in `log`, which must outlive what is made from this.
fn listener(log: &ValidationLog) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(
            vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
        )
        .message_type(
            vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
        )
        .pfn_user_callback(Some(collect))
        .user_data(Arc::as_ptr(&log.messages).cast_mut().cast())
}

fn extension_names(entry: &ash::Entry, layer: Option<&CStr>) -> Result<Vec<vk::ExtensionProperties>> {
    // SAFETY: the library is loaded, and a layer that is not there is an error, not undefined.
    unsafe { entry.enumerate_instance_extension_properties(layer) }
        .map_err(VulkanError::of("vkEnumerateInstanceExtensionProperties"))
}

/// Extensions that the validation layer brings along; fails if it is not installed.
fn validation_extensions(entry: &ash::Entry) -> Result<Vec<vk::ExtensionProperties>> {
    // SAFETY: the library is loaded.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }
        .map_err(VulkanError::of("vkEnumerateInstanceLayerProperties"))?;
    if !layers.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION_LAYER)) {
        let feature = format!("the layer {}", VALIDATION_LAYER.to_string_lossy());
        return Err(VulkanError::Missing { device: "this installation of Vulkan".into(), feature });
    }
    extension_names(entry, Some(VALIDATION_LAYER))
}

fn one_line(text: &str) -> String {
    text.lines().collect::<Vec<_>>().join(" ")
}

/// Called by the validation layer, from any thread.
unsafe extern "system" fn collect(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes valid data with a terminated or null message, and the pointer given to the messenger,
    // which is to a list that outlives it.
    let (text, messages) = unsafe {
        let text = (*data).message_as_c_str().unwrap_or(c"(no text)").to_string_lossy();
        (one_line(&text), &*messages.cast::<Messages>())
    };
    let is_error = severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR);
    let level = if is_error { log::Level::Error } else { log::Level::Warn };
    log::log!(target: VALIDATION_LOG, level, "{text}");
    let mut messages = messages.lock().unwrap_or_else(PoisonError::into_inner);
    if messages.len() < MOST_MESSAGES {
        messages.push(text);
    }
    vk::FALSE
}
