//! The acceleration structures of a Vulkan device in numbers.

use std::fmt::Write as _;

use ambray::vulkan::{AccelerationStats, GeometryKind};
use serde::Serialize;

use super::{bytes, counted, grouped, milliseconds};

/// The acceleration structures of a Vulkan device.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AccelerationReport {
    /// Bottom-level structures.
    pub structures: usize,
    /// Of these, with opaque triangles.
    pub opaque: usize,
    /// Of these, with triangles that rays may pass.
    pub masked: usize,
    /// Of these, with shapes.
    pub shapes: usize,
    /// Of these, in world space: made of several instances, or placed once.
    pub in_world: usize,
    /// Entries of the top-level structure if nothing is culled.
    pub placements: usize,
    /// Triangles in the structures, copies counted.
    pub triangles: u64,
    /// Boxes of shapes.
    pub boxes: u64,
    /// Triangles left out, since no ray can hit them.
    pub dropped: u64,
    /// Bottom-level structures as they were built.
    pub built_bytes: u64,
    /// Bottom-level structures after they were compacted.
    pub kept_bytes: u64,
    /// Top-level structure.
    pub top_bytes: u64,
    /// Scratch memory of the largest batch of builds, freed since.
    pub scratch_bytes: u64,
    /// From the scene to structures that can be traced.
    pub build_ms: f64,
    /// Overlap of the boxes if each instance had a structure of its own: over all pairs, the surface they have in common
    /// over that of the scene's box.
    pub overlap_of_instances: f64,
    /// The same of the structures as they are placed.
    pub overlap_of_structures: f64,
}

impl AccelerationReport {
    /// From the backend's numbers.
    #[must_use]
    pub fn of(stats: &AccelerationStats) -> Self {
        let kind = |kind: GeometryKind| stats.by_kind[kind as usize];
        Self {
            structures: stats.structures,
            opaque: kind(GeometryKind::Opaque),
            masked: kind(GeometryKind::Masked),
            shapes: kind(GeometryKind::Shape),
            in_world: stats.in_world,
            placements: stats.placements,
            triangles: stats.triangles,
            boxes: stats.boxes,
            dropped: stats.dropped,
            built_bytes: stats.bytes_before,
            kept_bytes: stats.bytes,
            top_bytes: stats.top_bytes,
            scratch_bytes: stats.scratch_bytes,
            build_ms: milliseconds(stats.build_time),
            overlap_of_instances: stats.overlap_before,
            overlap_of_structures: stats.overlap,
        }
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, rest: String| {
            let _ = writeln!(text, "{name:<9}{rest}"); // writing to a string cannot fail
        };
        let Self { opaque, masked, shapes, in_world, .. } = self;
        let count = counted(self.structures as u64, "structure");
        line(
            "bottom",
            format!(
                "{count}: {opaque} opaque, {masked} masked, {shapes} of shapes; {in_world} in world space"
            ),
        );
        let dropped = match self.dropped {
            0 => String::new(),
            dropped => format!("; {} that no ray can hit left out", grouped(dropped)),
        };
        let boxes =
            if self.boxes == 1 { "1 box".to_owned() } else { format!("{} boxes", grouped(self.boxes)) };
        line("", format!("{}, {boxes}{dropped}", counted(self.triangles, "triangle")));
        let (built, kept) = (bytes(self.built_bytes), bytes(self.kept_bytes));
        line(
            "",
            format!("{built} as built, {kept} compacted; {} of scratch memory", bytes(self.scratch_bytes)),
        );
        let (placed, instances) = (self.overlap_of_structures, self.overlap_of_instances);
        line("", format!("overlap {placed:.3} as placed, {instances:.3} with a structure for each instance"));
        line("top", format!("{}, {}", counted(self.placements as u64, "placement"), bytes(self.top_bytes)));
        text
    }
}
