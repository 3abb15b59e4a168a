//! The backend shows its scene at another pose.

use std::{sync::Arc, time::Instant};

use ambray_core::frame::PoseStats;
use ambray_scene::{Scene, animation::Pose};

use super::{BackendError, CpuBackend};

impl CpuBackend {
    /// Moves the scene to `pose`, which is of its rig.
    ///
    /// The scene at the current pose is left as it is, since others may hold it, and so is the one where motion vectors
    /// begin; another one is moved, which was shown before these.
    pub fn pose(&mut self, pose: &Pose, threads: usize) -> Result<PoseStats, BackendError> {
        let start = Instant::now();
        let pool = self.pool(threads)?;
        let mut scene = self.next_scene();
        // Copies only what others hold, and so nothing once each scene has meshes of its own that deform.
        let moved = Arc::make_mut(&mut scene);
        pool.install(|| {
            moved.place(pose);
            moved.deform(pose);
        });
        let deformation = start.elapsed();
        let stats = pool.install(|| self.world.update(scene));
        Ok(PoseStats { deformation, total: start.elapsed(), ..stats })
    }

    /// A scene to be moved, in some pose. The current one becomes the previous one if it was rendered, else the next spare.
    fn next_scene(&mut self) -> Arc<Scene> {
        let current = self.world.surfaces();
        let free = if std::mem::take(self.rendered.get_mut()) {
            let earlier = self.previous.replace(Arc::clone(current));
            earlier.map(|surfaces| Arc::clone(surfaces.scene())).or_else(|| self.spare.take())
        } else {
            self.spare.replace(Arc::clone(current.scene()))
        };
        free.unwrap_or_else(|| Arc::clone(current.scene()))
    }
}
