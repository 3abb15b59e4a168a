//! What an inspection consists of.

use std::fmt;

use glam::{Vec3, Vec4};

use crate::filter::Verdict;

/// Where a ray or a chord met a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Distance along the ray or the chord, scene units.
    pub distance: f32,
    /// The place, world space.
    pub position: Vec3,
    /// Index of the instance.
    pub instance: u32,
    /// Index of the triangle in its mesh.
    pub triangle: u32,
    /// Radiance L_r that leaves the surface, linear RGB; 0 where near radiance is off. For
    /// [`RadianceSource::SelfSimilar`](crate::settings::RadianceSource::SelfSimilar) still without the factor L_a F.
    pub radiance: Vec3,
}

/// A ray of the first batch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientRay {
    /// Where it starts, world space: the surface point, moved off its surface.
    pub origin: Vec3,
    /// Unit direction w, world space.
    pub direction: Vec3,
    /// Where it ends if nothing is met, scene units; may be infinite.
    pub t_max: f32,
    /// Whether it was traced. Directions below the geometric horizon are blocked at once, at distance 0.
    pub is_traced: bool,
    /// What it met; `None` if nothing, or if it was not traced.
    pub hit: Option<Meeting>,
    /// Openness μ(d) of the direction, which O1 is the mean of.
    pub openness: f32,
}

impl AmbientRay {
    /// Distance d of what blocks the direction: infinite where nothing does, 0 below the geometric horizon.
    #[must_use]
    pub fn distance(&self) -> f32 {
        if self.is_traced { self.hit.map_or(f32::INFINITY, |hit| hit.distance) } else { 0.0 }
    }
}

/// A chord of the second batch, which joins the ends of two missed rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// The two rays, by their place in the first batch.
    pub joins: [usize; 2],
    /// Where it starts, world space: on the first ray, at R (`thin paper`) or R/2 (`thin sheet`) from the surface point.
    pub from: Vec3,
    /// Where it ends, on the second ray.
    pub to: Vec3,
    /// What it met first.
    pub hit: Option<Meeting>,
    /// Degree in `[0, 1]` to which it counts as blocked: all or nothing for `thin paper`; for `thin sheet` 1 − μ of the
    /// distance from the surface point to the hit, with `thin-edge` times the edge factor S(e).
    pub blocked: f32,
    /// Its share in A2 = 1 − Σ weight · blocked: l/Σl for `thin paper`, 1/N for `thin sheet`.
    pub weight: f32,
}

/// A ray to a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowRay {
    /// Where it starts, world space.
    pub origin: Vec3,
    /// Unit direction towards the light, world space.
    pub direction: Vec3,
    /// Distance of the light, scene units; may be infinite.
    pub t_max: f32,
    /// Index of the light in [`View::lights`](crate::view::View::lights).
    pub light: usize,
    /// Whose light it asks for.
    pub source: ShadowSource,
    /// Whether anything is in the way.
    pub blocked: bool,
}

/// The surface that a shadow ray starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowSource {
    /// What the pixel sees.
    Surface,
    /// What the ray of this index met.
    Ray(usize),
    /// What the chord of this index met.
    Chord(usize),
}

/// A pixel of the filter's window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tap {
    /// Offset from the inspected pixel, to the right and down.
    pub offset: [i32; 2],
    /// The pixel; `None` outside the picture.
    pub pixel: Option<(u32, u32)>,
    /// Weight k in the window. Of the mean it is the share of k in the sum over the accepted taps.
    pub weight: f32,
    /// What the filter makes of it.
    pub verdict: Verdict,
    /// Its openness (x) and near radiance (yzw) in the frame, before the filter; `None` where no surface is seen.
    pub value: Option<Vec4>,
}

impl fmt::Display for AmbientRay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.hit {
            _ if !self.is_traced => write!(f, "below the horizon, openness 0"),
            Some(hit) => write!(f, "hit at {:.4}, openness {:.3}", hit.distance, self.openness),
            None => write!(f, "missed, openness {:.3}", self.openness),
        }
    }
}

impl fmt::Display for Chord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = self.joins;
        match self.hit {
            Some(hit) => write!(
                f,
                "rays {a} and {b}: blocked at {:.4}, counts by {:.3} of {:.3}",
                hit.distance,
                self.blocked * self.weight,
                self.weight
            ),
            None if self.blocked > 0.0 => write!(f, "rays {a} and {b}: blocked"),
            None => write!(f, "rays {a} and {b}: free"),
        }
    }
}

impl fmt::Display for ShadowRay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let state = if self.blocked { "blocked" } else { "lit" };
        match self.source {
            ShadowSource::Surface => write!(f, "light {}: {state}", self.light),
            ShadowSource::Ray(i) => write!(f, "light {} from the hit of ray {i}: {state}", self.light),
            ShadowSource::Chord(i) => write!(f, "light {} from the hit of chord {i}: {state}", self.light),
        }
    }
}

impl fmt::Display for Tap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [dx, dy] = self.offset;
        write!(f, "{dx:+}, {dy:+}, weight {}: {}", self.weight, self.verdict)
    }
}
