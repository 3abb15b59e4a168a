//! The door: a path in, a scene out.

use std::path::{Path, PathBuf};

use glam::{Vec3, Vec4};

use crate::error::{Fault, LoadError, Outcome};
use crate::files::{Folder, read_regular};
use crate::warnings::Warnings;
use crate::{Scene, gltf, limits, obj};

/// A loaded scene and what is to be said about it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// One line each: what was ignored, repaired or dropped.
    pub warnings: Vec<String>,
    /// The files that it is made of: the scene's own first, then those it refers to, also where they could not be read.
    pub files: Vec<PathBuf>,
}

/// What to load of a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Which scene of a glTF file; `None` for its default scene, or else its first. OBJ files have just one.
    pub scene: Option<SceneChoice>,
}

/// A scene of a glTF file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneChoice {
    /// Position in the file, from 0.
    Index(usize),
    /// Name in the file; the first of that name.
    Name(String),
}

/// Loads the `.gltf`, `.glb` or `.obj` file at `path` with default options.
///
/// # Errors
/// See [`load_with`].
pub fn load(path: &Path) -> Result<Loaded, LoadError> {
    load_with(path, &LoadOptions::default())
}

/// Loads the `.gltf`, `.glb` or `.obj` file at `path`.
///
/// GLB is recognised by its content, whatever the name. Files that the scene refers to must lie in its folder or below;
/// nothing is fetched from elsewhere. The work and memory are bounded by [`limits`].
///
/// # Errors
/// One line that names the file, the place in it and the reason.
pub fn load_with(path: &Path, options: &LoadOptions) -> Result<Loaded, LoadError> {
    read(path, options).map_err(|fault| fault.in_file(path))
}

fn read(path: &Path, options: &LoadOptions) -> Outcome<Loaded> {
    let kind = path.extension().map(|ext| ext.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let bytes = read_regular(path, limits::FILE_BYTES, "")?;
    let mut folder = Folder::of(path, bytes.len() as u64);
    let mut warnings = Warnings::default();
    let mut scene = match kind.as_str() {
        "gltf" | "glb" => gltf::load(&bytes, kind == "glb", &mut folder, options, &mut warnings)?,
        "obj" => obj::load(&bytes, &mut folder, &mut warnings)?,
        _ if gltf::is_glb(&bytes) => gltf::load(&bytes, true, &mut folder, options, &mut warnings)?,
        _ => return Err(Fault::unsupported("", "not a .gltf, .glb or .obj file")),
    };
    let mut clamped = 0;
    for material in &mut scene.materials {
        let color = material.base_color.clamp(Vec4::ZERO, Vec4::ONE);
        clamped += u64::from(color != material.base_color);
        material.base_color = color;
        if let Some(checker) = &mut material.checker {
            let color = checker.color.clamp(Vec3::ZERO, Vec3::ONE);
            clamped += u64::from(color != checker.color);
            checker.color = color;
        }
    }
    warnings.tally("base colours above 1 are clamped: no surface reflects more than it receives", clamped);
    if scene.instances.is_empty() && scene.shape_instances.is_empty() {
        warnings.push("the scene shows no triangles".into());
    }
    scene.name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let files = std::iter::once(path.to_owned()).chain(folder.into_asked()).collect();
    Ok(Loaded { scene, warnings: warnings.into_lines(), files })
}
