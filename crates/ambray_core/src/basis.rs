//! Orthonormal basis of a normal (Duff et al. 2017, "Building an orthonormal basis, revisited"; spec §1).

use glam::Vec3;

/// Right-handed basis (t, b, n), which the papers call a frame. Equal normals give equal bases, which the interleaved pattern relies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// First tangent t.
    pub tangent: Vec3,
    /// Second tangent b.
    pub bitangent: Vec3,
    /// The unit normal n.
    pub normal: Vec3,
}

impl Basis {
    /// Basis of the unit normal `n`.
    #[must_use]
    #[inline(always)]
    pub fn from_normal(n: Vec3) -> Self {
        let s = if n.z >= 0.0 { 1.0 } else { -1.0 };
        let p = -1.0 / (s + n.z);
        let q = n.x * n.y * p;
        Self {
            tangent: Vec3::new(1.0 + s * n.x * n.x * p, s * q, -s * n.x),
            bitangent: Vec3::new(q, s + n.y * n.y * p, -n.y),
            normal: n,
        }
    }

    /// World direction of `local` = (t, b, n) components.
    #[must_use]
    #[inline(always)]
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.tangent * local.x + self.bitangent * local.y + self.normal * local.z
    }
}
