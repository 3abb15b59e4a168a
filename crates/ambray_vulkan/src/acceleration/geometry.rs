//! The triangles and boxes that rays can hit.

use ambray_core::shape::Shape;
use ambray_scene::{Mesh, ShapeInstance};
use glam::{Affine3A, Vec3};

use super::bounds::Bounds;

/// Largest coordinate that is traced, as on the CPU: beyond it products overflow.
const LARGEST: f32 = 1e12;

/// Share of its largest coordinate by which the box of a shape is enlarged: some units in the last place, since the box
/// and the surface within it are rounded each in its own way.
const SHAPE_PAD: f32 = 8.0 * f32::EPSILON;

/// Whether rays can hit a triangle: all corners within [`LARGEST`], and not of zero area (in f64; coincident or collinear
/// corners). The CPU backend drops the same ones, so both see the same scene.
fn is_hittable([a, b, c]: [Vec3; 3]) -> bool {
    let within = |p: Vec3| p.is_finite() && p.abs().max_element() <= LARGEST;
    let area = || {
        let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
        (b - a).cross(c - a).abs().max_element()
    };
    within(a) && within(b) && within(c) && area() > 0.0
}

/// A mesh placed in the space of a structure.
pub(super) struct Placed<'m> {
    mesh: &'m Mesh,
    /// One a vertex of the mesh.
    pub(super) positions: Vec<Vec3>,
}

impl<'m> Placed<'m> {
    pub(super) fn new(mesh: &'m Mesh, transform: &Affine3A) -> Self {
        let positions = mesh.positions.iter().map(|&p| transform.transform_point3(p)).collect();
        Self { mesh, positions }
    }

    /// Number in the mesh, vertices and corners of each triangle that rays can hit.
    pub(super) fn hittable(&self) -> impl Iterator<Item = (u32, [u32; 3], [Vec3; 3])> {
        (0_u32..).zip(&self.mesh.triangles).filter_map(|(triangle, &vertices)| {
            let corners = vertices.map(|i| self.positions[i as usize]);
            is_hittable(corners).then_some((triangle, vertices, corners))
        })
    }

    /// Box around the triangles that rays can hit, and their number.
    pub(super) fn bounds(&self) -> (Bounds, u64) {
        self.hittable().fold((Bounds::EMPTY, 0), |(bounds, count), (_, _, corners)| {
            (corners.into_iter().fold(bounds, Bounds::with), count + 1)
        })
    }
}

/// Box of a placed shape in the world; `None` if no ray can hit it.
pub(super) fn shape_bounds(shape: &Shape, instance: &ShapeInstance) -> Option<Bounds> {
    place(shape_box(shape), &instance.world_from_object).map(|b| b.padded(SHAPE_PAD))
}

/// Box of a shape in its own space.
pub(super) fn shape_box(shape: &Shape) -> Bounds {
    let (lo, hi) = shape.bounds();
    Bounds { lo, hi }.padded(SHAPE_PAD)
}

/// World-space box of `bounds` placed by `transform`; `None` if no ray can hit it there: the placement must have an
/// inverse, and lead to coordinates that can be traced.
pub(super) fn place(bounds: Bounds, transform: &Affine3A) -> Option<Bounds> {
    let world = bounds.transformed(transform);
    let is_invertible = transform.is_finite() && transform.inverse().is_finite();
    (is_invertible && !world.is_empty() && world.extent() <= LARGEST).then_some(world)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_that_cannot_be_hit_are_dropped() {
        let good = [Vec3::ZERO, Vec3::X, Vec3::Y];
        assert!(is_hittable(good));
        assert!(is_hittable(good.map(|p| p * 1e-30)), "areas are taken in f64");
        assert!(!is_hittable([Vec3::ZERO, Vec3::X, 2.0 * Vec3::X]));
        assert!(!is_hittable([Vec3::ZERO, Vec3::X, Vec3::Y * 2e12]));
        assert!(!is_hittable([Vec3::ZERO, Vec3::X, Vec3::NAN]));
    }

    #[test]
    fn placements_without_inverse_hide_what_they_place() {
        let unit = Bounds { lo: Vec3::ZERO, hi: Vec3::ONE };
        assert_eq!(place(unit, &Affine3A::from_translation(Vec3::X)).unwrap().hi, Vec3::new(2.0, 1.0, 1.0));
        assert_eq!(place(unit, &Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))), None);
        assert_eq!(place(unit, &Affine3A::from_translation(Vec3::X * 1e13)), None);
        assert_eq!(place(Bounds::EMPTY, &Affine3A::IDENTITY), None);
    }
}
