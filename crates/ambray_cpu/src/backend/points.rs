//! Ambient light at arbitrary points.

use std::sync::atomic::{AtomicUsize, Ordering};

use ambray_core::{
    compose::near_radiance,
    control::{Cancelled, Control},
    gather::{GatherParams, GatherScratch, Gathered, gather},
    query::{QueryPoint, QueryResult},
    settings::Settings,
    view::View,
};
use rayon::prelude::*;

use super::world::CpuWorld;

/// Points of one task.
const CHUNK: usize = 256;

pub(super) fn run(
    world: &CpuWorld,
    settings: &Settings,
    view: &View,
    params: &GatherParams<'_>,
    points: &[QueryPoint],
    control: Control<'_>,
) -> Result<Vec<QueryResult>, Cancelled> {
    let mut results = vec![QueryResult::default(); points.len()];
    let (count, done) = (points.len(), AtomicUsize::new(0));
    let chunks = points.par_chunks(CHUNK).zip(results.par_chunks_mut(CHUNK));
    chunks.try_for_each_init(GatherScratch::default, |scratch, (points, results)| {
        control.check()?;
        let shaded: Vec<_> = points.iter().map(|point| point.shaded(settings)).collect();
        let mut gathered = vec![Gathered::default(); points.len()];
        gather(world, params, &shaded, scratch, &mut gathered);
        for (result, gathered) in results.iter_mut().zip(&gathered) {
            *result = finish(gathered, settings, view);
        }
        let done = done.fetch_add(points.len(), Ordering::Relaxed) + points.len();
        (control.progress)(done as f32 / count as f32);
        Ok(())
    })?;
    Ok(results)
}

fn finish(gathered: &Gathered, settings: &Settings, view: &View) -> QueryResult {
    QueryResult {
        openness: gathered.openness,
        near_radiance: near_radiance(
            settings.radiance_source,
            view.ambient,
            gathered.openness,
            gathered.near,
        ),
        bent_normal: gathered.bent.normalize_or_zero(),
        first_batch: gathered.first,
        second_batch: gathered.second,
        ambient_rays: gathered.ambient_rays,
        ambient_hits: gathered.ambient_hits,
        chord_rays: gathered.chord_rays,
        chord_hits: gathered.chord_hits,
        shadow_rays: gathered.shadow_rays,
    }
}
