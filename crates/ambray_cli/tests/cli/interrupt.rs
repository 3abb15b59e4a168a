//! Ctrl-C leaves nothing half-written.
#![cfg(unix)]

use std::{
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use super::Bench;

pub(super) fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status().expect("kill");
    assert!(status.success());
}

/// Waits for the end, at most a minute.
pub(super) fn end(mut child: Child) -> Option<i32> {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(60) {
        if let Some(status) = child.try_wait().expect("a child") {
            return status.code();
        }
        thread::sleep(Duration::from_millis(10));
    }
    let _ = child.kill();
    panic!("the program did not end");
}

#[test]
fn ctrl_c_ends_a_long_rendering() {
    for name in ["-INT", "-TERM"] {
        let bench = Bench::new();
        bench.write("out.png", "old");
        let long = ["render", "scene.obj", "--size=1920x1080", "--spp=65536", "-o", "out.png", "--aov=all"];
        let child = bench.command(&long).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("start");
        thread::sleep(Duration::from_millis(1500));
        signal(&child, name);
        assert_eq!(end(child), Some(130));
        assert_eq!(bench.files(), ["out.png"]);
        assert_eq!(bench.read_text("out.png"), "old");
    }
}

#[test]
fn ctrl_c_ends_waiting_for_points() {
    let bench = Bench::new();
    let mut command = bench.command(&["query", "scene.obj", "--points=-", "-o", "out.csv"]);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().expect("start");
    let _open = child.stdin.take();
    thread::sleep(Duration::from_millis(1500));
    assert_eq!(bench.files().len(), 1, "the temporary file is there");
    signal(&child, "-INT");
    assert_eq!(end(child), Some(130));
    assert_eq!(bench.files(), [""; 0]);
}

#[test]
fn ctrl_c_keeps_the_finished_frames_of_a_sequence() {
    let bench = Bench::animated();
    let line = ["render", "moving.gltf", "--size=64x36", "--frames=0..100000", "-o", "out/#.png"];
    let child = bench.command(&line).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("start");
    thread::sleep(Duration::from_millis(1500));
    signal(&child, "-INT");
    let output = child.wait_with_output().expect("end");
    assert_eq!(output.status.code(), Some(130));
    let (made, told) = (bench.made(), String::from_utf8_lossy(&output.stderr).into_owned());
    assert!(!made.is_empty() && made.iter().all(|name| name.ends_with(".png")), "{made:?}");
    assert!(told.contains(&format!("{} of 100000 frames are finished; --resume", made.len())), "{told}");
    made.iter().for_each(|name| drop(super::Png::of(&bench.read(name))));
}
