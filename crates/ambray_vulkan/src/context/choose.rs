//! Which device to use.

use super::DeviceOptions;
use super::probe::{DeviceKind, DeviceReport};
use crate::error::{Result, VulkanError};

/// Index in `devices`, all that [`probe`](super::probe()) lists, of the device that `options` mean: the named one, else the
/// best usable one.
pub fn choose(devices: &[DeviceReport], options: &DeviceOptions) -> Result<usize> {
    let best = |allowed: &dyn Fn(&DeviceReport) -> bool| {
        (0..devices.len()).filter(|&i| allowed(&devices[i])).min_by_key(|&i| (devices[i].kind, i))
    };
    let Some(asked) = &options.device else {
        let allowed =
            |d: &DeviceReport| d.is_usable() && (options.software || d.kind != DeviceKind::Software);
        return best(&allowed).ok_or_else(|| VulkanError::NoDevice { why: why_none(devices) });
    };
    let asked = asked.trim();
    // A number that no device has may still be part of a name: "4090".
    if let Some(index) = asked.parse().ok().filter(|&index| index < devices.len()) {
        return usable(devices, index);
    }
    let part = asked.to_lowercase();
    let is_named = |d: &DeviceReport| !part.is_empty() && d.name.to_lowercase().contains(&part);
    match best(&|d| is_named(d) && d.is_usable()).or_else(|| best(&is_named)) {
        Some(index) => usable(devices, index),
        None => {
            let known = if devices.is_empty() { "none".to_owned() } else { list(devices, |_| None) };
            Err(VulkanError::UnknownDevice { asked: asked.to_owned(), known })
        }
    }
}

fn usable(devices: &[DeviceReport], index: usize) -> Result<usize> {
    let device = &devices[index];
    if device.is_usable() {
        return Ok(index);
    }
    Err(VulkanError::Missing { device: device.name.clone(), feature: device.missing.join(", ") })
}

fn why_none(devices: &[DeviceReport]) -> String {
    list(devices, |device| {
        Some(if device.is_usable() {
            "is software and must be named".to_owned()
        } else {
            format!("lacks {}", device.missing.join(", "))
        })
    })
}

/// Numbers and names in one line, with a remark each.
fn list(devices: &[DeviceReport], remark: impl Fn(&DeviceReport) -> Option<String>) -> String {
    if devices.is_empty() {
        return "there is none".into();
    }
    let one = |device: &DeviceReport| {
        let remark = remark(device).map_or(String::new(), |r| format!(" {r}"));
        format!("{} '{}'{remark}", device.number, device.name)
    };
    devices.iter().map(one).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn device(number: usize, name: &str, kind: DeviceKind, missing: &[&'static str]) -> DeviceReport {
        DeviceReport {
            number,
            name: name.into(),
            kind,
            vendor: String::new(),
            driver: String::new(),
            api: String::new(),
            memory: 0,
            capabilities: Vec::new(),
            missing: missing.to_vec(),
            pipeline: missing.is_empty(),
            query: missing.is_empty(),
        }
    }

    fn devices() -> Vec<DeviceReport> {
        vec![
            device(0, "llvmpipe", DeviceKind::Software, &[]),
            device(1, "Old Card 900", DeviceKind::Discrete, &["accelerationStructure"]),
            device(2, "Little Graphics", DeviceKind::Integrated, &[]),
            device(3, "Big Card 4090", DeviceKind::Discrete, &[]),
        ]
    }

    fn named(device: &str) -> DeviceOptions {
        DeviceOptions { device: Some(device.into()), ..DeviceOptions::default() }
    }

    #[test]
    fn the_best_usable_device_is_chosen() {
        let mut devices = devices();
        assert_eq!(choose(&devices, &DeviceOptions::default()), Ok(3));
        devices.pop();
        assert_eq!(choose(&devices, &DeviceOptions::default()), Ok(2));
        devices.pop();
        let error = choose(&devices, &DeviceOptions::default()).unwrap_err().to_string();
        assert!(error.contains("'llvmpipe' is software"), "{error}");
        assert!(error.contains("'Old Card 900' lacks accelerationStructure"), "{error}");
        let software = DeviceOptions { software: true, ..DeviceOptions::default() };
        assert_eq!(choose(&devices, &software), Ok(0));
        assert!(matches!(choose(&[], &software), Err(VulkanError::NoDevice { .. })));
    }

    #[test]
    fn a_name_is_a_number_or_a_part() {
        let devices = devices();
        assert_eq!(choose(&devices, &named("0")), Ok(0));
        assert_eq!(choose(&devices, &named("LLVM")), Ok(0));
        assert_eq!(choose(&devices, &named("4090")), Ok(3));
        // Of two that match, the usable one.
        assert_eq!(choose(&devices, &named("card")), Ok(3));
        let missing = choose(&devices, &named("1")).unwrap_err().to_string();
        assert_eq!(missing, "Old Card 900 lacks accelerationStructure");
        let unknown = choose(&devices, &named("voodoo")).unwrap_err().to_string();
        assert!(unknown.contains("'voodoo'") && unknown.contains("2 'Little Graphics'"), "{unknown}");
        assert!(choose(&devices, &named("")).is_err());
    }
}
