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
