//! Time spent in the stages of a frame, which run interleaved over tiles and threads.

use std::{
    sync::atomic::{AtomicU64, Ordering},
    time::{Duration, Instant},
};

use ambray_core::frame::StageTimes;

/// What threads do.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stage {
    Primary,
    Direct,
    Ambient,
    Filter,
}

/// Thread time by stage, summed over all threads.
#[derive(Debug, Default)]
pub(super) struct Clock {
    nanoseconds: [AtomicU64; 4],
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

    /// Shares of the wall time `total` of pass 1, by the thread time of each of its stages.
    pub(super) fn shares(&self, total: Duration) -> StageTimes {
        let [primary, direct, ambient] =
            [Stage::Primary, Stage::Direct, Stage::Ambient].map(|stage| self.spent(stage));
        let sum = (primary + direct + ambient).max(1.0);
        let share = |spent: f64| total.mul_f64(spent / sum);
        StageTimes {
            primary: share(primary),
            direct: share(direct),
            ambient: share(ambient),
            tracing: share(self.tracing.load(Ordering::Relaxed) as f64),
            ..StageTimes::default()
        }
    }

    /// What each of `threads` threads did not use of the wall time `total` of the `stages`, on average.
    pub(super) fn idle(&self, stages: &[Stage], total: Duration, threads: usize) -> Duration {
        let busy: f64 = stages.iter().map(|&stage| self.spent(stage)).sum();
        total.saturating_sub(Duration::from_secs_f64(busy * 1e-9 / threads.max(1) as f64))
    }

    fn spent(&self, stage: Stage) -> f64 {
        self.nanoseconds[stage as usize].load(Ordering::Relaxed) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wall_time_is_shared_by_thread_time_and_the_rest_is_idle() {
        let clock = Clock::default();
        for (stage, milliseconds) in [(0, 10), (1, 20), (2, 70), (3, 40)] {
            clock.nanoseconds[stage].store(milliseconds * 1_000_000, Ordering::Relaxed);
        }
        clock.book_tracing(60_000_000);
        let milliseconds = Duration::from_millis;
        let times = clock.shares(milliseconds(50));
        assert_eq!(
            (times.primary, times.direct, times.ambient, times.tracing),
            (milliseconds(5), milliseconds(10), milliseconds(35), milliseconds(30))
        );
        // 140 ms of work by two threads are 70 ms of each.
        let all = [Stage::Primary, Stage::Direct, Stage::Ambient, Stage::Filter];
        assert_eq!(clock.idle(&all, milliseconds(75), 2), milliseconds(5));
        assert_eq!(clock.idle(&all, milliseconds(60), 2), Duration::ZERO);
    }
}
