//! Shapes given by formulas instead of triangles, and where rays meet them.
//!
//! Everything is in the shape's own space: centred on the origin, with its axis along +y (KHR_implicit_shapes). Only
//! +, −, ×, ÷, square roots, floors and comparisons of `f32` are used, in an order that the shaders repeat.
//!
//! Why rays do not hit the surface that they leave: each part of a convex shape decides by the signs of two numbers taken
//! at the origin of the ray itself, how far outside it lies and whether it moves away. Roots of quadratics are
//! c / q and q / a with q = −b ∓ √D, which keeps their signs, and D is a difference of squares in factors, so that it does
//! not drown in the distance of the origin (Haines, Günther and Akenine-Möller 2019, "Precision improvements for
//! ray/sphere intersection").

mod capsule;
mod cuboid;
mod cylinder;
mod field;
mod interval;
mod sphere;

pub use field::{FieldError, SignedDistanceField};

use glam::Vec3;

/// A closed surface around the origin of its own space. Sizes are in units of that space.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Sphere of `radius` > 0.
    Sphere {
        /// Distance of the surface from the origin.
        radius: f32,
    },
    /// Box with its sides along the axes.
    Box {
        /// Half of the size along each axis, > 0.
        half_extents: Vec3,
    },
    /// Convex hull of two spheres, whose centres are `height` ≥ 0 apart. One radius at least is > 0, both are ≥ 0.
    Capsule {
        /// Distance of the centres: they are at y = ∓ height / 2.
        height: f32,
        /// Radius of the sphere at −y.
        radius_bottom: f32,
        /// Radius of the sphere at +y.
        radius_top: f32,
    },
    /// Convex hull of two discs, `height` > 0 apart. One radius at least is > 0, both are ≥ 0.
    Cylinder {
        /// Distance of the discs: they are at y = ∓ height / 2.
        height: f32,
        /// Radius of the disc at −y.
        radius_bottom: f32,
        /// Radius of the disc at +y.
        radius_top: f32,
    },
    /// Where a sampled function is zero.
    Field(SignedDistanceField),
}

impl Shape {
    /// Lower and upper corner of the smallest box around the shape; of a field, the box of its samples.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match *self {
            Self::Sphere { radius } => (Vec3::splat(-radius), Vec3::splat(radius)),
            Self::Box { half_extents } => (-half_extents, half_extents),
            Self::Capsule { height, radius_bottom, radius_top } => {
                capsule::bounds(height, radius_bottom, radius_top)
            }
            Self::Cylinder { height, radius_bottom, radius_top } => {
                let radius = radius_bottom.max(radius_top);
                let high = Vec3::new(radius, 0.5 * height, radius);
                (-high, high)
            }
            Self::Field(ref field) => field.bounds(),
        }
    }

    /// Smallest t in (0, `t_max`] at which `origin` + t `direction` lies on the surface, met from either side.
    ///
    /// `direction` is finite, not zero, and need not have unit length: t is in units of it. Rays that start on the
    /// outside of a convex shape and move away from it never meet it.
    #[must_use]
    pub fn intersect(&self, origin: Vec3, direction: Vec3, t_max: f32) -> Option<f32> {
        let crossing = match *self {
            Self::Sphere { radius } => sphere::crossing(origin, direction, radius),
            Self::Box { half_extents } => cuboid::crossing(origin, direction, half_extents),
            Self::Capsule { height, radius_bottom, radius_top } => {
                capsule::crossing(origin, direction, height, radius_bottom, radius_top)
            }
            Self::Cylinder { height, radius_bottom, radius_top } => {
                cylinder::crossing(origin, direction, height, radius_bottom, radius_top)
            }
            Self::Field(ref field) => return field.intersect(origin, direction, t_max),
        };
        crossing.first(t_max)
    }

    /// Unit normal on the outer side at the point `p` of the surface; of a field, where its values are positive.
    #[must_use]
    pub fn normal(&self, p: Vec3) -> Vec3 {
        match *self {
            Self::Sphere { .. } => sphere::normal(p),
            Self::Box { half_extents } => cuboid::normal(p, half_extents),
            Self::Capsule { height, radius_bottom, radius_top } => {
                capsule::normal(p, height, radius_bottom, radius_top)
            }
            Self::Cylinder { height, radius_bottom, radius_top } => {
                cylinder::normal(p, height, radius_bottom, radius_top)
            }
            Self::Field(ref field) => field.normal(p),
        }
    }

    /// The point of the surface next to `p`, which is off it by rounding only: a hit is as far off as its distance is
    /// rounded, and the offset of the next ray must not have to cover that.
    #[must_use]
    pub fn project(&self, p: Vec3) -> Vec3 {
        match *self {
            Self::Sphere { radius } => sphere::project(p, radius),
            Self::Box { half_extents } => cuboid::project(p, half_extents),
            Self::Capsule { height, radius_bottom, radius_top } => {
                capsule::project(p, height, radius_bottom, radius_top)
            }
            Self::Cylinder { height, radius_bottom, radius_top } => {
                cylinder::project(p, height, radius_bottom, radius_top)
            }
            Self::Field(ref field) => field.project(p),
        }
    }
}
