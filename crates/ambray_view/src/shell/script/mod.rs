//! A walk through the window, one step a line: for tests, and for pictures of documentation.
//!
//! Empty lines and lines that begin with `#` mean nothing. Places and sizes are pixels of the window, from the top left.
//!
//! | Step | What it does |
//! |---|---|
//! | `wait` | waits until the final pictures are shown and nothing is being loaded |
//! | `open PATH` | opens a scene, a file or a built-in one |
//! | `drop PATH` | drops a file on the window |
//! | `set NAME VALUE` | changes a setting of the side that is edited |
//! | `side a`, `side b` | edits that side |
//! | `compare off`, `split`, `difference` | compares the sides |
//! | `divider SHARE` | moves the divider, 0 at the left, 1 at the right |
//! | `aov NAME` | shows another plane |
//! | `overlays on`, `off` | draws words, lines and messages over the picture, or leaves it bare |
//! | `frames COUNT` | waits until the picture is the mean of so many frames, 256 at most: with `temporal on` |
//! | `resize WIDTH HEIGHT` | makes the window that large |
//! | `key KEY` | presses a key: `F`, `?`, `Ctrl+Z` |
//! | `type TEXT` | types text |
//! | `move X Y`, `click X Y`, `double-click X Y`, `alt-click X Y` | uses the pointer |
//! | `scroll X Y LINES` | turns the wheel, up for numbers above 0 |
//! | `drag X Y DX DY [left, middle, right]` | drags from a place by so many pixels |
//! | `screenshot FILE.png` | writes what is on the window |
//! | `turntable FILE FRAMES` | begins to write a turn around the scene: numbered pictures or a video |
//! | `copy FILE` | writes the command line that renders the picture |
//! | `expect error TEXT`, `expect no-error` | fails unless there is a message of an error that holds the text, or none at all |
//! | `quit` | closes the window; what comes at the end of the script, too |

mod parse;
mod run;

use std::path::{Path, PathBuf};

use ambray::Aov;
use anyhow::Context as _;
use egui::{Key, Modifiers, PointerButton};

pub(super) use self::run::{Runner, Wish};
use crate::model::{Comparison, Side};

/// One step.
#[derive(Clone, Debug, PartialEq)]
enum Step {
    Wait,
    Open(PathBuf),
    Drop(PathBuf),
    Set { name: String, value: String },
    Edit(Side),
    Compare(Comparison),
    Divider(f32),
    Show(Aov),
    Overlays(bool),
    Frames(u32),
    Resize(u32, u32),
    Key { key: Key, modifiers: Modifiers, text: Option<String> },
    Type(String),
    Move(f32, f32),
    Click { at: (f32, f32), count: usize, modifiers: Modifiers },
    Scroll { at: (f32, f32), lines: f32 },
    Drag { from: (f32, f32), by: (f32, f32), with: PointerButton },
    Screenshot(PathBuf),
    Turntable { path: PathBuf, frames: u32 },
    Copy(PathBuf),
    ExpectError(String),
    ExpectNoError,
    Quit,
}

/// A walk that was read.
#[derive(Debug)]
pub(super) struct Script {
    path: PathBuf,
    /// Steps with the numbers of their lines, the first to come last.
    steps: Vec<(usize, Step)>,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// If it cannot be read, and if a line is no step: the message names file and line.
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
        Self::parse(path, &text)
    }

    fn parse(path: &Path, text: &str) -> anyhow::Result<Self> {
        let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
        let mut steps = lines
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
            .map(|(number, line)| {
                let step = parse::step(line).with_context(|| format!("{}:{number}", path.display()))?;
                Ok((number, step))
            })
            .collect::<anyhow::Result<Vec<_>>>()?;
        steps.reverse();
        Ok(Self { path: path.to_owned(), steps })
    }
}
