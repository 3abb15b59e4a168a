//! The thread that owns the renderer.

use std::{collections::VecDeque, sync::Arc, time::Instant};

use ambray::{Control, Drawn, Frame, Machine, RenderError, Renderer};
use ambray_files::Interrupted;

use super::{
    contract::{Event, Export, Inspected},
    device::Easel,
    export::Exporter,
    gallery::{Gallery, Shot},
    guard::caught,
    inbox::{Mail, SharedInbox},
    loader::Ready,
    outbox::Outbox,
    plan::{Schedule, Step},
    throttle::Throttle,
};
use crate::model::Side;

/// Renders what is wanted.
#[derive(Debug)]
pub(super) struct Worker {
    pub(super) inbox: SharedInbox,
    pub(super) outbox: Outbox,
    pub(super) gallery: Arc<Gallery>,
    pub(super) threads: usize,
    pub(super) open: Option<Open>,
    pub(super) schedule: Schedule,
    /// Whether pictures stay on the device that renders them.
    keeps_on_device: bool,
    easel: Easel,
    /// Whether both sides are wanted.
    compares: bool,
    /// A pixel to be inspected as soon as its picture is there.
    waiting: Option<(Side, (u32, u32))>,
    /// The last pictures that were taken down. The window may show them still.
    old: VecDeque<Arc<Frame>>,
}

/// Pictures that the window shows for a while after they were taken down, with one that it shows no more.
const OLD: usize = 2;

/// The scene that is open.
#[derive(Debug)]
pub(super) struct Open {
    pub(super) renderer: Renderer,
    /// What pictures say they show.
    pub(super) label: String,
}

impl Worker {
    pub(super) fn new(
        inbox: SharedInbox,
        outbox: Outbox,
        gallery: Arc<Gallery>,
        threads: usize,
        keeps_on_device: bool,
    ) -> Self {
        Self {
            inbox,
            outbox,
            gallery,
            threads,
            open: None,
            schedule: Schedule::default(),
            keeps_on_device,
            easel: Easel::default(),
            compares: false,
            waiting: None,
            old: VecDeque::new(),
        }
    }

    /// Works until all is over.
    pub(super) fn run(&mut self) {
        let mut step = None;
        while let Some(mail) = self.inbox.take(step.is_none()) {
            self.read(mail);
            step = self.open.is_some().then(|| self.schedule.next()).flatten();
            if step.is_none() {
                // Their memory is for pictures that follow at once.
                self.old.clear();
                if self.schedule.is_still() {
                    self.copy();
                }
            }
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
        if let Some((side, pixel)) = mail.inspect {
            self.inspect(side, pixel);
        }
        for export in mail.exports {
            self.export(&export);
        }
        if let Some(order) = mail.order {
            self.schedule.take(&order);
            self.compares = order.sides.iter().all(Option::is_some);
            self.easel.look(&order);
            // Before the gallery: what it says of a picture follows the picture.
            if let Err(message) = self.show() {
                log::warn!("the picture on the device cannot be shown: {message}");
                self.easel.clear();
            }
            self.gallery.look(&order, self.easel.side());
            self.keep();
        }
    }

    /// Sees to it that every picture that counts as done can be had: the device keeps one frame alone.
    fn keep(&mut self) {
        if self.compares && self.schedule.is_still() {
            // The other side may take its place.
            self.copy();
        }
        for side in Side::ALL {
            if self.easel.side() != Some(side) && self.gallery.shot(side).is_none() {
                self.schedule.again(side);
            }
        }
    }

    fn reopen(&mut self, ready: Ready) {
        let Ready { renderer, opened, label } = ready;
        let on_device = self.keeps_on_device && matches!(opened.machine, Machine::Vulkan { .. });
        self.schedule.clear(on_device);
        self.easel.clear();
        self.waiting = None;
        self.old.clear();
        self.gallery.reopen(opened);
        let old = self.open.replace(Open { renderer, label });
        // A large scene takes its time to be freed.
        rayon::spawn(move || drop(old));
    }

    /// Shows the picture on the device as it is wanted now.
    fn show(&mut self) -> Result<(), String> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let (easel, outbox) = (&mut self.easel, &self.outbox);
        caught(|| easel.show(&mut open.renderer, outbox))?.map_err(|error| error.to_string())
    }

    /// Copies the picture on the device to the host.
    fn copy(&mut self) {
        let Some(open) = &mut self.open else { return };
        let (easel, gallery) = (&mut self.easel, &self.gallery);
        let copied = caught(|| easel.copy(&mut open.renderer, gallery));
        if let Err(message) = copied.and_then(|done| done.map_err(|error| error.to_string())) {
            log::warn!("the picture on the device cannot be copied: {message}");
        }
    }

    /// Tells what `pixel` of the picture of `side` did.
    fn inspect(&mut self, side: Side, pixel: (u32, u32)) {
        if self.easel.is_uncopied(side) {
            self.copy();
        }
        self.waiting = None;
        // A pixel outside a coarse picture is one of the picture that follows.
        let is_there = |shot: &Arc<Shot>| {
            shot.level.is_final || pixel.0 < shot.frame.width && pixel.1 < shot.frame.height
        };
        let (Some(open), Some(shot)) = (&mut self.open, self.gallery.shot(side).filter(is_there)) else {
            self.waiting = Some((side, pixel));
            return;
        };
        // Asked before the picture of such a method came, from which the window knows that there is nothing to tell.
        if shot.settings.method.is_screen_space() {
            return;
        }
        let control = Control { threads: self.threads, ..Control::default() };
        let outcome = caught(|| open.renderer.inspect(&shot.settings, &shot.frame, pixel, control));
        let message = match outcome {
            Ok(Ok(inspection)) => {
                let inspected = Inspected { side, pixel, inspection };
                return self.outbox.send(Event::Inspected(Box::new(inspected)));
            }
            Ok(Err(error)) => error.to_string(),
            Err(panic) => panic,
        };
        self.outbox.send(Event::InspectFailed { side, message });
    }

    /// Writes what `export` asks for.
    fn export(&mut self, export: &Export) {
        let (Export::Screenshot { path, .. } | Export::Turntable { path, .. }) = export;
        let path = path.clone();
        // Its frames take the place of the one on the device.
        self.copy();
        let Some(open) = &mut self.open else {
            let message = "no scene is open".to_owned();
            return self.outbox.send(Event::ExportFailed { path, message });
        };
        if !self.inbox.begin_export() {
            return;
        }
        self.schedule.begin();
        self.easel.clear();
        self.outbox.send(Event::Exporting { share: 0.0 });
        let (outbox, throttle) = (&self.outbox, Throttle::new());
        let progress = |share| throttle.report(share, |share| outbox.send(Event::Exporting { share }));
        let mut exporter = Exporter {
            renderer: &mut open.renderer,
            label: &open.label,
            gallery: &self.gallery,
            threads: self.threads,
            cancel: self.inbox.export_cancel(),
            progress: &progress,
        };
        let message = match caught(|| exporter.run(export)) {
            Ok(Ok(())) => return self.outbox.send(Event::Exported { path }),
            Ok(Err(error)) if error.is::<Interrupted>() => "cancelled".to_owned(),
            Ok(Err(error)) => format!("{error:#}"),
            Err(panic) => panic,
        };
        self.outbox.send(Event::ExportFailed { path, message });
    }

    /// Shows what was `drawn`.
    fn hang(&mut self, step: &Step, drawn: Drawn) -> Result<(), String> {
        match drawn {
            Drawn::Host(frame) => {
                self.easel.clear();
                if let Some(open) = self.open.as_ref().filter(|_| step.is_shown) {
                    let Step { side, settings, level, frames, .. } = step.clone();
                    // Asked after the work: the processor may have stepped in.
                    let machine = open.renderer.machine_for(&settings);
                    let frame = Arc::from(frame);
                    let shot = Shot { side, settings, machine, level, frames, frame };
                    if let Some(old) = self.gallery.hang(shot, false) {
                        self.old.push_back(Arc::clone(&old.frame));
                        self.old.drain(..self.old.len().saturating_sub(OLD));
                    }
                }
            }
            Drawn::Device(frame) => {
                self.gallery.take_down(step.side);
                self.easel.take(step, *frame);
                if step.is_shown {
                    self.show()?;
                }
                // The other side will take its place.
                if self.compares && step.level.is_final && self.schedule.is_still() {
                    self.copy();
                }
            }
        }
        if let Some((_, pixel)) = self.waiting.filter(|(side, _)| *side == step.side && step.level.is_final) {
            self.inspect(step.side, pixel);
        }
        Ok(())
    }

    /// Gives the memory of old pictures that nobody shows any more to the next one.
    fn recycle(&mut self) {
        let Some(open) = &mut self.open else { return };
        for frame in std::mem::take(&mut self.old) {
            match Arc::try_unwrap(frame) {
                Ok(frame) => open.renderer.recycle(frame),
                Err(shown) => self.old.push_back(shown),
            }
        }
    }

    fn render(&mut self, step: &Step) {
        self.recycle();
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
            if self.keeps_on_device {
                open.renderer.draw(&step.settings, control)
            } else {
                open.renderer.render(&step.settings, control).map(|frame| Drawn::Host(Box::new(frame)))
            }
        });
        let messages = match outcome {
            Ok(Ok(drawn)) => {
                self.schedule.done(step, start.elapsed().as_secs_f64());
                match self.hang(step, drawn) {
                    Ok(()) => return,
                    Err(message) => vec![message],
                }
            }
            // What was on the device is half painted over.
            Ok(Err(RenderError::Cancelled)) => return self.easel.clear(),
            Ok(Err(RenderError::Settings(errors))) => errors.iter().map(ToString::to_string).collect(),
            Ok(Err(error)) => vec![error.to_string()],
            Err(panic) => vec![panic],
        };
        self.schedule.refuse(step);
        self.outbox.send(Event::Refused { side, messages });
    }
}
