//! What the integration tests share.
#![allow(dead_code, unreachable_pub, reason = "each test file uses its own part of it")]

use std::sync::Arc;

use ambray_vulkan::{Context, DeviceOptions, VulkanError};

/// A context with the validation layer watching, on whatever device there is, the processor included. `None`, with a line
/// that says so, where there is no Vulkan; a failure there if `AMBRAY_REQUIRE_VULKAN=1`.
pub fn context() -> Option<Arc<Context>> {
    // A real device may be asked for.
    let software = std::env::var_os("AMBRAY_VULKAN").is_none_or(|value| value != "hardware");
    let options = DeviceOptions { device: None, software, validation: true };
    match Context::new(&options) {
        Ok(context) => Some(context),
        Err(error) => {
            let expected = matches!(
                error,
                VulkanError::NoLoader { .. }
                    | VulkanError::NoDriver
                    | VulkanError::NoDevice { .. }
                    | VulkanError::Missing { .. }
            );
            let required = std::env::var_os("AMBRAY_REQUIRE_VULKAN").is_some_and(|v| v == "1");
            assert!(expected && !required, "{error}");
            eprintln!("skipped: {error}");
            None
        }
    }
}

/// Fails if the validation layer had anything to say.
pub fn assert_valid(context: &Context) {
    let messages = context.validation_messages();
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}
