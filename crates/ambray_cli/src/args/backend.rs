//! Options of backends: who renders, on which device, how rays are traced.

use ambray::{
    BackendChoice, RendererOptions,
    vulkan::{self, AccelerationOptions, DeviceOptions, TraceMode},
};
use anyhow::bail;
use clap::{Args, ValueEnum};

const HEADING: &str = "Backend";

/// Who renders.
#[derive(Clone, Debug, Args)]
pub struct BackendArgs {
    /// Who renders; pictures differ by rounding only
    #[arg(long, value_enum, value_name = "BACKEND", default_value_t = Backend::Auto, help_heading = HEADING)]
    pub backend: Backend,
    /// Which device, and how.
    #[command(flatten)]
    pub device: DeviceArgs,
}

/// Which Vulkan device renders, and how.
#[derive(Clone, Debug, Args)]
pub struct DeviceArgs {
    /// Vulkan device by its number or a part of its name, as ambray info --devices lists them; asks for Vulkan
    #[arg(long, value_name = "NAME_OR_NUMBER", help_heading = HEADING)]
    pub device: Option<String>,
    /// How a Vulkan device traces rays; pipeline and query ask for Vulkan
    #[arg(long, value_enum, value_name = "HOW", default_value_t = Trace::Auto, help_heading = HEADING)]
    pub trace: Trace,
    /// Let Vulkan's validation layer watch, which is slow: each message is a warning, and with any the exit code is 2; asks
    /// for Vulkan
    #[arg(long, help_heading = HEADING)]
    pub validation: bool,
}

/// Which meshes share an acceleration structure, for measurements.
#[derive(Clone, Copy, Debug, Args)]
pub struct GroupingArgs {
    /// Which meshes share an acceleration structure of a Vulkan device; per-mesh and single ask for Vulkan
    #[arg(long, value_enum, value_name = "WHAT", default_value_t = Grouping::Auto, help_heading = HEADING)]
    pub grouping: Grouping,
}

/// Value of `--backend`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// A graphics card that traces rays, if there is one; else the processor
    #[default]
    Auto,
    /// A Vulkan device, software included; an error without one
    Vulkan,
    /// The processor
    Cpu,
}

/// Value of `--trace`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Trace {
    /// By pipeline where the device has it, else by query
    #[default]
    Auto,
    /// By ray-tracing pipelines
    Pipeline,
    /// By ray queries in compute shaders
    Query,
}

/// Value of `--grouping`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Grouping {
    /// As tracing is expected to be fastest
    #[default]
    Auto,
    /// None: a structure for each mesh
    PerMesh,
    /// All that is static, of a kind
    Single,
}

impl BackendArgs {
    /// What a renderer needs to know. Options of a Vulkan device ask for one.
    pub fn options(&self, grouping: Grouping) -> anyhow::Result<RendererOptions> {
        let asked = self.device.asked(grouping);
        let backend = match (self.backend, asked) {
            (Backend::Cpu, Some(option)) => {
                bail!("{option} is not allowed with --backend cpu: it is about Vulkan devices")
            }
            (Backend::Cpu, None) => BackendChoice::Cpu,
            (Backend::Auto, None) => BackendChoice::Auto,
            (Backend::Auto, Some(_)) | (Backend::Vulkan, _) => BackendChoice::Vulkan,
        };
        Ok(RendererOptions { backend, ..self.device.options(grouping) })
    }
}

impl DeviceArgs {
    /// What a renderer needs to know to render with Vulkan.
    #[must_use]
    pub fn options(&self, grouping: Grouping) -> RendererOptions {
        RendererOptions {
            backend: BackendChoice::Vulkan,
            device: DeviceOptions {
                device: self.device.clone(),
                validation: self.validation,
                ..DeviceOptions::default()
            },
            trace: match self.trace {
                Trace::Auto => TraceMode::Auto,
                Trace::Pipeline => TraceMode::Pipeline,
                Trace::Query => TraceMode::Query,
            },
            acceleration: AccelerationOptions {
                grouping: match grouping {
                    Grouping::Auto => vulkan::Grouping::Auto,
                    Grouping::PerMesh => vulkan::Grouping::PerMesh,
                    Grouping::Single => vulkan::Grouping::Single,
                },
                ..AccelerationOptions::default()
            },
            ..RendererOptions::default()
        }
    }

    /// The first option that is about a Vulkan device, as it is spelled.
    #[must_use]
    pub fn asked(&self, grouping: Grouping) -> Option<String> {
        let spelled = |value: &dyn Fn() -> Option<clap::builder::PossibleValue>| {
            value().map(|value| value.get_name().to_owned()).unwrap_or_default()
        };
        let device = self.device.as_ref().map(|device| format!("--device {device}"));
        let trace = (self.trace != Trace::Auto)
            .then(|| format!("--trace {}", spelled(&|| self.trace.to_possible_value())));
        let grouping = (grouping != Grouping::Auto)
            .then(|| format!("--grouping {}", spelled(&|| grouping.to_possible_value())));
        device.or(trace).or(grouping).or_else(|| self.validation.then(|| "--validation".to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(backend: Backend, device: Option<&str>, trace: Trace) -> BackendArgs {
        let device = DeviceArgs { device: device.map(str::to_owned), trace, validation: false };
        BackendArgs { backend, device }
    }

    #[test]
    fn options_of_devices_ask_for_vulkan() {
        let backend =
            |args: BackendArgs| args.options(Grouping::Auto).map(|options| options.backend).expect("allowed");
        assert_eq!(backend(args(Backend::Auto, None, Trace::Auto)), BackendChoice::Auto);
        assert_eq!(backend(args(Backend::Auto, Some("0"), Trace::Auto)), BackendChoice::Vulkan);
        assert_eq!(backend(args(Backend::Auto, None, Trace::Query)), BackendChoice::Vulkan);
        assert_eq!(backend(args(Backend::Cpu, None, Trace::Auto)), BackendChoice::Cpu);
        let options = args(Backend::Auto, None, Trace::Auto).options(Grouping::Single).expect("allowed");
        assert_eq!(options.backend, BackendChoice::Vulkan);
        assert_eq!(options.acceleration.grouping, vulkan::Grouping::Single);
    }

    #[test]
    fn the_processor_has_no_options_of_devices() {
        let refused = |args: BackendArgs, grouping| args.options(grouping).unwrap_err().to_string();
        let why = "is not allowed with --backend cpu: it is about Vulkan devices";
        let named = args(Backend::Cpu, Some("big"), Trace::Auto);
        assert_eq!(refused(named, Grouping::Auto), format!("--device big {why}"));
        let traced = args(Backend::Cpu, None, Trace::Pipeline);
        assert_eq!(refused(traced, Grouping::Auto), format!("--trace pipeline {why}"));
        let grouped = args(Backend::Cpu, None, Trace::Auto);
        assert_eq!(refused(grouped, Grouping::PerMesh), format!("--grouping per-mesh {why}"));
    }
}
