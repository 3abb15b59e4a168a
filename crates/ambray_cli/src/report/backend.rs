//! Who rendered.

use ambray::{Machine, Renderer, settings::Settings, vulkan::TraceMode};
use serde::Serialize;

/// Who rendered. What does not apply is null in JSON.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BackendReport {
    /// `cpu` or `vulkan`.
    pub kind: &'static str,
    /// Instruction set of the processor's kernels.
    pub isa: Option<&'static str>,
    /// Why the processor rendered, where a device was looked for.
    pub reason: Option<String>,
    /// Name of the Vulkan device.
    pub device: Option<String>,
    /// Name and version of its driver.
    pub driver: Option<String>,
    /// How it traced rays: `pipeline` or `query`.
    pub trace: Option<&'static str>,
}

impl BackendReport {
    /// Who renders with `renderer` now: asked after the work, since the processor may have stepped in.
    #[must_use]
    pub fn of(renderer: &Renderer) -> Self {
        Self::named(renderer, renderer.machine())
    }

    /// The same with `settings`, whose method may need the processor.
    #[must_use]
    pub fn with(renderer: &Renderer, settings: &Settings) -> Self {
        Self::named(renderer, renderer.machine_for(settings))
    }

    fn named(renderer: &Renderer, machine: Machine) -> Self {
        match machine {
            Machine::Cpu { isa, reason } => {
                Self { kind: "cpu", isa: Some(isa), reason, device: None, driver: None, trace: None }
            }
            Machine::Vulkan { device, trace } => Self {
                kind: "vulkan",
                isa: None,
                reason: None,
                device: Some(device),
                driver: renderer.device().map(|device| device.driver.clone()),
                trace: Some(match trace {
                    TraceMode::Auto => "auto",
                    TraceMode::Pipeline => "pipeline",
                    TraceMode::Query => "query",
                }),
            },
        }
    }

    /// For people, with a newline.
    #[must_use]
    pub fn line(&self) -> String {
        let named = |value: Option<&str>| value.unwrap_or_default().to_owned();
        let told = if self.kind == "vulkan" {
            format!("vulkan: {}, by {}", named(self.device.as_deref()), named(self.trace))
        } else {
            let reason = self.reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
            format!("cpu, {} kernels{reason}", named(self.isa))
        };
        format!("backend  {told}\n")
    }
}

#[cfg(test)]
mod tests {
    use ambray::scene::atrium::atrium;

    use super::*;

    #[test]
    fn the_processor_is_told_with_its_kernels_and_the_reason() {
        let renderer = Renderer::new(atrium());
        let mut report = BackendReport::of(&renderer);
        assert_eq!(report.line(), format!("backend  cpu, {} kernels\n", ambray::Isa::detect().name()));
        report.reason = Some("no Vulkan driver is installed".to_owned());
        assert!(report.line().ends_with(" kernels (no Vulkan driver is installed)\n"));
    }
}
