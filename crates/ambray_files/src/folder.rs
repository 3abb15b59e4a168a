//! The folder of numbered files.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::Context as _;

use crate::atomic::{check_folder, folder_of};

/// A folder that files can be written to, once it is there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// The folder of the file at `path`. It may be missing itself, but what it lies in must be there: a whole path that is
    /// missing is more likely a slip.
    pub fn of(path: &Path) -> anyhow::Result<Self> {
        let folder = folder_of(path);
        let existing = if folder.exists() { folder } else { folder_of(folder) };
        check_folder(existing).with_context(|| format!("output {}", path.display()))?;
        Ok(Self { path: folder.to_owned() })
    }

    /// Makes it if it is missing.
    pub fn create(&self) -> anyhow::Result<()> {
        if self.path.is_dir() {
            return Ok(());
        }
        fs::create_dir(&self.path).with_context(|| format!("output folder {}", self.path.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_missing_folder_is_made() {
        let top = tempfile::tempdir().unwrap();
        let folder = Folder::of(&top.path().join("new/f_#.png")).unwrap();
        assert!(!top.path().join("new").exists(), "nothing is made before the work");
        folder.create().unwrap();
        folder.create().unwrap();
        assert!(top.path().join("new").is_dir());
        let error = format!("{:#}", Folder::of(&top.path().join("a/b/f_#.png")).unwrap_err());
        assert!(error.contains("a does not exist"), "{error}");
    }
}
