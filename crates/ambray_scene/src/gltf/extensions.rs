//! Which extensions are read, which can be ignored, and which are refused.

use crate::error::{Fault, Outcome, quoted};
use crate::warnings::Warnings;

use super::json::Root;

/// Extensions that are read in full.
const READ: &[&str] = &[
    "AMBRAY_implicit_surface",
    "AMBRAY_material_checker",
    "AMBRAY_shape_field",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_implicit_shapes",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Optional extensions that change nothing Ambray shows, or only what it does not model, and what is then ignored.
const HARMLESS: &[(&str, &str)] = &[
    ("KHR_materials_anisotropy", "anisotropic reflections"),
    ("KHR_materials_clearcoat", "clear coat"),
    ("KHR_materials_diffuse_transmission", "diffuse transmission"),
    ("KHR_materials_dispersion", "dispersion"),
    ("KHR_materials_ior", "index of refraction"),
    ("KHR_materials_iridescence", "iridescence"),
    ("KHR_materials_pbrSpecularGlossiness", "specular colour and glossiness, but not the diffuse colour"),
    ("KHR_materials_sheen", "sheen"),
    ("KHR_materials_specular", "specular reflections"),
    ("KHR_materials_transmission", "transmission"),
    ("KHR_materials_variants", "material variants"),
    ("KHR_materials_volume", "volume"),
    ("KHR_physics_rigid_bodies", "physics, and shapes that only collide are not shown"),
    ("KHR_xmp_json_ld", "metadata"),
];

/// Extensions whose data have another form beside them; where that is missing, the reader of the data refuses.
const WITH_FALLBACK: &[(&str, &str)] = &[
    ("EXT_meshopt_compression", "compressed data, the fallback is read"),
    ("KHR_meshopt_compression", "compressed data, the fallback is read"),
    ("KHR_draco_mesh_compression", "compressed data, the fallback is read"),
    ("KHR_texture_basisu", "KTX2 images, the fallback is read"),
];

/// Refuses files that require what we lack, and says what is ignored of the rest.
pub(super) fn check(root: &Root, warnings: &mut Warnings) -> Outcome<()> {
    for (i, name) in root.extensions_required.iter().enumerate() {
        if !READ.contains(&name.as_str()) {
            let reason = format!("required extension {} is not supported", quoted(name));
            return Err(Fault::unsupported(format!("extensionsRequired[{i}]"), reason));
        }
    }
    let mut seen: Vec<&str> = Vec::new();
    for name in root.extensions_used.iter().chain(&root.extensions_required) {
        if READ.contains(&name.as_str()) || seen.contains(&name.as_str()) {
            continue;
        }
        if seen.len() == MOST_WARNINGS {
            warnings.push("more unknown extensions are ignored".into());
            break;
        }
        seen.push(name);
        let ignored = lookup(HARMLESS, name).or_else(|| lookup(WITH_FALLBACK, name));
        warnings.push(match ignored {
            Some(what) => format!("extension {} is ignored: {what}", quoted(name)),
            None => format!("unknown extension {} is ignored", quoted(name)),
        });
    }
    Ok(())
}

/// Extensions warned of one by one.
const MOST_WARNINGS: usize = 32;

fn lookup<'t>(table: &[(&str, &'t str)], name: &str) -> Option<&'t str> {
    table.iter().find(|(known, _)| *known == name).map(|(_, what)| *what)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn required_and_optional() {
        let root = |used: &[&str], required: &[&str]| Root {
            extensions_used: used.iter().map(|&s| s.to_owned()).collect(),
            extensions_required: required.iter().map(|&s| s.to_owned()).collect(),
            ..Root::default()
        };
        let mut warnings = Warnings::default();
        let used = ["KHR_lights_punctual", "X_a", "X_a", "KHR_materials_ior"];
        check(&root(&used, &["KHR_lights_punctual"]), &mut warnings).expect("nothing missing");
        assert_eq!(
            warnings.into_lines(),
            [
                "unknown extension 'X_a' is ignored",
                "extension 'KHR_materials_ior' is ignored: index of refraction"
            ]
        );
        for name in ["KHR_draco_mesh_compression", "KHR_materials_transmission", "X_a"] {
            let fault = check(&root(&[], &[name]), &mut Warnings::default()).expect_err("lacking");
            let text = fault.in_file(std::path::Path::new("Box.gltf")).to_string();
            let expected =
                format!("Box.gltf: extensionsRequired[0]: required extension '{name}' is not supported");
            assert_eq!(text, expected);
        }
    }
}
