//! The newest frames, and the thread that shows them: a change of exposure waits for no ray.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use ambray::{Aov, Frame, Machine, settings::Settings};

use super::{
    contract::{Content, Difference, Event, Level, Opened, Order, Rendered, Statistics},
    guard::{caught, lock},
    outbox::Outbox,
    plan::{frame_settings, is_same},
    shown,
};
use crate::model::{Comparison, Side};

/// A rendered frame.
#[derive(Clone, Debug)]
pub(super) struct Shot {
    /// Of which side.
    pub(super) side: Side,
    /// What it was rendered with; how it is shown is up to the order.
    pub(super) settings: Settings,
    /// Who rendered it.
    pub(super) machine: Machine,
    /// How far it is refined.
    pub(super) level: Level,
    /// Frames whose mean it is.
    pub(super) frames: u32,
    /// The planes.
    pub(super) frame: Arc<Frame>,
}

/// A shot with its number: each has another one.
#[derive(Clone, Debug)]
struct Hung {
    number: u64,
    shot: Arc<Shot>,
    /// Whether the window has its picture from the device already.
    on_device: bool,
}

/// How a side is shown.
#[derive(Clone, Debug)]
pub(super) struct Look {
    pub(super) aov: Aov,
    pub(super) settings: Settings,
}

impl Look {
    /// How `order` shows `side`.
    pub(super) fn of(order: &Order, side: Side) -> Option<Self> {
        let settings = order.sides[side as usize].clone()?;
        Some(Self { aov: order.aov, settings })
    }

    /// `frame` settings under this look.
    pub(super) fn over(&self, frame: &Settings) -> Settings {
        let look = &self.settings;
        Settings {
            exposure: look.exposure,
            tone_map: look.tone_map,
            ramp: look.ramp,
            range: look.range.clone(),
            ..frame.clone()
        }
    }

    pub(super) fn is_same(&self, other: &Self) -> bool {
        let any = Settings::default();
        self.aov == other.aov && is_same(&self.over(&any), &other.over(&any))
    }
}

#[derive(Debug, Default)]
struct State {
    hung: [Option<Hung>; 2],
    looks: [Option<Look>; 2],
    comparison: Comparison,
    count: u64,
    is_closed: bool,
    /// What was shown last of each side: number and look.
    shown: [Option<(u64, Look)>; 2],
    /// The numbers that were compared last, in which plane.
    compared: Option<([u64; 2], Aov)>,
}

/// What is to be shown.
enum Task {
    Picture(Hung, Box<Look>),
    Difference([Hung; 2], Aov),
}

/// The newest frames of both sides.
#[derive(Debug)]
pub(super) struct Gallery {
    state: Mutex<State>,
    changed: Condvar,
    outbox: Outbox,
}

impl Gallery {
    pub(super) fn new(outbox: Outbox) -> Self {
        Self { state: Mutex::default(), changed: Condvar::new(), outbox }
    }

    /// Shows pictures as `order` says; the picture of `on_device` is shown by the device.
    pub(super) fn look(&self, order: &Order, on_device: Option<Side>) {
        let mut state = lock(&self.state);
        for hung in state.hung.iter_mut().flatten() {
            hung.on_device &= on_device == Some(hung.shot.side);
        }
        state.looks = Side::ALL.map(|side| Look::of(order, side));
        state.comparison = order.comparison;
        self.changed.notify_all();
    }

    /// Takes down the picture of `side`: there is a newer one elsewhere.
    pub(super) fn take_down(&self, side: Side) {
        lock(&self.state).hung[side as usize] = None;
    }

    /// Hangs a new picture; `on_device` if the window has it from the device already. Returns the one that hung there.
    pub(super) fn hang(&self, shot: Shot, on_device: bool) -> Option<Arc<Shot>> {
        let mut state = lock(&self.state);
        state.count += 1;
        let (side, number) = (shot.side as usize, state.count);
        let old = state.hung[side].replace(Hung { number, shot: Arc::new(shot), on_device });
        self.changed.notify_all();
        old.map(|hung| hung.shot)
    }

    /// Takes everything down, because another scene is open.
    pub(super) fn reopen(&self, opened: Opened) {
        let mut state = lock(&self.state);
        (state.hung, state.shown, state.compared) = Default::default();
        // Under the lock, so that no picture of the old scene comes after it.
        self.outbox.send(Event::Opened(Arc::new(opened)));
    }

    /// The picture of `side` that hangs now.
    pub(super) fn shot(&self, side: Side) -> Option<Arc<Shot>> {
        lock(&self.state).hung[side as usize].as_ref().map(|hung| Arc::clone(&hung.shot))
    }

    /// The final picture made with `settings`, if one hangs.
    pub(super) fn finished(&self, settings: &Settings) -> Option<Arc<Shot>> {
        let wanted = frame_settings(settings);
        Side::ALL.into_iter().filter_map(|side| self.shot(side)).find(|shot| {
            let first = shot.settings.frame.wrapping_sub(shot.frames.saturating_sub(1));
            shot.level.is_final && is_same(&Settings { frame: first, ..shot.settings.clone() }, &wanted)
        })
    }

    /// Ends the thread.
    pub(super) fn close(&self) {
        lock(&self.state).is_closed = true;
        self.changed.notify_all();
    }

    /// Shows what is hung until all is over.
    pub(super) fn run(&self) {
        while let Some(task) = self.wait() {
            match task {
                Task::Picture(hung, look) if hung.on_device => {
                    let (side, aov, frame) = (hung.shot.side, look.aov, Arc::clone(&hung.shot.frame));
                    if let Ok(statistics) = caught(|| statistics(&frame.plane(aov), aov)) {
                        self.deliver(&hung, Event::Copied { side, frame, aov, statistics });
                    }
                }
                Task::Picture(hung, look) => {
                    let side = hung.shot.side;
                    match caught(|| rendered(&hung.shot, &look)) {
                        Ok(rendered) => self.deliver(&hung, Event::Picture(Box::new(rendered))),
                        Err(message) => {
                            self.deliver(&hung, Event::Refused { side, messages: vec![message] });
                        }
                    }
                }
                Task::Difference([a, b], aov) => {
                    let compared = caught(|| Difference::of(&a.shot.frame, &b.shot.frame, aov));
                    if let Ok(Some(difference)) = compared {
                        self.deliver(&a, Event::Difference(Box::new(difference)));
                    }
                }
            }
        }
    }

    /// Sends what was made of `hung`, unless another scene is open by now.
    fn deliver(&self, hung: &Hung, event: Event) {
        let state = lock(&self.state);
        let newest = state.hung[hung.shot.side as usize].as_ref();
        if newest.is_some_and(|newest| newest.number >= hung.number) {
            self.outbox.send(event);
        }
    }

    fn wait(&self) -> Option<Task> {
        let mut state: MutexGuard<'_, State> = lock(&self.state);
        loop {
            if state.is_closed {
                return None;
            }
            if let Some(task) = state.task() {
                return Some(task);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl State {
    /// What is to be shown next, which then counts as shown.
    fn task(&mut self) -> Option<Task> {
        for i in 0..2 {
            let (Some(hung), Some(look)) = (&self.hung[i], &self.looks[i]) else { continue };
            let is_shown = self.shown[i]
                .as_ref()
                .is_some_and(|(number, shown)| *number == hung.number && shown.is_same(look));
            if !is_shown {
                self.shown[i] = Some((hung.number, look.clone()));
                return Some(Task::Picture(hung.clone(), Box::new(look.clone())));
            }
        }
        let (Some(a), Some(b), Some(look)) = (&self.hung[0], &self.hung[1], &self.looks[0]) else {
            return None;
        };
        let pair = ([a.number, b.number], look.aov);
        let fits = |a: &Frame, b: &Frame| (a.width, a.height) == (b.width, b.height);
        let is_wanted = self.comparison == Comparison::Difference && self.looks[1].is_some();
        if !is_wanted || self.compared == Some(pair) || !fits(&a.shot.frame, &b.shot.frame) {
            return None;
        }
        self.compared = Some(pair);
        Some(Task::Difference([a.clone(), b.clone()], look.aov))
    }
}

fn statistics(values: &[f32], aov: Aov) -> Arc<Statistics> {
    Arc::new(Statistics::of(values, aov.channels().len()))
}

/// `shot` as the window takes it.
fn rendered(shot: &Shot, look: &Look) -> Rendered {
    let settings = look.over(&shot.settings);
    let values = shot.frame.plane(look.aov);
    let pixels = shown::pixels(&shot.frame, look.aov, &values, &settings);
    Rendered {
        side: shot.side,
        settings,
        aov: look.aov,
        view: shot.frame.view.clone(),
        machine: shot.machine.clone(),
        level: shot.level,
        frames: shot.frames,
        stats: shot.frame.stats,
        frame_bytes: frame_bytes(&shot.frame),
        content: Content::Host { frame: Arc::clone(&shot.frame), pixels },
        statistics: Some(statistics(&values, look.aov)),
    }
}

/// Bytes that `frame` takes.
fn frame_bytes(frame: &Frame) -> u64 {
    let planes = [
        size_of_val(&frame.beauty[..]),
        size_of_val(&frame.gbuffer[..]),
        size_of_val(&frame.ambient_raw[..]),
        size_of_val(&frame.ambient[..]),
        size_of_val(&frame.bent[..]),
        size_of_val(&frame.history[..]),
    ];
    planes.iter().sum::<usize>() as u64
}
