//! The tables as they were when the last frame was rendered: where the motion of a surface begins.

use std::sync::Arc;

use super::{TABLE, Tables};
use crate::{
    Buffer, Context, Location, Recorder, Result,
    layout::{NONE, SceneTables},
};

/// Copies of what moves. What does not is read from the tables themselves.
#[derive(Debug)]
pub(crate) struct Previous {
    instances: Buffer,
    shape_instances: Buffer,
    /// Of deforming meshes alone, one after the other.
    positions: Buffer,
    normals: Buffer,
    addresses: Buffer,
}

/// Bytes of a position and of a normal.
const VECTOR: u64 = 12;

impl Previous {
    /// Makes room for copies of what moves in `tables`.
    pub(crate) fn new(context: &Arc<Context>, tables: &Tables) -> Result<Self> {
        let instances = tables.instances.twin(context, "instances of the last frame")?;
        let shape_instances = tables.shape_instances.twin(context, "placed shapes of the last frame")?;
        let (mut vertices, mut with_normals) = (0, 0);
        for mesh in tables.meshes.iter().filter(|mesh| mesh.previous_vertex != NONE) {
            vertices += u64::from(mesh.vertices);
            with_normals += if mesh.previous_normal == NONE { 0 } else { u64::from(mesh.vertices) };
        }
        let room = |name: &str, count: u64| context.buffer(name, count * VECTOR, TABLE, Location::Device);
        let positions = room("positions of the last frame", vertices)?;
        let normals = room("normals of the last frame", with_normals)?;
        let content = SceneTables {
            previous_instances: instances.address(),
            previous_shape_instances: shape_instances.address(),
            previous_positions: positions.address(),
            previous_normals: normals.address(),
            ..tables.content
        };
        let addresses = context.upload("tables after a move", TABLE, &[content])?;
        Ok(Self { instances, shape_instances, positions, normals, addresses })
    }

    /// Device address of the [`SceneTables`] with these as what the last frame saw.
    pub(crate) const fn address(&self) -> u64 {
        self.addresses.address()
    }

    /// Records the copies from `tables`.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, tables: &Tables) {
        tables.instances.record_copy(recorder, &self.instances);
        tables.shape_instances.record_copy(recorder, &self.shape_instances);
        for mesh in tables.meshes.iter().filter(|mesh| mesh.previous_vertex != NONE) {
            let size = VECTOR * u64::from(mesh.vertices);
            let at = |index: u32| VECTOR * u64::from(index);
            let (from, to) = (at(mesh.first_vertex), at(mesh.previous_vertex));
            recorder.copy(&tables.positions, from, &self.positions, to, size);
            if mesh.previous_normal != NONE {
                let (from, to) = (at(mesh.first_normal), at(mesh.previous_normal));
                recorder.copy(&tables.normals, from, &self.normals, to, size);
            }
        }
    }
}
