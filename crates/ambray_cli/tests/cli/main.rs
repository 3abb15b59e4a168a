//! Runs the `ambray` program as a user would.
#![forbid(unsafe_code)]

mod animate;
mod animated;
mod backend;
mod bench_and_info;
mod compare;
mod diff;
mod help;
mod interrupt;
mod options;
mod outputs;
mod query;
mod rays;
mod sequence;
mod video;

use std::{
    fs,
    io::Write as _,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

/// A folder with a tiny scene in it, where commands run.
struct Bench {
    folder: tempfile::TempDir,
}

/// A floor of 4 × 4 units around the origin and a wall of the same size at x = 1; y is up.
const SCENE: &str = "\
v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv 1 0 -2\nv 1 4 -2\nv 1 4 2\nv 1 0 2\n\
g floor\nf 1 4 3 2\ng wall\nf 5 8 7 6\n";

/// Settings for quick pictures.
const QUICK: [&str; 3] = ["--size=64x36", "--radius=1", "--quiet"];

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("temporary folder");
        fs::write(folder.path().join("scene.obj"), SCENE).expect("scene");
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn read_text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).expect("text")
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("file");
    }

    /// Names of the files in the folder besides the scene, sorted.
    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("folder");
        let names = entries.map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned());
        let mut names: Vec<_> = names.filter(|name| name != "scene.obj").collect();
        names.sort();
        names
    }

    /// The program on a machine without Vulkan drivers, so that it does the same on every machine.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = self.command_here(arguments);
        // Both names of the variable, for loaders old and new.
        command.env("VK_DRIVER_FILES", "none.json").env("VK_ICD_FILENAMES", "none.json");
        command
    }

    /// The program on this machine, with the Vulkan drivers it has.
    fn command_here(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ambray"));
        command.current_dir(self.folder.path()).args(arguments).stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> Run {
        Run::of(self.command(arguments).output().expect("the program starts"), arguments)
    }

    fn run_with_input(&self, arguments: &[&str], input: &str) -> Run {
        let mut command = self.command(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program starts");
        let mut stdin = child.stdin.take().expect("a pipe");
        let _ = stdin.write_all(input.as_bytes()); // the program may end before it has read all
        drop(stdin);
        Run::of(child.wait_with_output().expect("the program ends"), arguments)
    }

    /// Renders the scene quickly with further arguments.
    fn render(&self, arguments: &[&str]) -> Run {
        self.run(&[&["render", "scene.obj"], &QUICK[..], arguments].concat())
    }
}

/// What a run of the program left.
#[derive(Debug)]
struct Run {
    arguments: String,
    code: Option<i32>,
    stdout: Vec<u8>,
    stderr: String,
}

impl Run {
    fn of(output: Output, arguments: &[&str]) -> Self {
        Self {
            arguments: arguments.join(" "),
            code: output.status.code(),
            stdout: output.stdout,
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    fn text(&self) -> String {
        String::from_utf8(self.stdout.clone()).expect("text on stdout")
    }

    #[track_caller]
    fn succeeds(self) -> Self {
        assert_eq!(self.code, Some(0), "ambray {}: {}", self.arguments, self.stderr);
        self
    }

    /// Fails with an error that holds all `parts`, and says nothing on stdout.
    #[track_caller]
    fn fails(self, parts: &[&str]) -> Self {
        assert_eq!(self.code, Some(2), "ambray {}: {}", self.arguments, self.stderr);
        assert!(!self.stderr.contains("panicked"), "ambray {}: {}", self.arguments, self.stderr);
        for part in parts {
            assert!(
                self.stderr.contains(part),
                "ambray {} lacks {part:?} in:\n{}",
                self.arguments,
                self.stderr
            );
        }
        assert!(self.stdout.is_empty(), "ambray {} wrote to stdout", self.arguments);
        self
    }
}

/// A decoded PNG file.
struct Png {
    size: (u32, u32),
    color: png::ColorType,
    depth: png::BitDepth,
    bytes: Vec<u8>,
    texts: Vec<(String, String)>,
}

impl Png {
    #[track_caller]
    fn of(bytes: &[u8]) -> Self {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG file");
        let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
        let frame = reader.next_frame(&mut pixels).expect("pixels");
        let info = reader.info();
        let texts = info.utf8_text.iter().map(|t| (t.keyword.clone(), t.get_text().expect("text"))).collect();
        Self {
            size: (info.width, info.height),
            color: frame.color_type,
            depth: frame.bit_depth,
            bytes: pixels,
            texts,
        }
    }

    fn text(&self, keyword: &str) -> &str {
        let found = self.texts.iter().find(|(key, _)| key == keyword);
        &found.unwrap_or_else(|| panic!("no text {keyword}")).1
    }
}

fn exists(path: &Path) -> bool {
    path.try_exists().expect("a readable folder")
}
