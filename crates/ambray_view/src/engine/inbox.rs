//! What the window wants, on its way to the worker.

use std::{
    collections::VecDeque,
    sync::{
        Arc, Condvar, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use ambray::settings::Settings;

use super::{
    contract::{Export, Order},
    guard::lock,
    loader::Ready,
    plan::{Step, frame_settings, is_same},
};
use crate::model::Side;

/// What has come in.
#[derive(Debug, Default)]
pub(super) struct Mail {
    /// The latest order.
    pub(super) order: Option<Box<Order>>,
    /// A scene that was opened.
    pub(super) ready: Option<Box<Ready>>,
    /// The pixel to be inspected.
    pub(super) inspect: Option<(Side, (u32, u32))>,
    /// Exports, the oldest first.
    pub(super) exports: VecDeque<Export>,
}

impl Mail {
    fn is_empty(&self) -> bool {
        let Self { order, ready, inspect, exports } = self;
        order.is_none() && ready.is_none() && inspect.is_none() && exports.is_empty()
    }
}

/// A picture that is being rendered and may be cancelled.
#[derive(Debug)]
struct InFlight {
    side: Side,
    /// What was asked for when it began.
    asked: Option<Settings>,
    /// Whether it continues earlier frames, which would be lost with it.
    goes_on: bool,
}

#[derive(Debug, Default)]
struct State {
    mail: Mail,
    in_flight: Option<InFlight>,
    is_closed: bool,
    /// The newest order that came in, delivered or not.
    latest: Option<Order>,
}

/// The worker's inbox.
#[derive(Debug, Default)]
pub(super) struct Inbox {
    state: Mutex<State>,
    changed: Condvar,
    /// Stops the picture that is being rendered.
    cancel: AtomicBool,
    /// Stops the export that is under way.
    cancel_export: AtomicBool,
}

impl Inbox {
    /// Takes an order; one that says nothing new costs a comparison.
    pub(super) fn show(&self, order: Order) {
        let mut state = lock(&self.state);
        if state.latest.as_ref().is_some_and(|latest| is_repeated(latest, &order)) {
            return;
        }
        let quick = order.is_moving || order.is_playing;
        let is_outdated = state.in_flight.as_ref().is_some_and(|picture| {
            let asked = order.sides[picture.side as usize].as_ref().map(frame_settings);
            let is_same = match (&asked, &picture.asked) {
                (Some(a), Some(b)) => is_same(a, b),
                _ => false,
            };
            quick || !is_same
        });
        if is_outdated {
            self.cancel.store(true, Ordering::Relaxed);
        }
        state.latest = Some(order.clone());
        state.mail.order = Some(Box::new(order));
        self.changed.notify_all();
    }

    /// Puts something else in, for which a finer level is worth interrupting.
    pub(super) fn put(&self, change: impl FnOnce(&mut Mail)) {
        let mut state = lock(&self.state);
        change(&mut state.mail);
        if state.in_flight.is_some() {
            self.cancel.store(true, Ordering::Relaxed);
        }
        self.changed.notify_all();
    }

    /// Asks for an inspection, which waits for a frame that continues others: they would have to be rendered again.
    pub(super) fn inspect(&self, side: Side, pixel: (u32, u32)) {
        let mut state = lock(&self.state);
        state.mail.inspect = Some((side, pixel));
        if state.in_flight.as_ref().is_some_and(|picture| !picture.goes_on) {
            self.cancel.store(true, Ordering::Relaxed);
        }
        self.changed.notify_all();
    }

    /// Stops everything.
    pub(super) fn close(&self) {
        let mut state = lock(&self.state);
        state.is_closed = true;
        self.cancel.store(true, Ordering::Relaxed);
        self.cancel_export.store(true, Ordering::Relaxed);
        self.changed.notify_all();
    }

    /// Stops the export that is under way, and those that wait.
    pub(super) fn cancel_export(&self) -> VecDeque<Export> {
        let mut state = lock(&self.state);
        self.cancel_export.store(true, Ordering::Relaxed);
        std::mem::take(&mut state.mail.exports)
    }

    /// What has come in; waits for something if there is nothing and the worker `is_idle`. `None` when all is over.
    pub(super) fn take(&self, is_idle: bool) -> Option<Mail> {
        let mut state = lock(&self.state);
        while is_idle && state.mail.is_empty() && !state.is_closed {
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        let exports = state.mail.exports.pop_front();
        let rest = std::mem::take(&mut state.mail.exports);
        let mut mail = std::mem::take(&mut state.mail);
        // One at a time, so that those that wait can be stopped.
        (mail.exports, state.mail.exports) = (exports.into_iter().collect(), rest);
        (!state.is_closed).then_some(mail)
    }

    /// Begins to render `step`, unless something better has come in meanwhile.
    pub(super) fn begin(&self, step: &Step) -> bool {
        let mut state = lock(&self.state);
        if state.is_closed || (!step.is_first && !state.mail.is_empty()) {
            return false;
        }
        self.cancel.store(false, Ordering::Relaxed);
        let asked = state.latest.as_ref().and_then(|order| order.sides[step.side as usize].as_ref());
        let asked = asked.map(frame_settings);
        let picture = InFlight { side: step.side, asked, goes_on: step.frames > 1 };
        state.in_flight = (!step.is_first).then_some(picture);
        true
    }

    /// Nothing is being rendered any more.
    pub(super) fn end(&self) {
        lock(&self.state).in_flight = None;
    }

    /// Begins an export; `false` when all is over.
    pub(super) fn begin_export(&self) -> bool {
        let state = lock(&self.state);
        self.cancel_export.store(state.is_closed, Ordering::Relaxed);
        !state.is_closed
    }

    /// Set when the picture that is being rendered is no longer wanted.
    pub(super) const fn cancel(&self) -> &AtomicBool {
        &self.cancel
    }

    /// Set when the export is no longer wanted.
    pub(super) const fn export_cancel(&self) -> &AtomicBool {
        &self.cancel_export
    }
}

/// Whether `order` says what `latest` said.
fn is_repeated(latest: &Order, order: &Order) -> bool {
    let sides = latest.sides.iter().zip(&order.sides).all(|sides| match sides {
        (Some(a), Some(b)) => is_same(a, b),
        (a, b) => a.is_none() == b.is_none(),
    });
    let rest = |order: &Order| (order.aov, order.comparison, order.is_moving, order.is_playing);
    sides && rest(latest) == rest(order)
}

/// The inbox as several threads hold it.
pub(super) type SharedInbox = Arc<Inbox>;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::contract::Level;

    #[test]
    fn an_inspection_does_not_cost_the_frames_that_have_accumulated() {
        let step = |frames| Step {
            side: Side::A,
            settings: Settings::default(),
            level: Level { scale: 1.0, spp: 8, is_final: true },
            frames,
            begins: frames == 1,
            is_shown: true,
            is_first: false,
            share: [0.0, 1.0],
        };
        for (frames, is_cancelled) in [(1, true), (2, false)] {
            let inbox = Inbox::default();
            assert!(inbox.begin(&step(frames)));
            inbox.inspect(Side::A, (1, 2));
            assert_eq!(inbox.cancel().load(Ordering::Relaxed), is_cancelled, "{frames}");
            inbox.end();
            let mail = inbox.take(true).expect("nothing is over");
            assert_eq!(mail.inspect, Some((Side::A, (1, 2))));
        }
    }
}
