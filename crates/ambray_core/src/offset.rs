//! Ray origins moved off their surface (spec §5).

use glam::Vec3;

/// Moves `p` off a surface along its geometric normal `n`, by about 256 units in the last place of each coordinate,
/// or by `n/65536` where a coordinate is below 1/32 (Wächter and Binder 2019, "A fast and robust method for avoiding
/// self-intersection").
///
/// `p` should come from barycentric coordinates, and `n` must be the unit normal on the side of the outgoing ray.
#[must_use]
pub fn offset_point(p: Vec3, n: Vec3) -> Vec3 {
    Vec3::new(offset_coordinate(p.x, n.x), offset_coordinate(p.y, n.y), offset_coordinate(p.z, n.z))
}

fn offset_coordinate(p: f32, n: f32) -> f32 {
    if p.abs() < 1.0 / 32.0 {
        return p + n * (1.0 / 65536.0);
    }
    let of_i = (256.0 * n) as i32;
    // Bit patterns of floats are ordered like integers of their magnitude, so the sign of p decides the direction.
    f32::from_bits((p.to_bits() as i32).wrapping_add(if p < 0.0 { -of_i } else { of_i }) as u32)
}
