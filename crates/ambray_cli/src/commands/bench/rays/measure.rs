//! Tracing the same rays with everything there is, in turn.

use std::{
    hint::black_box,
    ops::Range,
    thread,
    time::{Duration, Instant},
};

use ambray::{
    BuildOptions, Control, Isa, Packets, Width,
    cpu::{
        Opaque, Stats, Tracer,
        rays::{Order, RayBatch, RayKind},
    },
    scene::Scene,
    trace::{Hit, Ray, Trace as _},
};
use ambray_files::{Interrupted, rays::Hits};
use anyhow::{Context as _, ensure};

use super::{
    clock::thread_time,
    report::{BuildReport, RateReport, RateSpread},
};
use crate::{args::Quality, progress::Progress, report::milliseconds, signals};

/// A tracer to be measured.
#[derive(Debug)]
pub(super) struct Contender {
    quality: Quality,
    isa: Isa,
    packets: Packets,
    tracer: Tracer,
}

/// Builds a tracer for each of `qualities` and `isas`, by measurement, in packets and one by one.
pub(super) fn contenders(
    scene: &Scene,
    isas: &[Isa],
    qualities: &[Quality],
    threads: usize,
) -> anyhow::Result<Vec<Contender>> {
    let mut contenders = Vec::new();
    for &quality in qualities {
        for &isa in isas {
            for packets in [Packets::Measured, Packets::Always, Packets::Never] {
                let options = BuildOptions { isa: Some(isa), packets, ..of_quality(quality) };
                let tracer = build(scene, options, threads)?;
                contenders.push(Contender { quality, isa, packets, tracer });
            }
        }
    }
    Ok(contenders)
}

/// Builds trees of every quality in the width that the tracer takes by itself, `rounds` times in turn, at least once.
pub(super) fn builds(
    scene: &Scene,
    threads: usize,
    rounds: u32,
    progress: &Progress,
) -> anyhow::Result<Vec<BuildReport>> {
    let width = Width::default();
    let mut built: Vec<Vec<Stats>> = vec![Vec::new(); Quality::ALL.len()];
    let kinds = built.len();
    for round in 0..rounds {
        for (i, (quality, built)) in Quality::ALL.into_iter().zip(&mut built).enumerate() {
            let options = BuildOptions { width: Some(width), ..of_quality(quality) };
            built.push(*build(scene, options, threads)?.stats());
            check_interrupted()?;
            progress.report((round as usize * kinds + i) as f32 / (rounds as usize * kinds) as f32);
        }
    }
    let report = |(quality, stats): (Quality, &Vec<Stats>)| {
        let times: Vec<f64> = stats.iter().map(|stats| milliseconds(stats.build_time)).collect();
        BuildReport::new(quality, width, &stats[0], &times)
    };
    Ok(Quality::ALL.into_iter().zip(&built).map(report).collect())
}

fn of_quality(quality: Quality) -> BuildOptions {
    BuildOptions { quality: quality.quality(), ..BuildOptions::default() }
}

/// Builds with so many threads.
fn build(scene: &Scene, options: BuildOptions, threads: usize) -> anyhow::Result<Tracer> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.context("the threads could not be started")?.install(|| Tracer::build(scene, Opaque, options)))
}

/// Rays in an order, with those that are traced at once.
struct Arranged {
    order: Order,
    /// Where each was in the batch.
    indices: Vec<u32>,
    rays: Vec<Ray>,
    tiles: Vec<Range<usize>>,
}

impl Arranged {
    fn new(batch: &RayBatch, order: Order) -> Self {
        let (indices, tiles) = batch.ordered(order);
        let rays = indices.iter().map(|&i| batch.rays[i as usize]).collect();
        Self { order, indices, rays, tiles }
    }
}

/// What a contender does with rays in an order.
struct Task<'a> {
    contender: &'a Contender,
    arranged: &'a Arranged,
    kind: RayKind,
}

/// Measures all `contenders` on `batch`; also returns its hits.
///
/// # Errors
/// If the contenders do not find the same hits, bit for bit; or if the user interrupts.
pub(super) fn batch(
    batch: &RayBatch,
    contenders: &[Contender],
    threads: usize,
    rounds: u32,
    progress: &Progress,
) -> anyhow::Result<(Vec<RateReport>, Hits)> {
    let mut arranged = vec![Arranged::new(batch, Order::Traced)];
    let deinterleaved = Arranged::new(batch, Order::Deinterleaved);
    if deinterleaved.indices != arranged[0].indices {
        arranged.push(deinterleaved);
    }
    arranged.push(Arranged::new(batch, Order::Pixel));
    let is_tried = |packets, order| match packets {
        Packets::Measured => order == Order::Traced,
        Packets::Always => order != Order::Pixel,
        Packets::Never => order == Order::Pixel,
    };
    let tasks: Vec<Task<'_>> = contenders
        .iter()
        .flat_map(|contender| {
            let orders = arranged.iter().filter(|arranged| is_tried(contender.packets, arranged.order));
            orders.map(|arranged| Task { contender, arranged, kind: batch.kind })
        })
        .collect();
    let hits = tasks.first().map(|task| task.hits(batch)).unwrap_or_default();
    for task in tasks.iter().skip(1) {
        ensure!(task.hits(batch) == hits, "{} found other hits than {}", task.name(), tasks[0].name());
        check_interrupted()?;
    }
    let mut rates: Vec<(Vec<f64>, Vec<f64>)> = vec![Default::default(); tasks.len()];
    for round in 0..rounds {
        for (i, (task, (by_thread, by_wall))) in tasks.iter().zip(&mut rates).enumerate() {
            let (thread, wall) = task.time(threads);
            let rate = |time: Duration| batch.rays.len() as f64 * 1e-6 / time.as_secs_f64().max(1e-9);
            by_thread.push(rate(thread));
            by_wall.push(rate(wall));
            check_interrupted()?;
            progress
                .report((round as usize * tasks.len() + i) as f32 / (rounds as usize * tasks.len()) as f32);
        }
    }
    let report = |(task, (by_thread, by_wall)): (&Task<'_>, &(Vec<f64>, Vec<f64>))| RateReport {
        quality: task.contender.quality.name(),
        isa: task.contender.isa.name(),
        mode: task.mode(),
        order: task.arranged.order.name(),
        mrays_per_s: RateSpread::of(by_thread),
        wall_mrays_per_s: RateSpread::of(by_wall),
    };
    Ok((tasks.iter().zip(&rates).map(report).collect(), hits))
}

impl Task<'_> {
    const fn mode(&self) -> &'static str {
        match self.contender.packets {
            Packets::Measured => "measured",
            Packets::Always => "packets",
            Packets::Never => "single",
        }
    }

    fn name(&self) -> String {
        let Contender { quality, isa, .. } = self.contender;
        format!("{} {} {} {}", isa.name(), self.mode(), self.arranged.order.name(), quality.name())
    }

    /// What becomes of the rays, as they are in `batch`.
    fn hits(&self, batch: &RayBatch) -> Hits {
        let (rays, tiles) = (&self.arranged.rays, &self.arranged.tiles);
        match self.kind {
            RayKind::Closest => {
                let mut found = vec![Hit::MISS; rays.len()];
                for tile in tiles {
                    self.contender.tracer.closest_hits(&rays[tile.clone()], &mut found[tile.clone()]);
                }
                Hits::closest(&batch.rays, &self.in_batch(&found, Hit::MISS))
            }
            RayKind::Any => {
                let mut found = vec![false; rays.len()];
                for tile in tiles {
                    self.contender.tracer.any_hits(&rays[tile.clone()], &mut found[tile.clone()]);
                }
                Hits::any(&batch.rays, &self.in_batch(&found, false))
            }
        }
    }

    fn in_batch<T: Copy>(&self, answers: &[T], blank: T) -> Vec<T> {
        let mut in_batch = vec![blank; answers.len()];
        for (&i, &answer) in self.arranged.indices.iter().zip(answers) {
            in_batch[i as usize] = answer;
        }
        in_batch
    }

    /// Time that the busiest of so many threads runs, and time on the wall, until all rays are answered.
    fn time(&self, threads: usize) -> (Duration, Duration) {
        let start = Instant::now();
        let busiest = thread::scope(|scope| {
            let threads: Vec<_> =
                (0..threads).map(|first| scope.spawn(move || self.time_share(first, threads))).collect();
            let times = threads.into_iter().map(|thread| thread.join().unwrap_or_default());
            times.max().unwrap_or_default()
        });
        (busiest, start.elapsed())
    }

    /// Time that the calling thread runs for every so many tiles, from the `first` on.
    fn time_share(&self, first: usize, threads: usize) -> Duration {
        let (rays, tiles) = (&self.arranged.rays, &self.arranged.tiles);
        let most = tiles.iter().map(ExactSizeIterator::len).max().unwrap_or(0);
        let (mut hits, mut blocked) = (vec![Hit::MISS; most], vec![false; most]);
        let start = thread_time();
        for tile in tiles.iter().skip(first).step_by(threads) {
            let rays = &rays[tile.clone()];
            match self.kind {
                RayKind::Closest => self.contender.tracer.closest_hits(rays, &mut hits[..rays.len()]),
                RayKind::Any => self.contender.tracer.any_hits(rays, &mut blocked[..rays.len()]),
            }
            black_box((&hits, &blocked));
        }
        thread_time() - start
    }
}

fn check_interrupted() -> anyhow::Result<()> {
    let control = Control { cancel: signals::cancel_flag(), ..Control::default() };
    Ok(control.check().map_err(|_| Interrupted)?)
}
