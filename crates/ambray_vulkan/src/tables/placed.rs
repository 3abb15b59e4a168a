//! Where instances are: the tables that every pose changes.

use std::sync::Arc;

use ambray_scene::{Motion, Scene, surface::normal_matrix};
use bytemuck::Pod;
use glam::{Affine3A, Mat3A};

use super::TABLE;
use crate::{Buffer, Context, Recorder, Result, layout};

/// A table of placements on the device, and what is in it.
#[derive(Debug)]
pub(crate) struct PlacedTable<T> {
    content: Vec<T>,
    buffer: Buffer,
}

/// Entries of a table that a pose changes, to be copied there.
#[derive(Debug)]
pub(crate) struct Change<T> {
    pub(crate) first: usize,
    pub(crate) entries: Vec<T>,
}

impl<T: Pod + PartialEq> PlacedTable<T> {
    pub(super) fn new(context: &Arc<Context>, name: &str, content: Vec<T>) -> Result<Self> {
        let buffer = context.upload(name, TABLE, &content)?;
        Ok(Self { content, buffer })
    }

    pub(crate) const fn address(&self) -> u64 {
        self.buffer.address()
    }

    /// Everything from the first to the last entry that `content` has otherwise.
    fn change(&self, content: &[T]) -> Change<T> {
        let differs = |i: &usize| self.content[*i] != content[*i];
        let first = (0..content.len()).find(differs).unwrap_or(content.len());
        let end = (first..content.len()).rev().find(differs).map_or(first, |last| last + 1);
        Change { first, entries: content[first..end].to_vec() }
    }

    /// Records the copy of `change`, whose entries are in `staging` at `offset`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        change: &Change<T>,
        staging: &Buffer,
        offset: u64,
    ) {
        let (at, size) = (change.first * size_of::<T>(), size_of_val(&change.entries[..]));
        recorder.copy(staging, offset, &self.buffer, at as u64, size as u64);
    }

    /// Records the copy of the whole table to `target`.
    pub(crate) fn record_copy(&self, recorder: &mut Recorder<'_>, target: &Buffer) {
        recorder.copy(&self.buffer, 0, target, 0, self.buffer.size());
    }

    /// Takes note of a copy that has run.
    pub(crate) fn accept(&mut self, change: Change<T>) {
        self.content[change.first..change.first + change.entries.len()].copy_from_slice(&change.entries);
    }

    /// Makes room for a copy of the table.
    pub(super) fn twin(&self, context: &Arc<Context>, name: &str) -> Result<Buffer> {
        context.buffer(name, self.buffer.size(), TABLE, crate::Location::Device)
    }
}

pub(super) fn instances(scene: &Scene) -> Vec<layout::Instance> {
    scene.instances.iter().map(instance).collect()
}

pub(super) fn shape_instances(scene: &Scene) -> Vec<layout::ShapeInstance> {
    scene.shape_instances.iter().map(|placed| shape_instance(scene, placed)).collect()
}

impl PlacedTable<layout::Instance> {
    /// What changes with the placements of `scene`. What is static stays.
    pub(super) fn change_to(&self, scene: &Scene) -> Change<layout::Instance> {
        let now = self.content.iter().zip(&scene.instances).map(|(kept, placed)| match placed.motion {
            Motion::Static => *kept,
            Motion::Rigid | Motion::Deforming => instance(placed),
        });
        self.change(&now.collect::<Vec<_>>())
    }
}

impl PlacedTable<layout::ShapeInstance> {
    /// As above.
    pub(super) fn change_to(&self, scene: &Scene) -> Change<layout::ShapeInstance> {
        let now = self.content.iter().zip(&scene.shape_instances).map(|(kept, placed)| match placed.motion {
            Motion::Static => *kept,
            Motion::Rigid | Motion::Deforming => shape_instance(scene, placed),
        });
        self.change(&now.collect::<Vec<_>>())
    }
}

fn instance(placed: &ambray_scene::Instance) -> layout::Instance {
    let m = placed.world_from_object.matrix3;
    layout::Instance {
        world_from_object: columns(&placed.world_from_object),
        normal_from_object: normal_columns(m),
        side: if m.determinant() < 0.0 { -1.0 } else { 1.0 },
        mesh: placed.mesh,
        motion: placed.motion as u32,
    }
}

fn shape_instance(scene: &Scene, placed: &ambray_scene::ShapeInstance) -> layout::ShapeInstance {
    layout::ShapeInstance {
        world_from_object: columns(&placed.world_from_object),
        object_from_world: columns(&placed.world_from_object.inverse()),
        normal_from_object: normal_columns(placed.world_from_object.matrix3),
        reach: placed.reach(&scene.shapes[placed.shape as usize]),
        shape: placed.shape,
        material: placed.material,
        motion: placed.motion as u32,
    }
}

fn columns(m: &Affine3A) -> [[f32; 3]; 4] {
    m.to_cols_array_2d()
}

fn normal_columns(m: Mat3A) -> [[f32; 3]; 3] {
    normal_matrix(m).to_cols_array_2d()
}
