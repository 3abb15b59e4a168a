//! Every backend that there is, for tests that must hold on each.

use ambray::{Renderer, scene::Scene, vulkan::TraceMode};

use crate::parity;

/// Calls `test` with `scene` on the processor, and on a Vulkan device by both ways to trace where there is one; says on which,
/// and fails if the validation layer has anything to say.
///
/// # Panics
/// As `test` does, and see [`parity::vulkan`].
pub fn each(scene: Scene, test: impl Fn(&mut Renderer)) {
    for mode in [TraceMode::Pipeline, TraceMode::Query] {
        if let Some(mut renderer) = parity::vulkan(scene.clone(), mode) {
            println!("by {mode:?}:");
            test(&mut renderer);
            let messages = renderer.validation_messages();
            assert!(messages.is_empty(), "{}", messages.join("\n"));
        }
    }
    println!("on the processor:");
    test(&mut Renderer::new(scene));
}
