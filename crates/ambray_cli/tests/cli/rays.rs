//! `ambray bench --rays`: files of rays, and the tracer measured on them.

use std::fs;

use super::Bench;

/// Quick files of all kinds of rays.
const WRITE: [&str; 8] = [
    "bench",
    "scene.obj",
    "--rays=rays",
    "--size=40x24",
    "--spp=4",
    "--radius=1",
    "--rounds=0",
    "--backend=cpu",
];
/// Quick measurements.
const MEASURE: [&str; 5] = ["bench", "--rays=rays", "--rounds=1", "--builds=0", "--threads=1"];

fn json(bytes: &[u8]) -> serde_json::Value {
    serde_json::from_slice(bytes).expect("JSON")
}

/// The `i`-th number of 32 bits after the magic word of a file.
fn word(bytes: &[u8], i: usize) -> u32 {
    u32::from_le_bytes(bytes[4 * (i + 1)..][..4].try_into().expect("four bytes"))
}

fn with<'a>(base: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [base, more].concat()
}

#[test]
fn rays_of_a_frame_are_written_and_measured() {
    let bench = Bench::new();
    let measure = WRITE.map(|word| if word == "--rounds=0" { "--rounds=2" } else { word });
    let run = bench.run(&with(&measure, &["--builds=1", "--threads=2", "--json"])).succeeds();
    let report = json(&run.stdout);
    let names = |report: &serde_json::Value| {
        let batches = report["batches"].as_array().expect("a list");
        batches.iter().map(|batch| batch["name"].as_str().expect("a name").to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names(&report), ["ambient", "chords-paper", "chords-sheet", "primary"]);
    assert_eq!(
        (&report["threads"], &report["rounds"], &report["triangles"]),
        (&2.into(), &2.into(), &4.into())
    );
    assert_eq!(report["source"]["settings"]["size"], "40x24");

    // As many as a frame has.
    let frame = |thin: &str| {
        let render = ["render", "scene.obj", "--backend=cpu", "--size=40x24", "--spp=4", "--radius=1"];
        let run = bench.run(&with(&render, &["--json", "-o", "frame.png", thin])).succeeds();
        json(&run.stdout)["rays"].clone()
    };
    let (paper, sheet) = (frame("--thin=paper"), frame("--thin=sheet"));
    let batch = |name: &str| {
        report["batches"].as_array().expect("a list").iter().find(|b| b["name"] == name).expect(name).clone()
    };
    let count = |name: &str| batch(name)["rays"].clone();
    assert_eq!(count("primary"), paper["primary"]);
    assert_eq!(count("ambient"), paper["ambient"]);
    assert_eq!(count("chords-paper"), paper["chord"]);
    assert_eq!(count("chords-sheet"), sheet["chord"]);
    for name in ["primary", "ambient", "chords-paper", "chords-sheet"] {
        assert_eq!(report["source"]["rays"][name], count(name));
        let file = bench.read(&format!("rays/{name}.rays"));
        assert_eq!(&file[..4], b"RAYS");
        assert_eq!(word(&file, 2) == 1, batch(name)["kind"] == "any", "{name}");
        assert_eq!((word(&file, 3), word(&file, 4)), (40, 24));
        assert_eq!(serde_json::json!(word(&file, 1)), count(name));
        for rate in batch(name)["rates"].as_array().expect("a list") {
            let of = |part: &str| rate["mrays_per_s"][part].as_f64().expect("a number");
            assert!(0.0 < of("min") && of("min") <= of("median") && of("median") <= of("max"), "{rate}");
        }
    }
    // Two of four rays make six pairs. Each instruction set has three modes: what is quicker, packets, and ray by ray.
    assert_eq!(word(&bench.read("rays/chords-paper.rays"), 5), 6);
    let rates = batch("ambient")["rates"].clone();
    let portable: Vec<_> =
        rates.as_array().expect("a list").iter().filter(|r| r["isa"] == "portable").collect();
    let modes: Vec<_> = portable.iter().map(|r| (r["mode"].as_str(), r["order"].as_str())).collect();
    assert_eq!(
        modes,
        [
            (Some("measured"), Some("traced")),
            (Some("packets"), Some("traced")),
            (Some("single"), Some("pixel"))
        ]
    );
    let builds = report["builds"].as_array().expect("a list");
    assert!(builds.iter().any(|b| b["quality"] == "best-trace" && b["width"] == 16), "{builds:?}");
    assert!(builds.iter().all(|b| b["bytes_per_triangle"].as_f64().is_some_and(|bytes| bytes > 0.0)));

    // The files alone give the same.
    let again = json(&bench.run(&with(&MEASURE, &["--json", "-o", "again.json"])).succeeds().stdout);
    assert_eq!(json(&bench.read("again.json")), again);
    assert_eq!(names(&again), names(&report));
    assert!(again["source"].is_null());
    for (a, b) in
        again["batches"].as_array().expect("a list").iter().zip(report["batches"].as_array().expect(""))
    {
        assert_eq!((&a["rays"], &a["hits"], &a["kind"]), (&b["rays"], &b["hits"], &b["kind"]));
    }
    assert!(batch("ambient")["hits"].as_u64().is_some_and(|hits| hits > 0));
}

#[test]
fn the_report_for_people_has_a_table_for_each_file() {
    let bench = Bench::new();
    let text = bench.run(&WRITE).succeeds().text();
    assert!(text.contains("written  4 triangles; ambient ") && !text.contains("trees"), "{text}");
    let text =
        bench.run(&with(&MEASURE, &["--isa=portable", "--quality=fast-build,balanced"])).succeeds().text();
    for part in [
        "1 thread, 1 round",
        "ambient: ",
        "fast-build  portable packets traced",
        "balanced    portable single pixel",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    let text = bench.run(&with(&MEASURE, &["--batches=primary", "--builds=2"])).succeeds().text();
    assert!(
        text.contains("bytes/triangle") && text.contains("primary: ") && !text.contains("ambient"),
        "{text}"
    );
    assert!(bench.run(&with(&MEASURE, &["--quiet"])).succeeds().text().is_empty());
}

#[test]
fn hits_are_written_and_compared() {
    let bench = Bench::new();
    bench.run(&WRITE).succeeds();
    bench.run(&with(&MEASURE, &["--write-hits=hits", "--quiet"])).succeeds();
    let hits = bench.read("hits/ambient.hits");
    assert_eq!((&hits[..4], word(&hits, 0)), (&b"HITS"[..], 1));
    let report = json(&bench.run(&with(&MEASURE, &["--check-hits=hits", "--json"])).succeeds().stdout);
    for batch in report["batches"].as_array().expect("a list") {
        let agreement = &batch["agreement"];
        assert_eq!((&agreement["differing_hits"], &agreement["far_hits"]), (&0.into(), &0.into()));
        assert_eq!(agreement["largest_relative_difference"], 0.0);
    }
    // The triangle of the first ray that hits anything: taken away, one ray differs.
    let count = word(&hits, 1) as usize;
    let is_hit = |i: &usize| word(&hits, 2 + count + i) != u32::MAX;
    let first = (0..count).find(is_hit).expect("a hit");
    let mut changed = hits.clone();
    changed[4 * (3 + count + first)..][..4].fill(0xff);
    fs::write(bench.path("hits/ambient.hits"), changed).expect("file");
    let check = with(&MEASURE, &["--check-hits=hits", "--batches=ambient"]);
    let text = bench.run(&check).succeeds().text();
    assert!(text.contains("1 ray hit or missed by one only, 0 hits elsewhere"), "{text}");
    fs::write(bench.path("hits/ambient.hits"), &hits[..40]).expect("file");
    bench.run(&with(&check, &["--json"])).fails(&["hits/ambient.hits: is too short"]);
}

#[test]
fn the_same_surface_in_more_triangles_has_the_same_rays() {
    let bench = Bench::new();
    bench.run(&WRITE).succeeds();
    let rays = bench.read("rays/ambient.rays");
    bench.run(&with(&WRITE, &["--triangles=100"])).succeeds();
    assert_eq!(word(&bench.read("rays/scene.tris"), 2), 100, "64 triangles, 12 of them cut in four");
    assert_eq!(bench.read("rays/ambient.rays"), rays);
    bench.run(&with(&WRITE, &["--triangles=1"])).succeeds();
    assert_eq!(word(&bench.read("rays/scene.tris"), 2), 1);
    // Without a scene the files stay as they are.
    let run = bench.run(&with(&MEASURE, &["--triangles=10", "--batches=ambient", "--json"])).succeeds();
    assert_eq!(json(&run.stdout)["triangles"], 10);
    assert_eq!(word(&bench.read("rays/scene.tris"), 2), 1);
}

#[test]
fn transparent_surfaces_can_be_left_out() {
    let bench = Bench::new();
    // The wall is glass.
    let scene = bench.read_text("scene.obj").replace("g wall", "usemtl glass\ng wall");
    bench.write("scene.obj", &format!("mtllib scene.mtl\nusemtl stone\n{scene}"));
    bench.write("scene.mtl", "newmtl stone\nKd 1 1 1\nnewmtl glass\nKd 1 1 1\nd 0.5\n");
    let text = bench.run(&WRITE).succeeds().text();
    assert!(text.contains("2 masked or blended triangles left out"), "{text}");
    let seen = bench.read("rays/ambient.rays");
    let text = bench.run(&with(&WRITE, &["--opaque"])).succeeds().text();
    assert!(!text.contains("left out"), "{text}");
    assert_ne!(bench.read("rays/ambient.rays"), seen, "rays of the wall's pixels");
    let frames = ["bench", "scene.obj", "--opaque", "--size=8x8", "--frames=1", "--warmup=0", "--json"];
    assert_eq!(json(&bench.run(&frames).succeeds().stdout)["scenes"][0]["scene"]["triangles"], 2);
}

#[test]
fn broken_files_end_in_one_line() {
    let bench = Bench::new();
    bench.run(&WRITE).succeeds();
    let (triangles, rays) = (bench.read("rays/scene.tris"), bench.read("rays/ambient.rays"));
    let broken = |name: &str, bytes: &[u8], expected: &str| {
        let whole = bench.read(name);
        fs::write(bench.path(name), bytes).expect("file");
        let run = bench.run(&with(&MEASURE, &["--batches=ambient", "--json"])).fails(&[name, expected]);
        let errors = run.stderr.lines().filter(|line| !line.starts_with("ambray: warning: "));
        assert_eq!(errors.count(), 1, "{}", run.stderr);
        fs::write(bench.path(name), whole).expect("file");
    };
    broken("rays/scene.tris", &triangles[..30], "is cut off");
    broken("rays/scene.tris", b"RAYS", "does not begin with TRIS");
    broken("rays/ambient.rays", &rays[..rays.len() - 4], "is too short");
    let mut many = rays.clone();
    many[8..12].fill(0xff);
    broken("rays/ambient.rays", &many, "is too short: 34359738360 more numbers should follow");
    let mut outside = rays;
    let last = outside.len() - 4;
    outside[last..].fill(0xff);
    broken("rays/ambient.rays", &outside, "outside the picture");
}

#[test]
fn options_that_do_not_go_together_are_refused() {
    let bench = Bench::new();
    let missing = bench.run(&["bench", "--rays=none"]).fails(&["none", "hint: name a scene"]);
    assert!(
        missing.stderr.contains("No such file") || missing.stderr.contains("cannot find"),
        "{}",
        missing.stderr
    );
    fs::create_dir(bench.path("rays")).expect("folder");
    bench.run(&MEASURE).fails(&["--rays rays: there are no files of rays", "hint: name a scene"]);
    bench.run(&WRITE).succeeds();
    bench.run(&with(&MEASURE, &["--batches=ambient,shadow"])).fails(&["--batches shadow", "chords-paper"]);
    bench.run(&with(&MEASURE, &["--spp=3"])).fails(&["settings are not allowed", "without a scene"]);
    bench.run(&with(&MEASURE, &["--opaque"])).fails(&["--opaque is not allowed", "without a scene"]);
    bench.run(&with(&MEASURE, &["--frames=3"])).fails(&["--frames is not allowed with --rays"]);
    let nothing = ["bench", "--rays=rays", "--rounds=0", "--batches=ambient"];
    bench.run(&nothing).fails(&["--batches is not allowed with --rounds 0"]);
    bench.run(&with(&MEASURE, &["a.obj", "b.obj"])).fails(&["--rays: the scene b.obj is one too many"]);
    bench.run(&with(&MEASURE, &["--check-hits=none"])).fails(&["none/ambient.hits"]);
    bench.run(&["bench", "--triangles=3"]).fails(&["--triangles is not allowed without --rays"]);
    bench.run(&["bench", "--isa=portable,avx2"]).fails(&["--isa", "without --rays"]);
    bench.run(&["bench", "--isa=sse"]).fails(&["--isa", "portable"]);
    bench.run(&["bench", "scene.obj", "--rays=rays", "--backend=vulkan"]).fails(&["--backend vulkan"]);
    bench.run(&["bench", "scene.obj", "--rays=no/such"]).fails(&["no", "does not exist"]);
}

#[test]
fn whole_frames_are_measured_with_the_kernels_asked_for() {
    let bench = Bench::new();
    let measure =
        ["bench", "scene.obj", "--size=8x8", "--frames=1", "--warmup=0", "--isa=portable", "--json"];
    let report = json(&bench.run(&measure).succeeds().stdout);
    assert_eq!(report["scenes"][0]["backend"]["isa"], "portable");
}
