//! Surfaces given by samples of a function on a grid.
//!
//! Between samples the function is trilinear, so along a ray it is a cubic in each cell, and the first sign change is found
//! exactly up to rounding (Hansson-Söderlund, Evans and Akenine-Möller 2022, "Ray tracing of signed distance function
//! grids"). The sign at the end of a cell is carried into the next: no crossing is lost between two.

use std::sync::Arc;

use glam::Vec3;

use super::cuboid::slab;
use super::interval::Interval;

/// A function sampled on a regular grid; its surface is where the trilinear interpolation changes sign.
///
/// The values should be distances to the surface, negative inside, but only their signs and their growth across the surface
/// matter. Nothing is there beyond the box: where values are negative at its faces, the surface is open. Copies share
/// the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct SignedDistanceField {
    samples: [u32; 3],
    half_extents: Vec3,
    distances: Arc<[f32]>,
}

/// Why samples make no field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FieldError {
    /// An axis needs two samples at least and [`SignedDistanceField::LONGEST_AXIS`] at most.
    #[error("a field needs 2 to 4096 samples along each axis")]
    Samples,
    /// The size must be positive and finite.
    #[error("the size of a field must be positive and finite")]
    Size,
    /// One value is needed for each point of the grid.
    #[error("the number of distances is not that of the grid's points")]
    Count,
    /// Values must be finite.
    #[error("a distance is not finite")]
    NotFinite,
}

/// A cell of the grid: indices of its lower corner, and the trilinear polynomial over its unit cube.
struct Cell {
    /// Coefficients of 1, x, y, z, xy, yz, zx, xyz.
    k: [f32; 8],
    /// Largest magnitude at a corner.
    largest: f32,
}

impl SignedDistanceField {
    /// Most samples along an axis: grid coordinates stay exact to 2⁻¹¹ of a cell.
    pub const LONGEST_AXIS: u32 = 4096;

    /// A field over a box of `size` around the origin. `distances` has a value for each point of the grid, x running
    /// fastest, then y; the outermost points lie on the faces of the box.
    ///
    /// # Errors
    /// See [`FieldError`].
    pub fn new(samples: [u32; 3], size: Vec3, distances: Vec<f32>) -> Result<Self, FieldError> {
        if samples.iter().any(|&n| !(2..=Self::LONGEST_AXIS).contains(&n)) {
            return Err(FieldError::Samples);
        }
        if !(size.is_finite() && size.min_element() > 0.0) {
            return Err(FieldError::Size);
        }
        if distances.len() as u64 != samples.iter().map(|&n| u64::from(n)).product::<u64>() {
            return Err(FieldError::Count);
        }
        if distances.iter().any(|distance| !distance.is_finite()) {
            return Err(FieldError::NotFinite);
        }
        Ok(Self { samples, half_extents: 0.5 * size, distances: distances.into() })
    }

    /// Samples along x, y, z.
    #[must_use]
    pub const fn samples(&self) -> [u32; 3] {
        self.samples
    }

    /// The values, x running fastest, then y.
    #[must_use]
    pub fn distances(&self) -> &[f32] {
        &self.distances
    }

    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        (-self.half_extents, self.half_extents)
    }

    /// Cells along each axis.
    fn cells(&self) -> Vec3 {
        let [x, y, z] = self.samples;
        Vec3::new((x - 1) as f32, (y - 1) as f32, (z - 1) as f32)
    }

    /// Cells a unit of length.
    fn density(&self) -> Vec3 {
        self.cells() / (self.half_extents + self.half_extents)
    }

    /// Lower corner of the cell at grid coordinates `g`.
    fn corner(&self, g: Vec3) -> Vec3 {
        g.floor().max(Vec3::ZERO).min(self.cells() - Vec3::ONE)
    }

    /// The cell with this lower corner, which must be one.
    fn cell(&self, corner: Vec3) -> Cell {
        let [nx, ny, _] = self.samples.map(|n| n as usize);
        let first = (corner.z as usize * ny + corner.y as usize) * nx + corner.x as usize;
        let at = |x: usize, y: usize, z: usize| self.distances[first + (z * ny + y) * nx + x];
        let [s000, s100, s010, s110] = [at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(1, 1, 0)];
        let [s001, s101, s011, s111] = [at(0, 0, 1), at(1, 0, 1), at(0, 1, 1), at(1, 1, 1)];
        let (x, y, z) = (s100 - s000, s010 - s000, s001 - s000);
        let (xy, yz, zx) = ((s110 - s010) - x, (s011 - s001) - y, (s101 - s100) - z);
        let xyz = ((s111 - s011) - (s101 - s001)) - xy;
        let low = s000.abs().max(s100.abs()).max(s010.abs()).max(s110.abs());
        let high = s001.abs().max(s101.abs()).max(s011.abs()).max(s111.abs());
        Cell { k: [s000, x, y, z, xy, yz, zx, xyz], largest: low.max(high) }
    }

    pub(super) fn intersect(&self, o: Vec3, d: Vec3, t_max: f32) -> Option<f32> {
        let half = self.half_extents;
        let within =
            slab(o.x, d.x, half.x).intersection(slab(o.y, d.y, half.y)).intersection(slab(o.z, d.z, half.z));
        let span = within.intersection(Interval { near: 0.0, far: t_max });
        if span.near > span.far {
            return None;
        }
        // From here on t counts from the entry, so that a far origin costs no precision within the box.
        let (start, last) = (span.near, span.far - span.near);
        let entry = if start > 0.0 { (o + d * start).max(-half).min(half) } else { o };
        let density = self.density();
        let (g, v) = ((entry + half) * density, d * density);
        let (mut corner, top) = (self.corner(g), self.cells() - Vec3::ONE);
        let step = Vec3::new(step(v.x), step(v.y), step(v.z));
        let mut now = 0.0_f32;
        let mut inside = None;
        // A ray passes each plane of the grid once.
        let most = self.samples.iter().sum::<u32>();
        for _ in 0..most {
            let exit = Vec3::new(
                plane(corner.x, step.x, g.x, v.x),
                plane(corner.y, step.y, g.y, v.y),
                plane(corner.z, step.z, g.z, v.z),
            );
            let next = exit.x.min(exit.y).min(exit.z);
            let end = next.min(last).max(now);
            let from = (g + v * now - corner).max(Vec3::ZERO).min(Vec3::ONE);
            let to = (g + v * end - corner).max(Vec3::ZERO).min(Vec3::ONE);
            let cell = self.cell(corner);
            let cubic = cell.along(from, to - from);
            let before = *inside.get_or_insert_with(|| cubic.starts_inside(cell.noise(top)));
            let (crossing, after) = cubic.first_crossing(before);
            if let Some(share) = crossing {
                let t = start + (now + (end - now) * share);
                if t > 0.0 && t <= t_max {
                    return Some(t);
                }
            }
            inside = Some(after);
            if next >= last {
                return None;
            }
            if exit.x <= exit.y && exit.x <= exit.z {
                corner.x += step.x;
            } else if exit.y <= exit.z {
                corner.y += step.y;
            } else {
                corner.z += step.z;
            }
            if corner.min_element() < 0.0 || corner.x > top.x || corner.y > top.y || corner.z > top.z {
                return None;
            }
            now = end;
        }
        None
    }

    /// Value and gradient at `p`, or at the point of the box next to it.
    fn value(&self, p: Vec3) -> (f32, Vec3) {
        let density = self.density();
        let g = (p + self.half_extents) * density;
        let corner = self.corner(g);
        let (value, slope) = self.cell(corner).value((g - corner).max(Vec3::ZERO).min(Vec3::ONE));
        (value, slope * density)
    }

    pub(super) fn normal(&self, p: Vec3) -> Vec3 {
        let (_, gradient) = self.value(p);
        let largest = gradient.x.abs().max(gradient.y.abs()).max(gradient.z.abs());
        if largest > 0.0 {
            let scaled = gradient / largest;
            scaled / scaled.dot(scaled).sqrt()
        } else {
            Vec3::Y
        }
    }

    pub(super) fn project(&self, p: Vec3) -> Vec3 {
        let (value, gradient) = self.value(p);
        let square = gradient.dot(gradient);
        let step = gradient * (value / square);
        // Where the field is flat, its zero may be anywhere: only rounding is removed.
        let size = 1.0 / self.density();
        let limit = 1e-3 * size.x.min(size.y).min(size.z);
        if square > 0.0 && step.dot(step) <= limit * limit {
            (p - step).max(-self.half_extents).min(self.half_extents)
        } else {
            p
        }
    }
}

/// Direction in which a ray crosses the cells of an axis.
fn step(v: f32) -> f32 {
    if v < 0.0 { -1.0 } else { 1.0 }
}

/// When a ray from `g` leaves the cell at `corner` along an axis.
fn plane(corner: f32, step: f32, g: f32, v: f32) -> f32 {
    if v == 0.0 { f32::INFINITY } else { (corner + 0.5 * (step + 1.0) - g) / v }
}

impl Cell {
    /// Value and derivatives at a point of the unit cube.
    fn value(&self, p: Vec3) -> (f32, Vec3) {
        let [one, x, y, z, xy, yz, zx, xyz] = self.k;
        let slope = Vec3::new(
            x + xy * p.y + (zx + xyz * p.y) * p.z,
            y + xy * p.x + (yz + xyz * p.x) * p.z,
            z + zx * p.x + (yz + xyz * p.x) * p.y,
        );
        (one + x * p.x + (y + xy * p.x) * p.y + slope.z * p.z, slope)
    }

    /// The cubic along the segment from `p` by `v`, for parameters in [0, 1].
    fn along(&self, p: Vec3, v: Vec3) -> Cubic {
        let [.., xy, yz, zx, xyz] = self.k;
        let (value, slope) = self.value(p);
        let bends =
            (xy + xyz * p.z) * (v.x * v.y) + (yz + xyz * p.x) * (v.y * v.z) + (zx + xyz * p.y) * (v.z * v.x);
        Cubic { c: [value, slope.dot(v), bends, xyz * (v.x * v.y) * v.z] }
    }

    /// Bound on the rounding of values: of the values themselves, and of grid coordinates up to `top`.
    fn noise(&self, top: Vec3) -> f32 {
        4.0 * f32::EPSILON * self.largest * (2.0 + top.x.max(top.y).max(top.z))
    }
}

/// c₀ + c₁ s + c₂ s² + c₃ s³ for s in [0, 1].
struct Cubic {
    c: [f32; 4],
}

impl Cubic {
    fn at(&self, s: f32) -> f32 {
        let [c0, c1, c2, c3] = self.c;
        c0 + s * (c1 + s * (c2 + s * c3))
    }

    /// On which side a ray starts; within the `noise` of the surface on the one that it goes to.
    fn starts_inside(&self, noise: f32) -> bool {
        let [value, slope, ..] = self.c;
        if value.abs() <= noise { slope < 0.0 } else { value < 0.0 }
    }

    /// Where the sign first differs from `inside`, and whether the end is inside.
    fn first_crossing(&self, inside: bool) -> (Option<f32>, bool) {
        let [_, c1, c2, c3] = self.c;
        let after = self.at(1.0) < 0.0;
        if (self.c[0] < 0.0) != inside {
            return (Some(0.0), after);
        }
        // Between its extrema the cubic is monotone. They are the roots of c₁ + 2 c₂ s + 3 c₃ s².
        let a = 3.0 * c3;
        let discriminant = c2 * c2 - a * c1;
        let mut extrema = [1.0_f32, 1.0];
        if discriminant > 0.0 {
            let root = discriminant.sqrt();
            let q = if c2 < 0.0 { root - c2 } else { -c2 - root };
            let first = if q == 0.0 { 1.0 } else { c1 / q };
            let second = if a == 0.0 { 1.0 } else { q / a };
            extrema = [first.min(second).clamp(0.0, 1.0), first.max(second).clamp(0.0, 1.0)];
        }
        let mut low = 0.0;
        for high in [extrema[0], extrema[1], 1.0] {
            if (self.at(high) < 0.0) != inside {
                return (Some(self.bisect(low, high, inside)), after);
            }
            low = high;
        }
        (None, after)
    }

    /// The sign change between `low`, on the side `inside`, and `high`: Newton's method, kept within the bracket.
    fn bisect(&self, mut low: f32, mut high: f32, inside: bool) -> f32 {
        /// Enough for halving alone to reach the rounding of s.
        const STEPS: u32 = 24;
        let [_, c1, c2, c3] = self.c;
        let mut s = 0.5 * (low + high);
        for _ in 0..STEPS {
            let value = self.at(s);
            if (value < 0.0) == inside {
                low = s;
            } else {
                high = s;
            }
            let slope = c1 + s * (2.0 * c2 + s * (3.0 * c3));
            let newton = if slope == 0.0 { low } else { s - value / slope };
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if next == s {
                break;
            }
            s = next;
        }
        s
    }
}
