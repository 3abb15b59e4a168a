//! From the planes of a device to a frame of the host.

use std::sync::Arc;

use ambray_core::{
    compose::{finished, smaller_batch},
    frame::{Frame, FrameStats, GBufferPixel, RayCounts},
    settings::Settings,
    view::View,
};
use bytemuck::Pod;
use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::{
    Buffer, Context, Location, Result,
    history::History,
    layout::{NONE, Tally},
    planes::{Plane, Transfer},
    state::State,
};

/// Copies everything; the times of the statistics are still to be filled in.
pub(crate) fn frame(
    context: &Arc<Context>,
    state: &State,
    settings: &Settings,
    view: &View,
) -> Result<Frame> {
    let (width, height) = view.camera.size();
    let count = width as usize * height as usize;
    let reader = Reader::new(context, state, count)?;
    let tallies: Vec<Tally> = reader.read(Plane::Tallies)?;
    let mut gbuffer = vec![GBufferPixel::NOTHING; count];
    for (pixel, tally) in gbuffer.iter_mut().zip(&tallies) {
        pixel.rays = 1 + rays_of(tally);
    }
    reader.each(Plane::SmoothNormals, &mut gbuffer, |pixel, v| {
        (pixel.smooth_normal, pixel.instance) = (v.xyz(), v.w.to_bits());
    })?;
    reader.each(Plane::Shading, &mut gbuffer, |pixel, v| {
        (pixel.shading_normal, pixel.material) = (v.xyz(), v.w.to_bits());
    })?;
    reader.each(Plane::Positions, &mut gbuffer, |pixel, v| {
        let depth = if pixel.instance == NONE { f32::INFINITY } else { v.w };
        (pixel.position, pixel.depth) = (v.xyz(), depth);
    })?;
    reader.each(Plane::Geometric, &mut gbuffer, |pixel, v| {
        (pixel.geometric_normal, pixel.reach) = (v.xyz(), v.w);
    })?;
    reader.each(Plane::Albedo, &mut gbuffer, |pixel, v| pixel.albedo = v.xyz())?;
    reader.each(Plane::Emission, &mut gbuffer, |pixel, v| pixel.emission = v.xyz())?;
    reader.each(Plane::Direct, &mut gbuffer, |pixel, v| pixel.direct = v.xyz())?;

    let mut ambient_raw = reader.vectors(Plane::Ambient)?;
    if settings.takes_minimum_after_filter() {
        let second = reader.vectors(Plane::Second)?;
        ambient_raw.iter_mut().zip(second).for_each(|(raw, second)| *raw = smaller_batch(*raw, second));
    }
    for raw in &mut ambient_raw {
        *raw = finished(settings.radiance_source, view.ambient, *raw);
    }
    let history = match state.history() {
        Some(kept) => {
            move_pixels(&reader, kept, width, &mut gbuffer)?;
            reader.read_buffer(kept.frames())?
        }
        None => vec![1.0; count],
    };
    let stats = FrameStats { rays: ray_counts(&tallies), ..FrameStats::default() };
    Ok(Frame {
        width,
        height,
        beauty: reader.vectors(Plane::Beauty)?.iter().map(|v| v.xyz()).collect(),
        gbuffer,
        ambient_raw,
        ambient: reader.vectors(Plane::Filtered)?,
        bent: reader.vectors(Plane::FilteredBent)?.iter().map(|v| v.xyz()).collect::<Vec<Vec3>>(),
        history,
        view: view.clone(),
        stats,
    })
}

/// Fills in how far pixels have moved since the frame that was continued, if one was.
fn move_pixels(
    reader: &Reader<'_>,
    history: &History,
    width: u32,
    gbuffer: &mut [GBufferPixel],
) -> Result<()> {
    let Some(camera) = history.continued() else { return Ok(()) };
    let then: Vec<Vec4> = reader.read_buffer(history.then_positions())?;
    for (i, (pixel, then)) in gbuffer.iter_mut().zip(then).enumerate() {
        let place = camera.project(then.xyz()).filter(|_| pixel.is_surface());
        let now = Vec2::new((i % width as usize) as f32, (i / width as usize) as f32);
        pixel.motion = place.map_or(Vec2::ZERO, |(place, _)| now - place);
    }
    Ok(())
}

/// Rays by type, one primary ray for each tally.
fn ray_counts(tallies: &[Tally]) -> RayCounts {
    let sum = |rays: fn(&Tally) -> u32| tallies.iter().map(|tally| u64::from(rays(tally))).sum();
    RayCounts {
        primary: tallies.len() as u64,
        ambient: sum(|tally| tally.ambient_rays),
        chord: sum(|tally| tally.chord_rays),
        shadow: sum(|tally| tally.direct_shadow_rays + tally.shadow_rays),
    }
}

/// Secondary rays of a pixel.
const fn rays_of(tally: &Tally) -> u32 {
    tally.ambient_rays + tally.chord_rays + tally.direct_shadow_rays + tally.shadow_rays
}

/// Reads planes of `count` entries.
pub(crate) struct Reader<'a> {
    context: &'a Arc<Context>,
    state: &'a State,
    transfer: Transfer,
    count: usize,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(context: &'a Arc<Context>, state: &'a State, count: usize) -> Result<Self> {
        let transfer = Transfer::new(context, count as u64 * 24, Location::Readback)?;
        Ok(Self { context, state, transfer, count })
    }

    pub(crate) fn read<T: Pod>(&self, plane: Plane) -> Result<Vec<T>> {
        self.transfer.read(self.context, self.state.planes().buffer(plane), self.count)
    }

    /// The entries of a plane that is not of the usual ones.
    fn read_buffer<T: Pod>(&self, plane: &Buffer) -> Result<Vec<T>> {
        self.transfer.read(self.context, plane, self.count)
    }

    pub(crate) fn vectors(&self, plane: Plane) -> Result<Vec<Vec4>> {
        self.read(plane)
    }

    fn each(
        &self,
        plane: Plane,
        pixels: &mut [GBufferPixel],
        set: impl Fn(&mut GBufferPixel, Vec4),
    ) -> Result<()> {
        let values = self.vectors(plane)?;
        pixels.iter_mut().zip(values).for_each(|(pixel, value)| set(pixel, value));
        Ok(())
    }
}
