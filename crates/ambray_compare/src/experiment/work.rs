//! How long work is followed and stopped.

use std::cell::Cell;

use ambray::Control;

/// Long work of several steps: tells which step is under way and what share of all is done.
pub struct Work<'a> {
    control: Control<'a>,
    tell: &'a dyn Fn(&str),
    total: f32,
    done: Cell<f32>,
}

impl std::fmt::Debug for Work<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Work").field("done", &self.done).field("total", &self.total).finish_non_exhaustive()
    }
}

impl<'a> Work<'a> {
    /// Work that `control` follows, and whose steps `tell` is told.
    #[must_use]
    pub fn new(control: Control<'a>, tell: &'a dyn Fn(&str)) -> Self {
        Self { control, tell, total: 1.0, done: Cell::new(0.0) }
    }

    /// Announces steps that together weigh `weight`, in the weights of [`step`](Self::step).
    pub fn expect(&mut self, weight: f32) {
        self.total = (self.done.get() + weight).max(1.0);
    }

    /// Does the step `what`, which weighs `weight` among all.
    pub fn step<T>(&self, what: &str, weight: f32, work: impl FnOnce(Control<'_>) -> T) -> T {
        (self.tell)(what);
        let (before, total, report) = (self.done.get(), self.total, self.control.progress);
        let progress = |share: f32| report(((before + weight * share) / total).min(1.0));
        let result = work(Control { progress: &progress, ..self.control });
        self.done.set(before + weight);
        report(((before + weight) / total).min(1.0));
        result
    }
}

#[cfg(test)]
mod tests {
    use std::{cell::RefCell, sync::Mutex};

    use super::*;

    #[test]
    fn steps_count_by_their_weight() {
        let (shares, told) = (Mutex::new(Vec::new()), RefCell::new(Vec::new()));
        let report = |share: f32| shares.lock().unwrap().push(share);
        let tell = |what: &str| told.borrow_mut().push(what.to_owned());
        let mut work = Work::new(Control { progress: &report, ..Control::default() }, &tell);
        work.expect(4.0);
        work.step("a", 1.0, |control| (control.progress)(0.5));
        work.step("b", 3.0, |_| ());
        assert_eq!(*shares.lock().unwrap(), [0.125, 0.25, 1.0]);
        assert_eq!(*told.borrow(), ["a", "b"]);
    }
}
