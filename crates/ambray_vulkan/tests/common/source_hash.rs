//! Hash of the shader sources, by which a test finds compiled shaders that are stale without compiling them.

use std::{fs, io, path::Path};

use sha2::{Digest, Sha256};

/// SHA-256 over all shader sources in the folder `shaders`, in order of their paths; hexadecimal.
///
/// # Errors
/// If a file cannot be read.
pub(crate) fn source_hash(folder: &Path) -> io::Result<String> {
    let mut paths = Vec::new();
    for folder in [folder.to_owned(), folder.join("include")] {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_file() {
                paths.push(path);
            }
        }
    }
    paths.sort();
    let mut hash = Sha256::new();
    for path in paths {
        let name = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        hash.update(name.as_bytes());
        hash.update([0]);
        hash.update(fs::read(&path)?);
        hash.update([0]);
    }
    Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}
