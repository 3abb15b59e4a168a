//! Reading files that were named by somebody we do not trust.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use percent_encoding::percent_decode_str;

use crate::error::{Fault, Outcome, quoted};
use crate::limits;

/// Reads `path` whole if it is a regular file of at most `limit` bytes; `at` is the place that asked for it.
///
/// Devices, pipes and folders are refused before they are opened, since opening alone may block.
pub(crate) fn read_regular(path: &Path, limit: u64, at: &str) -> Outcome<Vec<u8>> {
    let failed = |error: std::io::Error| {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if at.is_empty() {
            Fault::io(at, error.to_string())
        } else {
            Fault::io(at, format!("cannot read {}: {error}", quoted(&name)))
        }
    };
    let meta = fs::metadata(path).map_err(failed)?;
    if !meta.is_file() {
        let kind = if meta.is_dir() { "a folder" } else { "a device or pipe" };
        return Err(Fault::io(at, format!("{kind}, not a regular file")));
    }
    let too_large = || Fault::too_large(at, format!("file of more than {limit} bytes"));
    if meta.len() > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(meta.len() as usize);
    // The file may grow while it is read, and files of some file systems claim to be empty: trust only the count.
    let file = File::open(path).map_err(failed)?;
    file.take(limit + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limit { Err(too_large()) } else { Ok(bytes) }
}

/// Files beside the scene file, with the bytes they may still add up to.
#[derive(Debug)]
pub(crate) struct Folder {
    base: PathBuf,
    left: u64,
    /// Files that were read, or could not be.
    asked: Vec<PathBuf>,
}

impl Folder {
    /// The folder of `scene_file`, of which `used` bytes have been read already.
    pub(crate) fn of(scene_file: &Path, used: u64) -> Self {
        let base = scene_file.parent().map(Path::to_path_buf).unwrap_or_default();
        Self { base, left: limits::FILE_BYTES.saturating_sub(used), asked: Vec::new() }
    }

    /// The files that were asked for.
    pub(crate) fn into_asked(self) -> Vec<PathBuf> {
        self.asked
    }

    /// Reads the file that the percent-encoded relative `uri` names.
    pub(crate) fn read(&mut self, uri: &str, at: &str) -> Outcome<Vec<u8>> {
        let decoded = percent_decode_str(uri)
            .decode_utf8()
            .map_err(|_| Fault::invalid(at, format!("URI {} is not UTF-8", quoted(uri))))?;
        if let Some(scheme) = scheme(uri) {
            let reason = format!("URI scheme {} is not read, only files beside the scene", quoted(scheme));
            return Err(Fault::unsupported(at, reason));
        }
        self.read_name(&decoded, at)
    }

    /// Reads the file of the relative path `name`, its parts separated by `/`.
    pub(crate) fn read_name(&mut self, name: &str, at: &str) -> Outcome<Vec<u8>> {
        let relative = inside(name).ok_or_else(|| {
            Fault::invalid(at, format!("path {} does not stay in the scene's folder", quoted(name)))
        })?;
        let path = self.base.join(relative);
        let bytes = read_regular(&path, self.left, at);
        if !self.asked.contains(&path) {
            self.asked.push(path);
        }
        let bytes = bytes?;
        self.left -= bytes.len() as u64;
        Ok(bytes)
    }
}

/// The scheme of an absolute URI (RFC 3986 §3.1).
pub(crate) fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let legal = |c: char| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.');
    (scheme.starts_with(|c: char| c.is_ascii_alphabetic()) && scheme.chars().all(legal)).then_some(scheme)
}

/// `name` with `.` and `..` resolved, or `None` if it is absolute, climbs out of the folder or names nothing.
fn inside(name: &str) -> Option<PathBuf> {
    // Backslashes separate parts on Windows only, and a colon may name a drive or a stream there.
    if name.contains(['\0', '\\']) || name.starts_with('/') || (cfg!(windows) && name.contains(':')) {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in name.split('/') {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()?),
            _ => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.iter().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(name: &str, expected: Option<&str>) {
        assert_eq!(inside(name), expected.map(PathBuf::from), "{name}");
    }

    #[test]
    fn names_stay_in_the_folder() {
        check("a.bin", Some("a.bin"));
        check("./textures//a b.png", Some("textures/a b.png"));
        check("a/../b.bin", Some("b.bin"));
        check("❤/♻.png", Some("❤/♻.png"));
        check("../a.bin", None);
        check("a/../../b.bin", None);
        check("/etc/passwd", None);
        check("..\\a.bin", None);
        check("a\0b", None);
        check("", None);
        check(".", None);
    }

    #[test]
    fn schemes_are_seen() {
        assert_eq!(scheme("file:///etc/passwd"), Some("file"));
        assert_eq!(scheme("HTTP://x"), Some("HTTP"));
        assert_eq!(scheme("a/b:c"), None);
        assert_eq!(scheme("a.bin"), None);
    }

    #[test]
    fn refuses_what_is_not_a_file() {
        let dir = tempfile::tempdir().expect("temporary folder");
        std::fs::write(dir.path().join("five"), b"12345").expect("write");
        let mut folder = Folder::of(&dir.path().join("scene.gltf"), 0);
        assert_eq!(folder.read("five", "x"), Ok(b"12345".to_vec()));
        assert_eq!(folder.read("%66ive", "x"), Ok(b"12345".to_vec()));
        for uri in ["%2e%2e/five", "..%2ffive", "http://localhost/five", "six", "."] {
            assert!(folder.read(uri, "x").is_err(), "{uri}");
        }
        assert!(read_regular(&dir.path().join("five"), 4, "x").is_err());
        assert!(read_regular(dir.path(), 4, "x").is_err());
        #[cfg(unix)]
        assert!(read_regular(Path::new("/dev/zero"), 4, "x").is_err());
    }
}
