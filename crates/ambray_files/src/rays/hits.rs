//! Files of hits, and how far two of them agree.

use std::{io::Write, path::Path};

use ambray::{
    cpu::rays::RayKind,
    trace::{Hit, Ray},
};
use anyhow::{Context as _, ensure};

use super::words::{Words, begin, count, put};

const MAGIC: &[u8; 4] = b"HITS";
/// Triangle of a ray that hits nothing.
const NONE: u32 = u32::MAX;

/// What became of rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hits {
    /// Distances.
    pub distances: Vec<f32>,
    /// Triangles.
    pub triangles: Vec<u32>,
}

/// How far hits agree with others of the same rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Rays that hit something in one of them only.
    pub differing: u64,
    /// Of rays that hit something in both, those whose distances differ by more than [`FAR`](Self::FAR): they hit other
    /// places.
    pub far: u64,
    /// Of the rest, the largest difference of the distances over the larger one.
    pub largest_difference: f64,
}

impl Agreement {
    /// Difference of two distances, over the larger one, that rounding does not explain.
    pub const FAR: f64 = 1e-3;
}

impl Hits {
    /// The closest `hits` of `rays`.
    #[must_use]
    pub fn closest(rays: &[Ray], hits: &[Hit]) -> Self {
        let of = |(ray, hit): (&Ray, &Hit)| {
            if hit.is_hit() { (hit.t, hit.triangle) } else { (ray.t_max, NONE) }
        };
        let (distances, triangles) = rays.iter().zip(hits).map(of).unzip();
        Self { distances, triangles }
    }

    /// Whether `rays` are `blocked`.
    #[must_use]
    pub fn any(rays: &[Ray], blocked: &[bool]) -> Self {
        let of = |(ray, &blocked): (&Ray, &bool)| {
            if blocked { (f32::NEG_INFINITY, 0) } else { (ray.t_max, NONE) }
        };
        let (distances, triangles) = rays.iter().zip(blocked).map(of).unzip();
        Self { distances, triangles }
    }

    /// Rays that hit something.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.triangles.iter().filter(|&&triangle| triangle != NONE).count() as u64
    }

    /// Writes them.
    pub fn write(&self, out: &mut (impl Write + ?Sized)) -> anyhow::Result<()> {
        begin(out, MAGIC)?;
        put(out, [count(self.distances.len())?])?;
        put(out, self.distances.iter().map(|distance| distance.to_bits()))?;
        put(out, self.triangles.iter().copied())
    }

    /// Reads them.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let read = || -> anyhow::Result<Self> {
            let mut words = Words::open(path, MAGIC)?;
            let rays = u64::from(words.next()?);
            let distances = words.take(rays)?.into_iter().map(f32::from_bits).collect();
            let triangles = words.take(rays)?;
            words.end()?;
            Ok(Self { distances, triangles })
        };
        read().with_context(|| path.display().to_string())
    }

    /// How far these hits agree with `others` of the same rays.
    pub fn agreement(&self, others: &Self, kind: RayKind) -> anyhow::Result<Agreement> {
        let (here, there) = (self.triangles.len(), others.triangles.len());
        ensure!(here == there, "these are hits of {there} rays, not of the {here} that were traced");
        let mut agreement = Agreement::default();
        let distances = self.distances.iter().zip(&others.distances);
        for ((a, b), (s, t)) in self.triangles.iter().zip(&others.triangles).zip(distances) {
            if (*a == NONE) != (*b == NONE) {
                agreement.differing += 1;
            } else if *a != NONE && kind == RayKind::Closest {
                let (s, t) = (f64::from(*s), f64::from(*t));
                let difference = (s - t).abs() / s.abs().max(t.abs()).max(f64::MIN_POSITIVE);
                // What is not a number is far.
                if difference <= Agreement::FAR {
                    agreement.largest_difference = agreement.largest_difference.max(difference);
                } else {
                    agreement.far += 1;
                }
            }
        }
        Ok(agreement)
    }
}
