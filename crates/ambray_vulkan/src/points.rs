//! Ambient light at arbitrary points: the ambient pass, with points where pixels would be.

use std::sync::Arc;

use ambray_core::{
    compose::{near_radiance, smaller_batch},
    gather::ShadedPoint,
    query::{QueryPoint, QueryResult},
    settings::Settings,
    view::View,
};
use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::{
    Context, Location, Result,
    layout::Tally,
    planes::{Plane, Transfer},
    readback::Reader,
    state::State,
};

/// Points that are evaluated at once.
pub(crate) const MOST: usize = 1 << 20;

/// Points in a row.
pub(crate) const ROW: usize = 1024;

/// Width and height of the picture that `count` points are folded into.
pub(crate) fn folded(count: usize) -> [u32; 2] {
    [count.min(ROW) as u32, count.div_ceil(ROW) as u32]
}

/// Writes `points` to the planes that the ambient pass reads.
pub(crate) fn write(
    context: &Arc<Context>,
    state: &mut State,
    settings: &Settings,
    points: &[QueryPoint],
) -> Result<()> {
    let shaded: Vec<ShadedPoint> = points.iter().map(|point| point.shaded(settings)).collect();
    let mut transfer = Transfer::new(context, 16 * points.len() as u64, Location::Upload)?;
    let mut plane = |plane: Plane, entry: fn(&ShadedPoint) -> Vec4| {
        let values: Vec<Vec4> = shaded.iter().map(entry).collect();
        transfer.write(context, state.planes().buffer(plane), &values)
    };
    plane(Plane::Positions, |p| p.position.extend(1.0))?;
    plane(Plane::Geometric, |p| p.geometric_normal.extend(p.reach))?;
    plane(Plane::Shading, |p| p.normal.extend(0.0))?;
    // An instance, whichever: something is there.
    plane(Plane::SmoothNormals, |p| p.normal.extend(0.0))?;
    plane(Plane::Emission, |p| Vec3::ZERO.extend(f32::from_bits(p.key.class.into())))?;
    plane(Plane::Direct, |p| Vec3::ZERO.extend(f32::from_bits(p.key.hash)))
}

/// Reads the results of `count` points.
pub(crate) fn read(
    context: &Arc<Context>,
    state: &State,
    settings: &Settings,
    view: &View,
    count: usize,
    results: &mut Vec<QueryResult>,
) -> Result<()> {
    let reader = Reader::new(context, state, count)?;
    let tallies: Vec<Tally> = reader.read(Plane::Tallies)?;
    let (ambient, second, bent) =
        (reader.vectors(Plane::Ambient)?, reader.vectors(Plane::Second)?, reader.vectors(Plane::Bent)?);
    for i in 0..count {
        // The same where the pass has taken the minimum already.
        let (both, tally) = (smaller_batch(ambient[i], second[i]), tallies[i]);
        results.push(QueryResult {
            openness: both.x,
            near_radiance: near_radiance(settings.radiance_source, view.ambient, both.x, both.yzw()),
            bent_normal: bent[i].xyz().normalize_or_zero(),
            first_batch: bent[i].w,
            second_batch: second[i].x,
            ambient_rays: tally.ambient_rays,
            ambient_hits: tally.ambient_hits,
            chord_rays: tally.chord_rays,
            chord_hits: tally.chord_hits,
            shadow_rays: tally.shadow_rays,
        });
    }
    Ok(())
}
