//! Videos by an installed ffmpeg, which gets raw frames through a pipe.

use std::{
    env,
    ffi::OsString,
    io::{BufRead as _, BufReader, Write as _},
    path::Path,
    process::{Child, ChildStderr, ChildStdin, Command, ExitStatus, Stdio},
    sync::atomic::AtomicBool,
    thread::{self, JoinHandle},
    time::Duration,
};

use ambray::settings::Size;
use anyhow::{Context as _, anyhow};

use super::{Encode, Kind};
use crate::{Rate, interruption};

const PROGRAM: &str = "ffmpeg";

/// Pictures are sRGB; videos say so in the terms of BT.709, which has the same primaries.
const COLORS: [&str; 10] = [
    "-vf",
    "scale=out_color_matrix=bt709:out_range=tv",
    "-color_range",
    "tv",
    "-colorspace",
    "bt709",
    "-color_primaries",
    "bt709",
    "-color_trc",
    "iec61966-2-1",
];

/// Whether there is an ffmpeg on the path.
pub(super) fn is_installed() -> bool {
    let name = format!("{PROGRAM}{}", env::consts::EXE_SUFFIX);
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(&name).is_file())
}

/// How the video is encoded, and the format of its file.
fn encoding(kind: Kind) -> Vec<&'static str> {
    let chosen: &[&str] = match kind {
        Kind::Mp4 => {
            &["-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"]
        }
        Kind::Webm => &[
            "-c:v",
            "libvpx-vp9",
            "-crf",
            "24",
            "-b:v",
            "0",
            "-row-mt",
            "1",
            "-pix_fmt",
            "yuv420p",
            "-f",
            "webm",
        ],
        // The encoder converts colours by itself, as its format asks.
        Kind::Webp | Kind::Gif => {
            &["-c:v", "libwebp_anim", "-quality", "90", "-loop", "0", "-pix_fmt", "bgra", "-f", "webp"]
        }
    };
    let colors: &[&str] = if kind == Kind::Webp { &[] } else { &COLORS };
    [colors, chosen].concat()
}

/// A running ffmpeg.
pub(super) struct Ffmpeg<'a> {
    /// Ends the wait for it.
    cancel: &'a AtomicBool,
    child: Child,
    stdin: Option<ChildStdin>,
    /// Reads what it complains about, and returns the last line.
    complaints: Option<JoinHandle<String>>,
}

impl<'a> Ffmpeg<'a> {
    /// Starts it to write the file at `path`.
    pub(super) fn start(
        kind: Kind,
        path: &Path,
        size: Size,
        rate: Rate,
        cancel: &'a AtomicBool,
    ) -> anyhow::Result<Self> {
        let (frames, seconds) = rate.fraction();
        let mut command = Command::new(PROGRAM);
        command.args([
            "-hide_banner",
            "-loglevel",
            "error",
            "-y",
            "-f",
            "rawvideo",
            "-pixel_format",
            "rgb24",
        ]);
        command.args(["-video_size", &size.to_string(), "-framerate", &format!("{frames}/{seconds}")]);
        command.args(["-i", "pipe:0", "-an"]).args(encoding(kind)).arg(file_url(path));
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        // Ctrl-C is for this program, which then stops ffmpeg.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn().context("ffmpeg could not be started")?;
        let complaints = child.stderr.take().map(|stderr| thread::spawn(move || last_line(stderr)));
        Ok(Self { cancel, stdin: child.stdin.take(), child, complaints })
    }

    /// Waits for the end; it may be interrupted meanwhile.
    fn wait(&mut self) -> anyhow::Result<ExitStatus> {
        loop {
            if let Some(status) = self.child.try_wait().context("ffmpeg")? {
                return Ok(status);
            }
            interruption::check(self.cancel)?;
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// Why it failed, in its own words.
    fn failure(&mut self) -> anyhow::Error {
        let status = match self.wait() {
            Ok(status) => status,
            Err(error) => return error,
        };
        let complaints = self.complaints.take().and_then(|reader| reader.join().ok()).unwrap_or_default();
        match complaints.as_str() {
            "" => anyhow!("ffmpeg failed ({status})"),
            line => anyhow!("ffmpeg failed: {line}"),
        }
    }
}

/// A path that ffmpeg takes for nothing else, such as a protocol or an option.
fn file_url(path: &Path) -> OsString {
    let mut url = OsString::from("file:");
    url.push(path);
    url
}

fn last_line(stderr: ChildStderr) -> String {
    let lines = BufReader::new(stderr).split(b'\n').map_while(Result::ok);
    let lines = lines.map(|line| String::from_utf8_lossy(&line).trim().to_owned());
    lines.filter(|line| !line.is_empty()).last().unwrap_or_default()
}

impl Encode for Ffmpeg<'_> {
    fn frame(&mut self, rgb: &[u8]) -> anyhow::Result<()> {
        let Some(stdin) = &mut self.stdin else { return Err(self.failure()) };
        if stdin.write_all(rgb).is_ok() {
            return Ok(());
        }
        // It has closed the pipe: its own words say more than that.
        self.stdin = None;
        Err(self.failure())
    }

    fn finish(mut self: Box<Self>) -> anyhow::Result<()> {
        drop(self.stdin.take());
        if self.wait()?.success() { Ok(()) } else { Err(self.failure()) }
    }
}

impl Drop for Ffmpeg<'_> {
    fn drop(&mut self) {
        // Both fail if it has ended, as it should have.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
