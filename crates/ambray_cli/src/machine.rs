//! What a measurement depends on besides the scene: machine and program.

use std::{fs, thread};

use serde::Serialize;

/// Machine and program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// Version of ambray.
    pub version: &'static str,
    /// Commit it was built from, if the build set `AMBRAY_COMMIT`.
    pub commit: Option<&'static str>,
    /// Whether optimisations were on.
    pub optimized: bool,
    /// Name of the processor, if the system tells.
    pub cpu: Option<String>,
    /// Processors this process may use.
    pub cores: usize,
    /// Instruction set of the tracing kernels.
    pub isa: &'static str,
    /// Operating system.
    pub os: &'static str,
    /// Processor architecture.
    pub architecture: &'static str,
}

impl Machine {
    /// This machine and program.
    #[must_use]
    pub fn detect() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            commit: option_env!("AMBRAY_COMMIT"),
            optimized: !cfg!(debug_assertions),
            cpu: cpu_name(),
            cores: thread::available_parallelism().map_or(1, Into::into),
            isa: ambray::Isa::detect().name(),
            os: std::env::consts::OS,
            architecture: std::env::consts::ARCH,
        }
    }
}

/// Memory that is free for this process, bytes, as Linux tells it.
#[must_use]
pub fn free_memory() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

/// Name of the processor as Linux tells it.
fn cpu_name() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
