//! A real browser, to open pages as a reader does: Chromium without a window, driven over the Chrome DevTools protocol.

mod input;
mod page;
mod protocol;
pub mod report;

use std::{
    fs,
    net::TcpStream,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use serde_json::json;
use tempfile::TempDir;

pub use page::{Look, Page, Rect};
use protocol::Connection;

/// Programs that are tried, after the one that `AMBRAY_BROWSER` names.
const PROGRAMS: [&str; 5] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// How long anything may take: far more than it does.
const PATIENCE: Duration = Duration::from_secs(120);

/// A running browser; it ends when dropped.
#[derive(Debug)]
pub struct Browser {
    process: Child,
    /// Where it listens: `ws://…:port`.
    address: String,
    control: Connection,
    /// Its profile, and the pages that it was given as text.
    folder: TempDir,
}

impl Browser {
    /// Starts one, or says on the standard error why there is none, for the test to be skipped.
    ///
    /// # Panics
    /// If there is none although `AMBRAY_REQUIRE_BROWSER` is 1, or if one starts and does not answer.
    #[must_use]
    pub fn start() -> Option<Self> {
        let named = std::env::var("AMBRAY_BROWSER").ok();
        let mut programs = named.as_deref().into_iter().chain(PROGRAMS);
        let folder = TempDir::new().expect("a temporary folder");
        let Some(process) = programs.find_map(|program| launch(program, folder.path())) else {
            let is_required = std::env::var_os("AMBRAY_REQUIRE_BROWSER").is_some_and(|value| value == "1");
            assert!(!is_required, "no Chromium starts, and AMBRAY_REQUIRE_BROWSER=1");
            eprintln!("skipped: no Chromium starts (scripts/browser.sh installs it on Debian)");
            return None;
        };
        Some(Self::connect(process, folder))
    }

    fn connect(mut process: Child, folder: TempDir) -> Self {
        // It writes the port and the path of its socket there when it listens.
        let file = folder.path().join("profile/DevToolsActivePort");
        let start = Instant::now();
        let (port, path) = loop {
            let text = fs::read_to_string(&file).unwrap_or_default();
            if let Some((port, path)) = text.split_once('\n') {
                break (port.to_owned(), path.trim().to_owned());
            }
            let log = || fs::read_to_string(folder.path().join("log")).unwrap_or_default();
            if let Some(status) = process.try_wait().expect("a process") {
                panic!("the browser ended by itself ({status}):\n{}", log());
            }
            assert!(start.elapsed() < PATIENCE, "the browser does not listen:\n{}", log());
            thread::sleep(Duration::from_millis(20));
        };
        let address = format!("ws://127.0.0.1:{port}");
        let control = Connection::new(&format!("{address}{path}"), PATIENCE);
        Self { process, address, control, folder }
    }

    /// Opens the HTML file `file` as it looks on `look`, and waits until it is loaded.
    ///
    /// # Panics
    /// If the file cannot be opened.
    pub fn open(&mut self, file: &Path, look: Look) -> Page {
        let target = self.control.call("Target.createTarget", json!({ "url": "about:blank" }));
        let id = target["targetId"].as_str().expect("the id of a page");
        let page = Connection::new(&format!("{}/devtools/page/{id}", self.address), PATIENCE);
        Page::open(page, &file.canonicalize().expect("a page that is there"), look)
    }

    /// Opens `html`, saved as a file.
    ///
    /// # Panics
    /// If it cannot be saved.
    pub fn open_text(&mut self, html: &str, look: Look) -> Page {
        let file = self.folder.path().join("page.html");
        fs::write(&file, html).expect("a page");
        self.open(&file, look)
    }
}

impl Drop for Browser {
    /// Asks it to end, for its helpers then end too and let go of their files; ends it by force if it does not.
    fn drop(&mut self) {
        self.control.tell("Browser.close");
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(10) {
            if !matches!(self.process.try_wait(), Ok(None)) {
                return;
            }
            thread::sleep(Duration::from_millis(10));
        }
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Starts `program` if there is one.
fn launch(program: &str, folder: &Path) -> Option<Child> {
    let log = fs::File::create(folder.join("log")).expect("a file");
    let mut command = Command::new(program);
    // Only pages of the tests are opened, and in containers the sandbox cannot be had.
    command.args(["--headless", "--no-sandbox", "--remote-debugging-port=0"]);
    command.arg(format!("--user-data-dir={}", folder.join("profile").display()));
    command.args(["--no-first-run", "--disable-background-networking", "--disable-component-update"]);
    // Small shared memory is usual in containers; colours must not depend on a screen.
    command.args(["--disable-dev-shm-usage", "--force-color-profile=srgb", "--disable-gpu"]);
    // Without a screen there is no mouse either, unless one is promised; telephones are told otherwise.
    command.arg("--blink-settings=primaryHoverType=2,availableHoverTypes=2,primaryPointerType=4,availablePointerTypes=4");
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(log).spawn().ok()
}

/// The socket of a debugger that listens at `address`.
fn dial(address: &str) -> TcpStream {
    let host = address.trim_start_matches("ws://").split('/').next().expect("a host");
    TcpStream::connect(host).unwrap_or_else(|error| panic!("{host}: {error}"))
}
