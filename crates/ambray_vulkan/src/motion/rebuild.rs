//! Builds of structures that have become poor, and what is known of them.

use std::time::Duration;

use ambray_core::control::Control;
use glam::Vec3;

use super::bytes::Bytes;
use super::clusters::Built;
use super::memory::Found;
use super::mesh::DeformingMesh;
use super::programs::Step;
use super::{Choice, Motion};
use crate::{Acceleration, Result, Work, acceleration::Mode};

/// Structures that were built because others were poor.
#[derive(Debug, Default)]
pub(super) struct Rebuilds {
    /// Indices of their meshes.
    pub(super) meshes: Vec<usize>,
    pub(super) duration: Duration,
}

impl Motion {
    /// Builds structures for the pose that the device is at, as further ones while there are fewer than
    /// `most` of a mesh, else in place of the one that was not used for the longest time. `samples` and `found` are of that pose, of all meshes.
    pub(super) fn rebuild(
        &mut self,
        poor: &[Choice],
        mut samples: Vec<Vec<Vec3>>,
        found: &[Found],
        acceleration: &mut Acceleration,
        (most, control): (usize, &Control<'_>),
    ) -> Result<Rebuilds> {
        let mut choices = Vec::new();
        for &choice in poor {
            control.check()?;
            let built = self.place_for(choice, most, acceleration)?;
            choices.push(Choice { built, mode: Mode::Build, ..choice });
        }
        if choices.is_empty() {
            return Ok(Rebuilds::default());
        }
        let jobs: Vec<_> = choices.iter().map(|choice| self.job(choice)).collect();
        let Self { commands, memory, .. } = self;
        commands.submit(|recorder| {
            // Vertices come from an earlier submission, which ended with a barrier to everything.
            acceleration.record(recorder, &jobs, &memory.scratch, memory.room);
            super::finish(recorder);
            Ok(())
        })?;
        let duration = commands.wait()?.iter().filter_map(|timing| timing.duration).sum();
        for choice in &choices {
            let mesh = &mut self.meshes[choice.mesh];
            mesh.accept(choice.built, std::mem::take(&mut samples[choice.mesh]));
            acceleration.show(mesh.follower, choice.built, found[choice.mesh].bounds);
        }
        Ok(Rebuilds { meshes: choices.iter().map(|choice| choice.mesh).collect(), duration })
    }

    /// Where to build what is to take the place of `choice`.
    fn place_for(&mut self, choice: Choice, most: usize, acceleration: &mut Acceleration) -> Result<usize> {
        let mesh = &mut self.meshes[choice.mesh];
        // A failure may have left one that was not built.
        if let Some(unbuilt) = mesh.built.iter().position(|built| built.sample.is_none()) {
            return Ok(unbuilt);
        }
        if mesh.built.len() >= most {
            // What has not been used for the longest time goes, as on the CPU.
            let used = |i: &usize| (mesh.built[*i].used, *i != choice.built);
            return Ok((0..mesh.built.len()).min_by_key(used).unwrap_or(choice.built));
        }
        let built = Built::new(&self.context, mesh.triangles)?;
        acceleration.keep_another(&self.context, mesh.follower)?;
        mesh.built.push(built);
        Ok(mesh.built.len() - 1)
    }

    /// Puts the triangles of the structures that were built with the scene into clusters.
    pub(super) fn assign_first(&mut self, acceleration: &Acceleration) -> Result<()> {
        if self.meshes.is_empty() {
            return Ok(());
        }
        let followers = self.meshes.iter().map(|mesh| &acceleration.followers()[mesh.follower]);
        self.memory.set_bounds(followers.map(|follower| acceleration.bounds_of(follower)))?;
        let size = self.first_clusters().0.len();
        self.memory.reserve(size)?;
        // Again, since what is written holds addresses of its own parts.
        let (bytes, addresses) = self.first_clusters();
        self.memory.write(&bytes);
        let Self { commands, programs, meshes, memory, .. } = self;
        commands.submit(|recorder| {
            recorder.barrier(Work::HostWrite, Work::Transfer);
            recorder.copy(&memory.staging, 0, &memory.arguments, 0, size);
            recorder.barrier(Work::Transfer, Work::Compute);
            for (mesh, clusters) in meshes.iter().zip(&addresses) {
                programs.record(recorder, Step::Assign, *clusters, mesh.triangles);
            }
            super::finish(recorder);
            Ok(())
        })?;
        commands.wait()?;
        Ok(())
    }

    fn first_clusters(&self) -> (Bytes, Vec<u64>) {
        let (base, mut bytes) = (self.memory.arguments.address(), Bytes::default());
        let mut arguments = |(index, mesh): (usize, &DeformingMesh)| {
            mesh.clusters(&mut bytes, base, Some(0), (self.shared(), index))
        };
        let addresses = self.meshes.iter().enumerate().map(&mut arguments).collect();
        (bytes, addresses)
    }
}
