//! How a frame is cut into submissions: none may run so long that the system takes the device for hung, or that a caller
//! waits long for progress or to cancel.

use std::time::Duration;

use crate::{
    Limits,
    layout::{QUERY_HEIGHT, QUERY_WIDTH},
    pipeline::TracePass,
};

/// Part of a pass: a rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Step {
    pub(crate) work: StepWork,
    pub(crate) origin: [u32; 2],
    pub(crate) extent: [u32; 2],
}

/// What a step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StepWork {
    Trace(TracePass),
    Filter,
}

/// A pass with its cost, in rays a pixel or the like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pass {
    pub(crate) work: StepWork,
    pub(crate) cost: u64,
}

/// Most cost of a submission, and most pixels of a dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Budget {
    pub(crate) cost: u64,
    pub(crate) pixels: u64,
    pub(crate) side: u32,
    /// Least cost that is learnt: below it, waiting would outweigh the work.
    pub(crate) least: u64,
}

/// Least cost of a submission, and where the caller has set a bound to its time.
const LEAST: [u64; 2] = [1 << 18, 1 << 12];

impl Budget {
    /// For a device about whose speed nothing is known yet.
    pub(crate) fn of(limits: &Limits, is_software: bool) -> Self {
        let groups = limits.workgroup_count[0].min(limits.workgroup_count[1]);
        Self {
            cost: if is_software { 1 << 20 } else { 1 << 22 },
            // Devices that trace by queries alone have no such limit.
            pixels: match limits.ray_invocations {
                0 => u64::MAX,
                most => u64::from(most),
            },
            // Both passes of workgroups and of rays must fit along each axis.
            side: groups.saturating_mul(QUERY_WIDTH.min(QUERY_HEIGHT)).max(1),
            least: LEAST[0],
        }
    }

    /// Begins with submissions of about `bound`, if one is set, where those so far would take about `usual`.
    pub(crate) fn bound(&mut self, bound: Option<Duration>, usual: Duration) {
        let Some(bound) = bound else { return };
        self.least = LEAST[1];
        let share = bound.as_secs_f64() / usual.as_secs_f64();
        self.cost = ((self.cost as f64 * share) as u64).clamp(self.least, self.cost);
    }

    /// Learns from a submission of `cost` that took `elapsed`, so that the next ones take about `target`.
    pub(crate) fn learn(&mut self, cost: u64, elapsed: Duration, target: Duration) {
        // Small ones tell more about waiting than about work.
        if cost < self.cost / 4 {
            return;
        }
        let rate = cost as f64 / elapsed.as_secs_f64().max(1e-4);
        self.cost = ((rate * target.as_secs_f64()) as u64).clamp(self.least, 1 << 30);
    }
}

/// Cost of the steps of a submission.
pub(crate) fn cost_of(steps: &[Step], passes: &[Pass]) -> u64 {
    let of = |work: StepWork| passes.iter().find(|pass| pass.work == work).map_or(1, |pass| pass.cost);
    let pixels = |step: &Step| u64::from(step.extent[0]) * u64::from(step.extent[1]);
    steps.iter().map(|step| pixels(step).saturating_mul(of(step.work))).fold(0, u64::saturating_add)
}

/// The submissions of a frame of `size` pixels, each a list of steps in order.
pub(crate) fn submissions(passes: &[Pass], size: [u32; 2], budget: Budget) -> Vec<Vec<Step>> {
    let mut submissions = Vec::new();
    let mut current = Vec::new();
    let mut spent = 0_u64;
    for pass in passes {
        for (origin, extent) in rectangles(size, pass.cost, budget) {
            let cost = u64::from(extent[0]) * u64::from(extent[1]) * pass.cost;
            if !current.is_empty() && spent.saturating_add(cost) > budget.cost {
                submissions.push(std::mem::take(&mut current));
                spent = 0;
            }
            current.push(Step { work: pass.work, origin, extent });
            spent = spent.saturating_add(cost);
        }
    }
    submissions.push(current);
    submissions
}

/// Cuts a picture into rectangles of at most the budget: bands of whole rows if a row fits, else pieces of rows.
fn rectangles(size: [u32; 2], cost: u64, budget: Budget) -> impl Iterator<Item = ([u32; 2], [u32; 2])> {
    let [width, height] = size;
    let pixels = (budget.cost / cost.max(1)).min(budget.pixels).max(1);
    let columns = u64::from(width).min(pixels).min(u64::from(budget.side)) as u32;
    let rows =
        (pixels / u64::from(columns.max(1))).clamp(1, u64::from(height.min(budget.side).max(1))) as u32;
    // Workgroups of the filter and of ray queries should be full.
    let rows = if rows >= 8 { rows / 8 * 8 } else { rows };
    (0..height).step_by(rows as usize).flat_map(move |y| {
        (0..width)
            .step_by(columns.max(1) as usize)
            .map(move |x| ([x, y], [columns.min(width - x), rows.min(height - y)]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PASSES: [Pass; 3] = [
        Pass { work: StepWork::Trace(TracePass::Primary), cost: 1 },
        Pass { work: StepWork::Trace(TracePass::Ambient), cost: 40 },
        Pass { work: StepWork::Filter, cost: 1 },
    ];

    #[test]
    fn each_pass_covers_each_pixel_once_in_order() {
        for (cost, pixels, side) in [(1 << 20, 1 << 30, 65535), (1000, 1 << 30, 64), (7, 100, 16), (1, 1, 1)]
        {
            let budget = Budget { cost, pixels, side, least: LEAST[0] };
            let size = [53, 37];
            let steps: Vec<_> = submissions(&PASSES, size, budget).concat();
            for pass in PASSES {
                let mut seen = vec![0_u32; (size[0] * size[1]) as usize];
                for step in steps.iter().filter(|step| step.work == pass.work) {
                    assert!(step.extent[0] <= side && step.extent[1] <= side);
                    assert!(u64::from(step.extent[0]) * u64::from(step.extent[1]) <= pixels);
                    for y in 0..step.extent[1] {
                        for x in 0..step.extent[0] {
                            seen[((step.origin[1] + y) * size[0] + step.origin[0] + x) as usize] += 1;
                        }
                    }
                }
                assert!(seen.iter().all(|&count| count == 1), "{budget:?} {pass:?}");
            }
            let order: Vec<_> = steps.iter().map(|step| step.work).collect();
            let mut sorted = order.clone();
            sorted.sort_by_key(|work| PASSES.iter().position(|pass| pass.work == *work));
            assert_eq!(order, sorted);
        }
    }

    #[test]
    fn budgets_follow_the_speed_of_the_device() {
        let mut budget = Budget { cost: 1 << 22, pixels: u64::MAX, side: 65535, least: LEAST[0] };
        let target = Duration::from_millis(100);
        budget.learn(1 << 22, Duration::from_millis(10), target);
        assert!((budget.cost as f64 / f64::from(10 << 22) - 1.0).abs() < 1e-6);
        budget.learn(1, Duration::from_secs(1), target);
        assert!(budget.cost > 1 << 24, "a small submission changes nothing");
        let all = budget.cost;
        budget.learn(all, Duration::from_secs(2), target);
        assert!(budget.cost < all / 19);
        assert_eq!(cost_of(&submissions(&PASSES, [10, 10], budget).concat(), &PASSES), 4200);
    }

    #[test]
    fn a_bound_makes_submissions_short_from_the_first_on() {
        let usual = Duration::from_secs(1);
        let fresh = Budget { cost: 1 << 20, pixels: u64::MAX, side: 65535, least: LEAST[0] };
        let mut budget = fresh;
        budget.bound(None, usual);
        assert_eq!(budget, fresh);
        budget.bound(Some(usual / 16), usual);
        assert_eq!(budget.cost, 1 << 16);
        budget.learn(1 << 16, usual, usual / 16);
        assert_eq!(budget.cost, 1 << 12, "slower than thought");
        let mut budget = fresh;
        budget.bound(Some(Duration::ZERO), usual);
        assert_eq!(budget.cost, 1 << 12, "as short as is sensible");
    }

    #[test]
    fn a_small_frame_is_one_submission() {
        let budget = Budget { cost: 1 << 26, pixels: 1 << 30, side: 65535, least: LEAST[0] };
        assert_eq!(submissions(&PASSES, [640, 360], budget).len(), 1);
        assert!(submissions(&PASSES, [3840, 2160], budget).len() > 4);
    }
}
