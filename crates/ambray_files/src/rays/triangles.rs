//! Files of triangles.

use std::{io::Write, path::Path};

use ambray::{cpu::rays::Triangles, scene::Mesh};
use anyhow::{Context as _, bail};

use super::words::{Words, begin, count, put};

const MAGIC: &[u8; 4] = b"TRIS";

/// Writes `triangles`.
pub fn write_triangles(out: &mut (impl Write + ?Sized), triangles: &Triangles) -> anyhow::Result<()> {
    let (positions, indices) = (&triangles.positions, &triangles.indices);
    begin(out, MAGIC)?;
    put(out, [count(positions.len())?, count(indices.len())?])?;
    put(out, positions.iter().flat_map(|position| position.to_array().map(f32::to_bits)))?;
    put(out, indices.iter().copied().flatten())
}

/// Reads triangles, all of whose corners are finite and exist.
pub fn read_triangles(path: &Path) -> anyhow::Result<Triangles> {
    read(path).with_context(|| path.display().to_string())
}

fn read(path: &Path) -> anyhow::Result<Triangles> {
    let mut words = Words::open(path, MAGIC)?;
    let [vertices, triangles] = [words.next()?, words.next()?].map(u64::from);
    let positions = words.take(3 * vertices)?;
    let indices = words.take(3 * triangles)?;
    words.end()?;
    let mesh = Mesh {
        positions: positions.as_chunks().0.iter().map(|p: &[u32; 3]| p.map(f32::from_bits).into()).collect(),
        triangles: indices.as_chunks().0.to_vec(),
        ..Mesh::default()
    };
    if let Err(problem) = mesh.validate() {
        bail!("{problem}");
    }
    Ok(Triangles { positions: mesh.positions, indices: mesh.triangles })
}
