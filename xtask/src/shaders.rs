//! GLSL to SPIR-V. Users need no compiler: the result is committed.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, anyhow, bail};
use glslang::{
    Compiler, CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage, SourceLanguage,
    SpirvVersion, Target, VulkanVersion,
    include::{IncludeHandler, IncludeResult, IncludeType},
};

/// Writes `layout.glsl`, the SPIR-V of all shaders, and the hash of their sources.
pub(crate) fn write() -> anyhow::Result<()> {
    let folder = folder();
    fs::write(folder.join("include/layout.glsl"), ambray_vulkan::layout::glsl())?;
    let spirv = folder.join("spv");
    if spirv.exists() {
        fs::remove_dir_all(&spirv)?;
    }
    fs::create_dir_all(&spirv)?;
    for (name, words) in compile_all()? {
        fs::write(spirv.join(&name), bytes(&words)).with_context(|| name)?;
    }
    let hash = crate::source_hash::source_hash(&folder)?;
    fs::write(spirv.join("sources.sha256"), format!("{hash}\n"))?;
    Ok(())
}

/// File name and words of each shader, compiled.
pub(crate) fn compile_all() -> anyhow::Result<BTreeMap<String, Vec<u32>>> {
    let folder = folder();
    let mut compiled = BTreeMap::new();
    for entry in fs::read_dir(&folder)? {
        let path = entry?.path();
        if let Some(stage) = stage(&path) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let words = compile(&folder, &path, stage).with_context(|| name.clone())?;
            compiled.insert(format!("{name}.spv"), words);
        }
    }
    Ok(compiled)
}

pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/ambray_vulkan/shaders")
}

fn stage(path: &Path) -> Option<ShaderStage> {
    Some(match path.extension()?.to_str()? {
        "rgen" => ShaderStage::RayGeneration,
        "rchit" => ShaderStage::ClosestHit,
        "rahit" => ShaderStage::AnyHit,
        "rint" => ShaderStage::Intersect,
        "rmiss" => ShaderStage::Miss,
        "rcall" => ShaderStage::Callable,
        "comp" => ShaderStage::Compute,
        "vert" => ShaderStage::Vertex,
        "frag" => ShaderStage::Fragment,
        _ => return None,
    })
}

fn compile(folder: &Path, path: &Path, stage: ShaderStage) -> anyhow::Result<Vec<u32>> {
    let compiler = Compiler::acquire().ok_or_else(|| anyhow!("glslang does not start"))?;
    let source = ShaderSource::from(fs::read_to_string(path)?);
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_2, spirv_version: SpirvVersion::SPIRV1_5 },
        version_profile: None,
        messages: ShaderMessage::DEFAULT,
    };
    let mut includes = Includes { folder };
    let no_defines: Option<&[(&str, Option<&str>)]> = None;
    let input = ShaderInput::new(&source, stage, &options, no_defines, Some(&mut includes))?;
    let shader = match compiler.create_shader(input) {
        Ok(shader) => shader,
        Err(error) => bail!("{error}"),
    };
    let mut program = compiler.create_program();
    program.add_shader(&shader);
    Ok(program.compile(stage)?)
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Finds included files: stages name them from the folder of the shaders, included files by their own folder.
struct Includes<'a> {
    folder: &'a Path,
}

impl IncludeHandler for Includes<'_> {
    fn include(&mut self, _: IncludeType, name: &str, _: &str, _: usize) -> Option<IncludeResult> {
        let name = name.strip_prefix("include/").unwrap_or(name);
        let data = fs::read_to_string(self.folder.join("include").join(name)).ok()?;
        Some(IncludeResult { name: format!("include/{name}"), data })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn committed_spirv_is_what_the_sources_compile_to() {
        for (name, words) in compile_all().expect("the shaders compile") {
            let committed = fs::read(folder().join("spv").join(&name)).expect("compiled and committed");
            assert!(committed == bytes(&words), "{name} is stale: run `cargo xtask shaders`");
        }
    }
}
