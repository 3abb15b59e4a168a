//! What tests need and nothing else: single GLSL functions, to be compared with their twins in Rust, small submissions, and
//! given samples.

use std::sync::Arc;

use ambray_core::{sampling::SampleSets, settings::Settings, view::View};
use ash::vk::BufferUsageFlags;
use bytemuck::Pod;
use glam::{Vec2, Vec3, Vec4};

use crate::{
    Buffer, Context, Location, Picture, Result, VulkanBackend, Work,
    constants::SampleTables,
    layout::{ARGUMENTS, NONE, Push, QUERY_HEIGHT, QUERY_WIDTH, Specialization, VALUES},
    pipeline::{ComputePipeline, Interface},
    points,
    state::Inputs,
};

const FUNCTIONS: &[u8] = include_bytes!("../shaders/spv/functions.comp.spv");

/// Arguments of a call.
pub type Arguments = [u32; ARGUMENTS as usize];
/// Values of a call.
pub type Values = [u32; VALUES as usize];

/// The functions as they are compiled for some settings.
#[derive(Debug)]
pub struct Functions<'a> {
    pipeline: ComputePipeline,
    interface: Arc<Interface>,
    backend: &'a VulkanBackend,
    settings: Settings,
}

impl<'a> Functions<'a> {
    /// Compiles them.
    pub fn new(backend: &'a VulkanBackend, settings: &Settings) -> Result<Self> {
        let interface = Arc::clone(backend.state().interface());
        let pipeline =
            ComputePipeline::new(&interface, FUNCTIONS, &Specialization::of(settings, true, true))?;
        Ok(Self { pipeline, interface, backend, settings: settings.clone() })
    }

    /// The values of `function`, a `FUNCTION_` constant of [`layout`](crate::layout), for each of `calls`: words, or bits of
    /// floats. Tables and constants are those of the scene, the settings and `view`.
    pub fn call(&self, function: u32, view: &View, calls: &[Arguments]) -> Result<Vec<Values>> {
        let mut state = self.backend.state();
        let (width, height) = view.camera.size();
        let inputs = Inputs { settings: &self.settings, view, size: [width, height], count: width * height };
        let mut constants = state.prepare(&inputs)?;
        // The size stays the camera's, which functions read.
        let extent = points::folded(calls.len());
        constants.count = calls.len() as u32;
        constants.mode = function;
        let context = self.backend.context();
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let arguments = context.upload("arguments", usage, calls)?;
        let size = (calls.len() * size_of::<Values>()) as u64;
        let values = context.buffer("values", size, usage, Location::Readback)?;
        (constants.inputs, constants.outputs) = (arguments.address(), values.address());
        state.write_view(&constants);
        let (scene, view) = (self.backend.scene_address(&state), state.view_buffer.address());
        let push = Push { scene, view, origin: [0; 2], extent };
        context.run(|recorder| {
            self.pipeline.record(recorder, &self.interface, [QUERY_WIDTH, QUERY_HEIGHT], push);
            recorder.barrier(Work::Compute, Work::HostRead);
            Ok(())
        })?;
        Ok(values.read(0, calls.len()))
    }
}

/// The bytes of a picture: red, green, blue and alpha of each pixel, row by row from the top.
pub fn picture_bytes(context: &Arc<Context>, picture: &Picture) -> Result<Vec<u8>> {
    let (width, height) = picture.size();
    let size = 4 * u64::from(width) * u64::from(height);
    let pixels = context.buffer("bytes", size, BufferUsageFlags::TRANSFER_DST, Location::Readback)?;
    context.run(|recorder| {
        recorder.fetch(picture, &pixels);
        Ok(())
    })?;
    Ok(pixels.read(0, size as usize))
}

impl VulkanBackend {
    /// Cuts frames into submissions of at most `rays` rays, and of one row at least.
    pub fn limit_submissions(&self, rays: u64) {
        let mut state = self.state();
        (state.budget.cost, state.adapts) = (rays, false);
    }

    /// Positions, normals and tangents of a mesh as the shaders read them; lists are empty where it lacks them.
    pub fn vertices(&self, mesh: usize) -> Result<(Vec<Vec3>, Vec<Vec3>, Vec<Vec4>)> {
        let tables = self.tables();
        let mesh = tables.meshes[mesh];
        Ok((
            self.entries(&tables.positions, mesh.first_vertex, mesh.vertices)?,
            self.entries(&tables.normals, mesh.first_normal, mesh.vertices)?,
            self.entries(&tables.tangents, mesh.first_tangent, mesh.vertices)?,
        ))
    }

    /// Entries of a table; none if they begin nowhere.
    fn entries<T: Pod>(&self, table: &Buffer, first: u32, count: u32) -> Result<Vec<T>> {
        if first == NONE {
            return Ok(Vec::new());
        }
        let (stride, usage) = (size_of::<T>() as u64, BufferUsageFlags::TRANSFER_DST);
        let size = stride * u64::from(count);
        let copy = self.context().buffer("entries", size, usage, Location::Readback)?;
        self.context().run(|recorder| {
            recorder.barrier(Work::Everything, Work::Transfer);
            recorder.copy(table, stride * u64::from(first), &copy, 0, size);
            recorder.barrier(Work::Transfer, Work::HostRead);
            Ok(())
        })?;
        Ok(copy.read(0, count as usize))
    }

    /// Takes the same points of the unit square for every pixel, as long as the sampling of `settings` stays.
    pub fn give_samples(&self, settings: &Settings, points: &[Vec2]) -> Result<()> {
        let tables = SampleTables::of_sets(&SampleSets::from_points(points), 1);
        self.state().set_samples(settings, &tables).map(|_| ())
    }
}
