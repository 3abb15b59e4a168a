//! `ambray compare`, and other methods in `ambray render`.

use super::{Bench, QUICK};

const METHODS: [&str; 8] =
    ["traced-random", "traced-same", "traced-step", "ssao", "hbao", "gtao", "bitmask", "hybrid"];

fn json(bytes: &[u8]) -> serde_json::Value {
    serde_json::from_slice(bytes).expect("JSON")
}

#[test]
fn a_report_is_a_page_with_its_numbers_beside_it() {
    let bench = Bench::new();
    let compare = [
        "compare",
        "scene.obj",
        "--size=64x36",
        "--radius=1",
        "--methods=gtao,traced-random",
        "--rays=1,8",
        "--runs=1",
        "--truth-error=0.05",
        "--cache=truths",
        "-o",
        "report.html",
    ];
    let told = bench.run(&compare).succeeds().text();
    assert!(told.contains("truth    1024 rays a pixel") && told.contains("GTAO"), "{told}");
    assert!(told.contains("written  report.html, report.json, report.csv"), "{told}");
    let report = json(&bench.read("report.json"));
    let rows = report["comparison"]["rows"].as_array().expect("rows");
    let names: Vec<_> = rows.iter().map(|row| row["method"].as_str().expect("a name")).collect();
    assert_eq!(names, ["ambray", "traced-random", "gtao"], "in the order of the documentation");
    assert!(rows.iter().all(|row| row["measures"]["rmse"].as_f64().is_some_and(|rmse| rmse > 0.0)));
    assert_eq!(report["comparison"]["truth"]["cached"], false);
    let page = bench.read_text("report.html");
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("Error against rays"), "a page");
    assert!(page.contains("--methods=gtao,traced-random"), "the command is in the page");
    assert_eq!(bench.read_text("report.csv").lines().count(), 1 + 3 + 2 + 4 + 2);

    let again = bench.run(&[&compare[..], &["--json"]].concat()).succeeds();
    let again = json(&again.stdout);
    assert_eq!(again["comparison"]["truth"]["cached"], true, "the truth was kept");
    let rmse = |report: &serde_json::Value| report["comparison"]["rows"][0]["measures"]["rmse"].clone();
    assert_eq!(rmse(&again), rmse(&report));
}

#[test]
fn the_papers_figures_are_made_again() {
    let bench = Bench::new();
    let arguments = ["compare", "scene.obj", "--paper", "--size=64x36", "--radius=1", "--runs=1"];
    let more = ["--truth-error=0.05", "--no-cache", "-o", "paper.html"];
    let told = bench.run(&[&arguments[..], &more].concat()).succeeds().text();
    assert!(told.contains("thin sheet") && told.contains("chords"), "{told}");
    let page = bench.read_text("paper.html");
    for title in ["Figure 1", "Figure 2", "Figures 3 and 5", "Figure 6", "Table"] {
        assert!(page.contains(title), "{title}");
    }
    let report = json(&bench.read("paper.json"));
    assert_eq!(report["paper"]["times"].as_array().map(Vec::len), Some(3));
    assert_eq!(bench.read_text("paper.csv").lines().count(), 1 + 1 + 3 + 3 + 6);
}

#[test]
fn a_sequence_is_compared_frame_by_frame() {
    let bench = Bench::new();
    let arguments = ["compare", "banner", "--size=32x18", "--methods=traced-random", "--rays=1", "--runs=1"];
    let more = ["--truth-error=0.05", "--no-cache", "--frames=3", "--fps=12", "--json"];
    let report = json(&bench.run(&[&arguments[..], &more].concat()).succeeds().stdout);
    let sequence = &report["comparison"]["sequence"];
    assert_eq!((sequence["frames"].as_u64(), sequence["fps"].as_f64()), (Some(3), Some(12.0)));
    assert_eq!(sequence["rows"].as_array().map(Vec::len), Some(3), "two methods, and accumulated");
    assert!(sequence["rows"][0]["flicker"].as_f64().is_some_and(|flicker| flicker > 0.0));
}

#[test]
fn what_cannot_be_compared_is_told_in_a_line() {
    let bench = Bench::new();
    bench.run(&["compare", "scene.obj", "--frames=3"]).fails(&["--frames is not allowed", "no animation"]);
    bench.run(&["compare", "--method=gtao"]).fails(&["--method is not allowed", "--methods"]);
    bench.run(&["compare", "--fps=24"]).fails(&["--fps is not allowed without --frames"]);
    bench.run(&["compare", "--sampling=same"]).fails(&["--sampling same is not allowed"]);
    bench.run(&["compare", "--temporal=on"]).fails(&["--temporal on is not allowed", "--frames"]);
    bench.run(&["compare", "--paper", "--thin=sheet"]).fails(&["--thin is not allowed with --paper"]);
    bench
        .run(&["compare", "scene.obj", "--thin=paper", "--rays=8,512", "--no-cache", "--truth-spp=1000000"])
        .fails(&["--spp 512 is not allowed"]);
    bench.run(&["compare", "--methods=gato"]).fails(&["gato", "gtao"]);
    bench.run(&["compare", "-o", "report"]).fails(&["--output report", ".html"]);
    bench.run(&["compare", "-o", "nowhere/report.html"]).fails(&["nowhere"]);
    bench.run(&["compare", "--paper", "--rays=1"]).fails(&["--rays", "--paper"]);
    bench.run(&["compare", "--truth-error=0"]).fails(&["truth-error", "0.00001 to 1"]);
    assert_eq!(bench.files(), <[&str; 0]>::default());
}

#[test]
fn every_method_renders_a_picture_of_its_own() {
    let bench = Bench::new();
    let render = |method: &str| {
        let arguments = [&["render", "scene.obj", "-o", "out.png", "--method", method][..], &QUICK].concat();
        bench.run(&arguments).succeeds();
        bench.read("out.png")
    };
    let mut pictures: Vec<Vec<u8>> = METHODS.iter().map(|method| render(method)).collect();
    pictures.push(render("ambray"));
    let again = [&["render", "scene.obj", "-o", "again.png", "--settings", "out.png"][..], &QUICK].concat();
    bench.run(&again).succeeds();
    assert_eq!(bench.read("again.png"), pictures[METHODS.len()]);
    for (i, picture) in pictures.iter().enumerate() {
        assert!(
            !pictures[..i].contains(picture),
            "{} looks like another",
            METHODS.get(i).unwrap_or(&"ambray")
        );
    }
}

#[test]
fn methods_that_need_a_picture_say_so() {
    let bench = Bench::new();
    bench.write("points.csv", "0,0,0,0,1,0\n");
    bench
        .run(&["query", "scene.obj", "--points=points.csv", "--method=ssao"])
        .fails(&["the method ssao works on whole pictures only"]);
    bench
        .run(&["query", "scene.obj", "--points=points.csv", "--method=traced-step", "--radius=1", "-q"])
        .succeeds();
    bench
        .run(&["render", "scene.obj", "--method=gtao", "--thin=sheet"])
        .fails(&["--thin sheet is not allowed: off where the method works in screen space"]);
}
