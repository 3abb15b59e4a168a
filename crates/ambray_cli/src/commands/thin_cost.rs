//! What thin detection costs: one frame without it and with each kind.

use std::fmt::Write as _;

use ambray::{
    RayCounts,
    settings::{Settings, SettingsPatch, Size, Thin},
};
use anyhow::bail;
use serde::Serialize;

use super::bench::Measured;
use crate::{
    args::BenchArgs,
    report::{StageReport, milliseconds, short},
};

/// The kinds that are measured, the one without first.
const KINDS: [(&str, Thin); 3] = [("off", Thin::Off), ("paper", Thin::Paper), ("sheet", Thin::Sheet)];

/// The frame of `--thin-cost`, unless flags say otherwise.
const SIZE: Size = Size { width: 1920, height: 1080 };
const SPP: u32 = 8;

/// A frame with one kind of thin detection.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ThinCost {
    thin: &'static str,
    /// Median time of the frame.
    frame_ms: f64,
    /// That over the time of the frame without thin detection.
    more_ms: f64,
    /// Medians of the stages.
    stages: StageReport,
    rays: RayCounts,
    rays_per_pixel: f64,
}

/// The flags of `args` with those that `--thin-cost` stands for.
pub(super) fn flags(args: &BenchArgs) -> anyhow::Result<SettingsPatch> {
    let mut flags = args.settings.flags.clone();
    if !args.thin_cost {
        return Ok(flags);
    }
    if flags.thin.is_some() {
        bail!("--thin is not allowed with --thin-cost: it measures every kind");
    }
    flags.size.get_or_insert(SIZE);
    flags.spp.get_or_insert(SPP);
    flags.thin = Some(Thin::Off);
    Ok(flags)
}

/// The settings to measure.
pub(super) fn variants(settings: &Settings) -> Vec<Settings> {
    KINDS.iter().map(|&(_, thin)| Settings { thin, ..settings.clone() }).collect()
}

/// The costs of all kinds, from the measurements of [`variants`].
pub(super) fn costs(measured: &[Measured], size: Size) -> Vec<ThinCost> {
    let pixels = f64::from(size.width) * f64::from(size.height);
    let off = measured.first().map_or(0.0, Measured::passes_ms);
    let cost = |(&(thin, _), measured): (&(&'static str, Thin), &Measured)| {
        let frame_ms = measured.median_ms();
        ThinCost {
            thin,
            frame_ms,
            more_ms: ((measured.passes_ms() - off) * 1e3).round() / 1e3,
            stages: measured.stages(),
            rays: measured.rays,
            rays_per_pixel: (measured.rays.total() as f64 / pixels * 1e4).round() / 1e4,
        }
    };
    KINDS.iter().zip(measured).map(cost).collect()
}

/// The costs as a table.
pub(super) fn table(costs: &[ThinCost], size: Size) -> String {
    let mut text = String::new();
    let mut row = |cells: [&str; 8]| {
        let [thin, rays, primary, direct, ambient, filter, frame, more] = cells;
        let _ = writeln!(
            text, // writing to a string cannot fail
            "{thin:<9}{rays:>10}{primary:>9}{direct:>9}{ambient:>9}{filter:>9}{frame:>10}{more:>10}"
        );
    };
    row(["thin", "rays/px", "primary", "direct", "ambient", "filter", "frame ms", "more ms"]);
    for cost in costs {
        let StageReport { primary_ms, direct_ms, ambient_ms, filter_ms, .. } = cost.stages;
        let [primary, direct, ambient, filter] = [primary_ms, direct_ms, ambient_ms, filter_ms].map(short);
        let more = format!("{:+.2}", cost.more_ms);
        let rays = format!("{:.2}", cost.rays_per_pixel);
        row([
            &format!("  {}", cost.thin),
            &rays,
            &primary,
            &direct,
            &ambient,
            &filter,
            &short(cost.frame_ms),
            if cost.thin == "off" { "" } else { &more },
        ]);
    }
    let _ = writeln!(
        text,
        "         {size}; for its own test the paper claims about 2 ms more on graphics hardware at 1920x1080 with 8 rays"
    );
    text
}

impl Measured {
    /// Time of the passes alone: waiting between submissions, of which costlier frames have more, is not theirs.
    fn passes_ms(&self) -> f64 {
        let StageReport { primary_ms, direct_ms, ambient_ms, filter_ms, top_level_ms, .. } = self.stages();
        primary_ms + direct_ms + ambient_ms + filter_ms + top_level_ms
    }

    fn median_ms(&self) -> f64 {
        milliseconds(self.median())
    }
}
