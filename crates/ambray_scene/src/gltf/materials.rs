//! Materials.

use glam::{Affine2, Mat2, Vec2, Vec3, Vec4};

use crate::error::{Fault, Outcome, quoted};
use crate::{AlphaMode, Checker, Material, TextureRef};

use super::json::{self, Root, TextureInfo};
use super::textures::TextureUses;

/// All materials of the file, with the textures they use.
pub(super) fn read_materials(root: &Root, textures: &mut TextureUses) -> Outcome<Vec<Material>> {
    let each = root.materials.iter().enumerate();
    each.map(|(index, material)| read_material(root, material, &format!("materials[{index}]"), textures))
        .collect()
}

fn read_material(
    root: &Root,
    json: &json::Material,
    at: &str,
    textures: &mut TextureUses,
) -> Outcome<Material> {
    let mut texture = |info: Option<&TextureInfo>, srgb: bool, field: &str| {
        info.map(|info| texture_ref(root, info, srgb, &format!("{at}.{field}"), textures)).transpose()
    };
    // The diffuse part of specular-glossiness is what our base colour is; metallic-roughness is its fallback.
    let pbr = &json.pbr_metallic_roughness;
    let (factor, base_color_texture) = match &json.extensions.specular_glossiness {
        Some(sg) => {
            let at = "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture";
            (sg.diffuse_factor, texture(sg.diffuse_texture.as_ref(), true, at)?)
        }
        None => {
            let at = "pbrMetallicRoughness.baseColorTexture";
            (pbr.base_color_factor, texture(pbr.base_color_texture.as_ref(), true, at)?)
        }
    };
    let normal_texture = texture(json.normal_texture.as_ref(), false, "normalTexture")?;
    let emission_texture = texture(json.emissive_texture.as_ref(), true, "emissiveTexture")?;
    let strength =
        json.extensions.emissive_strength.as_ref().and_then(|e| e.emissive_strength).unwrap_or(1.0);
    let emission = Vec3::from(json.emissive_factor.unwrap_or_default()) * strength;
    let base_color = factor.map_or(Vec4::ONE, Vec4::from);
    let cutoff = json.alpha_cutoff.unwrap_or(0.5);
    let normal_scale = json.normal_texture.as_ref().and_then(|info| info.scale).unwrap_or(1.0);
    let checker = json.extensions.checker.as_ref().map(|checker| Checker {
        color: Vec3::from(checker.color_factor.unwrap_or_default()),
        size: checker.size.unwrap_or(1.0),
    });
    let checker_color = checker.map_or(Vec3::ZERO, |checker| checker.color);
    let numbers = [
        ("baseColorFactor", base_color.is_finite() && base_color.min_element() >= 0.0),
        ("emissiveFactor", emission.is_finite() && emission.min_element() >= 0.0),
        ("alphaCutoff", cutoff.is_finite() && cutoff >= 0.0),
        ("normalTexture.scale", normal_scale.is_finite()),
        (
            "extensions.AMBRAY_material_checker.colorFactor",
            checker_color.is_finite() && checker_color.min_element() >= 0.0,
        ),
    ];
    if let Some((field, _)) = numbers.iter().find(|(_, good)| !good) {
        return Err(Fault::invalid(format!("{at}.{field}"), "negative or beyond the range of numbers"));
    }
    if let Some(size) = checker.map(|checker| checker.size).filter(|size| !size.is_normal() || *size < 0.0) {
        let at = format!("{at}.extensions.AMBRAY_material_checker.size");
        return Err(Fault::invalid(at, format!("{size} is not positive")));
    }
    let alpha_mode = match json.alpha_mode.as_deref() {
        None | Some("OPAQUE") => AlphaMode::Opaque,
        Some("MASK") => AlphaMode::Mask(cutoff),
        Some("BLEND") => AlphaMode::Blend,
        Some(other) => {
            return Err(Fault::invalid(
                format!("{at}.alphaMode"),
                format!("no such mode: {}", quoted(other)),
            ));
        }
    };
    Ok(Material {
        name: json.name.clone().unwrap_or_default(),
        base_color,
        base_color_texture,
        normal_texture,
        normal_scale,
        emission,
        emission_texture,
        alpha_mode,
        double_sided: json.double_sided,
        unlit: json.extensions.unlit.is_some(),
        checker,
    })
}

fn texture_ref(
    root: &Root,
    info: &TextureInfo,
    srgb: bool,
    at: &str,
    textures: &mut TextureUses,
) -> Outcome<TextureRef> {
    let texture = textures.add(root, info.index, srgb, &format!("{at}.index"))?;
    let Some(json) = &info.extensions.transform else {
        return Ok(TextureRef { texture, uv_set: info.tex_coord, transform: Affine2::IDENTITY });
    };
    let transform = uv_transform(json);
    if !transform.is_finite() {
        return Err(Fault::invalid(
            format!("{at}.extensions.KHR_texture_transform"),
            "not a finite transform",
        ));
    }
    Ok(TextureRef { texture, uv_set: json.tex_coord.unwrap_or(info.tex_coord), transform })
}

/// KHR_texture_transform, "Overview": translation · rotation · scale.
fn uv_transform(json: &json::TextureTransform) -> Affine2 {
    let offset = json.offset.map_or(Vec2::ZERO, Vec2::from);
    let scale = json.scale.map_or(Vec2::ONE, Vec2::from);
    let (sin, cos) = libm::sincosf(json.rotation.unwrap_or(0.0));
    // The extension counts angles against the sense of mathematics: v points down.
    let rotation = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
    Affine2::from_mat2_translation(rotation * Mat2::from_diagonal(scale), offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uv_transform_is_the_extension_s() {
        let json = json::TextureTransform {
            offset: Some([0.25, 0.5]),
            rotation: Some(std::f32::consts::FRAC_PI_2),
            scale: Some([2.0, 3.0]),
            tex_coord: None,
        };
        let m = uv_transform(&json);
        // u alone: scaled to 2, turned by 90° onto -v, moved.
        assert!(m.transform_point2(Vec2::X).abs_diff_eq(Vec2::new(0.25, -1.5), 1e-6));
        assert!(m.transform_point2(Vec2::Y).abs_diff_eq(Vec2::new(3.25, 0.5), 1e-6));
    }
}
