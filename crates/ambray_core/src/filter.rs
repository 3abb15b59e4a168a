//! Geometry-aware low-pass over one period of the interleaved pattern (spec §7).
//!
//! O'(p) = Σ k A(p,q) O(q) / Σ k A(p,q). On a locally constant signal the pattern vanishes exactly, because every
//! window holds each of the 16 classes with the same total weight.

mod band;
mod verdict;

use glam::{Vec3, Vec4};

use crate::settings::{FilterTest, Settings, Window};

pub use band::BandScratch;
pub use verdict::{Refusal, Verdict};

/// What the filter knows about a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// Position x, world space.
    pub position: Vec3,
    /// View depth z, scene units; infinite where nothing is seen.
    pub depth: f32,
    /// Unit normal n, without normal map.
    pub normal: Vec3,
    /// Size of the pixel at this depth, scene units.
    pub footprint: f32,
}

impl Guide {
    /// A pixel that sees no surface: never accepted, never changed.
    pub const NOTHING: Self =
        Self { position: Vec3::ZERO, depth: f32::INFINITY, normal: Vec3::ZERO, footprint: 0.0 };

    /// Whether the pixel sees a surface.
    #[must_use]
    pub fn is_surface(&self) -> bool {
        self.depth.is_finite()
    }
}

/// Window and acceptance test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    window: Window,
    test: FilterTest,
    tolerance: f32,
    cos_normal: f32,
}

/// Pixels that the window reaches to each side, at most.
pub(crate) const REACH: u32 = 2;

/// Offsets along one axis with their weights: none, four taps from -1, or five whose outer ones count half.
const OFF: &[(i32, f32)] = &[(0, 1.0)];
const BOX: &[(i32, f32)] = &[(-1, 1.0), (0, 1.0), (1, 1.0), (2, 1.0)];
const CENTRED: &[(i32, f32)] = &[(-2, 0.5), (-1, 1.0), (0, 1.0), (1, 1.0), (2, 0.5)];

impl From<&Settings> for Filter {
    fn from(settings: &Settings) -> Self {
        let tolerance = match settings.filter_test {
            FilterTest::Plane => settings.filter_plane,
            FilterTest::Absolute => settings.filter_absolute,
            FilterTest::Relative => settings.filter_relative,
            FilterTest::None => f32::INFINITY,
        };
        let cos_normal = settings.filter_cos_normal;
        Self { window: settings.filter, test: settings.filter_test, tolerance, cos_normal }
    }
}

impl Filter {
    /// Tolerance of the depth test, and the smallest cosine between normals.
    #[must_use]
    pub const fn constants(&self) -> [f32; 2] {
        [self.tolerance, self.cos_normal]
    }

    /// Acceptance A(p, q) of pixel `q` by pixel `p`, both surfaces: close to its tangent plane or depth, and facing alike.
    #[inline]
    #[must_use]
    pub fn accepts(&self, p: &Guide, q: &Guide) -> bool {
        self.is_near(p, q) && self.faces_alike(p, q)
    }

    /// What the filter makes of pixel `q` in the window of `p`, which is a surface: [`accepts`](Self::accepts) with the
    /// reason.
    #[must_use]
    pub fn judge(&self, p: &Guide, q: &Guide) -> Verdict {
        if !q.is_surface() {
            Verdict::Refused(Refusal::NoSurface)
        } else if self.accepts(p, q) {
            Verdict::Accepted
        } else if self.is_near(p, q) {
            let (cosine, required) = (p.normal.dot(q.normal), self.cos_normal);
            Verdict::Refused(Refusal::Normal { cosine, required })
        } else {
            Verdict::Refused(self.too_far(p, q))
        }
    }

    #[inline]
    fn is_near(&self, p: &Guide, q: &Guide) -> bool {
        match self.test {
            FilterTest::Plane => plane_distance(p, q) < self.tolerance * p.footprint,
            FilterTest::Absolute => depth_difference(p, q) < self.tolerance,
            FilterTest::Relative => depth_difference(p, q) < self.tolerance * p.depth,
            FilterTest::None => true,
        }
    }

    #[inline]
    fn faces_alike(&self, p: &Guide, q: &Guide) -> bool {
        self.cos_normal <= -1.0 || p.normal.dot(q.normal) > self.cos_normal
    }

    /// The refusal of a pixel that is not near, in the unit of the test.
    fn too_far(&self, p: &Guide, q: &Guide) -> Refusal {
        let allowed = self.tolerance;
        match self.test {
            FilterTest::Plane => Refusal::Plane { footprints: plane_distance(p, q) / p.footprint, allowed },
            FilterTest::Relative => Refusal::Relative { share: depth_difference(p, q) / p.depth, allowed },
            FilterTest::Absolute | FilterTest::None => {
                Refusal::Absolute { difference: depth_difference(p, q), allowed }
            }
        }
    }

    /// Every tap of the window around pixel (x, y), which sees a surface: offset to the right and down, weight k in the
    /// window, and what the filter makes of it. The centre is always accepted.
    #[must_use]
    pub fn taps(
        &self,
        guides: &[Guide],
        width: usize,
        (x, y): (usize, usize),
    ) -> Vec<([i32; 2], f32, Verdict)> {
        let (p, height) = (y * width + x, guides.len() / width);
        let judge = |dx, dy| match (shifted(x, dx, width), shifted(y, dy, height)) {
            (Some(column), Some(row)) if row * width + column == p => Verdict::Accepted,
            (Some(column), Some(row)) => self.judge(&guides[p], &guides[row * width + column]),
            _ => Verdict::Refused(Refusal::OutsidePicture),
        };
        let rows = self.axis().iter();
        rows.flat_map(|&(dy, ky)| self.axis().iter().map(move |&(dx, kx)| ([dx, dy], kx * ky, judge(dx, dy))))
            .collect()
    }

    /// Offsets along one axis with their weights.
    #[inline]
    const fn axis(&self) -> &'static [(i32, f32)] {
        match self.window {
            Window::Off => OFF,
            Window::Box => BOX,
            Window::Centred => CENTRED,
        }
    }

    /// Filters row `y` of a picture of `width` pixels a row: a [band](Self::filter_band) of one row.
    pub fn filter_row<const PLANES: usize>(
        &self,
        guides: &[Guide],
        width: usize,
        y: usize,
        inputs: [&[Vec4]; PLANES],
        outputs: [&mut [Vec4]; PLANES],
    ) {
        self.filter_band(guides, width, y..y + 1, inputs, outputs, &mut BandScratch::default());
    }
}

/// Distance of `q` from the tangent plane of `p`, scene units.
#[inline]
fn plane_distance(p: &Guide, q: &Guide) -> f32 {
    p.normal.dot(q.position - p.position).abs()
}

/// Difference of their depths, scene units.
#[inline]
fn depth_difference(p: &Guide, q: &Guide) -> f32 {
    (q.depth - p.depth).abs()
}

/// `at` moved by `offset`, if that is below `end`.
#[inline]
fn shifted(at: usize, offset: i32, end: usize) -> Option<usize> {
    at.checked_add_signed(offset as isize).filter(|&shifted| shifted < end)
}
