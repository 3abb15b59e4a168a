//! The file that the memory lies in: read once, written on a thread of its own a moment after a change.

use std::{
    fs,
    path::{Path, PathBuf},
    thread::JoinHandle,
};

use anyhow::Context as _;

use super::Memory;
use crate::app::write;

/// Seconds without a change before the memory is written.
const DELAY: f64 = 1.5;

/// Where the memory lies unless something else is said: `view.toml` in the user's folder of configurations.
#[must_use]
pub fn default_path() -> Option<PathBuf> {
    Some(directories::ProjectDirs::from("", "", "ambray")?.config_dir().join("view.toml"))
}

/// The memory's place on disk.
#[derive(Debug, Default)]
pub struct Store {
    path: Option<PathBuf>,
    written: Memory,
    /// The state that waits to be written, and since when, seconds of the window's clock.
    waiting: Option<(Memory, f64)>,
    writing: Option<JoinHandle<anyhow::Result<()>>>,
}

impl Store {
    /// Remembers nothing beyond this run.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// Reads what lies at `path`. A file that is missing is empty; of one that is damaged the message is the reason, and
    /// nothing is remembered.
    #[must_use]
    pub fn open(path: PathBuf) -> (Self, Memory, Option<String>) {
        let memory = match read(&path) {
            Ok(memory) => memory,
            // The file is left alone: someone may mend it.
            Err(error) => {
                let warning = format!("nothing is remembered: {}: {error:#}", path.display());
                return (Self::none(), Memory::default(), Some(warning));
            }
        };
        (Self { path: Some(path), written: memory.clone(), ..Self::default() }, memory, None)
    }

    /// Writes `memory` in the background if it has changed and then stayed the same for a moment. The error is that of an
    /// earlier write. Says whether something still waits.
    pub fn keep(&mut self, memory: &Memory, now: f64) -> (bool, Option<String>) {
        let Some(path) = self.path.clone() else { return (false, None) };
        let mut told = None;
        if self.writing.as_ref().is_some_and(JoinHandle::is_finished) {
            told = self.finish_writing();
        }
        let target = self.waiting.as_ref().map_or(&self.written, |(waiting, _)| waiting);
        if target != memory {
            self.waiting = (self.written != *memory).then(|| (memory.clone(), now));
        }
        if self.writing.is_none()
            && let Some((waiting, _)) = self.waiting.take_if(|(_, since)| now - *since >= DELAY)
        {
            let text = spell(&waiting);
            self.written = waiting;
            self.writing = Some(std::thread::spawn(move || place(&path, &text)));
        }
        (self.waiting.is_some(), told)
    }

    /// Writes `memory` now if it has changed. For the end of the program.
    pub fn finish(&mut self, memory: &Memory) -> Option<String> {
        let earlier = self.finish_writing();
        let path = self.path.as_ref()?;
        self.waiting = None;
        if self.written == *memory && earlier.is_none() {
            return None;
        }
        self.written = memory.clone();
        place(path, &spell(memory)).err().map(|error| format!("{}: {error:#}", path.display()))
    }

    fn finish_writing(&mut self) -> Option<String> {
        let path = self.path.clone()?;
        match self.writing.take()?.join() {
            Ok(Ok(())) => None,
            Ok(Err(error)) => Some(format!("{}: {error:#}", path.display())),
            Err(_) => Some(format!("{}: could not be written", path.display())),
        }
    }
}

fn read(path: &Path) -> anyhow::Result<Memory> {
    match fs::read_to_string(path) {
        Ok(text) => toml::from_str(&text).map_err(|error| {
            let line =
                error.span().map_or(1, |span| 1 + text[..span.start.min(text.len())].matches('\n').count());
            anyhow::anyhow!("line {line}: {}", error.message())
        }),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Memory::default()),
        Err(error) => Err(error.into()),
    }
}

/// Writes the file, in a folder that may be new.
fn place(path: &Path, text: &str) -> anyhow::Result<()> {
    fs::create_dir_all(path.parent().context("is no file")?)?;
    write(path, text)
}

fn spell(memory: &Memory) -> String {
    toml::to_string(memory).expect("the memory is plain data")
}

#[cfg(test)]
mod tests {
    use ambray::settings::{Auto, Settings, Thin};

    use super::*;
    use crate::{
        memory::look_of,
        model::{Bookmark, SceneRef},
    };

    fn full() -> Memory {
        let settings = Settings { thin: Thin::Sheet, exposure: 0.1, ..Settings::default() };
        let mut memory = Memory { settings: look_of(&settings), ..Memory::default() };
        memory.opened(Path::new("/a/scene with \"quotes\".glb"));
        memory.panels.facts = false;
        memory.presets.insert("my é look".to_owned(), look_of(&settings));
        let bookmark = Bookmark { camera: Auto::Value("auto-ish".to_owned()), ..Bookmark::default() };
        let scene = SceneRef::new("atrium");
        memory.keep_bookmarks(&scene, &[(3, bookmark.clone())].into());
        assert_eq!(memory.bookmarks_of(&scene)[&3], bookmark);
        memory
    }

    #[test]
    fn what_is_kept_is_there_in_the_next_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/folder/view.toml");
        let (mut store, empty, warning) = Store::open(path.clone());
        assert_eq!((empty, warning), (Memory::default(), None));
        assert_eq!(store.finish(&full()), None);
        let (_, read, warning) = Store::open(path);
        assert_eq!((read, warning), (full(), None));
    }

    #[test]
    fn changes_are_written_once_they_rest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("view.toml");
        let (mut store, mut memory, _) = Store::open(path.clone());
        assert_eq!(store.keep(&memory, 0.0), (false, None));
        memory.opened(Path::new("/a.glb"));
        assert_eq!(store.keep(&memory, 1.0), (true, None));
        memory.opened(Path::new("/b.glb"));
        assert_eq!(store.keep(&memory, 2.0), (true, None));
        assert_eq!(store.keep(&memory, 3.0), (true, None), "a change begins the wait again");
        assert!(!path.exists());
        assert_eq!(store.keep(&memory, 4.0), (false, None));
        assert_eq!(store.finish(&memory), None);
        assert_eq!(Store::open(path).1, memory);
    }

    #[test]
    fn a_damaged_file_is_ignored_with_a_warning() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("view.toml");
        fs::write(&path, "recent = [\"a.glb\"]\nsettings = 3\n").unwrap();
        let (mut store, memory, warning) = Store::open(path.clone());
        assert_eq!(memory, Memory::default());
        assert_eq!(store.finish(&full()), None);
        assert!(fs::read_to_string(&path).unwrap().contains("a.glb"), "the file is left alone");
        let warning = warning.expect("something is said");
        assert!(warning.contains("view.toml: line 2"), "{warning}");
        fs::write(&path, [0xff, 0xfe, 0]).unwrap();
        assert!(Store::open(path).2.is_some());
    }

    #[test]
    fn nothing_is_written_where_nothing_is_remembered() {
        let mut store = Store::none();
        assert_eq!(store.keep(&full(), 100.0), (false, None));
        assert_eq!(store.finish(&full()), None);
    }
}
