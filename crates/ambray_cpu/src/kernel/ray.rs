//! What a ray needs to be tested against boxes and triangles.

use glam::{Affine3A, Vec3};

use super::slab::Slab;

/// Reciprocals of direction components are no larger than this, 2¹²⁶, over the largest coordinate of the origin where that is
/// above 1: they and their products with the origin are finite, and 0 · reciprocal is 0 and never NaN. A ray that is so steep
/// stays in its plane.
pub(crate) const LARGEST_RECIPROCAL: f32 = 8.507_059e37;

/// An axis of space; unlike an index it needs no check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(crate) enum Axis {
    X = 0,
    Y = 1,
    Z = 2,
}

impl Axis {
    /// Axes permuted so that this is the last.
    #[inline(always)]
    pub(crate) const fn last(self) -> [Self; 3] {
        match self {
            Self::X => [Self::Y, Self::Z, Self::X],
            Self::Y => [Self::Z, Self::X, Self::Y],
            Self::Z => [Self::X, Self::Y, Self::Z],
        }
    }
}

/// Which of a box's planes a ray meets first along each axis, and which last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Order {
    /// Whether the ray points down the axis.
    pub(crate) down: [bool; 3],
}

impl Order {
    #[inline(always)]
    pub(crate) fn near(self, axis: usize) -> usize {
        axis + 3 * usize::from(self.down[axis])
    }

    #[inline(always)]
    pub(crate) fn far(self, axis: usize) -> usize {
        axis + 3 * usize::from(!self.down[axis])
    }
}

/// What the triangle test needs of a ray.
pub(crate) trait OneRay {
    fn origin(&self, axis: usize) -> f32;
    fn reciprocal(&self, axis: usize) -> f32;
    /// d_x / d_z, d_y / d_z, 1 / d_z in permuted axes.
    fn shear(&self, axis: usize) -> f32;
    /// Permuted so that the direction is longest along the last.
    fn axes(&self) -> [Axis; 3];
    fn order(&self) -> Order;
}

/// Ray prepared for the slab test and the triangle test, in the space of one tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prepared {
    pub(crate) origin: [f32; 3],
    pub(crate) slab: [Slab; 3],
    /// Axes permuted so that the direction is longest along the last (Woop et al. 2013).
    pub(crate) axes: [Axis; 3],
    /// d_x / d_z, d_y / d_z, 1 / d_z in permuted axes.
    pub(crate) shear: [f32; 3],
    pub(crate) order: Order,
}

impl Prepared {
    /// `None` if the ray cannot hit anything: not finite, or without direction.
    #[inline(always)]
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Option<Self> {
        // So that there is no −0, which looks the other way.
        let (o, d) = (origin.to_array(), (direction + Vec3::ZERO).to_array());
        if !origin.is_finite() || !direction.is_finite() || d == [0.0; 3] {
            return None;
        }
        let a = d.map(f32::abs);
        let longest = if a[0] >= a[1] && a[0] >= a[2] {
            Axis::X
        } else if a[1] >= a[2] {
            Axis::Y
        } else {
            Axis::Z
        };
        let axes = longest.last();
        let far = o[0].abs().max(o[1].abs()).max(o[2].abs()).max(1.0);
        let mut slab = [Slab::NONE; 3];
        for axis in 0..3 {
            let r = 1.0 / d[axis];
            let steepest = (LARGEST_RECIPROCAL / far).copysign(d[axis]);
            let reciprocal = if r.abs() * far <= LARGEST_RECIPROCAL { r } else { steepest };
            slab[axis] = Slab::new(o[axis], reciprocal);
        }
        let [x, y, z] = axes.map(|axis| d[axis as usize]);
        let down = slab.map(|slab| slab.reciprocal < 0.0);
        Some(Self { origin: o, slab, axes, shear: [x / z, y / z, 1.0 / z], order: Order { down } })
    }

    /// The ray seen by an instance. The direction is not normalised, so that t means the same in both spaces.
    #[inline(always)]
    pub(crate) fn transformed(object_from_world: &Affine3A, origin: Vec3, direction: Vec3) -> Option<Self> {
        Self::new(object_from_world.transform_point3(origin), object_from_world.transform_vector3(direction))
    }
}

impl OneRay for Prepared {
    #[inline(always)]
    fn origin(&self, axis: usize) -> f32 {
        self.origin[axis]
    }
    #[inline(always)]
    fn reciprocal(&self, axis: usize) -> f32 {
        self.slab[axis].reciprocal
    }
    #[inline(always)]
    fn shear(&self, axis: usize) -> f32 {
        self.shear[axis]
    }
    #[inline(always)]
    fn axes(&self) -> [Axis; 3] {
        self.axes
    }
    #[inline(always)]
    fn order(&self) -> Order {
        self.order
    }
}
