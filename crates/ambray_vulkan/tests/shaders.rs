//! The committed shaders belong to the committed sources.

#[path = "common/source_hash.rs"]
mod source_hash;

use std::path::Path;

#[test]
fn spirv_was_compiled_from_these_sources() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let recorded = include_str!("../shaders/spv/sources.sha256").trim();
    let hash = source_hash::source_hash(&folder).expect("the sources can be read");
    assert_eq!(hash, recorded, "run `cargo xtask shaders`");
}
