//! The hook by which surfaces decide whether rays see them.

/// Whether a candidate hit counts, for meshes with masked or blended materials.
///
/// Answers must be pure functions of the arguments: a candidate may be asked about in any order, or not at all.
pub trait AlphaTest: Sync {
    /// Whether every ray sees every triangle of the mesh; asked once a mesh while building.
    fn is_opaque(&self, mesh: u32) -> bool;
    /// Whether a ray with this `seed` sees the point with barycentrics (`u`, `v`); asked for meshes that are not opaque,
    /// and for shapes, as triangle 0 at (0, 0).
    fn accepts(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool;
}

/// Everything is opaque.
#[derive(Clone, Copy, Debug, Default)]
pub struct Opaque;

impl AlphaTest for Opaque {
    fn is_opaque(&self, _mesh: u32) -> bool {
        true
    }
    fn accepts(&self, _instance: u32, _triangle: u32, _u: f32, _v: f32, _seed: u32) -> bool {
        true
    }
}

impl<A: AlphaTest + ?Sized> AlphaTest for &A {
    fn is_opaque(&self, mesh: u32) -> bool {
        (**self).is_opaque(mesh)
    }
    fn accepts(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool {
        (**self).accepts(instance, triangle, u, v, seed)
    }
}

impl<A: AlphaTest + Send> AlphaTest for std::sync::Arc<A> {
    fn is_opaque(&self, mesh: u32) -> bool {
        (**self).is_opaque(mesh)
    }
    fn accepts(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool {
        (**self).accepts(instance, triangle, u, v, seed)
    }
}

impl AlphaTest for ambray_scene::surface::Surfaces {
    fn is_opaque(&self, mesh: u32) -> bool {
        self.is_opaque(mesh)
    }
    fn accepts(&self, instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool {
        self.accepts(instance, triangle, u, v, seed)
    }
}
