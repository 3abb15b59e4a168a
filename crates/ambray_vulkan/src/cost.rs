//! What the passes must move through memory on any device: the floor under their times.

use ambray_core::settings::Settings;

use crate::planes::Plane::{
    self, Albedo, Ambient, Beauty, Bent, Direct, Emission, Filtered, FilteredBent, Geometric, Positions,
    Second, Shading, SmoothNormals, Tallies,
};

/// Bytes that a pass reads and writes at least for a pixel that sees a surface: every plane it touches, once and as whole
/// entries, since memory moves in larger pieces. Scene data, acceleration structures and what `Temporal::On` keeps come on
/// top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassBytes {
    /// `primary`, `direct`, `ambient` or `filter`.
    pub pass: &'static str,
    /// Bytes read.
    pub read: u64,
    /// Bytes written.
    pub written: u64,
}

impl PassBytes {
    /// Bytes moved.
    #[must_use]
    pub const fn total(&self) -> u64 {
        self.read + self.written
    }
}

/// Of each pass of a frame with `settings`, in the order in which they run.
#[must_use]
pub fn bytes_per_pixel(settings: &Settings) -> [PassBytes; 4] {
    let is_after_filter = settings.takes_minimum_after_filter();
    PASSES.map(|Pass { name, reads, writes }| {
        let bytes = |planes: &[Plane]| -> u64 {
            let used = planes.iter().filter(|&&plane| name != FILTER || plane != Second || is_after_filter);
            used.map(|plane| plane.stride()).sum()
        };
        PassBytes { pass: name, read: bytes(reads), written: bytes(writes) }
    })
}

const FILTER: &str = "filter";

/// A pass with the planes it touches.
#[derive(Clone, Copy)]
struct Pass {
    name: &'static str,
    reads: &'static [Plane],
    writes: &'static [Plane],
}

const PASSES: [Pass; 4] = [
    Pass {
        name: "primary",
        reads: &[],
        writes: &[Positions, Geometric, Shading, SmoothNormals, Albedo, Emission, Direct, Tallies],
    },
    Pass {
        name: "direct",
        reads: &[SmoothNormals, Geometric, Direct, Positions, Shading, Albedo],
        writes: &[Direct, Tallies],
    },
    Pass {
        name: "ambient",
        reads: &[SmoothNormals, Geometric, Positions, Shading, Emission, Direct, Tallies],
        writes: &[Ambient, Second, Bent, Tallies],
    },
    Pass {
        name: FILTER,
        // The second batch only where the minimum of both is taken after the filter.
        reads: &[Positions, SmoothNormals, Ambient, Second, Bent, Emission, Albedo, Direct],
        writes: &[Filtered, FilteredBent, Beauty],
    },
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use ambray_core::settings::{Thin, ThinMinimum};

    use super::*;

    const SOURCES: [&str; 4] = [
        include_str!("../shaders/include/primary_pass.glsl"),
        include_str!("../shaders/include/direct_pass.glsl"),
        include_str!("../shaders/include/ambient_pass.glsl"),
        include_str!("../shaders/filter.comp"),
    ];

    /// Name of a plane's address in the shaders: `SmoothNormals` is `smooth_normals`.
    fn field(plane: Plane) -> String {
        let mut name = String::new();
        for letter in format!("{plane:?}").chars() {
            if letter.is_uppercase() && !name.is_empty() {
                name.push('_');
            }
            name.push(letter.to_ascii_lowercase());
        }
        name
    }

    /// Planes that a shader reads, and those that it writes.
    fn touched(source: &str) -> [BTreeSet<String>; 2] {
        let names: BTreeSet<String> = Plane::ALL.into_iter().map(field).collect();
        let mut touched = [BTreeSet::new(), BTreeSet::new()];
        for line in source.lines().map(str::trim) {
            let is_store = ["Plane(VIEW.", "Tallies(VIEW."].iter().any(|start| line.starts_with(start))
                && line.contains(" = ");
            for (index, rest) in line.split("VIEW.").skip(1).enumerate() {
                let end = rest.find(|c: char| c != '_' && !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
                if names.contains(&rest[..end]) {
                    touched[usize::from(is_store && index == 0)].insert(rest[..end].to_owned());
                }
            }
        }
        touched
    }

    #[test]
    fn the_table_is_what_the_shaders_do() {
        for (pass, source) in PASSES.iter().zip(SOURCES) {
            let [reads, writes] = touched(source);
            let listed = |planes: &[Plane]| planes.iter().copied().map(field).collect::<BTreeSet<_>>();
            assert_eq!(listed(pass.reads), reads, "read by {}", pass.name);
            assert_eq!(listed(pass.writes), writes, "written by {}", pass.name);
        }
    }

    #[test]
    fn the_filter_moves_ten_vectors() {
        let of = |settings: &Settings| bytes_per_pixel(settings).map(|pass| (pass.read, pass.written));
        let settings = Settings::default();
        assert_eq!(of(&settings), [(0, 136), (96, 40), (120, 72), (112, 48)]);
        let late = Settings { thin: Thin::Sheet, thin_minimum: ThinMinimum::AfterFilter, ..settings };
        assert_eq!(of(&late)[3], (128, 48));
        // Together the passes write every plane.
        let written: BTreeSet<_> = PASSES.iter().flat_map(|pass| pass.writes).copied().map(field).collect();
        assert_eq!(written.len(), Plane::ALL.len());
    }
}
