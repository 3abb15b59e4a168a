//! The table of results: time of each pass at 1920 × 1080, with thin detection and without.

use ambray::{
    FrameStats, Machine, RenderError,
    settings::{Settings, Size, Thin},
};

use super::{Studio, Times, plain};
use crate::{
    document::{Best, Block, Cell, Column, Section, Table},
    experiment::{Spread, Who},
};

/// Rays a pixel of the paper's table.
const SPP: u32 = 8;
const KINDS: [Thin; 3] = [Thin::Off, Thin::Paper, Thin::Sheet];
/// Milliseconds that the paper's batch adds there, on its graphics card.
const PAPER_MORE: f64 = 2.0;

/// Weight of one run for the progress bar: frames of 8 rays at the size of the table.
pub(super) const WEIGHT: f32 = 3.0 * 8.0;

pub(super) fn table(
    studio: &mut Studio<'_, '_>,
    view: &Settings,
) -> Result<(Section, Vec<Times>), RenderError> {
    let size = studio.options.table_size;
    let settings = Settings { size, spp: SPP, ..plain(view) };
    let variants = KINDS.map(|thin| Settings { thin, ..settings.clone() });
    let mut measured: [Vec<FrameStats>; 3] = Default::default();
    for run in 0..=studio.options.runs {
        for (variant, measured) in variants.iter().zip(&mut measured) {
            let what = format!("timing with thin {}", variant.thin);
            let stats =
                studio.work.step(&what, SPP as f32, |control| studio.renderer.measure(variant, control))?;
            // The first one warms up.
            if run > 0 {
                measured.push(stats);
            }
        }
    }
    let times: Vec<Times> =
        KINDS.iter().zip(&measured).map(|(&thin, stats)| Times::of(thin, size, stats)).collect();
    let machine = studio.renderer.machine_for(&settings);
    let [off, paper, sheet] = [0, 1, 2].map(|i| times[i].total.median);
    let text = format!(
        "{} × {}, {SPP} rays a pixel, by {}; the middle of {} runs taken in turns.",
        size.width,
        size.height,
        Who::of(&machine),
        studio.options.runs
    );
    let more = format!(
        "{:.2} ms more here, {:.2} times the frame; the sheet variant {:.2} ms, {:.2} times.",
        paper - off,
        paper / off,
        sheet - off,
        sheet / off
    );
    let claim = format!("The paper's second batch costs about {PAPER_MORE} ms more on its graphics card.");
    let finding = if matches!(machine, Machine::Vulkan { .. }) {
        Block::Finding { claim, measured: more, holds: paper - off <= 1.5 * PAPER_MORE }
    } else {
        Block::Text(format!(
            "{claim} The processor rendered, whose milliseconds can tell nothing of that: {more}"
        ))
    };
    let section = Section {
        title: "Table: time of each pass".to_owned(),
        blocks: vec![Block::Text(text), Block::Table(passes(&times)), finding],
    };
    Ok((section, times))
}

impl Times {
    fn of(thin: Thin, size: Size, stats: &[FrameStats]) -> Self {
        let spread = |time: fn(&FrameStats) -> std::time::Duration| {
            Spread::of(stats.iter().map(|stats| time(stats).as_secs_f64() * 1e3).collect())
        };
        let pixels = f64::from(size.width) * f64::from(size.height);
        let rays = stats.last().map(|stats| stats.rays).unwrap_or_default();
        Self {
            thin: thin.to_string(),
            primary: spread(|stats| stats.times.primary),
            direct: spread(|stats| stats.times.direct),
            ambient: spread(|stats| stats.times.ambient),
            filter: spread(|stats| stats.times.filter),
            total: spread(|stats| stats.times.total),
            rays_per_pixel: rays.ambient as f64 / pixels,
            chords_per_pixel: rays.chord as f64 / pixels,
        }
    }
}

/// A row for each kind of thin detection.
fn passes(times: &[Times]) -> Table {
    let column = |title: &str, meaning: &str| Column {
        title: title.to_owned(),
        meaning: meaning.to_owned(),
        best: Best::None,
    };
    let columns = vec![
        column("thin", "Kind of thin detection"),
        column("primary, ms", "Primary rays and surfaces"),
        column("direct, ms", "Direct light with its shadow rays"),
        column("ambient, ms", "Ambient rays, chords included"),
        column("filter, ms", "Filter and composition"),
        column("frame, ms", "The whole frame"),
        column("p95, ms", "What 95 % of the frames did not exceed"),
        column("rays/pixel", "Ambient rays"),
        column("chords/pixel", "Rays of the second batch"),
    ];
    let row = |times: &Times| {
        let ms = |spread: &Spread| Cell::Number(spread.median, 2);
        vec![
            Cell::Text(times.thin.clone()),
            ms(&times.primary),
            ms(&times.direct),
            ms(&times.ambient),
            ms(&times.filter),
            ms(&times.total),
            Cell::Number(times.total.p95, 2),
            Cell::Number(times.rays_per_pixel, 2),
            Cell::Number(times.chords_per_pixel, 2),
        ]
    };
    Table { caption: "Median times.".to_owned(), columns, rows: times.iter().map(row).collect() }
}
