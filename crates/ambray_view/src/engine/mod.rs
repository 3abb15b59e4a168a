//! The engine: loads, renders and exports on threads of its own, so that the window never waits.
//!
//! The window tells it what is wanted; the latest [`Order`] counts. It answers with [`Event`]s.
//!
//! | thread | what it does |
//! |---|---|
//! | worker | owns the renderer; renders level after level, inspects, exports |
//! | gallery | holds the newest frames and makes display bytes, statistics and differences of them |
//! | loader | one for each scene on its way: reads and builds |
//! | watch | waits for changes of the scene's files |

mod contract;
mod device;
mod difference;
mod export;
mod gallery;
mod guard;
mod inbox;
mod loader;
mod outbox;
mod plan;
mod shown;
mod statistics;
mod throttle;
mod watch;
mod worker;

use std::{
    sync::{Arc, mpsc},
    thread::JoinHandle,
};

pub use contract::{
    AnimationInfo, CameraInfo, Content, Difference, EngineOptions, Event, Export, Inspected, Level, Opened,
    Order, Pixels, Rendered, Statistics, Wake,
};

pub use plan::MOST_FRAMES;

use self::{
    gallery::Gallery,
    inbox::{Inbox, SharedInbox},
    loader::Loader,
    outbox::Outbox,
    watch::Follow,
    worker::Worker,
};
use crate::model::{SceneRef, Side};

/// Does the work; made once. Dropping it stops everything.
#[derive(Debug)]
pub struct Engine {
    inbox: SharedInbox,
    gallery: Arc<Gallery>,
    loader: Arc<Loader>,
    follow: mpsc::Sender<Follow>,
    outbox: Outbox,
    events: mpsc::Receiver<Event>,
    threads: Vec<JoinHandle<()>>,
}

impl Engine {
    /// Starts the threads.
    ///
    /// # Panics
    /// If the system gives no threads.
    #[must_use]
    pub fn new(options: EngineOptions) -> Self {
        let (outbox, events) = Outbox::new(options.wake);
        let (follow, followed) = mpsc::channel();
        let inbox = SharedInbox::new(Inbox::default());
        let gallery = Arc::new(Gallery::new(outbox.clone()));
        let loader = Arc::new(Loader::new(
            options.renderer,
            options.threads,
            Arc::clone(&inbox),
            outbox.clone(),
            follow.clone(),
        ));
        let mut worker = Worker::new(
            Arc::clone(&inbox),
            outbox.clone(),
            Arc::clone(&gallery),
            options.threads,
            options.keeps_on_device,
        );
        let (shows, loads, changes) = (Arc::clone(&gallery), Arc::clone(&loader), follow.clone());
        let threads = vec![
            spawn("ambray-worker", move || worker.run()),
            spawn("ambray-gallery", move || shows.run()),
            spawn("ambray-watch", move || watch::run(&loads, &changes, &followed)),
        ];
        Self { inbox, gallery, loader, follow, outbox, events, threads }
    }

    /// Opens another scene, or the same one again. The old one stays until the new one is there, and if that fails.
    pub fn open(&self, scene: &SceneRef) {
        self.loader.open(scene);
    }

    /// Says what is wanted now. Cheap where nothing has changed.
    pub fn show(&self, order: Order) {
        self.inbox.show(order);
    }

    /// Asks what the pixel at `(x, y)` of the picture of `side` did; the answer is [`Event::Inspected`].
    pub fn inspect(&self, side: Side, pixel: (u32, u32)) {
        self.inbox.inspect(side, pixel);
    }

    /// Begins an export. Pictures wait while it is under way; those that hang can still be shown in another way.
    pub fn export(&self, export: Export) {
        self.inbox.put(|mail| mail.exports.push_back(export));
    }

    /// Stops the export that is under way, and those that wait.
    pub fn cancel_export(&self) {
        for export in self.inbox.cancel_export() {
            let (Export::Screenshot { path, .. } | Export::Turntable { path, .. }) = export;
            self.outbox.send(Event::ExportFailed { path, message: "cancelled".to_owned() });
        }
    }

    /// What has happened since the last call.
    pub fn poll(&self) -> Vec<Event> {
        self.events.try_iter().collect()
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.inbox.close();
        self.gallery.close();
        // The watcher may have ended by a panic of its own.
        let _ = self.follow.send(Follow::Stop);
        self.loader.close();
        for thread in self.threads.drain(..) {
            // A panic was told by the thread itself; there is nobody left to tell it to.
            let _ = thread.join();
        }
    }
}

fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> JoinHandle<()> {
    let thread = std::thread::Builder::new().name(name.to_owned()).spawn(work);
    thread.expect("the system gives the window its threads")
}
