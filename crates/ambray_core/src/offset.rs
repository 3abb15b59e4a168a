//! Ray origins moved off their surface (spec §5).

use glam::Vec3;

/// Moves ray origins off their surface along the geometric normal, by about 256 units in the last place of each
/// coordinate (Wächter and Binder 2019, "A fast and robust method for avoiding self-intersection").
///
/// Near zero, where units in the last place vanish, the method falls back to a fixed distance of 1/65536 for coordinates
/// below 1/32. That is 1.5 % of a millimetre-sized thing modelled in metres, so scenes smaller than one unit scale both
/// constants down by a power of two: results are then invariant under such scaling.
///
/// The published offset follows the point's own coordinates, but the errors of the point and of the tracer follow those
/// of the triangle it lies on: on a slanted floor of 100 units, a point near the origin is off the plane by more than
/// 1/65536. So an offset is at least 4 ε of the triangle's reach, where that is more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayOffset {
    /// Coordinates below this take the fixed distance.
    near_zero: f32,
    /// The fixed distance.
    distance: f32,
}

/// Share of a triangle's reach by which rays leave it at least. Measured on tilted quads of 10 to 10⁴ units, points lie up
/// to 0.92 ε of the reach off the plane of their triangle, and the tracer errs by as much again.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

impl RayOffset {
    /// The constants of the publication, for scenes of one unit and more.
    pub const UNIT: Self = Self { near_zero: 1.0 / 32.0, distance: 1.0 / 65536.0 };

    /// Offsets for a scene whose coordinates reach up to `extent` in magnitude.
    #[must_use]
    pub fn for_extent(extent: f32) -> Self {
        if extent.is_nan() || extent >= 1.0 {
            return Self::UNIT;
        }
        // The power of two at or below the extent; 2⁻⁶⁴ keeps its constants normal numbers.
        let exponent = libm::ilogbf(extent.max(f32::MIN_POSITIVE)).max(-64);
        let scale = libm::scalbnf(1.0, exponent);
        Self { near_zero: scale * Self::UNIT.near_zero, distance: scale * Self::UNIT.distance }
    }

    /// The constants: coordinates below the first take the second as a fixed distance.
    #[must_use]
    pub const fn constants(&self) -> [f32; 2] {
        [self.near_zero, self.distance]
    }

    /// Moves `p` off a surface along its geometric normal `n`.
    ///
    /// `p` should come from barycentric coordinates, and `n` must be the unit normal on the side of the outgoing ray.
    /// `reach` is the largest magnitude of a coordinate of the triangle's corners, and of the numbers they are computed
    /// from; 0 is the published offset.
    #[must_use]
    #[inline(always)]
    pub fn apply(&self, p: Vec3, n: Vec3, reach: f32) -> Vec3 {
        let published =
            Vec3::new(self.coordinate(p.x, n.x), self.coordinate(p.y, n.y), self.coordinate(p.z, n.z));
        let rounding = n * (ROUNDING * reach);
        Vec3::select((published - p).abs().cmplt(rounding.abs()), p + rounding, published)
    }

    #[inline(always)]
    fn coordinate(&self, p: f32, n: f32) -> f32 {
        if p.abs() < self.near_zero {
            return p + n * self.distance;
        }
        let of_i = (256.0 * n) as i32;
        // Bit patterns of floats are ordered like integers of their magnitude, so the sign of p decides the direction.
        f32::from_bits((p.to_bits() as i32).wrapping_add(if p < 0.0 { -of_i } else { of_i }) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_scenes_scale_the_constants() {
        assert_eq!(RayOffset::for_extent(40.0), RayOffset::UNIT);
        let small = RayOffset::for_extent(0.1);
        let (p, n) = (Vec3::new(0.01, 0.0, -0.05), Vec3::new(0.6, 0.8, 0.0));
        assert_eq!(small.apply(p, n, 0.0) * 16.0, RayOffset::UNIT.apply(p * 16.0, n, 0.0));
        assert!(RayOffset::for_extent(0.0).apply(Vec3::ZERO, Vec3::Y, 0.0).y > 0.0);
    }
}
