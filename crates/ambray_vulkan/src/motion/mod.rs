//! A scene that moves: vertices are deformed, structures updated and tables of placements written on the device.
//!
//! A pose is one submission ([`follow`]): what was rendered is kept for motion vectors, tables of placements are copied,
//! vertices are deformed, structures refitted, and clusters measured, which tell whether a structure has become poor. What
//! has is built anew in a second one ([`rebuild`]).

mod bytes;
mod clusters;
mod follow;
mod memory;
mod mesh;
mod programs;
mod rebuild;
mod sample;

use std::sync::Arc;

use ambray_core::{control::Control, frame::PoseStats};
use ambray_scene::{
    Scene,
    animation::{Deformer, Pose, UpdatePolicy},
};
use glam::Vec3;

use self::memory::Memory;
use self::mesh::{DeformingMesh, Shared};
pub(crate) use self::programs::MotionPrograms;
use self::rebuild::Rebuilds;
use crate::{
    Acceleration, CommandSet, Context, Recorder, Result, VulkanError, Work,
    acceleration::{Job, Mode},
    points::ROW,
    tables::{Previous, Tables},
};

/// What moves a scene.
#[derive(Debug)]
pub(crate) struct Motion {
    /// Dropped first: waits for what uses the rest.
    commands: CommandSet,
    programs: Arc<MotionPrograms>,
    meshes: Vec<DeformingMesh>,
    memory: Memory,
    /// Made when a frame that was rendered is first left.
    previous: Option<Previous>,
    /// Whether `previous` has what the last frame saw.
    has_moved: bool,
    /// Poses seen.
    clock: u64,
    context: Arc<Context>,
}

/// What moves at a pose.
#[derive(Debug)]
pub(crate) struct Move<'a> {
    /// The scene, placed.
    pub(crate) scene: &'a Scene,
    pub(crate) pose: &'a Pose,
}

impl Move<'_> {
    fn deformers(&self) -> &[Deformer] {
        deformers(self.scene)
    }
}

fn deformers(scene: &Scene) -> &[Deformer] {
    scene.rig.as_ref().map_or(&[], |rig| &rig.deformers)
}

/// What becomes of a structure of a mesh.
#[derive(Clone, Copy, Debug)]
struct Choice {
    /// Index into the meshes.
    mesh: usize,
    /// Which of its structures.
    built: usize,
    mode: Mode,
}

impl Motion {
    /// Uploads what deforms the meshes of `scene`, whose structures and tables these are. The scene still is as they were
    /// made from it, but for its placements.
    ///
    /// # Panics
    /// If a deformer does not fit its mesh.
    pub(crate) fn new(
        context: &Arc<Context>,
        scene: &Scene,
        acceleration: &Acceleration,
        tables: &Tables,
        programs: &Arc<MotionPrograms>,
    ) -> Result<Self> {
        let deformers = deformers(scene);
        let (mut meshes, mut boxes) = (Vec::<DeformingMesh>::new(), 0);
        for (follower, of) in acceleration.followers().iter().enumerate() {
            let Some(index) = deformers.iter().position(|deformer| deformer.mesh == of.mesh) else {
                // Said to deform, but nothing says how.
                continue;
            };
            let deformer = (&deformers[index], index);
            let mesh = DeformingMesh::new(context, scene, deformer, (acceleration, follower), tables, boxes)?;
            check_size(context, &mesh)?;
            boxes += mesh.box_bytes();
            meshes.push(mesh);
        }
        let room = acceleration.scratch_size();
        let mut motion = Self {
            commands: CommandSet::new(context)?,
            programs: Arc::clone(programs),
            memory: Memory::new(context, meshes.len(), boxes, room)?,
            meshes,
            previous: None,
            has_moved: false,
            clock: 0,
            context: Arc::clone(context),
        };
        if acceleration.updates().policy != UpdatePolicy::Rebuild {
            motion.assign_first(acceleration)?;
        }
        Ok(motion)
    }

    /// Device address of the tables for the next frame. `rendered` says whether one was rendered since the last pose.
    pub(crate) fn address(&self, tables: &Tables, rendered: bool) -> u64 {
        match &self.previous {
            Some(previous) if self.has_moved && !rendered => previous.address(),
            _ => tables.address(),
        }
    }

    /// Moves the scene. `rendered` says whether a frame of the last pose was rendered, and from then on that none of the new
    /// one was. Where memory is short, or the work is cancelled, all of the scene has moved or nothing has.
    pub(crate) fn pose(
        &mut self,
        moved: &Move<'_>,
        rendered: &mut bool,
        acceleration: &mut Acceleration,
        tables: &mut Tables,
        control: &Control<'_>,
    ) -> Result<PoseStats> {
        let updates = *acceleration.updates();
        let samples = self.samples(moved, updates.policy);
        let choices: Vec<_> = (self.meshes.iter().zip(&samples).enumerate())
            .map(|(index, (mesh, sample))| Choice {
                mesh: index,
                built: mesh.nearest(sample),
                mode: if updates.policy == UpdatePolicy::Rebuild { Mode::Build } else { Mode::Update },
            })
            .collect();
        let mut stats = self.follow(moved, rendered, &choices, acceleration, tables)?;
        let found = self.memory.found();
        for (choice, found) in choices.iter().zip(&found) {
            acceleration.show(self.meshes[choice.mesh].follower, choice.built, found.bounds);
        }
        acceleration.move_to(moved.scene);

        let decay = |choice: &Choice| match choice.mode {
            Mode::Update => clusters::decay(found[choice.mesh].cost, found[choice.mesh].fresh_cost),
            Mode::Build => 1.0,
        };
        let decays: Vec<f32> = choices.iter().map(decay).collect();
        let most = match updates.policy {
            UpdatePolicy::Refit | UpdatePolicy::Rebuild => 0,
            UpdatePolicy::Auto => 1,
            UpdatePolicy::Cache => updates.poses.max(1) as usize,
        };
        let is_poor = |decay: f32| most > 0 && decay > updates.poor;
        let poor: Vec<_> =
            choices.iter().zip(&decays).filter(|(_, d)| is_poor(**d)).map(|(choice, _)| *choice).collect();
        let Rebuilds { meshes: rebuilt, duration } =
            self.rebuild(&poor, samples, &found, acceleration, (most, control))?;
        stats.bottom_level += duration;
        self.clock += 1;
        for mesh in &mut self.meshes {
            let shown = acceleration.shown(&acceleration.followers()[mesh.follower]);
            mesh.built[shown].used = self.clock;
        }
        let is_refitted = |choice: &Choice| choice.mode == Mode::Update && !rebuilt.contains(&choice.mesh);
        let refitted: Vec<f32> = (choices.iter().zip(&decays))
            .filter(|(choice, _)| is_refitted(choice))
            .map(|(_, decay)| *decay)
            .collect();
        stats.decay = refitted.iter().copied().reduce(f32::max).unwrap_or(1.0);
        stats.refitted = refitted.len() as u32;
        stats.rebuilt = choices.len() as u32 - stats.refitted;
        stats.kept = acceleration.followers().iter().map(|f| acceleration.kept(f) as u32).sum();
        Ok(stats)
    }

    /// Some vertices of each mesh at the pose, if the policy compares poses.
    fn samples(&self, moved: &Move<'_>, policy: UpdatePolicy) -> Vec<Vec<Vec3>> {
        let sample = |mesh: &DeformingMesh| {
            if policy != UpdatePolicy::Cache {
                return Vec::new();
            }
            let deformer = &moved.deformers()[mesh.deformer];
            let (weights, joints) = mesh.posed(deformer, moved.pose);
            sample::posed(deformer, weights, joints)
        };
        self.meshes.iter().map(sample).collect()
    }

    fn job(&self, choice: &Choice) -> Job {
        let mesh = &self.meshes[choice.mesh];
        Job {
            follower: mesh.follower,
            kept: choice.built,
            mode: choice.mode,
            positions: mesh.positions(),
            indices: mesh.indices.address(),
        }
    }

    const fn shared(&self) -> Shared {
        Shared { boxes: self.memory.boxes.address(), results: self.memory.results.address() }
    }
}

/// Ends a submission: everything later sees tables and structures.
fn finish(recorder: &mut Recorder<'_>) {
    recorder.timestamp("structures");
    for work in [Work::Transfer, Work::Compute, Work::BuildStructure] {
        recorder.barrier(work, Work::Everything);
    }
}

/// Whether a dispatch can reach all vertices and triangles of `mesh`.
fn check_size(context: &Context, mesh: &DeformingMesh) -> Result<()> {
    let limit = ROW as u64 * u64::from(context.limits().workgroup_count[1]);
    let asked = u64::from(mesh.vertices.max(mesh.triangles));
    if asked <= limit {
        return Ok(());
    }
    Err(VulkanError::Limit { what: "vertices and triangles of a deforming mesh".into(), asked, limit })
}
