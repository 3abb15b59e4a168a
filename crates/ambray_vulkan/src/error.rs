//! What can go wrong on the way to a picture, by what the caller can do about it. Each text is one line.

use ambray_core::control::Cancelled;
use ash::vk;

/// Why the Vulkan backend could not do what it was asked for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum VulkanError {
    /// The system has no Vulkan loader: install one, or render on the processor.
    #[error("no Vulkan loader: {why}")]
    NoLoader {
        /// What the system said.
        why: String,
    },
    /// There is a loader but no driver: install the one of the graphics card, or render on the processor.
    #[error("no Vulkan driver is installed")]
    NoDriver,
    /// There are drivers, but no device may be used: render on the processor, or name a device.
    #[error("no Vulkan device can be used: {why}")]
    NoDevice {
        /// Each device with what is missing.
        why: String,
    },
    /// The device that was asked for does not exist: choose another one.
    #[error("no Vulkan device is called '{asked}'; there are {known}")]
    UnknownDevice {
        /// As the caller named it.
        asked: String,
        /// Numbers and names of all devices.
        known: String,
    },
    /// The device cannot do what is needed: choose another one.
    #[error("{device} lacks {feature}")]
    Missing {
        /// Name of the device, or of the installation.
        device: String,
        /// What it lacks.
        feature: String,
    },
    /// Memory is short: render a smaller picture or a smaller scene.
    #[error("{}", out_of_memory(side, what, *bytes))]
    OutOfMemory {
        /// Whose memory is short.
        side: MemorySide,
        /// What the memory was for.
        what: String,
        /// Size of the request; 0 where it is unknown.
        bytes: u64,
    },
    /// The driver gave up on the device, often because a submission ran longer than the system allows. Only a new context
    /// helps.
    #[error("the Vulkan device was lost")]
    DeviceLost,
    /// The scene or picture exceeds a limit of the device: make it smaller, or choose another device.
    #[error("{what}: {asked}, but the device allows {limit}")]
    Limit {
        /// What there is too much of.
        what: String,
        /// How much was asked for.
        asked: u64,
        /// How much the device allows.
        limit: u64,
    },
    /// There is no frame to be shown or read: none was drawn yet, or the planes were used otherwise since. Draw one.
    #[error("no frame has been drawn")]
    NothingDrawn,
    /// The caller stopped the work.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The driver refused a call for another reason: an error of the driver or of Ambray.
    #[error("{call}: {result}")]
    Driver {
        /// Name of the Vulkan function.
        call: &'static str,
        /// What it returned.
        result: vk::Result,
    },
}

/// Whose memory a [`VulkanError::OutOfMemory`] is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemorySide {
    /// Memory of the device.
    Device,
    /// Memory of the machine.
    Host,
}

/// Result of everything that talks to the driver.
pub type Result<T, E = VulkanError> = std::result::Result<T, E>;

impl VulkanError {
    /// What `result` of `call` means; for `map_err`.
    pub(crate) fn of(call: &'static str) -> impl Fn(vk::Result) -> Self {
        move |result| Self::at(call, call, 0, result)
    }

    /// What `result` of `call` means when it was to make `what` of `bytes`.
    pub(crate) fn at(call: &'static str, what: &str, bytes: u64, result: vk::Result) -> Self {
        let out_of_memory = |side| Self::OutOfMemory { side, what: what.to_owned(), bytes };
        match result {
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => out_of_memory(MemorySide::Device),
            vk::Result::ERROR_OUT_OF_HOST_MEMORY => out_of_memory(MemorySide::Host),
            vk::Result::ERROR_DEVICE_LOST => Self::DeviceLost,
            vk::Result::ERROR_INCOMPATIBLE_DRIVER => Self::NoDriver,
            result => Self::Driver { call, result },
        }
    }
}

fn out_of_memory(side: &MemorySide, what: &str, bytes: u64) -> String {
    let side = match side {
        MemorySide::Device => "device",
        MemorySide::Host => "host",
    };
    match bytes {
        0 => format!("out of {side} memory: {what}"),
        _ => format!("out of {side} memory: {what} needs {:.1} MiB", bytes as f64 / (1024.0 * 1024.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_single_lines_that_name_things() {
        let oom = VulkanError::at("vkCreateBuffer", "frame", 3 << 20, vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
        assert_eq!(oom.to_string(), "out of device memory: frame needs 3.0 MiB");
        let lost = VulkanError::of("vkQueueSubmit")(vk::Result::ERROR_DEVICE_LOST);
        assert_eq!(lost, VulkanError::DeviceLost);
        let other = VulkanError::of("vkCreateFence")(vk::Result::ERROR_UNKNOWN);
        assert!(other.to_string().starts_with("vkCreateFence: "), "{other}");
        assert!(!other.to_string().contains('\n'));
        assert_eq!(VulkanError::from(Cancelled).to_string(), "cancelled");
    }
}
