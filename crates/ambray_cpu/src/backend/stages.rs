//! Time spent in the interleaved stages of pass 1.

use std::{
    sync::atomic::{AtomicU64, Ordering},
    time::{Duration, Instant},
};

use ambray_core::frame::StageTimes;

/// Stage of pass 1.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stage {
    Primary,
    Direct,
    Ambient,
}

/// Thread time by stage, summed over all threads.
#[derive(Debug, Default)]
pub(super) struct Clock {
    nanoseconds: [AtomicU64; 3],
    /// Within the stages.
    tracing: AtomicU64,
}

impl Clock {
    /// Books the time since `start` on `stage`, and returns now.
    pub(super) fn book(&self, stage: Stage, start: Instant) -> Instant {
        let now = Instant::now();
        let elapsed = u64::try_from((now - start).as_nanos()).unwrap_or(u64::MAX);
        self.nanoseconds[stage as usize].fetch_add(elapsed, Ordering::Relaxed);
        now
    }

    /// Books time that was spent tracing rays, whatever the stage.
    pub(super) fn book_tracing(&self, nanoseconds: u64) {
        self.tracing.fetch_add(nanoseconds, Ordering::Relaxed);
    }

    /// Shares of the wall time `total` of pass 1, by the thread time of each stage.
    pub(super) fn shares(&self, total: Duration) -> StageTimes {
        let spent = |stage: Stage| self.nanoseconds[stage as usize].load(Ordering::Relaxed) as f64;
        let sum = (spent(Stage::Primary) + spent(Stage::Direct) + spent(Stage::Ambient)).max(1.0);
        let share = |stage| total.mul_f64(spent(stage) / sum);
        let tracing = total.mul_f64(self.tracing.load(Ordering::Relaxed) as f64 / sum);
        StageTimes {
            primary: share(Stage::Primary),
            direct: share(Stage::Direct),
            ambient: share(Stage::Ambient),
            tracing,
            ..StageTimes::default()
        }
    }
}
