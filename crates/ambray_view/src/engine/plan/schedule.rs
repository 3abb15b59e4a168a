//! Which picture is rendered next.

use ambray::settings::{Settings, Temporal};

use super::{
    levels::cost,
    pace::Pace,
    rate::{Rate, work},
    work::{Work, frame_settings, is_same},
};
use crate::{
    engine::contract::{Level, Order},
    model::Side,
};

/// A first picture should be there after so many seconds.
const QUICK: f64 = 0.05;
/// The same on a device, where changing the size of pictures takes time itself.
const QUICK_ON_DEVICE: f64 = 0.2;

/// What the pictures are for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Mode {
    /// To be looked at: they are refined.
    #[default]
    Still,
    /// To follow something that is dragged: the quickest level will do.
    Moving,
    /// To follow time: one level for each moment.
    Playing,
}

/// A picture to be rendered.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::engine) struct Step {
    /// Of which side.
    pub(in crate::engine) side: Side,
    /// With these settings.
    pub(in crate::engine) settings: Settings,
    /// At this level.
    pub(in crate::engine) level: Level,
    /// Frames whose mean it will be.
    pub(in crate::engine) frames: u32,
    /// Whether it begins a sequence: nothing of earlier frames counts.
    pub(in crate::engine) begins: bool,
    /// Whether it is to be shown; frames that only catch up with a mean that was shown before are not.
    pub(in crate::engine) is_shown: bool,
    /// Whether it is the first picture of what was asked for, and so not to be cancelled.
    pub(in crate::engine) is_first: bool,
    /// Share of the refinement that is done before it and that will be done after it.
    pub(in crate::engine) share: [f32; 2],
}

/// What is done and what is to be done.
#[derive(Debug, Default)]
pub(in crate::engine) struct Schedule {
    sides: [Option<Work>; 2],
    is_wanted: [bool; 2],
    mode: Mode,
    pace: Pace,
    rate: Rate,
    last: Option<Side>,
    /// The side whose frames the renderer could continue, and how many of them there are.
    history: Option<(Side, u32)>,
    /// Frames since an animation plays.
    played: u32,
    /// Whether a device renders.
    on_device: bool,
}

impl Schedule {
    /// Takes in a new order.
    pub(in crate::engine) fn take(&mut self, order: &Order) {
        let mode = match (order.is_playing, order.is_moving) {
            (true, _) => Mode::Playing,
            (false, true) => Mode::Moving,
            (false, false) => Mode::Still,
        };
        let stopped = self.mode == Mode::Playing && mode != Mode::Playing;
        if self.mode != Mode::Playing {
            self.played = 0;
        }
        self.mode = mode;
        for side in Side::ALL {
            let i = side as usize;
            self.is_wanted[i] = order.sides[i].is_some();
            let Some(asked) = &order.sides[i] else { continue };
            let settings = frame_settings(asked);
            let mut work = match self.sides[i].take() {
                // Frames that played went on with one another; a still view begins anew.
                Some(work) if is_same(&work.settings, &settings) && !(stopped && work.accumulates()) => work,
                Some(old) => Work { frames: old.frames, ..Work::new(settings) },
                None => Work::new(settings),
            };
            if work.shown.is_none() && mode != Mode::Playing {
                work.frames = 0;
            }
            match mode {
                Mode::Playing => work.left.clear(),
                _ => work.plan(self.rate, self.quick(), mode == Mode::Moving),
            }
            self.sides[i] = Some(work);
        }
    }

    /// Forgets everything but what is wanted: another scene is open.
    pub(in crate::engine) fn clear(&mut self, on_device: bool) {
        (self.rate, self.history, self.pace) = (Rate::default(), None, Pace::default());
        self.on_device = on_device;
        let quick = self.quick();
        for work in self.sides.iter_mut().flatten() {
            *work = Work::new(work.settings.clone());
            if self.mode != Mode::Playing {
                work.plan(self.rate, quick, self.mode == Mode::Moving);
            }
        }
    }

    /// The picture of `side` is lost. If it counts as done, it is done again; while an animation plays, the next one takes its place.
    pub(in crate::engine) fn again(&mut self, side: Side) {
        let (rate, quick, mode) = (self.rate, self.quick(), self.mode);
        let work = self.sides[side as usize].as_mut();
        if mode != Mode::Playing
            && let Some(work) = work.filter(|work| work.shown.is_some() && work.left.is_empty())
        {
            *work = Work { is_refused: work.is_refused, ..Work::new(work.settings.clone()) };
            work.plan(rate, quick, mode == Mode::Moving);
        }
    }

    /// How long a first picture may take, seconds.
    const fn quick(&self) -> f64 {
        if self.on_device { QUICK_ON_DEVICE } else { QUICK }
    }

    /// Whether pictures are to be looked at, rather than to follow something.
    pub(in crate::engine) fn is_still(&self) -> bool {
        self.mode == Mode::Still
    }

    /// What is to be rendered next; `None` if everything is done.
    pub(in crate::engine) fn next(&mut self) -> Option<Step> {
        if self.mode == Mode::Playing {
            return self.play();
        }
        self.refine().or_else(|| if self.mode == Mode::Still { self.accumulate() } else { None })
    }

    /// The work of the sides that are shown and can be rendered.
    fn open(&self) -> impl Iterator<Item = (Side, &Work)> {
        let work = |side: Side| self.sides[side as usize].as_ref().filter(|_| self.is_wanted[side as usize]);
        Side::ALL.into_iter().filter_map(move |side| Some((side, work(side)?))).filter(|(_, w)| !w.is_refused)
    }

    /// A picture of the moment that was asked for last.
    fn play(&mut self) -> Option<Step> {
        let count = self.open().count();
        let (side, work) = self.open().find(|(_, work)| work.shown.is_none())?;
        let (work, before) = (work.clone(), work.frames);
        let level = self.pace.next(work.settings.size, work.spp(), self.rate, count);
        let mut settings = work.settings_at(&level);
        let continues = self.history.is_some_and(|(of, _)| of == side);
        let accumulates = settings.temporal == Temporal::On;
        if accumulates {
            settings.frame = settings.frame.wrapping_add(self.played);
        }
        Some(Step {
            side,
            settings,
            level: Level { is_final: level.is_final && !accumulates, ..level },
            frames: if accumulates && continues { before + 1 } else { 1 },
            begins: accumulates && !continues,
            is_shown: true,
            is_first: true,
            share: [0.0, 1.0],
        })
    }

    /// The next level of the side that is behind.
    fn refine(&self) -> Option<Step> {
        let behind = |(side, work): &(Side, &Work)| {
            let asked = work.spp().max(1) as f32;
            let shown = work.shown.map_or((0.0, 0.0), |level| (level.scale, level.spp as f32 / asked));
            (shown, self.last == Some(*side))
        };
        let (side, work) = self
            .open()
            .filter(|(_, work)| !work.left.is_empty())
            .min_by(|a, b| behind(a).partial_cmp(&behind(b)).unwrap_or(std::cmp::Ordering::Equal))?;
        let level = *work.left.first()?;
        let size = work.settings.size;
        let costs: Vec<f64> = work.left.iter().map(|level| cost(size, level)).collect();
        let all = costs.iter().sum::<f64>() + work.shown.map_or(0.0, |level| cost(size, &level));
        let before = all - costs.iter().sum::<f64>();
        let mut settings = work.settings_at(&level);
        if !level.is_final {
            settings.temporal = Temporal::Off;
        }
        Some(Step {
            side,
            begins: settings.temporal == Temporal::On,
            settings,
            level,
            frames: 1,
            is_shown: true,
            is_first: work.shown.is_none(),
            share: [before / all, (before + costs[0]) / all].map(|share| share as f32),
        })
    }

    /// The next frame of a view that stands still.
    fn accumulate(&self) -> Option<Step> {
        let continued = |side: Side| self.history.filter(|(of, _)| *of == side).map(|(_, frames)| frames);
        let (side, work) = self
            .open()
            .filter(|(_, work)| work.goes_on())
            .max_by_key(|(side, _)| (continued(*side).is_some(), side.other() as u8))?;
        // Where something else was rendered in between, the renderer has forgotten the frames before.
        let before = continued(side).unwrap_or(0);
        let mut settings = work.settings.clone();
        settings.frame = settings.frame.wrapping_add(before);
        Some(Step {
            side,
            settings,
            level: Level { scale: 1.0, spp: work.spp(), is_final: true },
            frames: before + 1,
            begins: before == 0,
            is_shown: before + 1 > work.frames,
            is_first: false,
            share: [0.0, 1.0],
        })
    }

    /// `step` is about to be rendered, or the renderer is about to be used for something else (`None`): whatever becomes of
    /// it, the frames before cannot be continued unless it is [done](Self::done).
    pub(in crate::engine) const fn begin(&mut self) {
        self.history = None;
    }

    /// `step` took `seconds`.
    pub(in crate::engine) fn done(&mut self, step: &Step, seconds: f64) {
        self.rate.measured(work(step.settings.size, step.level.spp), seconds);
        self.last = Some(step.side);
        if step.settings.temporal == Temporal::On {
            self.history = Some((step.side, step.frames));
        }
        if self.mode == Mode::Playing {
            self.played = self.played.wrapping_add(1);
        }
        let Some(work) = &mut self.sides[step.side as usize] else { return };
        work.shown = Some(step.level);
        work.frames = if self.mode == Mode::Playing { step.frames } else { work.frames.max(step.frames) };
        if work.left.first().is_some_and(|level| *level == step.level) {
            work.left.remove(0);
        }
    }

    /// `step` cannot be rendered; nothing more is tried until its settings change.
    pub(in crate::engine) fn refuse(&mut self, step: &Step) {
        if let Some(work) = &mut self.sides[step.side as usize] {
            work.is_refused = true;
        }
    }
}

#[cfg(test)]
#[path = "schedule_tests.rs"]
mod tests;
