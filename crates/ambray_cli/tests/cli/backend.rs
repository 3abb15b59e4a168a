//! Which backend renders, what is said about it, and what happens without Vulkan.

use super::{Bench, Png, Run};

fn json(run: &Run) -> serde_json::Value {
    serde_json::from_slice(&run.stdout).expect("JSON")
}

impl Bench {
    /// Runs the program with the Vulkan drivers of this machine.
    fn run_here(&self, arguments: &[&str]) -> Run {
        Run::of(self.command_here(arguments).output().expect("the program starts"), arguments)
    }

    /// Whether this machine has a Vulkan device that can be used.
    fn has_vulkan(&self) -> bool {
        let devices = json(&self.run_here(&["info", "--devices", "--json"]).succeeds());
        let has_one = devices["devices"].as_array().expect("a list").iter().any(|d| d["usable"] == true);
        if !has_one {
            assert!(
                std::env::var_os("AMBRAY_REQUIRE_VULKAN").is_none(),
                "no usable Vulkan device: {devices}"
            );
            println!("skipped: no usable Vulkan device");
        }
        has_one
    }
}

#[test]
fn help_lists_the_options_of_backends() {
    let bench = Bench::new();
    for command in ["render", "query", "bench"] {
        let help = bench.run(&[command, "--help"]).succeeds().text();
        for option in ["--backend <BACKEND>", "--device <NAME_OR_NUMBER>", "--trace <HOW>", "--validation"] {
            assert!(help.contains(option), "{command} lacks {option}");
        }
        assert!(help.contains("threads of the CPU backend"), "{command}");
    }
    let help = bench.run(&["info", "--help"]).succeeds().text();
    for option in ["--devices", "--acceleration", "--device <", "--trace <", "--grouping <"] {
        assert!(help.contains(option), "info lacks {option}");
    }
}

#[test]
fn both_backends_make_the_same_picture() {
    let bench = Bench::new();
    if !bench.has_vulkan() {
        return;
    }
    let render = |backend: &str, output: &str| {
        let line = ["render", "scene.obj", "--size=64x36", "--radius=1", "--backend", backend, "-o", output];
        bench.run_here(&[&line[..], &["--aov=openness", "--json"]].concat()).succeeds()
    };
    let (cpu, vulkan) = (json(&render("cpu", "cpu.png")), json(&render("vulkan", "vulkan.png")));
    for file in ["png", "openness.png"] {
        let of = |backend: &str| Png::of(&bench.read(&format!("{backend}.{file}"))).bytes;
        let (a, b) = (of("cpu"), of("vulkan"));
        // Rays that graze an edge may hit on one side only.
        let differing = a.iter().zip(&b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
        assert!(differing * 100 <= a.len(), "{file}: {differing} of {} values differ", a.len());
    }
    assert_eq!(cpu["backend"]["kind"], "cpu");
    assert_eq!(cpu["backend"]["isa"], ambray::Isa::detect().name());
    assert_eq!(cpu["times"]["transfer_ms"], 0.0);
    assert_eq!(vulkan["backend"]["kind"], "vulkan");
    assert!(vulkan["backend"]["device"].is_string() && vulkan["backend"]["driver"].is_string());
    assert!(["pipeline", "query"].contains(&vulkan["backend"]["trace"].as_str().expect("a word")));
    assert_eq!(vulkan["threads"], 0);
    assert!(vulkan["times"]["transfer_ms"].as_f64().is_some_and(|time| time > 0.0));
    // Rays that hit nothing trace no more; the rest is the same.
    assert_eq!(cpu["rays"]["ambient"], vulkan["rays"]["ambient"]);
    // The picture does not tell who rendered: its settings are the same.
    assert_eq!(cpu["settings"], vulkan["settings"]);
}

#[test]
fn points_are_evaluated_on_devices_too() {
    let bench = Bench::new();
    if !bench.has_vulkan() {
        return;
    }
    bench.write("p.csv", "x,y,z,nx,ny,nz\n-1.5,0,0,0,1,0\n0.9,0,0,0,1,0\n");
    let query = ["query", "scene.obj", "--points=p.csv", "--radius=1", "--spp=256", "--backend"];
    let openness = |backend: &str| -> Vec<f32> {
        let text = bench.run_here(&[&query[..], &[backend]].concat()).succeeds().text();
        text.lines().skip(1).map(|l| l.split(',').nth(7).expect("8").parse().expect("a number")).collect()
    };
    let (cpu, vulkan) = (openness("cpu"), openness("vulkan"));
    assert_eq!(cpu.len(), 2);
    assert!(cpu.iter().zip(&vulkan).all(|(a, b)| (a - b).abs() < 1e-3), "{cpu:?} {vulkan:?}");
}

#[test]
fn bench_on_a_device_tells_its_passes() {
    let bench = Bench::new();
    if !bench.has_vulkan() {
        return;
    }
    let line = ["bench", "scene.obj", "--size=64x36", "--frames=2", "--warmup=1", "--backend=vulkan"];
    let scene =
        &json(&bench.run_here(&[&line[..], &["--json", "--bandwidth=100"]].concat()).succeeds())["scenes"][0];
    let passes = scene["cost"]["passes"].as_array().expect("a list");
    assert_eq!(passes.len(), 4);
    assert_eq!(passes[3]["pass"], "filter");
    assert_eq!(passes[3]["read_bytes_per_pixel"], 112);
    // 160 B x 2304 pixels at 100 GB/s.
    assert_eq!(passes[3]["floor_ms"], 0.0037);
    assert_eq!(scene["cost"]["bandwidth_source"], "given");
    assert_eq!(scene["stages"]["transfer_ms"], 0.0, "measured frames stay on the device");
    assert!(scene["acceleration"]["structures"].as_u64().is_some_and(|count| count > 0));
    let text = bench.run_here(&[&line[..], &["--cost", "--grouping=per-mesh"]].concat()).succeeds().text();
    for part in ["backend  vulkan: ", " GB/s (measured)", "x floor"] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
}

#[test]
fn the_validation_layer_is_content() {
    let bench = Bench::new();
    if !bench.has_vulkan() {
        return;
    }
    let run = bench.run_here(&["render", "scene.obj", "--size=16x8", "--validation", "-q"]);
    if run.stderr.contains("lacks the layer") {
        println!("skipped: no validation layer");
        run.fails(&["VK_LAYER_KHRONOS_validation"]);
    } else {
        assert_eq!(run.stderr, "");
        run.succeeds();
    }
}

#[test]
fn devices_that_are_not_there_are_told() {
    let bench = Bench::new();
    if bench.has_vulkan() {
        let run = bench.run_here(&["render", "scene.obj", "--device=voodoo"]);
        let run = run.fails(&["no Vulkan device is called 'voodoo'; there are 0 '"]);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    }
    let one_line = |arguments: &[&str]| {
        let run = bench.run(arguments).fails(&["ambray: error: no Vulkan "]);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    };
    one_line(&["render", "scene.obj", "--backend=vulkan"]);
    one_line(&["render", "scene.obj", "--device=0"]);
    one_line(&["render", "scene.obj", "--trace=query", "-q"]);
    one_line(&["query", "scene.obj", "--points=-", "--backend=vulkan"]);
    one_line(&["info", "scene.obj", "--acceleration"]);
    bench.run(&["bench", "scene.obj", "--backend=vulkan"]).fails(&["ambray: error: no Vulkan "]);
    assert_eq!(bench.files(), [""; 0]);
}

#[test]
fn options_of_devices_do_not_go_with_the_processor() {
    let bench = Bench::new();
    let check = |option: &str, told: &str| {
        let run = bench.run(&["render", "scene.obj", "--backend=cpu", option]);
        let expected =
            format!("ambray: error: {told} is not allowed with --backend cpu: it is about Vulkan devices\n");
        assert_eq!(run.fails(&[]).stderr, expected);
    };
    check("--trace=query", "--trace query");
    check("--device=0", "--device 0");
    check("--validation", "--validation");
    bench.run(&["bench", "--backend=cpu", "--grouping=single"]).fails(&["--grouping single"]);
    bench.run(&["render", "--backend=gpu"]).fails(&["--backend gpu is not allowed: auto, vulkan, cpu"]);
    bench.run(&["render", "--trace=rays"]).fails(&["--trace rays is not allowed: auto, pipeline, query"]);
    bench.run(&["info", "scene.obj", "--device=0"]).fails(&["--device 0", "--acceleration"]);
    bench.run(&["info", "scene.obj", "--devices"]).fails(&["--devices is not allowed with SCENE"]);
    bench.run(&["info", "--acceleration"]).fails(&["--acceleration needs a SCENE", "hint"]);
    assert_eq!(bench.files(), [""; 0]);
}

#[test]
fn without_driver_the_processor_renders_and_says_why() {
    let bench = Bench::new();
    let line = ["render", "scene.obj", "--size=16x8", "--radius=1"];
    let run = bench.run(&line).succeeds();
    assert!(
        run.text().contains("\nbackend  cpu, ") && run.text().contains(" kernels (no Vulkan "),
        "{run:?}"
    );
    // Nothing failed: no warning.
    assert_eq!(run.stderr, "");
    let auto = bench.read("ambray.png");
    let report = json(&bench.run(&[&line[..], &["--json"]].concat()).succeeds());
    assert!(report["backend"]["reason"].as_str().is_some_and(|why| why.starts_with("no Vulkan ")));
    let run = bench.run(&[&line[..], &["--backend=cpu", "--json"]].concat()).succeeds();
    assert!(json(&run)["backend"]["reason"].is_null(), "no device was looked for");
    assert_eq!(bench.read("ambray.png"), auto);
}

#[test]
fn that_there_is_no_driver_is_an_answer() {
    let bench = Bench::new();
    let text = bench.run(&["info", "--devices"]).succeeds().text();
    assert!(text.starts_with("no Vulkan ") && text.contains(": install "), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    let answer = json(&bench.run(&["info", "--devices", "--json"]).succeeds());
    assert_eq!(answer["devices"], serde_json::json!([]));
    assert!(answer["auto"].is_null() && answer["reason"].is_string() && answer["advice"].is_string());
}

#[test]
fn devices_are_listed() {
    let bench = Bench::new();
    if !bench.has_vulkan() {
        return;
    }
    let devices = json(&bench.run_here(&["info", "--devices", "--json"]).succeeds());
    let first = &devices["devices"][0];
    assert_eq!(first["number"], 0);
    for key in ["name", "kind", "vendor", "driver", "api"] {
        assert!(first[key].is_string(), "{key}");
    }
    assert!(first["memory_bytes"].is_u64() && first["pipeline"].is_boolean() && first["query"].is_boolean());
    let text = bench.run_here(&["info", "--devices"]).succeeds().text();
    assert!(text.starts_with(&format!("0  {}\n", first["name"].as_str().expect("a name"))), "{text}");
    assert!(text.lines().last().is_some_and(|line| line.starts_with("--backend auto takes ")), "{text}");
}

#[test]
fn acceleration_structures_are_told_in_numbers() {
    let bench = Bench::new();
    if !bench.has_vulkan() {
        return;
    }
    let line = ["info", "scene.obj", "--acceleration"];
    let info = json(&bench.run_here(&[&line[..], &["--json"]].concat()).succeeds());
    let numbers = info["acceleration"].as_object().expect("an object");
    let keys = "structures opaque masked shapes in_world placements triangles boxes dropped built_bytes \
                kept_bytes top_bytes scratch_bytes build_ms overlap_of_instances overlap_of_structures";
    for key in keys.split_whitespace() {
        assert!(numbers.get(key).is_some_and(serde_json::Value::is_number), "{key}");
    }
    assert_eq!(numbers["triangles"], 4);
    assert_eq!(info["backend"]["kind"], "vulkan");
    let apart = bench.run_here(&[&line[..], &["--json", "--grouping=per-mesh"]].concat()).succeeds();
    assert_eq!(json(&apart)["acceleration"]["structures"], info["meshes"].as_array().map_or(0, Vec::len));
    let text = bench.run_here(&line).succeeds().text();
    assert!(text.contains("\nbottom   1 structure: ") && text.contains("\ntop      1 placement, "), "{text}");
}
