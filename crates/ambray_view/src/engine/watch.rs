//! Reads a scene again when its files change.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    sync::{Arc, mpsc},
    time::{Duration, Instant, SystemTime},
};

use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};

use super::{guard::caught, loader::Loader};
use crate::model::SceneRef;

/// Files count as written when nothing has happened to them for so long.
const QUIET: Duration = Duration::from_millis(200);
/// A file that is missing, as between removal and replacement, is waited for no longer than this.
const PATIENCE: Duration = Duration::from_secs(3);

/// What is to be watched.
#[derive(Debug)]
pub(super) enum Follow {
    /// The files of a scene.
    Scene(SceneRef, Vec<PathBuf>),
    /// One of the watched folders has seen a change.
    Changed(Vec<PathBuf>),
    /// Nothing any more.
    Stop,
}

/// The files of the scene that is open.
#[derive(Debug)]
struct Watched {
    scene: SceneRef,
    files: BTreeSet<PathBuf>,
    /// Watches the folders while it lives.
    _watcher: Option<RecommendedWatcher>,
}

/// Follows files until it is told to stop. `sender` is where changes come in too.
pub(super) fn run(loader: &Arc<Loader>, sender: &mpsc::Sender<Follow>, follow: &mpsc::Receiver<Follow>) {
    let mut watched: Option<Watched> = None;
    while let Ok(message) = follow.recv() {
        match message {
            Follow::Stop => return,
            Follow::Scene(scene, files) => watched = Some(Watched::new(scene, &files, sender)),
            Follow::Changed(paths) => {
                let Some(current) = &watched else { continue };
                if !current.concerns(&paths) {
                    continue;
                }
                match settle(current, follow) {
                    Settled::Still => loader.reload(&current.scene),
                    Settled::Other(scene, files) => watched = Some(Watched::new(scene, &files, sender)),
                    Settled::Stop => return,
                }
            }
        }
    }
}

/// How waiting for silence ended.
enum Settled {
    Still,
    Other(SceneRef, Vec<PathBuf>),
    Stop,
}

/// Waits until the files are written.
fn settle(watched: &Watched, follow: &mpsc::Receiver<Follow>) -> Settled {
    let begin = Instant::now();
    let mut last = begin;
    let mut seen = stamps(&watched.files);
    loop {
        match follow.recv_timeout(QUIET / 2) {
            Ok(Follow::Stop) | Err(mpsc::RecvTimeoutError::Disconnected) => return Settled::Stop,
            Ok(Follow::Scene(scene, files)) => return Settled::Other(scene, files),
            Ok(Follow::Changed(paths)) if watched.concerns(&paths) => last = Instant::now(),
            Ok(Follow::Changed(_)) | Err(mpsc::RecvTimeoutError::Timeout) => {}
        }
        if last.elapsed() < QUIET {
            continue;
        }
        let now = stamps(&watched.files);
        let is_whole = now.iter().all(Option::is_some) || begin.elapsed() > PATIENCE;
        if now == seen && is_whole {
            return Settled::Still;
        }
        (seen, last) = (now, Instant::now());
    }
}

/// Size and time of the last change of each file; `None` for those that are missing.
fn stamps(files: &BTreeSet<PathBuf>) -> Vec<Option<(u64, Option<SystemTime>)>> {
    let stamp = |path: &PathBuf| fs::metadata(path).ok().map(|meta| (meta.len(), meta.modified().ok()));
    files.iter().map(stamp).collect()
}

impl Watched {
    fn new(scene: SceneRef, files: &[PathBuf], changes: &mpsc::Sender<Follow>) -> Self {
        let files: BTreeSet<PathBuf> = files.iter().map(|path| absolute(path)).collect();
        let watcher = caught(|| watcher(&files, changes.clone())).unwrap_or(None);
        Self { scene, files, _watcher: watcher }
    }

    fn concerns(&self, paths: &[PathBuf]) -> bool {
        paths.iter().any(|path| self.files.contains(path))
    }
}

/// Watches the folders of `files`: editors replace files, and a watch on a file would end with it. Where the system cannot
/// watch, nothing is read again.
fn watcher(files: &BTreeSet<PathBuf>, changes: mpsc::Sender<Follow>) -> Option<RecommendedWatcher> {
    let folders: BTreeSet<&Path> = files.iter().filter_map(|path| path.parent()).collect();
    if folders.is_empty() {
        return None;
    }
    let tell = move |event: notify::Result<notify::Event>| {
        if let Ok(event) = event
            && !matches!(event.kind, EventKind::Access(_))
        {
            // The receiver ends with the engine.
            let _ = changes.send(Follow::Changed(event.paths));
        }
    };
    let mut watcher = notify::recommended_watcher(tell)
        .map_err(|error| log::warn!("changes are not followed: {error}"))
        .ok()?;
    for folder in folders {
        if let Err(error) = watcher.watch(folder, RecursiveMode::NonRecursive) {
            log::warn!("changes in {} are not followed: {error}", folder.display());
        }
    }
    Some(watcher)
}

/// `path` as events name it.
fn absolute(path: &Path) -> PathBuf {
    let full = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    // Links in the way are resolved, but not the file itself: it may be one that is replaced.
    match (full.parent().and_then(|folder| folder.canonicalize().ok()), full.file_name()) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => full,
    }
}
