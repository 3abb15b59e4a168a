//! Videos. The program itself makes GIF files; for the others a script stands in for ffmpeg.

use std::{fs, process::Command};

use super::{Bench, Run};

/// Size, delays in hundredths of a second, and pixels of the frames of a GIF file, as indices into a set of colours.
fn gif(bytes: &[u8]) -> ((u16, u16), Vec<u16>, Vec<Vec<u8>>) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).expect("a GIF file");
    assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
    let (mut delays, mut frames) = (Vec::new(), Vec::new());
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        delays.push(frame.delay);
        frames.push(frame.buffer.to_vec());
    }
    ((decoder.width(), decoder.height()), delays, frames)
}

#[test]
fn gif_shows_the_whole_animation() {
    let bench = Bench::animated();
    let run = bench
        .run(&["render", "moving.gltf", "--size=64x36", "--animation=Bend", "-o", "bend.gif"])
        .succeeds();
    assert!(run.text().contains("15 frames, 0..=14, 30 fps") && run.text().contains("wrote    bend.gif"));
    let (size, delays, frames) = gif(&bench.read("bend.gif"));
    assert_eq!((size, delays.len()), ((64, 36), 15));
    assert_eq!(delays.iter().sum::<u16>(), 50, "half a second");
    assert!(delays.contains(&3) && delays.contains(&4));
    assert_ne!(frames[0], frames[7]);
    // Every second frame at half the rate lasts as long.
    bench.animate(&["--frames=0..10:2", "--fps=20", "-o", "steps.gif"]).succeeds();
    let (_, delays, _) = gif(&bench.read("steps.gif"));
    assert_eq!(delays, [10; 5]);
    assert_eq!(bench.made(), ["bend.gif", "steps.gif"]);
}

#[test]
fn gif_frames_look_like_pictures() {
    let bench = Bench::animated();
    bench.animate(&["--frames=0..2", "--fps=2", "-o", "a.gif"]).succeeds();
    bench.animate(&["--frames=0..2", "--fps=2", "-o", "#.png"]).succeeds();
    let (_, _, frames) = gif(&bench.read("a.gif"));
    for (i, frame) in frames.iter().enumerate() {
        let picture = super::Png::of(&bench.read(&format!("{i}.png"))).bytes;
        let shown = frame.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
        let sum: u64 = picture.iter().zip(shown).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        assert!(sum < 4 * picture.len() as u64, "frame {i}: {sum}");
    }
}

#[test]
fn what_is_about_pictures_is_refused() {
    let bench = Bench::animated();
    bench.animate(&["-o", "a.gif", "--fps=60"]).fails(&["--fps 60 is not allowed here: GIF shows"]);
    bench.animate(&["-o", "a.gif", "--aov=depth"]).fails(&["output a.gif: --aov is not allowed"]);
    bench.animate(&["-o", "a.gif", "--resume"]).fails(&["output a.gif: --resume is not allowed"]);
    bench.animate(&["-o", "a.mp4", "--format=png8"]).fails(&["--format png8 is not allowed with a video"]);
    bench
        .animate(&["-o", "a.mp4", "--size=63x36"])
        .fails(&["H.264 in MP4 needs even sides", "hint: --size 64x36"]);
    bench.animate(&["-o", "no/a.gif"]).fails(&["the folder no does not exist"]);
    bench.animate(&["-o", "a.gif", "--animation=Run"]).fails(&["error: --animation Run is not in the scene"]);
    bench.animate(&["-o", "a.gif", "--save-settings=a.gif"]).fails(&["--save-settings a.gif"]);
    bench.render(&["-o", "a.gif"]).fails(&["scene.obj has no animation to make a video of"]);
    assert_eq!(bench.made(), [""; 0]);
}

#[test]
fn animations_without_end_are_refused() {
    let bench = Bench::animated();
    for seconds in [99_999.0, 1e9] {
        bench.write("moving.gltf", &super::animated::lasting(seconds));
        let told = format!("the animation lasts {seconds} s, more than 1000000 frames at 30 fps");
        bench.animate(&["-o", "a.gif"]).fails(&[&told, "hint: --frames 0..300"]);
    }
    bench.animate(&["-o", "a.gif", "--frames=0..2", "--fps=10"]).succeeds();
    fs::remove_file(bench.path("a.gif")).expect("a video of a part");
    assert_eq!(bench.made(), [""; 0]);
}

/// Counts what comes in, and writes the count with its arguments into the video.
#[cfg(unix)]
const STAND_IN: &str = "#!/bin/sh\nfor last; do :; done\necho \"$(wc -c) $*\" > \"${last#file:}\"\n";

#[cfg(unix)]
impl Bench {
    /// Renders the animated scene where this script is the ffmpeg of the machine; `None` has none.
    fn film(&self, ffmpeg: Option<&str>, arguments: &[&str]) -> Run {
        let line = [&["render", "moving.gltf"], &super::QUICK[..], arguments].concat();
        Run::of(self.film_command(ffmpeg, &line).output().expect("the program starts"), &line)
    }

    fn film_command(&self, ffmpeg: Option<&str>, line: &[&str]) -> Command {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = self.path("out"); // which `made` looks into but does not list itself
        let mut path = folder.clone().into_os_string();
        fs::create_dir_all(&folder).expect("folder");
        let program = folder.join("ffmpeg");
        let _ = fs::remove_file(&program);
        if let Some(script) = ffmpeg {
            fs::write(&program, script).expect("script");
            fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("permissions");
            path.push(":/usr/bin:/bin"); // for what the script runs
        }
        let mut command = self.command(line);
        command.env("PATH", path);
        command
    }
}

#[cfg(unix)]
#[test]
fn ffmpeg_gets_raw_frames() {
    let bench = Bench::animated();
    let expected = [
        ("a.mp4", &["-c:v libx264", "-crf 18", "-pix_fmt yuv420p", "-f mp4 file:"][..]),
        ("a.webm", &["-c:v libvpx-vp9", "-f webm file:"]),
        ("a.webp", &["-c:v libwebp_anim", "-loop 0", "-f webp file:"]),
    ];
    for (name, parts) in expected {
        bench.film(Some(STAND_IN), &["--frames=0..5", "--fps=30000/1001", "-o", name]).succeeds();
        let told = bench.read_text(name);
        assert!(told.starts_with(&format!("{} ", 5 * 64 * 36 * 3)), "{told}");
        let input = "-f rawvideo -pixel_format rgb24 -video_size 64x36 -framerate 30000/1001 -i pipe:0";
        for part in parts.iter().chain([&input]) {
            assert!(told.contains(part), "{part} is missing in {told}");
        }
    }
    assert_eq!(bench.made(), ["a.mp4", "a.webm", "a.webp", "out/ffmpeg"]);
}

#[cfg(unix)]
#[test]
fn failures_of_ffmpeg_are_told_and_leave_nothing() {
    let bench = Bench::animated();
    bench.write("old.mp4", "old");
    let last = "#!/bin/sh\necho first >&2\necho \"Unknown encoder 'libx264'\" >&2\n";
    for script in [format!("{last}exit 1\n"), format!("{last}wc -c >/dev/null\nexit 1\n")] {
        let run = bench.film(Some(&script), &["--frames=0..40", "-o", "old.mp4"]);
        run.fails(&["ambray: error: output old.mp4: ffmpeg failed: Unknown encoder 'libx264'\n"]);
    }
    let silent = bench.film(Some("#!/bin/sh\nexit 3\n"), &["--frames=0..40", "-o", "old.mp4"]);
    silent.fails(&["ffmpeg failed (exit status: 3)"]);
    let none = bench.film(None, &["-o", "old.mp4", "--spp=65536", "--size=4096x4096"]);
    none.fails(&["output old.mp4: ffmpeg is not installed", "hint: install ffmpeg, or write a .gif"]);
    assert_eq!(bench.made(), ["old.mp4"]);
    assert_eq!(bench.read_text("old.mp4"), "old");
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_half_video() {
    use super::interrupt::{end, signal};
    let bench = Bench::animated();
    for name in ["a.gif", "a.mp4"] {
        let line = ["render", "moving.gltf", "--size=320x180", "--spp=64", "--frames=0..5000", "-o", name];
        let mut command = bench.film_command(Some(STAND_IN), &line);
        command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
        let child = command.spawn().expect("start");
        std::thread::sleep(std::time::Duration::from_millis(1500));
        assert!(bench.made().len() > 1, "the temporary file is there");
        signal(&child, "-INT");
        assert_eq!(end(child), Some(130));
        assert_eq!(bench.made(), ["out/ffmpeg"]);
    }
}

/// Where ffmpeg is installed, it takes what it is given.
#[test]
fn a_real_ffmpeg_makes_videos() {
    let bench = Bench::animated();
    let encoders = Command::new("ffmpeg").args(["-hide_banner", "-encoders"]).output();
    let Ok(encoders) = encoders else { return eprintln!("ffmpeg is not installed: skipped") };
    let encoders = String::from_utf8_lossy(&encoders.stdout).into_owned();
    for (name, encoder) in [("a.mp4", "libx264"), ("a.webm", "libvpx-vp9"), ("a.webp", "libwebp_anim")] {
        if encoders.contains(encoder) {
            bench.animate(&["--frames=0..4", "-o", name]).succeeds();
            assert!(bench.read(name).len() > 200, "{name}");
        }
    }
}
