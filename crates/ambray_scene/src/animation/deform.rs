//! Morph targets and skins: from a shape at rest, weights and joint matrices to the shape as it stands.
//!
//! `shaders/deform.comp` of the Vulkan backend is the twin of this file: change both.

use glam::{Affine3A, Mat3A, Vec3, Vec3A, Vec4};

use crate::surface::normal_matrix;

/// A mesh of the scene at rest, and what deforms it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deformer {
    /// Index into [`Scene::meshes`](crate::Scene::meshes).
    pub mesh: u32,
    /// Node whose morph weights it follows: index into [`Rig::nodes`](super::Rig::nodes).
    pub node: u32,
    /// Index into [`Rig::skins`](super::Rig::skins); `None` without influences.
    pub skin: Option<u32>,
    /// Positions at rest: one a vertex of the mesh, finite.
    pub positions: Vec<Vec3>,
    /// Unit normals at rest; empty if the mesh has none.
    pub normals: Vec<Vec3>,
    /// Unit tangents at rest, with the bitangent's sign in w; empty if the mesh has none.
    pub tangents: Vec<Vec4>,
    /// Displacements, added by weight.
    pub targets: Vec<MorphTarget>,
    /// Joints of each vertex, [`Self::influences_per_vertex`] each, one vertex after the other; empty without a skin. Every
    /// joint is in the skin.
    pub influences: Vec<Influence>,
    /// Influences of one vertex: a multiple of 4.
    pub influences_per_vertex: usize,
}

/// Displacements of all vertices; each list is empty if the target leaves that attribute alone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// Of positions.
    pub positions: Vec<Vec3>,
    /// Of normals.
    pub normals: Vec<Vec3>,
    /// Of tangents, without their sign.
    pub tangents: Vec<Vec3>,
}

/// Pull of a joint on a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Influence {
    /// Index into [`Skin::joints`](super::Skin::joints).
    pub joint: u32,
    /// Weight; those of a vertex are scaled to add up to 1.
    pub weight: f32,
}

/// A deformed vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// In the space of the mesh's instances: the world if it has a skin.
    pub position: Vec3,
    /// Unit, or [`Vec3::ZERO`] if the mesh has no normals.
    pub normal: Vec3,
    /// Unit with the bitangent's sign in w, or [`Vec4::ZERO`] if the mesh has no tangents.
    pub tangent: Vec4,
}

/// Largest coordinate of a deformed vertex. What lies beyond, or is no number, goes to the origin.
pub const LARGEST_COORDINATE: f32 = 1e12;

impl Deformer {
    /// Vertex `i` for these morph weights and joint matrices, which are those of its
    /// [`Pose`](super::Pose); `joints` is empty without a skin.
    ///
    /// # Panics
    /// If there is no such vertex or joint.
    #[must_use]
    pub fn vertex(&self, i: usize, weights: &[f32], joints: &[Affine3A]) -> Vertex {
        let mut position = self.positions[i];
        let mut normal = self.normals.get(i).copied().unwrap_or_default();
        let mut tangent = self.tangents.get(i).copied().unwrap_or_default();
        for (target, &weight) in self.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let delta = |list: &[Vec3]| list.get(i).map_or(Vec3::ZERO, |&delta| delta * weight);
            position += delta(&target.positions);
            normal += delta(&target.normals);
            tangent += delta(&target.tangents).extend(0.0);
        }
        if !self.influences.is_empty() {
            let first = i * self.influences_per_vertex;
            let m = blend(&self.influences[first..first + self.influences_per_vertex], joints);
            position = m.transform_point3(position);
            normal = (normal_matrix(m.matrix3) * Vec3A::from(normal)).into();
            // A mirroring bone mirrors the bitangent, too.
            let side = if m.matrix3.determinant() < 0.0 { -tangent.w } else { tangent.w };
            tangent = m.transform_vector3(tangent.truncate()).extend(side);
        }
        Vertex {
            // Number by number: a maximum would pass over what is no number.
            position: if position.abs().cmple(Vec3::splat(LARGEST_COORDINATE)).all() {
                position
            } else {
                Vec3::ZERO
            },
            normal: unit(normal, || self.normals.get(i).copied()),
            tangent: unit(tangent.truncate(), || self.tangents.get(i).map(|t| t.truncate()))
                .extend(tangent.w),
        }
    }
}

/// `v` with length 1; `rest` where it has no direction, and nothing where there is no rest.
fn unit(v: Vec3, rest: impl Fn() -> Option<Vec3>) -> Vec3 {
    let Some(rest) = rest() else { return Vec3::ZERO };
    v.try_normalize().unwrap_or(rest)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn influences<const N: usize>(pairs: [(u32, f32); N]) -> Vec<Influence> {
        pairs.into_iter().map(|(joint, weight)| Influence { joint, weight }).collect()
    }

    /// Two vertices with normals and tangents, a target that moves the first along x.
    fn deformer() -> Deformer {
        Deformer {
            positions: vec![Vec3::X, Vec3::Y],
            normals: vec![Vec3::X, Vec3::Z],
            tangents: vec![Vec4::new(0.0, 1.0, 0.0, 1.0); 2],
            targets: vec![MorphTarget { positions: vec![Vec3::X, Vec3::ZERO], ..MorphTarget::default() }],
            influences: influences([
                (0, 2.0),
                (0, 0.0),
                (0, 0.0),
                (1, 0.0),
                (1, 0.0),
                (0, 0.0),
                (0, 0.0),
                (0, 0.0),
            ]),
            influences_per_vertex: 4,
            ..Deformer::default()
        }
    }

    #[test]
    fn weights_move_then_joints_turn() {
        let deformer = deformer();
        let joints =
            [Affine3A::from_rotation_z(std::f32::consts::FRAC_PI_2), Affine3A::from_scale(Vec3::splat(3.0))];
        let vertex = deformer.vertex(0, &[0.5], &joints);
        assert!(vertex.position.abs_diff_eq(Vec3::Y * 1.5, 1e-6), "{}", vertex.position);
        assert!(vertex.normal.abs_diff_eq(Vec3::Y, 1e-6));
        assert!(vertex.tangent.abs_diff_eq(Vec4::new(-1.0, 0.0, 0.0, 1.0), 1e-6));
        // No weight at all: the first joint rules.
        let vertex = deformer.vertex(1, &[0.5], &joints);
        assert!(vertex.position.abs_diff_eq(Vec3::Y * 3.0, 1e-6));
        assert_eq!(vertex.normal, Vec3::Z);
    }

    #[test]
    fn weights_are_scaled_over_all_sets() {
        let joints: Vec<Affine3A> = (0..8).map(|i| Affine3A::from_translation(Vec3::X * i as f32)).collect();
        let sets =
            influences([(0, 0.25), (1, 0.0), (2, 0.0), (7, 0.25), (4, 0.5), (5, 0.5), (6, 0.5), (3, 0.0)]);
        let deformer = Deformer {
            positions: vec![Vec3::Y],
            influences: sets,
            influences_per_vertex: 8,
            ..Deformer::default()
        };
        let vertex = deformer.vertex(0, &[], &joints);
        // (0.25·7 + 0.5·(4 + 5 + 6)) / 2
        assert!(vertex.position.abs_diff_eq(Vec3::new(4.625, 1.0, 0.0), 1e-6), "{}", vertex.position);
        assert_eq!((vertex.normal, vertex.tangent), (Vec3::ZERO, Vec4::ZERO), "a mesh without them");
    }

    #[test]
    fn mirroring_joints_mirror_the_bitangent() {
        let deformer = deformer();
        let joints = [Affine3A::from_scale(Vec3::new(1.0, 1.0, -2.0)); 2];
        let vertex = deformer.vertex(1, &[0.0], &joints);
        assert_eq!(vertex.normal, Vec3::NEG_Z);
        assert_eq!(vertex.tangent, Vec4::new(0.0, 1.0, 0.0, -1.0));
    }

    #[test]
    fn what_is_out_of_range_goes_to_the_origin() {
        let deformer = deformer();
        for bad in [f32::NAN, f32::INFINITY, 1e13] {
            let mut joint = Affine3A::IDENTITY;
            joint.translation.x = bad;
            let vertex = deformer.vertex(0, &[0.0], &[joint, joint]);
            assert_eq!(vertex.position, Vec3::ZERO, "{bad}");
            assert_eq!(vertex.normal, Vec3::X, "{bad}");
        }
        let nothing = Affine3A::from_mat3(glam::Mat3::ZERO);
        let vertex = deformer.vertex(0, &[0.0], &[nothing, nothing]);
        assert_eq!((vertex.position, vertex.normal), (Vec3::ZERO, Vec3::X));
        assert_eq!(vertex.tangent.truncate(), Vec3::Y, "the rest where there is no direction");
    }
}
