//! Every reference in the file leads somewhere, used or not: checked once, so that readers can trust indices.

use crate::error::{Fault, Outcome, quoted};

use super::document::missing;
use super::json::{Animation, Index, Material, Node, Root, TextureInfo};

/// Checks all references.
pub(super) fn validate(root: &Root) -> Outcome<()> {
    check_buffers(root)?;
    check_textures(root)?;
    for (i, material) in root.materials.iter().enumerate() {
        check_material(root, material, &format!("materials[{i}]"))?;
    }
    check_meshes(root)?;
    for (i, shape) in root.shapes().iter().enumerate() {
        let distances = shape.extensions.field.as_ref().map(|field| field.distances);
        expect(distances, root.accessors.len(), "accessor", || {
            format!("extensions.KHR_implicit_shapes.shapes[{i}].extensions.AMBRAY_shape_field.distances")
        })?;
    }
    for (i, node) in root.nodes.iter().enumerate() {
        check_node(root, node, &format!("nodes[{i}]"))?;
    }
    for (i, skin) in root.skins.iter().enumerate() {
        let at = format!("skins[{i}]");
        expect(skin.inverse_bind_matrices, root.accessors.len(), "accessor", || {
            format!("{at}.inverseBindMatrices")
        })?;
        expect(skin.skeleton, root.nodes.len(), "node", || format!("{at}.skeleton"))?;
        expect_all(&skin.joints, root.nodes.len(), "node", || format!("{at}.joints"))?;
    }
    for (i, animation) in root.animations.iter().enumerate() {
        check_animation(root, animation, &format!("animations[{i}]"))?;
    }
    for (i, scene) in root.scenes.iter().enumerate() {
        expect_all(&scene.nodes, root.nodes.len(), "node", || format!("scenes[{i}].nodes"))?;
    }
    expect(root.scene, root.scenes.len(), "scene", || "scene".into())
}

/// `index`, if there is one, is below `count`.
fn expect(index: Option<Index>, count: usize, what: &str, at: impl FnOnce() -> String) -> Outcome<()> {
    match index {
        Some(index) if index >= count => Err(missing(&at(), what, index)),
        _ => Ok(()),
    }
}

fn expect_all<'i>(
    indices: impl IntoIterator<Item = &'i Index>,
    count: usize,
    what: &str,
    at: impl Fn() -> String,
) -> Outcome<()> {
    let mut indices = indices.into_iter().enumerate();
    indices.try_for_each(|(i, &index)| expect(Some(index), count, what, || format!("{}[{i}]", at())))
}

pub(super) fn check_version(root: &Root) -> Outcome<()> {
    let Some(asset) = &root.asset else {
        return Err(Fault::invalid("asset", "missing: glTF 2.0 files state their version"));
    };
    let number = |text: &str, at: &str| {
        let parts =
            text.split_once('.').and_then(|(major, minor)| Some((major.parse().ok()?, minor.parse().ok()?)));
        parts.ok_or_else(|| Fault::invalid(at, format!("{} is not a version such as '2.0'", quoted(text))))
    };
    let version: (u32, u32) = number(&asset.version, "asset.version")?;
    if version.0 != 2 {
        return Err(Fault::unsupported(
            "asset.version",
            format!("glTF {}, only 2.x is read", quoted(&asset.version)),
        ));
    }
    if let Some(text) = &asset.min_version {
        let least: (u32, u32) = number(text, "asset.minVersion")?;
        if least > (2, 0) {
            let reason = format!("needs a reader of glTF {}, this one reads 2.0", quoted(text));
            return Err(Fault::unsupported("asset.minVersion", reason));
        }
    }
    Ok(())
}

fn check_buffers(root: &Root) -> Outcome<()> {
    for (i, view) in root.buffer_views.iter().enumerate() {
        expect(Some(view.buffer), root.buffers.len(), "buffer", || format!("bufferViews[{i}].buffer"))?;
        let end = view.byte_offset.checked_add(view.byte_length);
        let size = root.buffers[view.buffer].byte_length;
        if end.is_none_or(|end| end > size) {
            let end = u128::from(view.byte_offset) + u128::from(view.byte_length);
            let reason = format!("ends at byte {end} of a {size}-byte buffer");
            return Err(Fault::invalid(format!("bufferViews[{i}]"), reason));
        }
        if view.byte_stride.is_some_and(|stride| !stride.is_multiple_of(4) && stride != 1 && stride != 2) {
            // Strides of 1 and 2 occur in files of the wild where indices share the view's rules.
            let reason = format!("{} is not a multiple of 4", view.byte_stride.unwrap_or_default());
            return Err(Fault::invalid(format!("bufferViews[{i}].byteStride"), reason));
        }
    }
    let views = root.buffer_views.len();
    for (i, accessor) in root.accessors.iter().enumerate() {
        expect(accessor.buffer_view, views, "buffer view", || format!("accessors[{i}].bufferView"))?;
        if let Some(sparse) = &accessor.sparse {
            let at = |field: &str| format!("accessors[{i}].sparse.{field}.bufferView");
            expect(Some(sparse.indices.buffer_view), views, "buffer view", || at("indices"))?;
            expect(Some(sparse.values.buffer_view), views, "buffer view", || at("values"))?;
        }
    }
    Ok(())
}

fn check_textures(root: &Root) -> Outcome<()> {
    for (i, image) in root.images.iter().enumerate() {
        expect(image.buffer_view, root.buffer_views.len(), "buffer view", || {
            format!("images[{i}].bufferView")
        })?;
    }
    for (i, texture) in root.textures.iter().enumerate() {
        let at = format!("textures[{i}]");
        let images = root.images.len();
        expect(texture.source, images, "image", || format!("{at}.source"))?;
        expect(texture.sampler, root.samplers.len(), "sampler", || format!("{at}.sampler"))?;
        let webp = texture.extensions.webp.as_ref().and_then(|webp| webp.source);
        expect(webp, images, "image", || format!("{at}.extensions.EXT_texture_webp.source"))?;
        let basisu = texture.extensions.basisu.as_ref().and_then(|basisu| basisu.source);
        expect(basisu, images, "image", || format!("{at}.extensions.KHR_texture_basisu.source"))?;
    }
    Ok(())
}

fn check_material(root: &Root, material: &Material, at: &str) -> Outcome<()> {
    let pbr = &material.pbr_metallic_roughness;
    let glossiness = material.extensions.specular_glossiness.as_ref();
    let textures: [(&str, Option<&TextureInfo>); 6] = [
        ("pbrMetallicRoughness.baseColorTexture", pbr.base_color_texture.as_ref()),
        ("pbrMetallicRoughness.metallicRoughnessTexture", pbr.metallic_roughness_texture.as_ref()),
        ("normalTexture", material.normal_texture.as_ref()),
        ("occlusionTexture", material.occlusion_texture.as_ref()),
        ("emissiveTexture", material.emissive_texture.as_ref()),
        (
            "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture",
            glossiness.and_then(|sg| sg.diffuse_texture.as_ref()),
        ),
    ];
    textures.iter().try_for_each(|(field, info)| {
        expect(info.map(|info| info.index), root.textures.len(), "texture", || format!("{at}.{field}.index"))
    })
}

fn check_meshes(root: &Root) -> Outcome<()> {
    let accessors = root.accessors.len();
    for (i, mesh) in root.meshes.iter().enumerate() {
        if mesh.primitives.is_empty() {
            return Err(Fault::invalid(format!("meshes[{i}].primitives"), "mesh without primitives"));
        }
        for (j, primitive) in mesh.primitives.iter().enumerate() {
            let at = format!("meshes[{i}].primitives[{j}]");
            expect(primitive.indices, accessors, "accessor", || format!("{at}.indices"))?;
            expect(primitive.material, root.materials.len(), "material", || format!("{at}.material"))?;
            for (name, &accessor) in &primitive.attributes {
                expect(Some(accessor), accessors, "accessor", || format!("{at}.attributes.{name}"))?;
            }
            for (k, target) in primitive.targets.iter().enumerate() {
                for (name, &accessor) in target {
                    expect(Some(accessor), accessors, "accessor", || format!("{at}.targets[{k}].{name}"))?;
                }
            }
        }
    }
    Ok(())
}

fn check_animation(root: &Root, animation: &Animation, at: &str) -> Outcome<()> {
    for (i, channel) in animation.channels.iter().enumerate() {
        expect(Some(channel.sampler), animation.samplers.len(), "sampler", || {
            format!("{at}.channels[{i}].sampler")
        })?;
        expect(channel.target.node, root.nodes.len(), "node", || format!("{at}.channels[{i}].target.node"))?;
    }
    for (i, sampler) in animation.samplers.iter().enumerate() {
        for (field, accessor) in [("input", sampler.input), ("output", sampler.output)] {
            expect(Some(accessor), root.accessors.len(), "accessor", || {
                format!("{at}.samplers[{i}].{field}")
            })?;
        }
    }
    Ok(())
}

fn check_node(root: &Root, node: &Node, at: &str) -> Outcome<()> {
    expect(node.mesh, root.meshes.len(), "mesh", || format!("{at}.mesh"))?;
    expect(node.skin, root.skins.len(), "skin", || format!("{at}.skin"))?;
    expect(node.camera, root.cameras.len(), "camera", || format!("{at}.camera"))?;
    expect_all(&node.children, root.nodes.len(), "node", || format!("{at}.children"))?;
    let lights = root.extensions.lights.as_ref().map_or(0, |lights| lights.lights.len());
    let light = node.extensions.light.as_ref().map(|light| light.light);
    expect(light, lights, "light", || format!("{at}.extensions.KHR_lights_punctual.light"))?;
    if let Some(surface) = &node.extensions.surface {
        let at = |field: &str| format!("{at}.extensions.AMBRAY_implicit_surface.{field}");
        expect(Some(surface.shape), root.shapes().len(), "shape", || at("shape"))?;
        expect(surface.material, root.materials.len(), "material", || at("material"))?;
    }
    for (name, &accessor) in node.extensions.instancing.iter().flat_map(|instancing| &instancing.attributes) {
        let at = || format!("{at}.extensions.EXT_mesh_gpu_instancing.attributes.{name}");
        expect(Some(accessor), root.accessors.len(), "accessor", at)?;
    }
    Ok(())
}
