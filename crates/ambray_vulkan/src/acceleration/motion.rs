//! Structures of what moves: instances are placed anew, and structures of deforming meshes updated or built again.

use std::sync::Arc;

use ambray_scene::{Scene, animation::Updates};
use ash::vk;

use super::build::{self, Manner};
use super::structure::{Scratch, Structure};
use super::{Acceleration, Bounds, geometry, transform_of};
use crate::commands::Work;
use crate::error::Result;
use crate::layout::NONE;
use crate::{Context, Recorder};

/// A deforming mesh with the structures that follow it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Follower {
    /// Index of the mesh.
    pub(crate) mesh: u32,
    /// Number of its triangles in the structures.
    pub(crate) triangles: u32,
    /// Number of vertices of the mesh.
    vertices: u32,
    /// First of its triangles in the refs.
    first_ref: u32,
    /// Index of its slot.
    slot: usize,
    manner: Manner,
    /// Scratch memory of an update or build, bytes, aligned.
    scratch: u64,
}

/// What is done to a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// New boxes for the tree that is there.
    Update,
    /// A new tree in its place.
    Build,
}

/// An update or build of a structure of a deforming mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Job {
    /// Which of [`Acceleration::followers`].
    pub(crate) follower: usize,
    /// Which of its structures.
    pub(crate) kept: usize,
    pub(crate) mode: Mode,
    /// Address of the first vertex of the mesh.
    pub(crate) positions: u64,
    /// Address of the vertex numbers, which [`Acceleration::indices`] says.
    pub(crate) indices: u64,
}

impl Follower {
    pub(super) const fn new(
        mesh: u32,
        [vertices, triangles]: [u32; 2],
        first_ref: u32,
        slot: usize,
        manner: Manner,
    ) -> Self {
        Self { mesh, triangles, vertices, first_ref, slot, manner, scratch: 0 }
    }

    fn geometry(&self, positions: u64, indices: u64) -> vk::AccelerationStructureGeometryKHR<'static> {
        build::triangles(positions, self.vertices.into(), indices, self.manner)
    }

    /// Asks how much scratch memory it takes.
    pub(super) fn ask_scratch(&mut self, context: &Context) {
        let sizes = self.sizes(context);
        let need = sizes.build_scratch_size.max(sizes.update_scratch_size);
        self.scratch = need.next_multiple_of(u64::from(context.limits().scratch_alignment));
    }

    fn sizes(&self, context: &Context) -> vk::AccelerationStructureBuildSizesInfoKHR<'static> {
        build::sizes(context, self.geometry(0, 0), self.triangles, self.manner.flags(false))
    }
}

impl Acceleration {
    /// Takes the places of moving instances from `scene`, which must be the one that was built but for these. They show
    /// with the next build of a top-level structure.
    pub fn move_to(&mut self, scene: &Scene) {
        for (placement, placed) in self.placements.iter().zip(&mut self.placed) {
            if placement.instance != NONE {
                placed.transform = transform_of(scene, placement.instance);
                placed.bounds = geometry::place(self.bounds[placed.structure], &placed.transform);
            }
        }
    }

    /// The meshes whose vertices move.
    pub(crate) fn followers(&self) -> &[Follower] {
        &self.followers
    }

    /// How structures follow them.
    pub(crate) const fn updates(&self) -> &Updates {
        &self.options.updates
    }

    /// Vertex numbers of the triangles of a follower, in the order of its structures.
    pub(crate) fn indices(&self, follower: &Follower, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
        let first = follower.first_ref as usize;
        let refs = &self.refs[first..first + follower.triangles as usize];
        refs.iter().map(|&[_, triangle]| triangles[triangle as usize]).collect()
    }

    /// Box of a follower in its own space.
    pub(crate) fn bounds_of(&self, follower: &Follower) -> Bounds {
        self.bounds[follower.slot]
    }

    /// Number of structures kept for a follower.
    pub(crate) fn kept(&self, follower: &Follower) -> usize {
        self.structures[follower.slot].kept.len()
    }

    /// Which of them rays meet.
    pub(crate) fn shown(&self, follower: &Follower) -> usize {
        self.structures[follower.slot].shown
    }

    /// Makes the structure `kept` of a follower the one that rays meet, and takes the box of its vertices. Placements take
    /// both with [`move_to`](Self::move_to).
    pub(crate) fn show(&mut self, follower: usize, kept: usize, bounds: Bounds) {
        let slot = self.followers[follower].slot;
        self.structures[slot].shown = kept;
        self.bounds[slot] = bounds;
    }

    /// Adds an empty structure for a follower, to be built before it is shown.
    pub(crate) fn keep_another(&mut self, context: &Arc<Context>, follower: usize) -> Result<()> {
        let follower = self.followers[follower];
        let structure = Structure::new(
            context,
            "bottom-level structure of a pose",
            vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL,
            follower.sizes(context).acceleration_structure_size,
        )?;
        self.stats.bytes += structure.size();
        self.structures[follower.slot].kept.push(structure);
        Ok(())
    }

    /// Scratch memory with which [`record`](Self::record) can work on all followers, bytes: enough for the largest, and for
    /// all at once if that is not more than a batch.
    pub(crate) fn scratch_size(&self) -> u64 {
        let needs = self.followers.iter().map(|follower| follower.scratch);
        let (all, largest) = needs.fold((0, 0), |(all, largest), need| (all + need, need.max(largest)));
        all.min(self.options.batch).max(largest)
    }

    /// Records `jobs`, which are of different structures; later work must wait by a barrier. `scratch` has
    /// [`scratch_size`](Self::scratch_size) bytes.
    ///
    /// Vertices and vertex numbers must be as many as at the build, and the numbers the same. Everything must live until the
    /// commands have run, and nothing else may use the structures or the scratch memory meanwhile.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, jobs: &[Job], scratch: &Scratch, room: u64) {
        let mut rest = jobs;
        while !rest.is_empty() {
            if rest.len() < jobs.len() {
                // The scratch memory is used again.
                recorder.barrier(Work::BuildStructure, Work::BuildStructure);
            }
            let (mut used, mut offsets) = (0, Vec::new());
            for job in rest {
                let need = self.followers[job.follower].scratch;
                if used + need > room && used > 0 {
                    break;
                }
                offsets.push(used);
                used += need;
            }
            let (batch, later) = rest.split_at(offsets.len());
            self.record_batch(recorder, batch, scratch, &offsets);
            rest = later;
        }
    }

    fn record_batch(&self, recorder: &Recorder<'_>, jobs: &[Job], scratch: &Scratch, offsets: &[u64]) {
        let geometry = |job: &Job| [self.followers[job.follower].geometry(job.positions, job.indices)];
        let geometries: Vec<_> = jobs.iter().map(geometry).collect();
        let infos: Vec<_> = (jobs.iter().zip(&geometries).zip(offsets))
            .map(|((job, geometry), offset)| {
                let follower = &self.followers[job.follower];
                let structure = self.structures[follower.slot].kept[job.kept].handle();
                let device_address = scratch.address() + offset;
                let info = build::info(geometry, follower.manner.flags(false))
                    .dst_acceleration_structure(structure)
                    .scratch_data(vk::DeviceOrHostAddressKHR { device_address });
                match job.mode {
                    Mode::Build => info,
                    Mode::Update => info
                        .mode(vk::BuildAccelerationStructureModeKHR::UPDATE)
                        .src_acceleration_structure(structure),
                }
            })
            .collect();
        let range = |job: &Job| {
            let count = self.followers[job.follower].triangles;
            [vk::AccelerationStructureBuildRangeInfoKHR::default().primitive_count(count)]
        };
        let ranges: Vec<_> = jobs.iter().map(range).collect();
        let ranges: Vec<&[_]> = ranges.iter().map(|r| &r[..]).collect();
        // SAFETY: addresses are of buffers with as many vertices and vertex numbers as the follower has, which live until
        // this has run, as the caller promises; scratch ranges are aligned, disjoint and within the scratch memory; the
        // structures are as large as the driver asked for, differ from job to job, and what is updated was built with the
        // flag for it from geometry of the same form.
        unsafe {
            let commands = &recorder.context().acceleration;
            commands.cmd_build_acceleration_structures(recorder.raw(), &infos, &ranges);
        }
    }
}
