//! Wavefront OBJ import.
//!
//! | Part of the format | What happens |
//! |---|---|
//! | `v` with or without colour, `vt`, `vn`, `f` with positive or relative indices | read; polygons are cut into fans, which suits convex ones |
//! | `o`, `g`, `usemtl` | each begins a new [`Mesh`](crate::Mesh) |
//! | `mtllib` | read; a missing library is a warning, and its materials are white |
//! | MTL: `Kd`, `Ke`, `d`, `Tr`, `map_Kd`, `map_Ke`, `norm`; `map_d` where it names the file of `map_Kd` | read; textures that are missing are errors |
//! | `p`, `l` | skipped with one warning |
//! | smoothing groups, free-form geometry and everything else | ignored |
//!
//! A reader of our own, since the crates at hand panic on damaged material libraries or cannot say which line is wrong.

mod mtl;
mod parse;

use std::sync::Arc;

use glam::Affine3A;

use crate::decode::{Encoded, decode_all};
use crate::error::{Outcome, quoted};
use crate::files::Folder;
use crate::repair::repair;
use crate::warnings::Warnings;
use crate::{Instance, Material, Sampler, Scene, Texture, tangents};

use mtl::Library;

/// Reads the scene in `bytes`.
pub(crate) fn load(bytes: &[u8], folder: &mut Folder, warnings: &mut Warnings) -> Outcome<Scene> {
    // Names and comments may be in any encoding; numbers and keywords are ASCII in all of them.
    let text = String::from_utf8_lossy(bytes);
    let parsed = parse::parse(&text, warnings)?;
    let mut library = Library::default();
    for name in &parsed.libraries {
        let at = format!("mtllib {}", quoted(name));
        match folder.read_name(name, &at) {
            Ok(bytes) => library.add(name, &String::from_utf8_lossy(&bytes), warnings)?,
            Err(fault) => warnings.push(format!("{at} is not read: {}", fault.reason())),
        }
    }
    let mut scene = Scene::default();
    let mut images: Vec<(String, bool)> = Vec::new();
    scene.materials = library.materials(&mut images);
    for (mut mesh, material_name) in parsed.meshes {
        let known = material_name.as_deref().and_then(|name| library.index(name));
        if known.is_none() && material_name.is_some() {
            warnings.tally("meshes name a material that no library defines", 1);
        }
        mesh.material = known.unwrap_or_else(|| default_material(&mut scene, library.len()));
        repair(&mut mesh, warnings);
        if scene.materials[mesh.material as usize].normal_texture.is_some() {
            tangents::generate(&mut mesh, 0);
        }
        let instance = Instance {
            mesh: scene.meshes.len() as u32,
            world_from_object: Affine3A::IDENTITY,
            ..Instance::default()
        };
        scene.instances.push(instance);
        scene.meshes.push(Arc::new(mesh));
    }
    let encoded: Outcome<Vec<Encoded<'_>>> = images.iter().map(|image| read_image(image, folder)).collect();
    scene.images = decode_all(&encoded?)?;
    let texture = |image| Texture { image, sampler: Sampler::default() };
    scene.textures = (0..scene.images.len() as u32).map(texture).collect();
    Ok(scene)
}

/// The material of faces without one, appended when first needed to the `count` of the libraries.
fn default_material(scene: &mut Scene, count: usize) -> u32 {
    if scene.materials.len() == count {
        scene.materials.push(Material::default());
    }
    count as u32
}

fn read_image((name, srgb): &(String, bool), folder: &mut Folder) -> Outcome<Encoded<'static>> {
    let at = format!("texture {}", quoted(name));
    let bytes = folder.read_name(name, &at)?.into();
    Ok(Encoded { bytes, name: name.clone(), at, uses: vec![*srgb] })
}
