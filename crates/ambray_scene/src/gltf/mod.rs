//! glTF 2.0 import.
//!
//! | Part of the format | What happens |
//! |---|---|
//! | `.gltf`, `.glb`, data URIs, files beside the scene | read; other URI schemes and paths that leave the folder are refused |
//! | scenes | the chosen one, or the default one, or the first; without any, all root nodes |
//! | nodes, matrix and TRS | read; cycles and nodes with two parents are refused; singular ones drop their instance with a warning |
//! | triangle lists, strips, fans | read; every primitive is a [`Mesh`](crate::Mesh) |
//! | points, lines | skipped with one warning |
//! | accessors: all index types, sparse, interleaved, normalised, quantised | read, every byte bounds-checked |
//! | POSITION, NORMAL, TANGENT, TEXCOORD_n, COLOR_0 | read; missing normals mean flat shading; missing tangents are generated where a normal map needs them |
//! | other attributes | ignored |
//! | morph targets, skins | applied; at rest with default weights and joints where the nodes are |
//! | animations of nodes and morph weights: STEP, LINEAR, CUBICSPLINE | read into the scene's [`Rig`], what they move is marked; the scene itself is at rest |
//! | animations of anything else | ignored with a warning |
//! | animations of a node with a matrix | move its translation, rotation and scale; if it shears it stays, with a warning |
//! | materials: base colour, normal, emission, alpha mode, doubleSided | read |
//! | materials: metalness, roughness, occlusion texture | ignored |
//! | images: PNG, JPEG, WebP | read if a material uses them |
//! | cameras | read |
//! | KHR_lights_punctual, KHR_materials_emissive_strength, KHR_materials_unlit, KHR_mesh_quantization, KHR_texture_transform, EXT_mesh_gpu_instancing, EXT_texture_webp | read |
//! | KHR_implicit_shapes | shapes that a node shows by AMBRAY_implicit_surface; planes are refused there |
//! | AMBRAY_implicit_surface, AMBRAY_shape_field, AMBRAY_material_checker | read, see `docs/scenes.md` |
//! | KHR_physics_rigid_bodies | ignored with a warning; refused if required |
//! | KHR_materials_pbrSpecularGlossiness | its diffuse colour is the base colour |
//! | other KHR_materials_*, KHR_xmp_json_ld | ignored with a warning; refused if required |
//! | EXT_meshopt_compression, KHR_draco_mesh_compression, KHR_texture_basisu | the uncompressed fallback is read; refused without one |
//! | other extensions | ignored with a warning; refused if required |

mod accessor;
mod animations;
mod assemble;
mod container;
mod document;
mod extensions;
mod instancing;
mod json;
mod materials;
mod motion;
mod nodes;
mod part;
mod primitives;
mod shapes;
mod skins;
mod textures;
mod validate;
mod views;

pub(crate) use container::is_glb;

use std::sync::Arc;

use crate::Scene;
use crate::animation::Rig;
use crate::error::Outcome;
use crate::files::Folder;
use crate::load::LoadOptions;
use crate::warnings::Warnings;

/// Reads the scene in `bytes`; `expect_glb` says what the file's name promises.
pub(crate) fn load(
    bytes: &[u8],
    expect_glb: bool,
    folder: &mut Folder,
    options: &LoadOptions,
    warnings: &mut Warnings,
) -> Outcome<Scene> {
    let container::Parts { root, binary } = container::parse(bytes, expect_glb)?;
    validate::check_version(&root)?;
    extensions::check(&root, warnings)?;
    validate::validate(&root)?;
    let hierarchy = nodes::Hierarchy::of(&root)?;
    let visible = nodes::visible(&root, options.scene.as_ref())?;
    let doc = document::Document::open(&root, binary, folder)?;

    let mut scene = Scene::default();
    let mut used = textures::TextureUses::default();
    scene.materials = materials::read_materials(&root, &mut used)?;
    let mut rig = Rig { nodes: hierarchy.nodes(&root)?, ..Rig::default() };
    rig.clips = animations::read_clips(&doc, &hierarchy, &mut rig.nodes, warnings)?;
    assemble::assemble(&doc, &hierarchy, &visible, &mut rig, &mut scene, warnings)?;
    let moves = rig.clips.iter().any(|clip| !clip.channels.is_empty());
    scene.rig = moves.then(|| Arc::new(rig));
    (scene.textures, scene.images) = used.load(&doc, folder)?;
    Ok(scene)
}
