//! What `ambray bench --rays` says.

use std::{collections::BTreeMap, fmt::Write as _};

use ambray::{
    Width,
    cpu::{
        Stats,
        rays::{RayBatch, RayKind},
    },
    settings::Settings,
};
use ambray_files::rays::{Agreement, Hits};
use serde::Serialize;

use super::RaysFolder;
use crate::{
    args::Quality,
    machine::Machine,
    report::{SceneReport, ViewReport, bytes, counted, quantile},
};

/// The result.
#[derive(Clone, Debug, Serialize)]
pub(super) struct RaysReport {
    pub(super) machine: Machine,
    pub(super) threads: usize,
    pub(super) rounds: u32,
    folder: String,
    /// What was written before; null where the files were there.
    pub(super) source: Option<SourceReport>,
    /// Triangles that were traced.
    pub(super) triangles: u64,
    pub(super) builds: Vec<BuildReport>,
    pub(super) batches: Vec<BatchReport>,
}

/// What the files were made of.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SourceReport {
    pub(super) scene: SceneReport,
    pub(super) view: ViewReport,
    pub(super) settings: Settings,
    /// Triangles that were written.
    pub(super) triangles: u64,
    /// Triangles of masked and blended materials, which were not.
    pub(super) masked_triangles: u64,
    /// Placed shapes, which were not.
    pub(super) shapes: u64,
    /// Rays by file.
    pub(super) rays: BTreeMap<&'static str, u64>,
}

/// Trees of a quality and width.
#[derive(Clone, Debug, Serialize)]
pub(super) struct BuildReport {
    quality: &'static str,
    width: u32,
    build_ms: RateSpread,
    bytes: u64,
    bytes_per_triangle: f64,
    sah_cost: f32,
    triangles_per_leaf: f64,
}

/// Rays of one file.
#[derive(Clone, Debug, Serialize)]
pub(super) struct BatchReport {
    name: String,
    /// `closest` or `any`.
    kind: &'static str,
    rays: u64,
    hits: u64,
    rates: Vec<RateReport>,
    /// Beside the hits of `--check-hits`.
    agreement: Option<AgreementReport>,
}

/// A way to trace them.
#[derive(Clone, Debug, Serialize)]
pub(super) struct RateReport {
    pub(super) quality: &'static str,
    pub(super) isa: &'static str,
    /// `measured`, `packets` or `single`.
    pub(super) mode: &'static str,
    pub(super) order: &'static str,
    /// By the time that the busiest thread ran.
    pub(super) mrays_per_s: RateSpread,
    pub(super) wall_mrays_per_s: RateSpread,
}

/// Distribution over the rounds.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct RateSpread {
    median: f64,
    min: f64,
    max: f64,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct AgreementReport {
    /// Rays that hit something for one only.
    differing_hits: u64,
    /// Rays whose distances differ by more than a thousandth.
    far_hits: u64,
    /// Of the others.
    largest_relative_difference: f64,
}

impl RateSpread {
    /// Of `values`, at least one.
    pub(super) fn of(values: &[f64]) -> Self {
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        let at = |q| quantile(&values, q);
        Self { median: at(0.5), min: at(0.0), max: at(1.0) }
    }
}

impl RaysReport {
    pub(super) fn new(
        machine: Machine,
        folder: &RaysFolder,
        threads: usize,
        rounds: u32,
        source: Option<SourceReport>,
    ) -> Self {
        let (folder, triangles) = (folder.path().display().to_string(), 0);
        Self { machine, threads, rounds, folder, source, triangles, builds: Vec::new(), batches: Vec::new() }
    }

    /// For people: all but the rays.
    pub(super) fn head(&self) -> String {
        let mut text = format!(
            "rays     {}: {}; {}, {}\n",
            self.folder,
            counted(self.triangles, "triangle"),
            counted(self.threads as u64, "thread"),
            counted(u64::from(self.rounds), "round"),
        );
        if self.builds.is_empty() {
            return text;
        }
        text.push_str(
            "trees    quality     width   build ms    memory  bytes/triangle  surface-area cost  triangles/leaf\n",
        );
        for build in &self.builds {
            let BuildReport {
                quality,
                width,
                build_ms,
                bytes_per_triangle,
                sah_cost,
                triangles_per_leaf,
                ..
            } = build;
            let _ = writeln!(
                text, // writing to a string cannot fail
                "         {quality:<11} {width:>5} {:>10.1} {:>9} {bytes_per_triangle:>15.1} {sah_cost:>18.1} {triangles_per_leaf:>15.2}",
                build_ms.median,
                bytes(build.bytes),
            );
        }
        text
    }
}

impl SourceReport {
    /// For people.
    pub(super) fn text(&self, settings: &Settings) -> String {
        let mut text = format!(
            "scene    {}: {} in {}; rays for {} with {}\n",
            self.scene.source,
            counted(self.scene.triangles, "triangle"),
            counted(self.scene.instances, "instance"),
            settings.size,
            counted(u64::from(settings.spp), "ray"),
        );
        let rays = self.rays.iter().map(|(name, count)| format!("{name} {}", crate::report::grouped(*count)));
        let _ = writeln!(
            text, // writing to a string cannot fail
            "written  {}; {}",
            counted(self.triangles, "triangle"),
            rays.collect::<Vec<_>>().join(", "),
        );
        let left_out = [(self.masked_triangles, "masked or blended triangle"), (self.shapes, "shape")];
        for (count, what) in left_out.into_iter().filter(|(count, _)| *count > 0) {
            let _ = writeln!(text, "         {} left out, which the frame sees", counted(count, what));
        }
        text
    }
}

impl BuildReport {
    /// From the tracer's `stats` and the `times` of several builds.
    pub(super) fn new(quality: Quality, width: Width, stats: &Stats, times: &[f64]) -> Self {
        let triangles = stats.triangles.max(1) as f64;
        Self {
            quality: quality.name(),
            width: match width {
                Width::Eight => 8,
                Width::Sixteen => 16,
            },
            build_ms: RateSpread::of(times),
            bytes: stats.bytes as u64,
            bytes_per_triangle: stats.bytes as f64 / triangles,
            sah_cost: stats.sah_cost,
            triangles_per_leaf: triangles / stats.leaf_blocks.max(1) as f64,
        }
    }
}

impl BatchReport {
    pub(super) fn new(
        name: &str,
        batch: &RayBatch,
        hits: &Hits,
        rates: Vec<RateReport>,
        agreement: Option<Agreement>,
    ) -> Self {
        Self {
            name: name.to_owned(),
            kind: match batch.kind {
                RayKind::Closest => "closest",
                RayKind::Any => "any",
            },
            rays: batch.rays.len() as u64,
            hits: hits.count(),
            rates,
            agreement: agreement.map(|agreement| AgreementReport {
                differing_hits: agreement.differing,
                far_hits: agreement.far,
                largest_relative_difference: agreement.largest_difference,
            }),
        }
    }

    /// For people.
    pub(super) fn text(&self) -> String {
        let share = 100.0 * self.hits as f64 / self.rays.max(1) as f64;
        let mut text =
            format!("{}: {}, {} hit, {share:.1} % hit\n", self.name, counted(self.rays, "ray"), self.kind,);
        text.push_str(
            "         quality     kernels                          million rays/s     min     max\n",
        );
        for rate in &self.rates {
            let kernels = format!("{} {} {}", rate.isa, rate.mode, rate.order);
            let RateSpread { median, min, max } = rate.mrays_per_s;
            let quality = rate.quality;
            let _ = writeln!(
                text, // writing to a string cannot fail
                "         {quality:<11} {kernels:<32} {median:>14.2} {min:>7.2} {max:>7.2}"
            );
        }
        if let Some(agreement) = &self.agreement {
            let _ = writeln!(
                text,
                "         beside the other hits: {} hit or missed by one only, {} elsewhere by more than 1/1000, the rest within {:.1e}",
                counted(agreement.differing_hits, "ray"),
                counted(agreement.far_hits, "hit"),
                agreement.largest_relative_difference,
            );
        }
        text
    }
}
