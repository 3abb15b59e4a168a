//! Ambray's Vulkan backend: the same picture by hardware ray tracing.
