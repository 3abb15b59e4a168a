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

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;

    use ambray_core::trace::{Hit, Ray, Trace};
    use ambray_scene::animation::{Clips, Moment};
    use glam::Vec3;

    use super::*;
    use crate::BuildOptions;

    fn banner_at(time: f64) -> (Scene, Pose) {
        let mut scene = ambray_scene::moving::banner();
        let rig = Arc::clone(scene.rig.as_ref().unwrap());
        let pose = rig.pose(Some(&Moment { clips: Clips::All, time, repeat: true }));
        scene.place(&pose);
        scene.deform(&pose);
        (scene, pose)
    }

    /// Every third pose is not rendered; others hold the scene of the current pose.
    #[test]
    fn scenes_take_turns_without_copies() {
        let mut backend = CpuBackend::new(Arc::new(ambray_scene::moving::banner()), BuildOptions::default());
        let cloth = ambray_scene::moving::banner().rig.unwrap().deformers[0].mesh as usize;
        let mut held;
        let mut places = Vec::new();
        let mut rendered = None;
        for step in 0..12 {
            let (expected, pose) = banner_at(0.3 * f64::from(step));
            backend.pose(&pose, 1).unwrap();
            held = Arc::clone(backend.world().surfaces().scene());
            assert_eq!(held.meshes, expected.meshes);
            assert_eq!(held.instances, expected.instances);
            places.push(Arc::as_ptr(&held.meshes[cloth]));
            let previous =
                backend.previous.as_ref().map(|previous| previous.scene().meshes[cloth].positions.clone());
            assert_eq!(previous, rendered);
            if step % 3 != 2 {
                backend.rendered.store(true, Ordering::Relaxed);
                rendered = Some(held.meshes[cloth].positions.clone());
            }
        }
        places.sort_unstable();
        places.dedup();
        assert!(places.len() <= 3, "{} copies of the mesh", places.len());
    }

    #[test]
    fn poses_are_traced_as_scenes_opened_there() {
        let mut backend = CpuBackend::new(Arc::new(ambray_scene::moving::banner()), BuildOptions::default());
        let rays: Vec<_> = (0..2000)
            .map(|i| {
                let target = Vec3::new((i % 50) as f32 / 25.0 - 1.0, (i / 50) as f32 / 20.0 + 0.3, 0.0);
                let origin = Vec3::new(0.2, 1.6, 4.0);
                Ray { origin, t_max: 100.0, direction: (target - origin).normalize(), seed: i }
            })
            .collect();
        let trace = |backend: &CpuBackend| {
            let mut hits = vec![Hit::MISS; rays.len()];
            backend.world().closest_hits(&rays, &mut hits);
            hits
        };
        let mut before = trace(&backend);
        for time in [0.7, 1.6, 0.2] {
            let (scene, pose) = banner_at(time);
            let stats = backend.pose(&pose, 2).unwrap();
            assert_eq!((stats.refitted + stats.rebuilt, stats.kept), (1, 1));
            assert!(stats.total >= stats.deformation + stats.bottom_level + stats.top_level);
            let after = trace(&backend);
            assert_ne!(after, before);
            assert_eq!(after, trace(&CpuBackend::new(Arc::new(scene), BuildOptions::default())));
            before = after;
        }
    }
}
