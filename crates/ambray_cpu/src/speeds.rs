//! Packets or single rays: which is quicker for batches like this one, by measurement.
//!
//! Packets win where neighbouring rays meet the same boxes, and lose where a tile of pixels sees geometry finer than itself. No
//! cheap property of rays tells one from the other, so now and then a batch is split: most of it goes in packets, the rest ray
//! by ray, and the later batches go the quicker way. Parts of one batch are alike, batches of different tiles are not; and
//! packets need the company of many rays, single rays do not. Answers are the same both ways.

use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use ambray_core::trace::Ray;

/// Rays of a batch that is worth measuring.
const WORTHWHILE: usize = 256;

/// Pairs of neighbours looked at to tell how alike the directions of a batch are.
const PAIRS: usize = 32;

/// Neighbours are alike if the cosine between them is larger.
const ALIKE: f32 = 0.9;

/// Sorts of batches by the share of alike neighbours.
const LIKENESSES: usize = 4;

/// Part of a compared batch that goes before both, so that neither has to wait for what is not in the caches.
const WARM_UP: f32 = 0.125;

/// Part of a compared batch that goes ray by ray.
const SHARE: f32 = 0.25;

/// Comparisons that the mean advantage is taken over.
const MEMORY: u32 = 8;

/// Largest advantage that one comparison may show, so that a thread interrupted meanwhile does not decide for long. As of
/// all advantages, the logarithm to base 2 of the ratio of speeds.
const LARGEST: f32 = 1.5;

/// Shortest and longest time between comparisons, in batches.
const PAUSES: [f32; 2] = [8.0, 512.0];

/// Comparisons may cost one part in so many of the time.
const PRICE: f32 = 128.0;

/// How a batch is to be traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Packets,
    Single,
    /// Part by part, so that they can be compared.
    Compare(Parts),
}

/// Parts of a batch that is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Parts {
    /// Where the first compared part begins, and where the second.
    pub(crate) starts: [usize; 2],
    /// Whether the rays before both parts go in packets, and whether each of them does.
    pub(crate) packets: [bool; 3],
}

/// What is known of batches that ask the same, by sort. Shared by all threads: an update that is lost does no harm.
#[derive(Debug, Default)]
pub(crate) struct Speeds {
    /// Of rays with ends, and of endless ones.
    sorts: [[Sort; LIKENESSES]; 2],
}

impl Speeds {
    /// The sort that `rays` belong to; `None` of batches so small that nothing is known of them.
    pub(crate) fn sort(&self, rays: &[Ray]) -> Option<&Sort> {
        if rays.len() < WORTHWHILE {
            return None;
        }
        let pairs = (0..PAIRS).map(|i| i * (rays.len() - 1) / PAIRS);
        let alike = pairs.filter(|&i| rays[i].direction.dot(rays[i + 1].direction) > ALIKE).count();
        let is_endless = rays[0].t_max == f32::INFINITY;
        Some(&self.sorts[usize::from(is_endless)][(alike * LIKENESSES / PAIRS).min(LIKENESSES - 1)])
    }
}

/// Batches of one sort.
#[derive(Debug, Default)]
pub(crate) struct Sort {
    /// Mean advantage of packets, as bits of an `f32`.
    advantage: AtomicU32,
    comparisons: AtomicU32,
    /// Batches until the next comparison.
    pause: AtomicU32,
}

impl Sort {
    /// How the next batch, of so many `rays`, is to be traced.
    pub(crate) fn next(&self, rays: usize) -> Way {
        let pause = self.pause.load(Ordering::Relaxed);
        if pause == 0 {
            let packets_first = self.comparisons.load(Ordering::Relaxed).is_multiple_of(2);
            let second = if packets_first { 1.0 - SHARE } else { WARM_UP + SHARE };
            let starts = [WARM_UP, second].map(|share| (rays as f32 * share) as usize);
            let packets = [self.advantage() >= 0.0, packets_first, !packets_first];
            return Way::Compare(Parts { starts, packets });
        }
        self.pause.store(pause - 1, Ordering::Relaxed);
        if self.advantage() >= 0.0 { Way::Packets } else { Way::Single }
    }

    /// Parts of a batch have been traced in these times, each for so many rays.
    pub(crate) fn learn(&self, packets: (Duration, usize), single: (Duration, usize)) {
        let per_ray = |(time, rays): (Duration, usize)| time.as_secs_f32().max(1e-9) / rays.max(1) as f32;
        let seen = (per_ray(single) / per_ray(packets)).log2().clamp(-LARGEST, LARGEST);
        let before = self.comparisons.load(Ordering::Relaxed);
        let advantage = self.advantage();
        let advantage = advantage + (seen - advantage) / (before + 1).min(MEMORY) as f32;
        self.advantage.store(advantage.to_bits(), Ordering::Relaxed);
        self.comparisons.store(before.saturating_add(1), Ordering::Relaxed);
        // What goes the slower way; while little is known, not much is staked on it.
        let slower = if advantage >= 0.0 { SHARE } else { 1.0 - SHARE };
        let price = slower * (advantage.abs().exp2() - 1.0);
        let known = PAUSES[0] * (before.min(8) as f32).exp2();
        let pause = (price * PRICE).clamp(PAUSES[0], PAUSES[1]).min(known);
        self.pause.store(pause as u32, Ordering::Relaxed);
    }

    fn advantage(&self) -> f32 {
        f32::from_bits(self.advantage.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Traces so many batches of which packets take `packets` times as long as single rays; returns those that went in packets,
    /// ray by ray, and in parts.
    fn trace(sort: &Sort, packets: impl Fn(u32) -> f32, batches: u32) -> [u32; 3] {
        let mut counts = [0; 3];
        for batch in 0..batches {
            match sort.next(2000) {
                Way::Packets => counts[0] += 1,
                Way::Single => counts[1] += 1,
                Way::Compare(Parts { starts, packets: [_, first, second] }) => {
                    assert_eq!(starts, [250, if first { 1500 } else { 750 }]);
                    assert_ne!(first, second);
                    counts[2] += 1;
                    // Every batch takes another time.
                    let single = Duration::from_micros(u64::from(50 + batch * 37 % 100));
                    sort.learn((single.mul_f32(2.5 * packets(batch)), 1250), (single, 500));
                }
            }
        }
        counts
    }

    #[test]
    fn the_quicker_way_is_taken_and_the_other_is_looked_at_seldom() {
        for (packets, way) in [(0.5, 0), (0.8, 0), (1.25, 1), (2.0, 1)] {
            let sort = Sort::default();
            let first = trace(&sort, |_| packets, 100);
            assert_eq!(first[1 - way], 0, "{packets}: {first:?}");
            assert!(first[2] < 13, "{packets}: {first:?}");
            let later = trace(&sort, |_| packets, 10_000);
            assert_eq!(later[1 - way], 0, "{packets}: {later:?}");
            // Parts of the compared batches cost what the other way costs more.
            let part = if packets < 1.0 { SHARE } else { 1.0 - SHARE };
            let cost = f64::from(later[2]) / 10_000.0 * f64::from(part * (packets.max(1.0 / packets) - 1.0));
            assert!(later[2] > 0 && cost < 1.1 / f64::from(PRICE), "{packets}: {later:?}");
        }
    }

    #[test]
    fn what_changes_is_noticed() {
        let sort = Sort::default();
        trace(&sort, |_| 0.7, 1000);
        assert!(trace(&sort, |_| 1.4, 500)[2] > 3);
        let [packets, single, _] = trace(&sort, |_| 1.4, 1000);
        assert!(packets == 0 && single > 900);
    }

    #[test]
    fn an_interruption_does_not_decide() {
        let sort = Sort::default();
        trace(&sort, |_| 0.8, 1000);
        sort.learn((Duration::from_millis(10), 1000), (Duration::from_micros(100), 1000));
        assert_eq!(trace(&sort, |_| 0.8, 1000)[1], 0);
    }

    #[test]
    fn batches_are_sorted_by_likeness_and_ends() {
        let speeds = Speeds::default();
        let ray = |i: usize, run: usize, t_max| {
            let angle = (i / run) as f32;
            let direction = Vec3::new(angle.cos(), angle.sin(), 0.0);
            Ray { origin: Vec3::ZERO, t_max, direction, seed: 0 }
        };
        let of = |run: usize, t_max| -> Vec<_> { (0..1000).map(|i| ray(i, run, t_max)).collect() };
        let place = |rays: &[Ray]| {
            let sort: *const _ = speeds.sort(rays).expect("large enough");
            speeds.sorts.iter().flatten().position(|other| std::ptr::eq(other, sort)).expect("one of them")
        };
        assert_eq!(place(&of(16, 1.0)), 3);
        assert_eq!(place(&of(1, 1.0)), 0);
        assert_eq!(place(&of(16, f32::INFINITY)), LIKENESSES + 3);
        assert!(speeds.sort(&of(1, 1.0)[..WORTHWHILE - 1]).is_none());
    }
}
