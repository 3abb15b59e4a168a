//! Materials: the part of glTF's material model that ambient lighting needs.

use glam::{Affine2, Vec3, Vec4};

/// Surface description. Colours are linear RGB.
///
/// Shading is diffuse: the base colour is the albedo, whatever the metalness, so metals do not turn black.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the file, may be empty.
    pub name: String,
    /// Albedo and alpha, multiplied by the texture and the vertex colour.
    pub base_color: Vec4,
    /// sRGB base colour and alpha.
    pub base_color_texture: Option<TextureRef>,
    /// Tangent-space normal map, linear.
    pub normal_texture: Option<TextureRef>,
    /// Scale of the x and y of the normal map.
    pub normal_scale: f32,
    /// Emitted radiance, strength included.
    pub emission: Vec3,
    /// sRGB texture that multiplies the emission.
    pub emission_texture: Option<TextureRef>,
    /// What the alpha means.
    pub alpha_mode: AlphaMode,
    /// glTF's flag. Tracing treats all surfaces as two-sided; this is kept for reports.
    pub double_sided: bool,
    /// KHR_materials_unlit: the base colour is shown as it is.
    pub unlit: bool,
    /// A second base colour that alternates with the first; ignored where `unlit`.
    pub checker: Option<Checker>,
}

/// Which program shades a material: the index of its callable shader on a GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum MaterialKind {
    /// Lit, without emission.
    #[default]
    Lit = 0,
    /// Shown as it is, whatever else it has.
    Unlit = 1,
    /// Lit, and emits.
    Emissive = 2,
    /// Lit, with a checker; may emit as well.
    Checker = 3,
}

/// A solid pattern of cubes in two colours, in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checker {
    /// Takes the place of the base colour in every other cube, linear RGB. The cube from 0 to `size` has the base colour.
    pub color: Vec3,
    /// Edge of a cube, object units, > 0.
    pub size: f32,
}

impl Checker {
    /// Share of a cube by which the pattern is moved towards −x, −y and −z: faces that lie exactly between two layers of
    /// cubes, as those of boxes and floors do, show one of them instead of the rounding of their points.
    pub const BIAS: f32 = 1.0 / 1024.0;

    /// The colour at `object_position`, given the material's `base` colour.
    #[must_use]
    pub fn at(&self, base: Vec3, object_position: Vec3) -> Vec3 {
        let cube = (object_position / self.size + Self::BIAS).floor();
        let sum = cube.x + cube.y + cube.z;
        // Even sums are twice an integer.
        if sum - 2.0 * (0.5 * sum).floor() == 0.0 { base } else { self.color }
    }
}

impl Material {
    /// What shades it. Unlit wins over all, and a checker over emission, which it keeps.
    #[must_use]
    pub fn kind(&self) -> MaterialKind {
        if self.unlit {
            MaterialKind::Unlit
        } else if self.checker.is_some() {
            MaterialKind::Checker
        } else if self.emission != Vec3::ZERO {
            MaterialKind::Emissive
        } else {
            MaterialKind::Lit
        }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emission: Vec3::ZERO,
            emission_texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            checker: None,
        }
    }
}

/// How the alpha of a surface decides whether rays see it. All ray types obey it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Present where alpha ≥ the cutoff.
    Mask(f32),
    /// Present with probability alpha, so coverage is right on average
    /// (see [`alpha_threshold`](ambray_core::trace::alpha_threshold)).
    Blend,
}

/// Use of a texture by a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Index into [`Scene::textures`](crate::Scene::textures).
    pub texture: u32,
    /// Which of the mesh's UV sets to read.
    pub uv_set: u32,
    /// KHR_texture_transform: maps the mesh's UV to the texture's.
    pub transform: Affine2,
}
