//! `ambray info --devices`: the Vulkan devices of this machine.

use std::fmt::Write as _;

use ambray::vulkan::{DeviceOptions, DeviceReport, Need, VulkanError, choose, probe};
use serde::Serialize;

use crate::{
    report::{self, bytes},
    terminal,
};

/// Tells about the devices. That there is none is an answer too.
pub(super) fn run(as_json: bool) -> anyhow::Result<()> {
    let devices = match probe() {
        Ok(reports) => Devices::of(&reports),
        Err(error @ (VulkanError::NoLoader { .. } | VulkanError::NoDriver)) => Devices::none(&error),
        Err(error) => return Err(error.into()),
    };
    terminal::print(&if as_json { report::json(&devices)? } else { devices.text() })
}

#[derive(Debug, Serialize)]
struct Devices {
    devices: Vec<Device>,
    /// Number of the device that is taken by itself; null if the processor is.
    auto: Option<usize>,
    /// Why the processor is taken.
    reason: Option<String>,
    /// What to do about it.
    advice: Option<&'static str>,
}

#[derive(Debug, Serialize)]
struct Device {
    /// What `--device` takes.
    number: usize,
    /// A part of it is enough for `--device`.
    name: String,
    /// `discrete`, `integrated`, `virtual`, `other` or `software`.
    kind: &'static str,
    vendor: String,
    driver: String,
    /// Vulkan version that it offers.
    api: String,
    memory_bytes: u64,
    /// Whether nothing is missing.
    usable: bool,
    /// Whether it traces rays by pipeline, and by query.
    pipeline: bool,
    query: bool,
    missing: Vec<&'static str>,
    capabilities: Vec<Capability>,
}

#[derive(Debug, Serialize)]
struct Capability {
    /// Vulkan's name of it.
    name: &'static str,
    /// If not, it is one way of tracing rays, of which one must be there.
    required: bool,
    present: bool,
}

impl Devices {
    fn of(reports: &[DeviceReport]) -> Self {
        let auto = choose(reports, &DeviceOptions::default()).ok();
        let has_usable = reports.iter().any(DeviceReport::is_usable);
        let reason = match auto {
            Some(_) => None,
            None if has_usable => Some("the CPU backend is faster than a device that is software".to_owned()),
            None if reports.is_empty() => Some("the drivers know no device".to_owned()),
            None => Some("no device has all that is needed".to_owned()),
        };
        Self {
            devices: reports.iter().map(Device::of).collect(),
            auto: auto.map(|index| reports[index].number),
            reason,
            advice: None,
        }
    }

    fn none(error: &VulkanError) -> Self {
        let advice = match error {
            VulkanError::NoLoader { .. } => {
                "install the Vulkan loader (libvulkan1 on Debian and Ubuntu, vulkan-loader on Fedora; on Windows it \
                 comes with the driver) and the driver of the graphics card"
            }
            _ => {
                "install a driver of the graphics card that has Vulkan (NVIDIA's own, or Mesa's: \
                  mesa-vulkan-drivers)"
            }
        };
        Self { devices: Vec::new(), auto: None, reason: Some(error.to_string()), advice: Some(advice) }
    }

    fn text(&self) -> String {
        if let (Some(reason), Some(advice)) = (&self.reason, self.advice) {
            return format!("{reason}: {advice}; until then the processor renders\n");
        }
        let mut text: String = self.devices.iter().map(Device::text).collect();
        let auto = match (self.auto, &self.reason) {
            (Some(number), _) => format!("device {number}"),
            (None, reason) => format!("the processor: {}", reason.as_deref().unwrap_or_default()),
        };
        let _ = writeln!(text, "--backend auto takes {auto}"); // writing to a string cannot fail
        text
    }
}

impl Device {
    fn of(report: &DeviceReport) -> Self {
        let capability = |c: &ambray::vulkan::Capability| Capability {
            name: c.name,
            required: c.need == Need::Required,
            present: c.present,
        };
        Self {
            number: report.number,
            name: report.name.clone(),
            kind: report.kind.name(),
            vendor: report.vendor.clone(),
            driver: report.driver.clone(),
            api: report.api.clone(),
            memory_bytes: report.memory,
            usable: report.is_usable(),
            pipeline: report.pipeline,
            query: report.query,
            missing: report.missing.clone(),
            capabilities: report.capabilities.iter().map(capability).collect(),
        }
    }

    fn text(&self) -> String {
        let mut text = format!("{}  {}\n", self.number, self.name);
        let mut line = |name: &str, rest: &str| {
            let _ = writeln!(text, "   {name:<8}{rest}");
        };
        line("kind", &format!("{}, {}", self.kind, self.vendor));
        line("driver", &self.driver);
        line("Vulkan", &self.api);
        line("memory", &bytes(self.memory_bytes));
        let ways: Vec<_> = [("pipeline", self.pipeline), ("query", self.query)]
            .into_iter()
            .filter_map(|(way, present)| present.then_some(way))
            .collect();
        if self.usable {
            line("traces", &format!("by {}", ways.join(" and by ")));
        } else {
            line("lacks", &self.missing.join(", "));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use ambray::vulkan::DeviceKind;

    use super::*;

    fn device(number: usize, kind: DeviceKind, missing: &[&'static str]) -> DeviceReport {
        DeviceReport {
            number,
            name: format!("Card {number}"),
            kind,
            vendor: "Maker".to_owned(),
            driver: "driver 1".to_owned(),
            api: "1.3.0".to_owned(),
            memory: 8_000_000_000,
            capabilities: Vec::new(),
            missing: missing.to_vec(),
            pipeline: missing.is_empty(),
            query: true,
        }
    }

    #[test]
    fn what_auto_takes_is_told_with_the_reason() {
        let software = device(0, DeviceKind::Software, &[]);
        let old = device(1, DeviceKind::Discrete, &["accelerationStructure"]);
        let good = device(2, DeviceKind::Discrete, &[]);
        let text = |devices: &[&DeviceReport]| {
            Devices::of(&devices.iter().map(|&d| d.clone()).collect::<Vec<_>>()).text()
        };
        let all = text(&[&software, &old, &good]);
        assert!(all.ends_with("--backend auto takes device 2\n"), "{all}");
        assert!(all.contains("   lacks   accelerationStructure\n"), "{all}");
        assert!(all.contains("   traces  by pipeline and by query\n"), "{all}");
        assert!(text(&[&software, &old]).contains("takes the processor: the CPU backend is faster"));
        assert!(text(&[&old]).contains("takes the processor: no device has all"));
        assert!(text(&[]).contains("takes the processor: the drivers know no device"));
    }

    #[test]
    fn without_driver_there_is_advice() {
        let text = Devices::none(&VulkanError::NoDriver).text();
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(text.starts_with("no Vulkan driver is installed: install a driver"), "{text}");
    }
}
