//! Points on placed shapes: positions come from the ray, since shapes have no corners to interpolate.

use ambray_core::shape::Shape;
use ambray_core::trace::{Hit, Ray};
use glam::{Affine3A, Mat3A, Vec3, Vec3A};

use crate::ShapeInstance;
use crate::surface::normal_matrix;

/// What placing a shape does to rays and normals.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeFrame {
    object_from_world: Affine3A,
    /// Turns normals; does not keep their length.
    normal_from_object: Mat3A,
    reach: f32,
}

/// A point on a placed shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapePoint {
    /// World space.
    pub(crate) position: Vec3,
    pub(crate) object_position: Vec3,
    /// Unit normal on the outer side, world space.
    pub(crate) normal: Vec3,
    pub(crate) reach: f32,
}

impl ShapeInstance {
    /// Largest magnitude of the numbers that points of the placed `shape` are computed from, and of those that a ray which
    /// leaves them is compared with, in world units: what rounding errors follow (see
    /// [`RayOffset::apply`](ambray_core::offset::RayOffset::apply)).
    #[must_use]
    pub fn reach(&self, shape: &Shape) -> f32 {
        let (low, high) = shape.bounds();
        let size = Vec3A::from(low.abs().max(high.abs()));
        let (placed, back) = (self.world_from_object, self.world_from_object.inverse());
        let (m, back_m) = (magnitudes(placed.matrix3), magnitudes(back.matrix3));
        let point = m * size + placed.translation.abs();
        // The ray is taken back to object space, whose rounding errors the placement scales again.
        let of_ray = m * (back_m * point + back.translation.abs());
        point.max(of_ray).max_element()
    }
}

fn magnitudes(m: Mat3A) -> Mat3A {
    Mat3A::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

impl ShapeFrame {
    pub(crate) fn new(instance: &ShapeInstance, shape: &Shape) -> Self {
        Self {
            object_from_world: instance.world_from_object.inverse(),
            normal_from_object: normal_matrix(instance.world_from_object.matrix3),
            reach: instance.reach(shape),
        }
    }

    /// A normal of the shape's own space in the world, unit.
    pub(crate) fn normal(&self, object: Vec3) -> Vec3 {
        let normal: Vec3 = (self.normal_from_object * Vec3A::from(object)).into();
        // The matrix may be tiny or huge; a direction is left as long as a component is.
        (normal / normal.abs().max_element()).try_normalize().unwrap_or(Vec3::Y)
    }

    /// The point of `shape`, placed by `instance`, at the `hit` of `ray`.
    pub(crate) fn point(&self, instance: &ShapeInstance, shape: &Shape, ray: &Ray, hit: &Hit) -> ShapePoint {
        let origin = self.object_from_world.transform_point3(ray.origin);
        let direction = self.object_from_world.transform_vector3(ray.direction);
        let object_position = shape.project(origin + direction * hit.t);
        let normal = self.normal(shape.normal(object_position));
        let position = instance.world_from_object.transform_point3(object_position);
        ShapePoint { position, object_position, normal, reach: self.reach }
    }
}
