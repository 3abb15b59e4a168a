//! The folder with the files of `--rays`.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use ambray::cpu::rays::{RayBatch, Triangles};
use ambray_files::{
    atomic::{Batch, Target},
    folder::Folder,
    rays::{Hits, read_batch, read_triangles, write_batch, write_triangles},
    with_hint,
};
use anyhow::{Context as _, anyhow, bail};

const HINT: &str = "name a scene to write its triangles and rays to the folder";

/// Files of triangles, rays and hits.
#[derive(Clone, Debug)]
pub(super) struct RaysFolder {
    path: PathBuf,
}

impl RaysFolder {
    pub(super) fn new(path: &Path) -> Self {
        Self { path: path.to_owned() }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Makes the folder if it is missing, and finds out whether files can be written to it.
    pub(super) fn prepare(&self) -> anyhow::Result<()> {
        Folder::of(&self.triangles_file())?.create()
    }

    /// Writes `triangles` and `batches` with their names; all appear together.
    pub(super) fn write(&self, triangles: &Triangles, batches: &[(&str, RayBatch)]) -> anyhow::Result<()> {
        let mut files = Batch::default();
        files.add(&Target::File(self.triangles_file()), |out| write_triangles(out, triangles))?;
        for (name, batch) in batches {
            files.add(&Target::File(self.file(name, "rays")), |out| write_batch(out, batch))?;
        }
        files.commit()
    }

    /// The triangles.
    pub(super) fn triangles(&self) -> anyhow::Result<Triangles> {
        read_triangles(&self.triangles_file()).map_err(hinted)
    }

    /// The rays called `name`.
    pub(super) fn batch(&self, name: &str) -> anyhow::Result<RayBatch> {
        read_batch(&self.file(name, "rays"))
    }

    /// Names of the files of rays in the order of the alphabet, or those of them that are `asked` for.
    pub(super) fn batches(&self, asked: &[String]) -> anyhow::Result<Vec<String>> {
        let context = || format!("--rays {}", self.path.display());
        let mut names = Vec::new();
        for entry in fs::read_dir(&self.path).with_context(context).map_err(hinted)? {
            let path = entry.with_context(context)?.path();
            if path.extension().is_some_and(|extension| extension == "rays")
                && let Some(name) = path.file_stem().and_then(|name| name.to_str())
            {
                names.push(name.to_owned());
            }
        }
        names.sort();
        if names.is_empty() {
            let error = anyhow!("--rays {}: there are no files of rays", self.path.display());
            return Err(with_hint(error, HINT));
        }
        match asked.iter().find(|name| !names.contains(name)) {
            Some(name) => bail!("--batches {name} is not allowed: there are {}", names.join(", ")),
            None if asked.is_empty() => Ok(names),
            None => Ok(asked.to_vec()),
        }
    }

    /// Writes the `hits` of the rays called `name`.
    pub(super) fn write_hits(&self, name: &str, hits: &Hits) -> anyhow::Result<()> {
        let mut files = Batch::default();
        files.add(&Target::File(self.file(name, "hits")), |out| hits.write(out))?;
        files.commit()
    }

    /// The hits of the rays called `name`.
    pub(super) fn hits(&self, name: &str) -> anyhow::Result<Hits> {
        Hits::read(&self.file(name, "hits"))
    }

    fn triangles_file(&self) -> PathBuf {
        self.file("scene", "tris")
    }

    fn file(&self, name: &str, extension: &str) -> PathBuf {
        self.path.join(format!("{name}.{extension}"))
    }
}

/// Adds advice to what happens where nothing was written yet.
fn hinted(error: anyhow::Error) -> anyhow::Error {
    let is_missing = |cause: &(dyn std::error::Error + 'static)| {
        cause.downcast_ref().is_some_and(|io: &io::Error| io.kind() == io::ErrorKind::NotFound)
    };
    if error.chain().any(is_missing) { with_hint(error, HINT) } else { error }
}
