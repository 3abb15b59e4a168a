//! A screen in memory, and the program on it.

use std::{
    fs,
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
    thread,
    time::{Duration, Instant},
};

/// How long a run may take: far more than any does.
const PATIENCE: Duration = Duration::from_secs(240);

/// An X server without a screen; it ends when dropped.
pub(crate) struct Display {
    server: Child,
    pub(crate) name: String,
}

impl Display {
    /// Starts one, or says why there is none. Panics where one must be there.
    pub(crate) fn start() -> Option<Self> {
        let started = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1600x1000x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = match started {
            Ok(server) => server,
            Err(error) => {
                let is_required = std::env::var_os("AMBRAY_REQUIRE_WINDOW").is_some_and(|value| value == "1");
                assert!(!is_required, "Xvfb does not start: {error}, and AMBRAY_REQUIRE_WINDOW=1");
                eprintln!("skipped: Xvfb does not start: {error}");
                return None;
            }
        };
        let mut number = String::new();
        BufReader::new(server.stdout.take().expect("a pipe")).read_line(&mut number).expect("a line");
        Some(Self { server, name: format!(":{}", number.trim()) })
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// A folder where the program runs.
pub(crate) struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("temporary folder") }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The program here, without a display.
    pub(crate) fn program(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ambray"));
        command.current_dir(self.folder.path()).stdin(Stdio::null());
        command
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_CONFIG_HOME", self.path("config"));
        // The system's scale must not change sizes.
        command.env("WINIT_X11_SCALE_FACTOR", "1");
        command
    }

    /// `ambray view` on `display`.
    pub(crate) fn view(&self, display: &Display, arguments: &[&str]) -> Command {
        let mut command = self.program();
        command.env("DISPLAY", &display.name).arg("view").args(arguments);
        command
    }

    /// Walks through the window with `script`; gives what the program said.
    #[track_caller]
    pub(crate) fn walk(&self, display: &Display, arguments: &[&str], script: &str) -> Output {
        fs::write(self.path("walk.txt"), script).expect("script");
        let arguments = [&["--no-memory", "--script", "walk.txt"], arguments].concat();
        let child = (self.view(display, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()))
            .spawn()
            .expect("the program starts");
        finish(child)
    }

    /// Runs the command line in `file`, which begins with `ambray`, with further arguments.
    #[track_caller]
    pub(crate) fn run_line(&self, file: &str, more: &[&str]) {
        let line = fs::read_to_string(self.path(file)).expect("a line");
        let words = shlex::split(line.trim()).expect("words");
        assert_eq!(words[0], "ambray", "{line}");
        let output = self.program().args(&words[1..]).args(more).output().expect("the program starts");
        assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

/// Waits for `child`, and kills it where it hangs.
#[track_caller]
pub(crate) fn finish(mut child: Child) -> Output {
    let start = Instant::now();
    while child.try_wait().expect("a process").is_none() {
        if start.elapsed() > PATIENCE {
            let _ = child.kill();
            let output = child.wait_with_output().expect("output");
            panic!("the window hangs: {}", String::from_utf8_lossy(&output.stderr));
        }
        thread::sleep(Duration::from_millis(20));
    }
    child.wait_with_output().expect("output")
}

/// Looks until there is what is looked for.
#[track_caller]
pub(crate) fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(start.elapsed() < PATIENCE, "{what} does not come");
        thread::sleep(Duration::from_millis(50));
    }
}

/// The program ended well and had nothing to say.
#[track_caller]
pub(crate) fn assert_quiet(output: &Output) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{}: {said}", output.status);
}

/// Whether lavapipe is here, the Vulkan device in software.
pub(crate) fn lavapipe() -> Option<PathBuf> {
    let folder = fs::read_dir("/usr/share/vulkan/icd.d").ok()?;
    let mut drivers = folder.filter_map(|entry| Some(entry.ok()?.path()));
    let driver = drivers
        .find(|path| Path::file_name(path).is_some_and(|n| n.to_string_lossy().starts_with("lvp_icd")));
    if driver.is_none() {
        let is_required = std::env::var_os("AMBRAY_REQUIRE_VULKAN").is_some_and(|value| value == "1");
        assert!(!is_required, "lavapipe is not installed, and AMBRAY_REQUIRE_VULKAN=1");
        eprintln!("skipped: lavapipe is not installed");
    }
    driver
}
