//! Tools to model with: boxes, turned things, lofts and sheets, all as plain triangles with texture coordinates.
//!
//! Texture coordinates are in metres along the surface; materials scale them to their textures.

use glam::{Vec2, Vec3};

use super::pose::{Pose, sin_cos};

/// Corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    pub(crate) position: Vec3,
    pub(crate) uv: Vec2,
}

/// Triangles that are not yet a mesh: normals and shared vertices come when the builder adds them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shape {
    pub(crate) triangles: Vec<[Corner; 3]>,
}

/// Least area of a triangle, m²; anything smaller is left out.
pub(crate) const LEAST_AREA: f32 = 1e-9;

impl Shape {
    /// Adds a triangle, unless it has no area.
    pub(crate) fn triangle(&mut self, corners: [Corner; 3]) {
        let [a, b, c] = corners.map(|c| c.position);
        if 0.5 * (b - a).cross(c - a).length() > LEAST_AREA {
            self.triangles.push(corners);
        }
    }

    /// Adds a quadrilateral, corners anticlockwise as seen from its front.
    pub(crate) fn quad(&mut self, [a, b, c, d]: [Corner; 4]) {
        self.triangle([a, b, c]);
        self.triangle([a, c, d]);
    }

    /// Adds a flat quadrilateral, corners anticlockwise, textured along its first edge.
    pub(crate) fn panel(&mut self, corners: [Vec3; 4]) {
        let u = (corners[1] - corners[0]).normalize();
        let v = u.cross(corners[3] - corners[0]).cross(u).normalize();
        let local = |p: Vec3| Vec2::new((p - corners[0]).dot(u), -(p - corners[0]).dot(v));
        self.quad(corners.map(|position| Corner { position, uv: local(position) }));
    }

    /// Adds all triangles of `other`.
    pub(crate) fn append(&mut self, other: Self) {
        self.triangles.extend(other.triangles);
    }

    /// The same shape elsewhere.
    pub(crate) fn posed(mut self, pose: &Pose) -> Self {
        for corner in self.triangles.iter_mut().flatten() {
            corner.position = pose.point(corner.position);
        }
        self
    }

    /// The same shape with its texture moved by `offset` metres.
    pub(crate) fn with_uv_offset(mut self, offset: Vec2) -> Self {
        for corner in self.triangles.iter_mut().flatten() {
            corner.uv += offset;
        }
        self
    }

    /// The same shape with its texture turned by a quarter.
    pub(crate) fn with_uv_turned(mut self) -> Self {
        for corner in self.triangles.iter_mut().flatten() {
            corner.uv = corner.uv.perp();
        }
        self
    }

    /// Box with the opposite corners `lo` and `hi`.
    pub(crate) fn cuboid(lo: Vec3, hi: Vec3) -> Self {
        let p = |x: bool, y: bool, z: bool| {
            Vec3::new(if x { hi.x } else { lo.x }, if y { hi.y } else { lo.y }, if z { hi.z } else { lo.z })
        };
        let (o, i) = (false, true);
        let mut shape = Self::default();
        shape.panel([p(o, o, i), p(i, o, i), p(i, i, i), p(o, i, i)]);
        shape.panel([p(i, o, o), p(o, o, o), p(o, i, o), p(i, i, o)]);
        shape.panel([p(i, o, i), p(i, o, o), p(i, i, o), p(i, i, i)]);
        shape.panel([p(o, o, o), p(o, o, i), p(o, i, i), p(o, i, o)]);
        shape.panel([p(o, i, i), p(i, i, i), p(i, i, o), p(o, i, o)]);
        shape.panel([p(o, o, o), p(i, o, o), p(i, o, i), p(o, o, i)]);
        shape
    }

    /// Box of the given `size` standing on the origin.
    pub(crate) fn block(size: Vec3) -> Self {
        let half = Vec3::new(0.5 * size.x, 0.0, 0.5 * size.z);
        Self::cuboid(-half, half + Vec3::Y * size.y)
    }

    /// Surface through `rings` of equally many points; the front is where path × profile points to.
    ///
    /// A path is closed by repeating its first ring, a profile by repeating its first point.
    pub(crate) fn loft(rings: &[Vec<Vec3>]) -> Self {
        let profile = &rings[0];
        let v = running_sum(profile.windows(2).map(|w| w[0].distance(w[1])));
        let longest_step =
            |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
        let mut u = running_sum(rings.windows(2).map(|w| longest_step(&w[0], &w[1])));
        if rings.first() == rings.last() {
            // Whole metres around, so that the texture meets itself.
            let around = u[rings.len() - 1];
            let whole = libm::roundf(around).max(1.0);
            u.iter_mut().for_each(|u| *u *= whole / around);
        }
        let corner = |i: usize, j: usize| Corner { position: rings[i][j], uv: Vec2::new(u[i], -v[j]) };
        let mut shape = Self::default();
        for i in 1..rings.len() {
            for j in 1..profile.len() {
                shape.quad([corner(i - 1, j - 1), corner(i, j - 1), corner(i, j), corner(i - 1, j)]);
            }
        }
        shape
    }

    /// Turned about the y axis: `profile` holds (radius, height), from below to above on the outside.
    pub(crate) fn lathe(profile: &[Vec2], segments: u32) -> Self {
        let ring = |k: u32| {
            // The last ring is the first, bit for bit.
            let (sin, cos) = libm::sincosf((k % segments) as f32 / segments as f32 * core::f32::consts::TAU);
            profile.iter().map(|p| Vec3::new(p.x * cos, p.y, -p.x * sin)).collect()
        };
        Self::loft(&(0..=segments).map(ring).collect::<Vec<Vec<_>>>())
    }

    /// Ball about the origin, half as many rings as segments.
    pub(crate) fn sphere(radius: f32, segments: u32) -> Self {
        let rings = segments / 2;
        let profile = (0..=rings).map(|k| {
            let (sin, cos) = sin_cos(180.0 * k as f32 / rings as f32);
            Vec2::new(sin, -cos) * radius
        });
        Self::lathe(&profile.collect::<Vec<_>>(), segments)
    }

    /// Moulding around the outside of an upright rectangular block of half size `half` (x, z):
    /// `profile` holds (distance outwards, height), from below to above.
    pub(crate) fn moulding(half: Vec2, profile: &[Vec2]) -> Self {
        let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)];
        let ring = |&(x, z): &(f32, f32)| {
            profile.iter().map(|p| Vec3::new(x * (half.x + p.x), p.y, z * (half.y + p.x))).collect()
        };
        Self::loft(&corners.iter().map(ring).collect::<Vec<Vec<_>>>())
    }

    /// Moulding around the inside of a rectangular court of half size `half` (x, z):
    /// `profile` holds (distance into the court, height), from below to above.
    pub(crate) fn inner_moulding(half: Vec2, profile: &[Vec2]) -> Self {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)];
        let ring = |&(x, z): &(f32, f32)| {
            profile.iter().map(|p| Vec3::new(x * (half.x - p.x), p.y, z * (half.y - p.x))).collect()
        };
        Self::loft(&corners.iter().map(ring).collect::<Vec<Vec<_>>>())
    }

    /// Sheet of no thickness of `columns` × `rows` quadrilaterals: `point` maps (u, v) in `[0, 1]²` to a place,
    /// `size` is its extent in texture coordinates; the top of the texture is at v = 1.
    pub(crate) fn sheet(columns: u32, rows: u32, size: Vec2, point: impl Fn(f32, f32) -> Vec3) -> Self {
        let corner = |i: u32, j: u32| {
            let (u, v) = (i as f32 / columns as f32, j as f32 / rows as f32);
            Corner { position: point(u, v), uv: Vec2::new(u, 1.0 - v) * size }
        };
        let mut shape = Self::default();
        for j in 0..rows {
            for i in 0..columns {
                shape.quad([corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
            }
        }
        shape
    }

    /// Pipe of radius `thickness` along `path`, with open ends.
    pub(crate) fn tube(path: &[Vec3], thickness: f32, segments: u32) -> Self {
        let ring = |i: usize| {
            let along = (path[(i + 1).min(path.len() - 1)] - path[i.saturating_sub(1)]).normalize();
            let side = if along.y.abs() < 0.9 { Vec3::Y } else { Vec3::X }.cross(along).normalize();
            let up = along.cross(side);
            let point = |k: u32| {
                let turn = (k % segments) as f32 / segments as f32 * core::f32::consts::TAU;
                let (sin, cos) = libm::sincosf(turn);
                path[i] + (up * sin - side * cos) * thickness
            };
            (0..=segments).map(point).collect()
        };
        Self::loft(&(0..path.len()).map(ring).collect::<Vec<Vec<_>>>())
    }

    /// Ring about the y axis: a circle of radius `thickness` turned at distance `radius`.
    pub(crate) fn torus(radius: f32, thickness: f32, segments: u32, around: u32) -> Self {
        let profile: Vec<Vec2> = (0..=around)
            .map(|k| {
                let turn = (k % around) as f32 / around as f32 * core::f32::consts::TAU;
                let (sin, cos) = libm::sincosf(turn);
                Vec2::new(radius + thickness * cos, thickness * sin)
            })
            .collect();
        Self::lathe(&profile, segments)
    }
}

/// Sums of the first 0, 1, 2, … `steps`.
fn running_sum(steps: impl Iterator<Item = f32>) -> Vec<f32> {
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    for step in steps {
        sum += step;
        sums.push(sum);
    }
    sums
}

/// Outline of a moulding or a turned thing, drawn from below to above.
#[derive(Clone, Debug, Default)]
pub(crate) struct Profile(pub(crate) Vec<Vec2>);

impl Profile {
    /// Begins at (`out`, `height`).
    pub(crate) fn from(out: f32, height: f32) -> Self {
        Self(vec![Vec2::new(out, height)])
    }

    /// A straight line to (`out`, `height`).
    pub(crate) fn to(mut self, out: f32, height: f32) -> Self {
        self.0.push(Vec2::new(out, height));
        self
    }

    /// A half round of the given `radius` that bulges outwards, from (`out`, `height`) upwards.
    pub(crate) fn torus(mut self, out: f32, height: f32, radius: f32, steps: u32) -> Self {
        for k in 0..=steps {
            let (sin, cos) = libm::sincosf((k as f32 / steps as f32 - 0.5) * core::f32::consts::PI);
            self.0.push(Vec2::new(out + radius * cos, height + radius + radius * sin));
        }
        self
    }

    /// A parabola from the last point towards `control` and on to `end`.
    pub(crate) fn curve(mut self, control: Vec2, end: Vec2, steps: u32) -> Self {
        let start = self.0[self.0.len() - 1];
        for k in 1..=steps {
            let t = k as f32 / steps as f32;
            let s = 1.0 - t;
            self.0.push(start * (s * s) + control * (2.0 * s * t) + end * (t * t));
        }
        self
    }
}
