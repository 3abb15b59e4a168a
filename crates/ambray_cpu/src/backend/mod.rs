//! The CPU backend: the passes of a frame, and points evaluated one by one.
//!
//! Pass 1 runs over tiles of 16 × 16 pixels: primary rays, direct light, and the gather of openness and near radiance
//! with the pixels of a tile ordered by sample class, so that the rays of a batch are nearly parallel. Pass 2 filters
//! and composes in bands of 16 rows. Every pixel is a pure function of the scene, the settings and its place, so the
//! picture does not depend on the number of threads.

mod motion;
mod pass1;
mod pass2;
mod planes;
mod points;
mod record;
mod rival;
mod segment;
mod stages;
mod temporal;
mod vectors;
mod world;

use std::{
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

use ambray_core::{
    control::{Cancelled, Control},
    frame::{Frame, FrameStats},
    gather::GatherParams,
    query::{QueryPoint, QueryResult},
    sampling::SampleSets,
    settings::{Settings, Temporal},
    view::View,
};
use ambray_scene::{Scene, surface::Surfaces};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

pub(crate) use segment::TILE;
pub use world::CpuWorld;

use planes::Planes;
use stages::Stage;
use temporal::{History, Sequel};

use crate::BuildOptions;

/// Why the backend returned nothing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BackendError {
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// More rays were to be recorded than there are tags for.
    #[error("the picture has too many rays to record: at most 2^32, counted by pixels and by pairs of rays")]
    TooManyRays,
    /// The threads could not be started.
    #[error("the threads could not be started")]
    Threads(#[from] ThreadPoolBuildError),
}

/// A scene made ready for rendering on the CPU.
#[derive(Debug)]
pub struct CpuBackend {
    world: CpuWorld,
    /// Surfaces at the pose of the last frame that was rendered, if the scene has moved since: where motion vectors begin.
    previous: Option<Arc<Surfaces>>,
    /// A scene to be moved to the next pose.
    spare: Option<Arc<Scene>>,
    /// Whether a frame of the current pose was rendered.
    rendered: AtomicBool,
    /// What the last frame left for the next one, where light is accumulated.
    history: Mutex<Option<History>>,
    /// Memory for the next frame.
    planes: Mutex<Planes>,
    /// The threads of the last call, kept for the next one.
    pool: Mutex<Option<Pool>>,
}

/// Threads, and how many were asked for: 0 for one a core.
type Pool = (usize, Arc<ThreadPool>);

impl CpuBackend {
    /// Builds the trees of `scene` with a thread for each core.
    ///
    /// # Panics
    /// As [`with_threads`](Self::with_threads).
    #[must_use]
    pub fn new(scene: Arc<Scene>, options: BuildOptions) -> Self {
        Self::with_threads(scene, options, 0)
    }

    /// Builds the trees of `scene` with `threads` threads, 0 for one a core, and keeps these for the first frame. Where they
    /// cannot be started the caller's work instead, and the first frame says so.
    ///
    /// # Panics
    /// If indices within the scene are out of range, or the machine lacks the instruction set asked for.
    #[must_use]
    pub fn with_threads(scene: Arc<Scene>, options: BuildOptions, threads: usize) -> Self {
        let (world, pool) = by_threads(threads, || CpuWorld::new(scene, options));
        Self {
            world,
            previous: None,
            spare: None,
            rendered: AtomicBool::new(false),
            history: Mutex::default(),
            planes: Mutex::default(),
            pool: Mutex::new(pool),
        }
    }

    /// The scene as the method sees it.
    #[must_use]
    pub const fn world(&self) -> &CpuWorld {
        &self.world
    }

    /// Renders a frame. With [`Temporal::On`] it continues the last one.
    pub fn render(
        &self,
        settings: &Settings,
        view: &View,
        control: Control<'_>,
    ) -> Result<Frame, BackendError> {
        let start = Instant::now();
        let pool = self.pool(control.threads)?;
        let samples = SampleSets::of(settings);
        let params = GatherParams::new(settings, view, &samples);
        let earlier = self.history().take().filter(|earlier| earlier.suits(settings, view));
        let scene_moved = !self.rendered.swap(true, Ordering::Relaxed);
        let accumulation = (settings.temporal == Temporal::On).then(|| Sequel {
            surfaces: self.previous.as_ref().filter(|_| scene_moved),
            scene_moved,
            earlier: earlier.as_ref(),
        });
        pool.install(|| {
            let (sequel, vectors) = (accumulation.as_ref(), self.world.vectors());
            // Taken out, so that frames that are rendered at once do not wait for each other.
            let mut planes = std::mem::take(&mut *self.planes());
            let mut pass1 = pass1::run(&self.world, settings, view, &params, sequel, &mut planes, control)?;
            let mut times = pass1.clock.shares(pass1.elapsed);
            let pass2 = if settings.method.is_screen_space() {
                let rival = rival::run(&self.world, settings, view, &params, &mut pass1, control)?;
                let pass2 =
                    pass2::run(&mut pass1, &rival.settings, view, None, vectors, &mut planes, control)?;
                pass1.ambient = rival.raw;
                [times.ambient, times.filter] = rival.elapsed;
                times.tracing += rival.tracing;
                pass2
            } else {
                pass2::run(&mut pass1, settings, view, sequel, vectors, &mut planes, control)?
            };
            let (width, height) = view.camera.size();
            times.filter += pass2.elapsed;
            let stages = [Stage::Primary, Stage::Direct, Stage::Ambient, Stage::Filter];
            let threads = pool.current_num_threads();
            times.idle = pass1.clock.idle(&stages, pass1.elapsed + pass2.elapsed, threads);
            times.total = start.elapsed();
            if sequel.is_some() {
                *self.history() = Some(History::new(settings, view, pass1.guides, pass2.means));
            } else {
                planes.give(pass1.guides);
            }
            planes.give(pass1.then);
            planes.give(pass1.second);
            planes.give(pass1.bent);
            *self.planes() = planes;
            Ok(Frame {
                width,
                height,
                beauty: pass2.beauty,
                gbuffer: pass1.gbuffer,
                ambient_raw: pass1.ambient,
                ambient: pass2.ambient,
                bent: pass2.bent,
                history: pass2.history,
                view: view.clone(),
                stats: FrameStats { rays: pass1.rays, times, threads },
            })
        })
    }

    /// Takes back a frame that is not needed any more: the next one of its size is written to its memory, which saves the
    /// system the work of mapping and clearing it.
    pub fn recycle(&self, frame: Frame) {
        self.planes().give_frame(frame);
    }

    fn planes(&self) -> MutexGuard<'_, Planes> {
        // Whole at any time, so a panic of another thread does not matter.
        self.planes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Forgets earlier frames: the next one begins a sequence.
    pub fn forget_frames(&self) {
        *self.history() = None;
    }

    fn history(&self) -> MutexGuard<'_, Option<History>> {
        // Whole or empty at any time, so a panic of another thread does not matter.
        self.history.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Evaluates ambient light at `points`; result `i` belongs to point `i`.
    pub fn query(
        &self,
        settings: &Settings,
        view: &View,
        points: &[QueryPoint],
        control: Control<'_>,
    ) -> Result<Vec<QueryResult>, BackendError> {
        let samples = SampleSets::of(settings);
        let params = GatherParams::new(settings, view, &samples);
        let pool = self.pool(control.threads)?;
        Ok(pool.install(|| points::run(&self.world, settings, view, &params, points, control))?)
    }

    /// `threads` threads, 0 for one a core.
    fn pool(&self, threads: usize) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
        // The slot is always whole, so a panic of another thread does not matter.
        let mut slot = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((count, pool)) = &*slot
            && *count == threads
        {
            return Ok(Arc::clone(pool));
        }
        let (_, pool) = slot.insert(started(threads)?);
        Ok(Arc::clone(pool))
    }
}

fn started(threads: usize) -> Result<Pool, ThreadPoolBuildError> {
    Ok((threads, Arc::new(ThreadPoolBuilder::new().num_threads(threads).build()?)))
}

/// What `build` returns, built by `threads` threads if they can be started, and these.
fn by_threads<T: Send>(threads: usize, build: impl FnOnce() -> T + Send) -> (T, Option<Pool>) {
    match started(threads) {
        Ok(pool) => (pool.1.install(build), Some(pool)),
        Err(error) => {
            log::warn!("built by the threads of the caller: {error}");
            (build(), None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_threads_build_as_are_asked_for() {
        for threads in [1, 3] {
            let (used, pool) = by_threads(threads, rayon::current_num_threads);
            assert_eq!((used, pool.unwrap().0), (threads, threads));
        }
        let scene = Arc::new(ambray_scene::moving::banner());
        let backend = CpuBackend::with_threads(scene, BuildOptions::default(), 3);
        let kept = backend.pool.lock().unwrap().clone().unwrap();
        assert_eq!((kept.0, kept.1.current_num_threads()), (3, 3));
        assert!(Arc::ptr_eq(&backend.pool(3).unwrap(), &kept.1));
    }
}
