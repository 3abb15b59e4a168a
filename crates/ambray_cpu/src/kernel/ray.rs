//! What a ray needs to be tested against boxes and triangles.

use glam::{Affine3A, Vec3};

/// Reciprocals of direction components stay below this, so that 0 · reciprocal is 0 and never NaN. A ray that is
/// this steep moves less than 2⁻¹⁰⁰ units along the axis a unit of t.
pub(crate) const LARGEST_RECIPROCAL: f32 = 1.267_650_6e30;

/// Axes permuted so that the last is x, y or z.
pub(crate) const AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

/// For each axis which of a node's planes a ray meets first and last, if it points `down` the axis or not.
#[inline(always)]
pub(crate) fn planes(down: [bool; 3]) -> ([usize; 3], [usize; 3]) {
    let down = down.map(usize::from);
    ([3 * down[0], 1 + 3 * down[1], 2 + 3 * down[2]], [3 - 3 * down[0], 4 - 3 * down[1], 5 - 3 * down[2]])
}

/// Ray prepared for the slab test and the triangle test, in the space of one tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prepared {
    pub(crate) origin: [f32; 3],
    pub(crate) reciprocal: [f32; 3],
    /// Axes permuted so that the direction is longest along the last (Woop et al. 2013).
    pub(crate) axes: [usize; 3],
    /// d_x / d_z, d_y / d_z, 1 / d_z in permuted axes.
    pub(crate) shear: [f32; 3],
    /// For each axis which of a node's planes is met first.
    pub(crate) near: [usize; 3],
    /// For each axis which of a node's planes is met last.
    pub(crate) far: [usize; 3],
}

impl Prepared {
    /// `None` if the ray cannot hit anything: not finite, or without direction.
    #[inline(always)]
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Option<Self> {
        let d = direction.to_array();
        if !origin.is_finite() || !direction.is_finite() || d == [0.0; 3] {
            return None;
        }
        let a = d.map(f32::abs);
        let z = if a[0] >= a[1] && a[0] >= a[2] {
            0
        } else if a[1] >= a[2] {
            1
        } else {
            2
        };
        let axes = AXES[z];
        let reciprocal = d.map(|d| {
            let r = 1.0 / d;
            if r.abs() <= LARGEST_RECIPROCAL { r } else { LARGEST_RECIPROCAL.copysign(d) }
        });
        let (near, far) = planes(reciprocal.map(|r| r < 0.0));
        Some(Self {
            origin: origin.to_array(),
            reciprocal,
            axes,
            shear: [d[axes[0]] / d[axes[2]], d[axes[1]] / d[axes[2]], 1.0 / d[axes[2]]],
            near,
            far,
        })
    }

    /// The ray seen by an instance. The direction is not normalised, so that t means the same in both spaces.
    #[inline(always)]
    pub(crate) fn transformed(object_from_world: &Affine3A, origin: Vec3, direction: Vec3) -> Option<Self> {
        Self::new(object_from_world.transform_point3(origin), object_from_world.transform_vector3(direction))
    }
}
