//! The submission that moves everything to a pose.

use ambray_core::frame::PoseStats;
use glam::Affine3A;

use super::bytes::Bytes;
use super::programs::Step;
use super::{Choice, Motion, Move};
use crate::{
    Acceleration, Result, Work,
    acceleration::Mode,
    tables::{Previous, Tables},
};

/// Label of the deformation among the timings.
const DEFORMATION: &str = "deformation";

/// What the shaders read at a pose.
struct Arguments {
    bytes: Bytes,
    /// Of each choice, addresses of the deformation, of the clusters of its structure, and of those for the pose.
    addresses: Vec<[u64; 3]>,
}

impl Motion {
    /// Copies tables, deforms, and does what `choices` say to structures; `rendered` as in [`Motion::pose`]. Waits.
    pub(super) fn follow(
        &mut self,
        moved: &Move<'_>,
        rendered: &mut bool,
        choices: &[Choice],
        acceleration: &Acceleration,
        tables: &mut Tables,
    ) -> Result<PoseStats> {
        let (instances, shapes) = tables.changes(moved.scene);
        let leaves_rendered = *rendered;
        if leaves_rendered && self.previous.is_none() {
            self.previous = Some(Previous::new(&self.context, tables)?);
        }
        // Parts are aligned, and so is what follows them.
        let slack = 64;
        let entries = size_of_val(&instances.entries[..]) + size_of_val(&shapes.entries[..]) + slack;
        let size = self.arguments(moved, choices).bytes.len();
        self.memory.reserve(size + entries as u64)?;
        // Again, since what is written holds addresses of its own parts.
        let Arguments { mut bytes, addresses } = self.arguments(moved, choices);
        let instances_at = bytes.push(&instances.entries);
        let shapes_at = bytes.push(&shapes.entries);
        self.memory.write(&bytes);
        let jobs: Vec<_> = choices.iter().map(|choice| self.job(choice)).collect();
        let is_measured = choices.iter().any(|choice| choice.mode == Mode::Update);

        let Self { commands, programs, meshes, memory, previous, .. } = self;
        commands.submit(|recorder| {
            if let Some(previous) = previous.as_ref().filter(|_| leaves_rendered) {
                previous.record(recorder, tables);
                // What was copied is overwritten.
                recorder.barrier(Work::Transfer, Work::Transfer);
            }
            recorder.barrier(Work::HostWrite, Work::Transfer);
            recorder.copy(&memory.staging, 0, &memory.arguments, 0, size);
            tables.instances.record(recorder, &instances, &memory.staging, instances_at);
            tables.shape_instances.record(recorder, &shapes, &memory.staging, shapes_at);
            // Empty boxes.
            recorder.fill(&memory.results, u32::MAX);
            recorder.fill(&memory.boxes, u32::MAX);
            recorder.barrier(Work::Transfer, Work::Compute);
            for (choice, [deformation, ..]) in choices.iter().zip(&addresses) {
                programs.record(recorder, Step::Deform, *deformation, meshes[choice.mesh].vertices);
            }
            recorder.timestamp(DEFORMATION);
            recorder.barrier(Work::Compute, Work::Compute);
            recorder.barrier(Work::Compute, Work::BuildStructure);
            if is_measured {
                for step in [Step::Assign, Step::Measure, Step::Cost] {
                    for (choice, [_, built, fresh]) in choices.iter().zip(&addresses) {
                        let count = meshes[choice.mesh].triangles;
                        programs.record(recorder, step, *fresh, count);
                        if step != Step::Assign {
                            programs.record(recorder, step, *built, count);
                        }
                    }
                    recorder.barrier(Work::Compute, Work::Compute);
                }
            }
            acceleration.record(recorder, &jobs, &memory.scratch, memory.room);
            memory.read_back(recorder);
            super::finish(recorder);
            Ok(())
        })?;
        let mut stats = PoseStats::default();
        for timing in commands.wait()? {
            let duration = timing.duration.unwrap_or_default();
            let is_deformation = timing.label == DEFORMATION;
            *(if is_deformation { &mut stats.deformation } else { &mut stats.bottom_level }) += duration;
        }
        self.has_moved |= leaves_rendered;
        *rendered = false;
        tables.instances.accept(instances);
        tables.shape_instances.accept(shapes);
        Ok(stats)
    }

    /// What the shaders read, with the addresses that it has in the memory there is now.
    fn arguments(&self, moved: &Move<'_>, choices: &[Choice]) -> Arguments {
        let base = self.memory.arguments.address();
        let mut bytes = Bytes::default();
        let mut skin = |joints: &Vec<Affine3A>| {
            let columns: Vec<_> = joints.iter().map(Affine3A::to_cols_array_2d).collect();
            base + bytes.push(&columns)
        };
        let skins: Vec<u64> = moved.pose.joints.iter().map(&mut skin).collect();
        let mut addresses = Vec::with_capacity(choices.len());
        for choice in choices {
            let mesh = &self.meshes[choice.mesh];
            let deformer = &moved.deformers()[mesh.deformer];
            let (weights, _) = mesh.posed(deformer, moved.pose);
            let joints = deformer.skin.map_or(0, |skin| skins[skin as usize]);
            let place = (self.shared(), choice.mesh);
            addresses.push([
                mesh.deformation(&mut bytes, base, weights, joints, place),
                mesh.clusters(&mut bytes, base, Some(choice.built), place),
                mesh.clusters(&mut bytes, base, None, place),
            ]);
        }
        Arguments { bytes, addresses }
    }
}
