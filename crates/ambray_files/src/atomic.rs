//! Files that appear complete or not at all.
//!
//! Each file is written beside its destination under a temporary name; when all of a command are complete, they are
//! renamed.

use std::{
    fs::{self, File},
    io::{BufWriter, Cursor, IsTerminal as _, Seek, Write},
    path::{Path, PathBuf},
};

use anyhow::{Context as _, bail};
use tempfile::NamedTempFile;

use crate::{problem::with_hint, temporary::Temporary};

/// Where output goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Standard output.
    Stdout,
    /// A file, or a device such as `/dev/null`.
    File(PathBuf),
}

impl Target {
    /// The target that `path` names; `-` is stdout.
    #[must_use]
    pub fn of(path: &Path) -> Self {
        if path == Path::new("-") { Self::Stdout } else { Self::File(path.to_owned()) }
    }

    /// Its name in messages.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Stdout => "stdout".to_owned(),
            Self::File(path) => path.display().to_string(),
        }
    }

    /// Finds out before the work whether the target can be written.
    pub fn check(&self) -> anyhow::Result<()> {
        let Self::File(path) = self else { return Ok(()) };
        check_file(path).with_context(|| format!("output {}", path.display()))
    }

    /// As [`check`](Self::check), apart from the folder: fit for thousands of files of one folder.
    pub fn check_name(&self) -> anyhow::Result<()> {
        let Self::File(path) = self else { return Ok(()) };
        check_name(path).map(drop).with_context(|| format!("output {}", path.display()))
    }

    /// Refuses to write bytes that are no text to a terminal.
    pub fn check_binary(&self) -> anyhow::Result<()> {
        if *self == Self::Stdout && std::io::stdout().is_terminal() {
            bail!("stdout is a terminal, and a picture is no text: redirect it to a file or a program");
        }
        Ok(())
    }
}

fn check_file(path: &Path) -> anyhow::Result<()> {
    match check_name(path)? {
        Place::Device => Ok(()),
        Place::File => check_folder(folder_of(path)),
    }
}

/// What is to be written to.
enum Place {
    File,
    Device,
}

/// Whether there may be a file at `path`, apart from its folder.
fn check_name(path: &Path) -> anyhow::Result<Place> {
    match fs::metadata(path).ok() {
        Some(metadata) if metadata.is_dir() => bail!("is a folder, not a file"),
        Some(metadata) if metadata.permissions().readonly() => bail!("the file exists and is read-only"),
        Some(metadata) if !metadata.is_file() => Ok(Place::Device),
        _ if path.file_name().is_none() => bail!("not the name of a file"),
        _ => Ok(Place::File),
    }
}

/// Whether files can be made in `folder`.
pub(super) fn check_folder(folder: &Path) -> anyhow::Result<()> {
    if !folder.is_dir() {
        let missing = anyhow::anyhow!("the folder {} does not exist", folder.display());
        return Err(with_hint(missing, "create the folder first"));
    }
    match temporary_in(folder) {
        Ok(_) => Ok(()),
        // The name of the temporary file would say nothing to the user.
        Err(error) => bail!("the folder {} is not writable: {}", folder.display(), reason(&error)),
    }
}

/// The system's own words, without the path that `tempfile` adds.
fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" at path ").next().unwrap_or(&text).to_owned()
}

/// The folder that `path` lies in.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

fn temporary_in(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".ambray-").suffix(".tmp");
    #[cfg(unix)]
    let everyone: fs::Permissions = std::os::unix::fs::PermissionsExt::from_mode(0o666); // less the umask
    #[cfg(unix)]
    builder.permissions(everyone);
    builder.tempfile_in(folder)
}

/// What pictures are written to.
pub trait Output: Write + Seek {}
impl<T: Write + Seek> Output for T {}

/// A file that is being written beside its destination. What is not put into a [`Batch`] vanishes.
#[derive(Debug)]
pub struct Pending {
    temporary: NamedTempFile,
    destination: PathBuf,
    _registered: Temporary,
}

impl Pending {
    /// Begins the file at `path`.
    pub fn new(path: &Path) -> anyhow::Result<Self> {
        if fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
            bail!("is no plain file");
        }
        // A link keeps being one: the file that it points to is replaced.
        let destination = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let temporary = temporary_in(folder_of(&destination))?;
        let registered = Temporary::register(temporary.path());
        Ok(Self { temporary, destination, _registered: registered })
    }

    /// The file, to write to.
    #[must_use]
    pub fn file(&self) -> &File {
        self.temporary.as_file()
    }

    /// Where the file is meanwhile, for another program that writes it.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.temporary.path()
    }
}

/// Outputs of one command. What is not [committed](Self::commit) vanishes.
#[derive(Debug, Default)]
pub struct Batch {
    staged: Vec<Staged>,
}

#[derive(Debug)]
enum Staged {
    File(Pending),
    // Stdout and devices cannot be renamed to: the bytes wait in memory.
    Bytes { bytes: Vec<u8>, target: Target },
}

impl Batch {
    /// Writes one output to its temporary place.
    pub fn add(
        &mut self,
        target: &Target,
        write: impl FnOnce(&mut dyn Output) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        let staged = stage(target, write).with_context(|| format!("output {}", target.name()))?;
        self.staged.push(staged);
        Ok(())
    }

    /// Adds a file that is complete.
    pub fn push(&mut self, pending: Pending) {
        self.staged.push(Staged::File(pending));
    }

    /// Makes all outputs appear.
    pub fn commit(self) -> anyhow::Result<()> {
        self.staged.into_iter().try_for_each(|staged| match staged {
            Staged::File(Pending { temporary, destination, .. }) => {
                let context = || format!("output {}", destination.display());
                temporary.persist(&destination).map(drop).map_err(|e| e.error).with_context(context)
            }
            Staged::Bytes { bytes, target: Target::Stdout } => write_stdout(&bytes),
            Staged::Bytes { bytes, target: Target::File(path) } => File::options()
                .write(true)
                .open(&path)
                .and_then(|mut device| device.write_all(&bytes))
                .with_context(|| format!("output {}", path.display())),
        })
    }
}

/// Writes `bytes` to stdout.
pub fn write_stdout(bytes: &[u8]) -> anyhow::Result<()> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(bytes)?;
    Ok(stdout.flush()?)
}

fn stage(
    target: &Target,
    write: impl FnOnce(&mut dyn Output) -> anyhow::Result<()>,
) -> anyhow::Result<Staged> {
    match target {
        Target::File(path) if fs::metadata(path).is_ok_and(|m| !m.is_file()) => stage_bytes(target, write),
        Target::File(path) => {
            let pending = Pending::new(path)?;
            let mut buffered = BufWriter::new(pending.file());
            write(&mut buffered)?;
            buffered.flush()?;
            drop(buffered);
            Ok(Staged::File(pending))
        }
        Target::Stdout => stage_bytes(target, write),
    }
}

fn stage_bytes(
    target: &Target,
    write: impl FnOnce(&mut dyn Output) -> anyhow::Result<()>,
) -> anyhow::Result<Staged> {
    let mut bytes = Cursor::new(Vec::new());
    write(&mut bytes)?;
    Ok(Staged::Bytes { bytes: bytes.into_inner(), target: target.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> =
            entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn files_appear_together_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let target = |name: &str| Target::File(folder.path().join(name));
        fs::write(folder.path().join("a"), "old").unwrap();
        let write = |text: &'static str| move |out: &mut dyn Output| Ok(out.write_all(text.as_bytes())?);

        let mut batch = Batch::default();
        batch.add(&target("a"), write("new")).unwrap();
        batch.add(&target("b"), |_| bail!("full")).unwrap_err();
        drop(batch);
        assert_eq!(names(folder.path()), ["a"]);
        assert_eq!(fs::read_to_string(folder.path().join("a")).unwrap(), "old");

        let mut batch = Batch::default();
        batch.add(&target("a"), write("new")).unwrap();
        batch.add(&target("b"), write("too")).unwrap();
        batch.commit().unwrap();
        assert_eq!(names(folder.path()), ["a", "b"]);
        assert_eq!(fs::read_to_string(folder.path().join("a")).unwrap(), "new");
    }

    #[cfg(unix)]
    #[test]
    fn links_devices_and_permissions_are_kept() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        symlink(&file, &link).unwrap();
        let mut batch = Batch::default();
        batch.add(&Target::File(link.clone()), |out| Ok(out.write_all(b"new")?)).unwrap();
        batch.add(&Target::File("/dev/null".into()), |out| Ok(out.write_all(b"gone")?)).unwrap();
        batch.commit().unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        let mode = fs::metadata(&file).unwrap().permissions().mode();
        assert_eq!(mode & 0o600, 0o600);
        assert_eq!(mode & 0o111, 0, "{mode:o}");
    }

    #[test]
    fn impossible_targets_are_refused_early() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |path: &Path| format!("{:#}", Target::File(path.to_owned()).check().unwrap_err());
        assert!(refused(folder.path()).contains("is a folder"));
        assert!(refused(&folder.path().join("no/x.png")).contains("does not exist"));
        assert!(refused(Path::new("..")).contains("folder"));
        assert!(Target::File(folder.path().join("x.png")).check().is_ok());
        assert_eq!(names(folder.path()), [""; 0]);
    }
}
