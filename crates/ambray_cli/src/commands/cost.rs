//! What a frame costs: rays a pixel, and bytes a pixel beside the bandwidth of the memory.

use std::fmt::Write as _;

use ambray::{
    RayCounts, Renderer,
    settings::Settings,
    vulkan::cost::{PassBytes, bytes_per_pixel},
};
use serde::Serialize;

use crate::{
    report::{StageReport, short},
    terminal,
};

/// The cost of a frame.
#[derive(Clone, Debug, Serialize)]
pub(super) struct CostReport {
    pixels: u64,
    rays_per_pixel: RaysPerPixel,
    /// Bandwidth of the device's memory, reading and writing together; null on the processor.
    bandwidth_gb_per_s: Option<f64>,
    /// `measured` with large copies, or `given`.
    bandwidth_source: Option<&'static str>,
    /// The passes of a Vulkan device; empty on the processor.
    passes: Vec<PassCost>,
}

/// Rays a pixel by type. Shadow rays are those of the direct pass, and of the hits of ambient rays with --radiance-source
/// lit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct RaysPerPixel {
    primary: f64,
    ambient: f64,
    chord: f64,
    shadow: f64,
    total: f64,
}

/// A pass beside the least that its planes take.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct PassCost {
    pass: &'static str,
    /// Median time.
    ms: f64,
    /// Bytes a pixel that sees a surface, each plane once; scene, acceleration structures and what --temporal on keeps
    /// come on top.
    read_bytes_per_pixel: u64,
    written_bytes_per_pixel: u64,
    /// Time to move these bytes at the bandwidth.
    floor_ms: Option<f64>,
    /// Time of the pass over that. Below 1 caches held a part.
    times_floor: Option<f64>,
}

impl CostReport {
    /// Of a frame that `renderer` rendered, with `rays` and median times `stages`. `bandwidth` is in GB/s; measured if none
    /// is given.
    pub(super) fn of(
        renderer: &Renderer,
        settings: &Settings,
        rays: RayCounts,
        stages: &StageReport,
        bandwidth: Option<f64>,
    ) -> Self {
        let pixels = u64::from(settings.size.width) * u64::from(settings.size.height);
        let rays_per_pixel = RaysPerPixel::of(rays, pixels);
        if renderer.device().is_none() {
            let (bandwidth_gb_per_s, bandwidth_source, passes) = (None, None, Vec::new());
            return Self { pixels, rays_per_pixel, bandwidth_gb_per_s, bandwidth_source, passes };
        }
        let measured = || match renderer.copy_bandwidth() {
            Ok(measured) => measured.map(|bytes| (bytes * 1e-8).round() * 0.1),
            Err(error) => {
                terminal::warn(&format!("the bandwidth could not be measured: {error}"));
                None
            }
        };
        let bandwidth_gb_per_s = bandwidth.or_else(measured);
        let source = if bandwidth.is_some() { "given" } else { "measured" };
        let passes = bytes_per_pixel(settings).map(|bytes| {
            let ms = match bytes.pass {
                "primary" => stages.primary_ms,
                "direct" => stages.direct_ms,
                "ambient" => stages.ambient_ms,
                _ => stages.filter_ms,
            };
            PassCost::of(bytes, ms, pixels, bandwidth_gb_per_s)
        });
        Self {
            pixels,
            rays_per_pixel,
            bandwidth_gb_per_s,
            bandwidth_source: bandwidth_gb_per_s.map(|_| source),
            passes: passes.to_vec(),
        }
    }

    /// For people.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        let RaysPerPixel { primary, ambient, chord, shadow, total } = self.rays_per_pixel;
        let _ = writeln!(
            text, // writing to a string cannot fail
            "cost     {total:.2} rays a pixel: primary {primary:.2}, ambient {ambient:.2}, chord {chord:.2}, shadow {shadow:.2}"
        );
        if self.passes.is_empty() {
            text.push_str("         bytes of passes are told of Vulkan devices only\n");
            return text;
        }
        let _ = match (self.bandwidth_gb_per_s, self.bandwidth_source) {
            (Some(rate), Some(source)) => writeln!(text, "         memory moves {rate:.1} GB/s ({source})"),
            _ => writeln!(text, "         the bandwidth of the memory is not known: --bandwidth gives it"),
        };
        let _ = writeln!(
            text,
            "         {:<8}{:>9}{:>10}{:>10}{:>10}{:>9}",
            "", "ms", "read", "written", "floor ms", "x floor"
        );
        for pass in &self.passes {
            let known = |value: Option<f64>, digits: usize| match value {
                Some(value) => format!("{value:.digits$}"),
                None => "-".to_owned(),
            };
            let _ = writeln!(
                text,
                "         {:<8}{:>9}{:>8} B{:>8} B{:>10}{:>9}",
                pass.pass,
                short(pass.ms),
                pass.read_bytes_per_pixel,
                pass.written_bytes_per_pixel,
                known(pass.floor_ms, 3),
                known(pass.times_floor, 1)
            );
        }
        text.push_str("         bytes a pixel are of planes, each once; scene and acceleration structures come on top,\n");
        text.push_str("         and what --temporal on keeps from frame to frame\n");
        text
    }
}

impl RaysPerPixel {
    fn of(rays: RayCounts, pixels: u64) -> Self {
        let each = |count: u64| (count as f64 / pixels.max(1) as f64 * 1e4).round() / 1e4;
        let RayCounts { primary, ambient, chord, shadow } = rays;
        Self {
            primary: each(primary),
            ambient: each(ambient),
            chord: each(chord),
            shadow: each(shadow),
            total: each(rays.total()),
        }
    }
}

impl PassCost {
    fn of(bytes: PassBytes, ms: f64, pixels: u64, bandwidth_gb_per_s: Option<f64>) -> Self {
        let floor = bandwidth_gb_per_s.map(|rate| (bytes.total() * pixels) as f64 / rate * 1e-6);
        let rounded = |value: f64| (value * 1e4).round() / 1e4;
        Self {
            pass: bytes.pass,
            ms,
            read_bytes_per_pixel: bytes.read,
            written_bytes_per_pixel: bytes.written,
            floor_ms: floor.map(rounded),
            // Without a clock on the device there is no time.
            times_floor: floor.filter(|_| ms > 0.0).map(|floor| rounded(ms / floor)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_floor_is_bytes_over_bandwidth() {
        let bytes = PassBytes { pass: "filter", read: 112, written: 48 };
        // 2 million pixels x 160 B = 320 MB at 640 GB/s.
        let cost = PassCost::of(bytes, 0.75, 2_000_000, Some(640.0));
        assert_eq!((cost.floor_ms, cost.times_floor), (Some(0.5), Some(1.5)));
        let unknown = PassCost::of(bytes, 0.75, 2_000_000, None);
        assert_eq!((unknown.floor_ms, unknown.times_floor), (None, None));
        assert_eq!(PassCost::of(bytes, 0.0, 2_000_000, Some(640.0)).times_floor, None);
    }

    #[test]
    fn rays_are_counted_a_pixel() {
        let rays = RayCounts { primary: 100, ambient: 790, chord: 0, shadow: 35 };
        let each = RaysPerPixel::of(rays, 100);
        assert_eq!((each.primary, each.ambient, each.shadow, each.total), (1.0, 7.9, 0.35, 9.25));
    }
}
