//! Opens scenes in the background.

use std::{
    path::PathBuf,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread::JoinHandle,
};

use ambray::{Control, RenderError, Renderer, RendererOptions, scene::Scene};

use ambray_files::scene_source;

use super::{
    contract::{AnimationInfo, CameraInfo, Event, Opened},
    guard::{caught, lock},
    inbox::SharedInbox,
    outbox::Outbox,
    throttle::Throttle,
    watch::Follow,
};
use crate::model::SceneRef;

/// A scene that is ready to be rendered.
#[derive(Debug)]
pub(super) struct Ready {
    pub(super) renderer: Renderer,
    pub(super) opened: Opened,
    /// What pictures say they show.
    pub(super) label: String,
}

/// A scene on its way.
#[derive(Debug)]
struct Job {
    scene: SceneRef,
    cancel: Arc<AtomicBool>,
    thread: JoinHandle<()>,
}

#[derive(Debug, Default)]
struct State {
    jobs: Vec<Job>,
    /// The scene that was opened last.
    opened: Option<SceneRef>,
}

/// Opens scenes, each on a thread of its own; the newest counts.
#[derive(Debug)]
pub(super) struct Loader {
    state: Mutex<State>,
    options: RendererOptions,
    threads: usize,
    inbox: SharedInbox,
    outbox: Outbox,
    follow: mpsc::Sender<Follow>,
}

impl Loader {
    pub(super) fn new(
        options: RendererOptions,
        threads: usize,
        inbox: SharedInbox,
        outbox: Outbox,
        follow: mpsc::Sender<Follow>,
    ) -> Self {
        Self { state: Mutex::default(), options, threads, inbox, outbox, follow }
    }

    /// Begins to open `scene` and gives up what is on its way.
    pub(super) fn open(self: &Arc<Self>, scene: &SceneRef) {
        let cancel = Arc::new(AtomicBool::new(false));
        let (loader, flag, asked) = (Arc::clone(self), Arc::clone(&cancel), scene.clone());
        let mut state = lock(&self.state);
        for job in &state.jobs {
            job.cancel.store(true, Ordering::Relaxed);
        }
        state.jobs.retain(|job| !job.thread.is_finished());
        let work = move || loader.work(&asked, &flag);
        match std::thread::Builder::new().name("ambray-loader".to_owned()).spawn(work) {
            Ok(thread) => state.jobs.push(Job { scene: scene.clone(), cancel, thread }),
            Err(error) => {
                let message = format!("no thread to open it: {error}");
                self.outbox.send(Event::OpenFailed { scene: scene.clone(), message });
            }
        }
    }

    /// Opens `scene`, whose files have changed, again; unless another one is on its way, which takes its place anyway.
    pub(super) fn reload(self: &Arc<Self>, scene: &SceneRef) {
        let is_replaced = {
            let state = lock(&self.state);
            let on_its_way = |job: &&Job| !job.thread.is_finished() && !job.cancel.load(Ordering::Relaxed);
            state.jobs.iter().find(on_its_way).is_some_and(|job| job.scene != *scene)
        };
        if !is_replaced {
            self.open(scene);
        }
    }

    /// Gives up what is on its way. Waits only where a device is used that others own: reading a file cannot be interrupted,
    /// and what it reads is thrown away.
    pub(super) fn close(&self) {
        let jobs = std::mem::take(&mut lock(&self.state).jobs);
        for job in &jobs {
            job.cancel.store(true, Ordering::Relaxed);
        }
        if self.options.shared.is_some() {
            for job in jobs {
                // It has told of its own panics.
                let _ = job.thread.join();
            }
        }
    }

    fn work(&self, scene: &SceneRef, cancel: &AtomicBool) {
        let outcome = caught(|| self.load(scene, cancel)).unwrap_or_else(Err);
        // The check and the delivery are one step, so that an older scene never comes after a newer one.
        let mut state = lock(&self.state);
        if cancel.load(Ordering::Relaxed) {
            return;
        }
        match outcome {
            Ok((mut ready, files)) => {
                ready.opened.is_reload = state.opened.as_ref() == Some(scene);
                state.opened = Some(scene.clone());
                // The watcher ends before the loader only when all is over.
                let _ = self.follow.send(Follow::Scene(scene.clone(), files));
                self.inbox.put(|mail| mail.ready = Some(Box::new(ready)));
            }
            Err(message) => self.outbox.send(Event::OpenFailed { scene: scene.clone(), message }),
        }
    }

    fn load(&self, scene: &SceneRef, cancel: &AtomicBool) -> Result<(Ready, Vec<PathBuf>), String> {
        let tell = |stage, share| self.outbox.send(Event::Loading { scene: scene.clone(), stage, share });
        tell("reading", None);
        let source = scene_source::open(&scene.path, scene.gltf_scene.as_deref())
            .map_err(|error| format!("{error:#}"))?;
        if cancel.load(Ordering::Relaxed) {
            return Err(RenderError::Cancelled.to_string());
        }
        tell("building", None);
        let throttle = Throttle::new();
        let progress = |share| throttle.report(share, |share| tell("building", Some(share)));
        let control = Control { progress: &progress, cancel, threads: self.threads };
        let renderer =
            Renderer::open(source.scene, &self.options, control).map_err(|error| error.to_string())?;
        let opened = Opened {
            scene: scene.clone(),
            warnings: source.warnings,
            load_time: source.load_time,
            build: renderer.build_stats(),
            machine: renderer.machine(),
            cameras: cameras(renderer.scene()),
            animations: animations(renderer.scene()),
            bounds: renderer.scene().bounds().unwrap_or_default(),
            is_reload: false,
        };
        Ok((Ready { renderer, opened, label: source.label }, source.files))
    }
}

fn named(name: &str, number: usize) -> String {
    if name.is_empty() { number.to_string() } else { name.to_owned() }
}

fn cameras(scene: &Scene) -> Vec<CameraInfo> {
    let cameras = scene.cameras.iter().enumerate();
    cameras.map(|(i, camera)| CameraInfo { name: named(&camera.name, i) }).collect()
}

fn animations(scene: &Scene) -> Vec<AnimationInfo> {
    let clips = scene.rig.iter().flat_map(|rig| rig.clips.iter().enumerate());
    clips.map(|(i, clip)| AnimationInfo { name: named(&clip.name, i), duration: clip.duration }).collect()
}
