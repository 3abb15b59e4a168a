//! Files of rays.

use std::{io::Write, path::Path};

use ambray::{
    cpu::rays::{RayBatch, RayKind},
    trace::Ray,
};
use anyhow::{Context as _, bail, ensure};

use super::words::{Words, begin, count, put};

const MAGIC: &[u8; 4] = b"RAYS";
/// Numbers of a ray.
const RAY: usize = 8;
/// How far a squared length of a direction may be from 1.
const UNIT: f32 = 1e-3;

/// Writes `batch`. What decides on transparent surfaces is lost: the tracers that are compared see opaque ones.
pub fn write_batch(out: &mut (impl Write + ?Sized), batch: &RayBatch) -> anyhow::Result<()> {
    let kind = match batch.kind {
        RayKind::Closest => 0,
        RayKind::Any => 1,
    };
    begin(out, MAGIC)?;
    put(out, [count(batch.rays.len())?, kind, batch.width, batch.height, batch.per_pixel, 0])?;
    let numbers = |ray: &Ray| {
        let (o, d) = (ray.origin, ray.direction);
        [o.x, o.y, o.z, 0.0, d.x, d.y, d.z, ray.t_max].map(f32::to_bits)
    };
    put(out, batch.rays.iter().flat_map(numbers))?;
    put(out, batch.tags.iter().copied())
}

/// Reads rays that Ambray's tracer takes: finite origins, t_min 0, unit directions, each with a tag in the picture.
pub fn read_batch(path: &Path) -> anyhow::Result<RayBatch> {
    read(path).with_context(|| path.display().to_string())
}

fn read(path: &Path) -> anyhow::Result<RayBatch> {
    let mut words = Words::open(path, MAGIC)?;
    let rays = words.next()?;
    let kind = match words.next()? {
        0 => RayKind::Closest,
        1 => RayKind::Any,
        other => bail!("has rays of the kind {other}, and only 0 and 1 are known"),
    };
    let [width, height, per_pixel, _] = [words.next()?, words.next()?, words.next()?, words.next()?];
    ensure!(
        width > 0 && height > 0 && per_pixel > 0 && RayBatch::has_tags(width, height, per_pixel),
        "has a picture of {width} x {height} pixels with {per_pixel} rays each, which is nothing or too much"
    );
    let numbers = words.take(RAY as u64 * u64::from(rays))?;
    let tags = words.take(u64::from(rays))?;
    words.end()?;
    let rays = numbers.as_chunks().0.iter().enumerate();
    let rays = rays.map(|(i, numbers)| ray(numbers).with_context(|| format!("ray {i}")));
    let rays: Vec<Ray> = rays.collect::<anyhow::Result<_>>()?;
    let most = u64::from(width) * u64::from(height) * u64::from(per_pixel);
    if let Some(i) = tags.iter().position(|&tag| u64::from(tag) >= most) {
        bail!("ray {i}: its tag {} is outside the picture", tags[i]);
    }
    Ok(RayBatch { kind, width, height, per_pixel, rays, tags })
}

fn ray(numbers: &[u32; RAY]) -> anyhow::Result<Ray> {
    let [x, y, z, t_min, dx, dy, dz, t_max] = numbers.map(f32::from_bits);
    let ray = Ray { origin: [x, y, z].into(), t_max, direction: [dx, dy, dz].into(), seed: 0 };
    ensure!(ray.origin.is_finite(), "its origin is not finite");
    ensure!(t_min == 0.0, "it begins at {t_min}, and Ambray's rays begin at 0");
    ensure!((ray.direction.length_squared() - 1.0).abs() < UNIT, "its direction is no unit vector");
    ensure!(t_max >= 0.0, "it ends at {t_max}"); // not a number is refused as well
    Ok(ray)
}
