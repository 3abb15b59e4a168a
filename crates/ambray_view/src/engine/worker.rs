//! The thread that owns the renderer.

use std::{sync::Arc, time::Instant};

use ambray::{Control, RenderError, Renderer};

use super::{
    contract::Event,
    gallery::{Gallery, Shot},
    guard::caught,
    inbox::{Mail, SharedInbox},
    loader::Ready,
    outbox::Outbox,
    plan::{Schedule, Step},
    throttle::Throttle,
};

/// Renders what is wanted.
#[derive(Debug)]
pub(super) struct Worker {
    pub(super) inbox: SharedInbox,
    pub(super) outbox: Outbox,
    pub(super) gallery: Arc<Gallery>,
    pub(super) threads: usize,
    pub(super) open: Option<Open>,
    pub(super) schedule: Schedule,
}

/// The scene that is open.
#[derive(Debug)]
pub(super) struct Open {
    pub(super) renderer: Renderer,
    /// What pictures say they show.
    pub(super) label: String,
}

impl Worker {
    pub(super) fn new(inbox: SharedInbox, outbox: Outbox, gallery: Arc<Gallery>, threads: usize) -> Self {
        Self { inbox, outbox, gallery, threads, open: None, schedule: Schedule::default() }
    }

    /// Works until all is over.
    pub(super) fn run(&mut self) {
        let mut step = None;
        while let Some(mail) = self.inbox.take(step.is_none()) {
            self.read(mail);
            step = self.open.is_some().then(|| self.schedule.next()).flatten();
            if let Some(step) = &step
                && self.inbox.begin(step)
            {
                self.render(step);
                self.inbox.end();
            }
        }
    }

    /// Takes in what has come.
    fn read(&mut self, mail: Mail) {
        if let Some(ready) = mail.ready {
            self.reopen(*ready);
        }
        if let Some(order) = mail.order {
            self.schedule.take(&order);
            self.gallery.look(&order);
        }
    }

    fn reopen(&mut self, ready: Ready) {
        let Ready { renderer, opened, label } = ready;
        self.schedule.clear();
        self.gallery.reopen(opened);
        let old = self.open.replace(Open { renderer, label });
        // A large scene takes its time to be freed.
        rayon::spawn(move || drop(old));
    }

    fn render(&mut self, step: &Step) {
        let Some(open) = &mut self.open else { return };
        self.schedule.begin();
        let (outbox, side) = (&self.outbox, step.side);
        let throttle = Throttle::new();
        let [from, to] = step.share;
        let progress = |share: f32| {
            let share = from + (to - from) * share;
            throttle.report(share, |share| outbox.send(Event::Progress { side, share }));
        };
        let control = Control { progress: &progress, cancel: self.inbox.cancel(), threads: self.threads };
        let start = Instant::now();
        let outcome = caught(|| {
            if step.begins {
                open.renderer.forget_frames();
            }
            open.renderer.render(&step.settings, control)
        });
        let messages = match outcome {
            Ok(Ok(frame)) => {
                self.schedule.done(step, start.elapsed().as_secs_f64());
                if step.is_shown {
                    let (settings, level, frames) = (step.settings.clone(), step.level, step.frames);
                    self.gallery.hang(Shot { side, settings, level, frames, frame: Arc::new(frame) });
                }
                return;
            }
            Ok(Err(RenderError::Cancelled)) => return,
            Ok(Err(RenderError::Settings(errors))) => errors.iter().map(ToString::to_string).collect(),
            Ok(Err(error)) => vec![error.to_string()],
            Err(panic) => vec![panic],
        };
        self.schedule.refuse(step);
        self.outbox.send(Event::Refused { side, messages });
    }
}
