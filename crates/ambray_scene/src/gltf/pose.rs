//! Morph targets and skins: from a rest shape, weights and joint matrices to the mesh as it stands.
//!
//! [`Deformable`] keeps all that a pose depends on, so that evaluating another one needs no file.

use glam::{Affine3A, DAffine3, DMat4, Mat3A, Vec3, Vec3A};

use crate::Mesh;
use crate::error::{Fault, Outcome};
use crate::surface::normal_matrix;

use super::accessor::Accept;
use super::document::{Document, missing};
use super::json::Index;

/// A primitive at rest and what deforms it.
#[derive(Clone, Debug, Default)]
pub(super) struct Deformable {
    /// Undeformed, in object space.
    pub(super) rest: Mesh,
    /// Displacements, added by weight.
    pub(super) targets: Vec<MorphTarget>,
    /// Joints of each vertex: glTF's sets of four, flattened. Empty without a skin.
    pub(super) influences: Vec<Influence>,
    /// Influences of one vertex: they lie one after the other.
    pub(super) influences_per_vertex: usize,
}

/// Displacements of all vertices; each list is empty if the target leaves that attribute alone.
#[derive(Clone, Debug, Default)]
pub(super) struct MorphTarget {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) tangents: Vec<Vec3>,
}

/// Pull of a joint on a vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Influence {
    pub(super) joint: u32,
    pub(super) weight: f32,
}

impl Deformable {
    /// Whether `joints` or `weights` could change the rest shape.
    pub(super) fn is_deformed_by(&self, weights: &[f32], skinned: bool) -> bool {
        let morphed = self.targets.iter().zip(weights).any(|(_, &weight)| weight != 0.0);
        morphed || (skinned && !self.influences.is_empty())
    }

    /// The mesh for these morph weights and, if the node has a skin, these joint matrices (world from bind space).
    ///
    /// With `joints` the result is in world space. Every joint of the influences must exist.
    pub(super) fn pose(&self, weights: &[f32], joints: Option<&[Affine3A]>) -> Mesh {
        let mut mesh = self.rest.clone();
        for (target, &weight) in self.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            add(&mut mesh.positions, &target.positions, weight);
            add(&mut mesh.normals, &target.normals, weight);
            for (tangent, delta) in mesh.tangents.iter_mut().zip(&target.tangents) {
                *tangent += (*delta * weight).extend(0.0);
            }
        }
        if let Some(joints) = joints.filter(|_| !self.influences.is_empty()) {
            self.skin(&mut mesh, joints);
        }
        mesh
    }

    fn skin(&self, mesh: &mut Mesh, joints: &[Affine3A]) {
        for (i, influences) in self.influences.chunks_exact(self.influences_per_vertex).enumerate() {
            let m = blend(influences, joints);
            mesh.positions[i] = m.transform_point3(mesh.positions[i]);
            if let Some(normal) = mesh.normals.get_mut(i) {
                *normal = (normal_matrix(m.matrix3) * Vec3A::from(*normal)).normalize_or_zero().into();
            }
            if let Some(tangent) = mesh.tangents.get_mut(i) {
                let turned = m.transform_vector3(tangent.truncate()).normalize_or_zero();
                // A mirroring bone mirrors the bitangent, too.
                let side = if m.matrix3.determinant() < 0.0 { -tangent.w } else { tangent.w };
                *tangent = turned.extend(side);
            }
        }
    }
}

fn add(to: &mut [Vec3], delta: &[Vec3], weight: f32) {
    to.iter_mut().zip(delta).for_each(|(to, delta)| *to += *delta * weight);
}

/// Weighted mean of the joints; weights that do not add up to 1 are scaled, and without any the first joint rules.
fn blend(influences: &[Influence], joints: &[Affine3A]) -> Affine3A {
    let total: f32 = influences.iter().map(|influence| influence.weight).sum();
    if !(total > 0.0 && total.is_finite()) {
        return joints[influences[0].joint as usize];
    }
    let mut sum = Affine3A { matrix3: Mat3A::ZERO, translation: Vec3A::ZERO };
    for influence in influences.iter().filter(|influence| influence.weight != 0.0) {
        let (joint, weight) = (&joints[influence.joint as usize], influence.weight / total);
        sum.matrix3 += joint.matrix3 * weight;
        sum.translation += joint.translation * weight;
    }
    sum
}

/// Joint matrices of skin `index`: world from bind space, for the nodes where `world` puts them.
pub(super) fn joint_matrices(
    doc: &Document<'_>,
    index: Index,
    world: &[DAffine3],
    at: &str,
) -> Outcome<Vec<Affine3A>> {
    let skin = doc.root.skins.get(index).ok_or_else(|| missing(at, "skin", index))?;
    let place = format!("skins[{index}]");
    if skin.joints.is_empty() {
        return Err(Fault::invalid(format!("{place}.joints"), "skin without joints"));
    }
    let binds = match skin.inverse_bind_matrices {
        Some(accessor) => doc.read::<16>(accessor, Accept::Float, &format!("{place}.inverseBindMatrices"))?,
        None => Vec::new(),
    };
    if skin.inverse_bind_matrices.is_some() && binds.len() < skin.joints.len() {
        let reason = format!("{} matrices for {} joints", binds.len(), skin.joints.len());
        return Err(Fault::invalid(format!("{place}.inverseBindMatrices"), reason));
    }
    let joint = |(i, &node): (usize, &Index)| {
        let world = world.get(node).ok_or_else(|| missing(&format!("{place}.joints[{i}]"), "node", node))?;
        let bind = binds.get(i).map_or(DAffine3::IDENTITY, |columns| {
            DAffine3::from_mat4(DMat4::from_cols_array(&columns.map(f64::from)))
        });
        Ok(super::nodes::single(*world * bind))
    };
    skin.joints.iter().enumerate().map(joint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec4;

    #[test]
    fn weights_move_then_joints_turn() {
        let shape = Deformable {
            rest: Mesh {
                positions: vec![Vec3::X, Vec3::Y],
                normals: vec![Vec3::X, Vec3::Z],
                tangents: vec![Vec4::new(0.0, 1.0, 0.0, 1.0); 2],
                ..Mesh::default()
            },
            targets: vec![MorphTarget { positions: vec![Vec3::X, Vec3::ZERO], ..MorphTarget::default() }],
            influences: vec![Influence { joint: 0, weight: 2.0 }, Influence { joint: 1, weight: 0.0 }],
            influences_per_vertex: 1,
        };
        let joints =
            [Affine3A::from_rotation_z(std::f32::consts::FRAC_PI_2), Affine3A::from_scale(Vec3::splat(3.0))];
        let posed = shape.pose(&[0.5], Some(&joints));
        assert!(posed.positions[0].abs_diff_eq(Vec3::Y * 1.5, 1e-6), "{}", posed.positions[0]);
        assert!(posed.normals[0].abs_diff_eq(Vec3::Y, 1e-6));
        assert!(posed.tangents[0].abs_diff_eq(Vec4::new(-1.0, 0.0, 0.0, 1.0), 1e-6));
        // No weight at all: the first joint rules.
        assert!(posed.positions[1].abs_diff_eq(Vec3::Y * 3.0, 1e-6));
        assert_eq!(shape.pose(&[0.0], None), shape.rest);
        assert!(!shape.is_deformed_by(&[0.0], false) && shape.is_deformed_by(&[], true));
    }
}
