//! Makes any vertex data satisfy the invariants of [`Mesh`].
//!
//! Triangles that use a position which is not finite are dropped, and that position becomes the origin. Normals that
//! are not finite or have no length become the mean of the adjacent faces' normals, tangents any vector orthogonal to
//! the normal. Texture coordinates become 0, colours white. Colours are clamped to [0, 1].

use glam::{Vec2, Vec3, Vec4};

use crate::Mesh;
use crate::warnings::Warnings;

/// Repairs `mesh`, whose attribute lengths and indices must be right already, and says what was done.
pub(crate) fn repair(mesh: &mut Mesh, warnings: &mut Warnings) {
    drop_broken_triangles(mesh, warnings);
    repair_normals(mesh, warnings);
    repair_tangents(mesh);
    let mut repaired = 0;
    for uv in mesh.uvs.iter_mut().flatten().filter(|uv| !uv.is_finite()) {
        *uv = Vec2::ZERO;
        repaired += 1;
    }
    for color in &mut mesh.colors {
        if !color.is_finite() {
            *color = Vec4::ONE;
            repaired += 1;
        }
        *color = color.clamp(Vec4::ZERO, Vec4::ONE);
    }
    warnings.tally("texture coordinates or colours that are not finite are replaced", repaired);
}

fn drop_broken_triangles(mesh: &mut Mesh, warnings: &mut Warnings) {
    if mesh.positions.iter().all(|p| p.is_finite()) {
        return;
    }
    let (positions, before) = (&mesh.positions, mesh.triangles.len());
    mesh.triangles.retain(|triangle| triangle.iter().all(|&i| positions[i as usize].is_finite()));
    let dropped = before - mesh.triangles.len();
    warnings.tally("triangles with a vertex position that is not finite are dropped", dropped as u64);
    for p in mesh.positions.iter_mut().filter(|p| !p.is_finite()) {
        *p = Vec3::ZERO;
    }
}

fn repair_normals(mesh: &mut Mesh, warnings: &mut Warnings) {
    let mut broken = 0;
    for n in &mut mesh.normals {
        // Normals of tiny length are as good as long ones: scale before squaring.
        let scaled = *n / n.abs().max_element();
        *n = scaled.try_normalize().unwrap_or(Vec3::NAN);
        broken += u64::from(n.is_nan());
    }
    if broken == 0 {
        return;
    }
    warnings.tally("vertex normals without a direction are replaced", broken);
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a);
        triangle.iter().for_each(|&i| sums[i as usize] += normal);
    }
    for (n, sum) in mesh.normals.iter_mut().zip(sums).filter(|(n, _)| n.is_nan()) {
        *n = sum.try_normalize().unwrap_or(Vec3::Y);
    }
}

fn repair_tangents(mesh: &mut Mesh) {
    for (i, tangent) in mesh.tangents.iter_mut().enumerate() {
        let xyz = tangent.truncate();
        let unit = if xyz.is_finite() { xyz.try_normalize() } else { None };
        let unit =
            unit.unwrap_or_else(|| mesh.normals.get(i).map_or(Vec3::X, |n| n.any_orthonormal_vector()));
        *tangent = unit.extend(if tangent.w < 0.0 { -1.0 } else { 1.0 });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_data_is_repaired() {
        let nan = f32::NAN;
        let mut mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::Z, Vec3::X, Vec3::new(f32::INFINITY, 0.0, 0.0)],
            normals: vec![Vec3::Y * 1e-30, Vec3::ZERO, Vec3::splat(nan), Vec3::ZERO],
            tangents: vec![Vec4::new(nan, 0.0, 0.0, -1.0); 4],
            uvs: vec![vec![Vec2::new(nan, 1.0); 4]],
            colors: vec![Vec4::new(2.0, -1.0, 0.5, 1.0), Vec4::splat(nan), Vec4::ZERO, Vec4::ONE],
            triangles: vec![[0, 1, 2], [1, 2, 3]],
            ..Mesh::default()
        };
        let mut warnings = Warnings::default();
        repair(&mut mesh, &mut warnings);
        mesh.validate().expect("repaired");
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(mesh.normals, [Vec3::Y; 4]);
        assert!(mesh.tangents.iter().all(|t| t.truncate().is_normalized() && t.y == 0.0 && t.w == -1.0));
        assert_eq!(mesh.uvs[0], [Vec2::ZERO; 4]);
        assert_eq!(mesh.colors[..2], [Vec4::new(1.0, 0.0, 0.5, 1.0), Vec4::ONE]);
        assert_eq!(warnings.into_lines().len(), 3);
    }
}
