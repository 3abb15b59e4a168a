//! `ambray query`: lists of points in, results out.

use super::Bench;

/// On the floor far from the wall, on the floor beside the wall, on the wall.
const CSV: &str = "x,y,z,nx,ny,nz\n-1.5,0,0,0,1,0\n0.9,0,0,0,1,0\n1,2,0,-1,0,0\n";

fn rows(text: &str) -> Vec<Vec<f32>> {
    let parse = |line: &str| line.split(',').map(|v| v.parse().expect("a number")).collect();
    text.lines().skip(1).map(parse).collect()
}

#[test]
fn csv_in_csv_out() {
    let bench = Bench::new();
    bench.write("points.csv", CSV);
    let query = ["query", "scene.obj", "--radius=1", "--spp=1024", "--points"];
    let run = bench.run(&[&query[..], &["points.csv"]].concat()).succeeds();
    let text = run.text();
    assert!(text.starts_with("x,y,z,nx,ny,nz,class,openness,near_r,"), "{text}");
    let rows = rows(&text);
    assert_eq!(rows.len(), 3);
    assert_eq!(rows[1][..7], [0.9, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    assert_eq!(rows[0][7], 1.0, "nothing is near");
    // 0.1 from an endless wall would give 0.690767 (spec §9); this one ends at the radius and beyond.
    assert!((rows[1][7] - 0.690_767).abs() < 0.01, "{}", rows[1][7]);
    assert_eq!(rows[2][16], 1024.0, "ambient rays");
    assert!(run.stderr.contains("3 points"), "{}", run.stderr);

    // From stdin and to a file the same comes out.
    let piped = bench.run_with_input(&[&query[..], &["-", "-o", "out.csv", "-q"]].concat(), CSV).succeeds();
    assert_eq!((piped.text().as_str(), piped.stderr.as_str()), ("", ""));
    assert_eq!(bench.read_text("out.csv"), text);
}

#[test]
fn json_lines_in_and_out() {
    let bench = Bench::new();
    let input = "{\"position\":[-1.5,0,0],\"normal\":[0,2,0],\"class\":3}\n";
    let query = ["query", "scene.obj", "--points=-", "--radius=1", "--json", "-q"];
    let run = bench.run_with_input(&query, input).succeeds();
    let line: serde_json::Value = serde_json::from_str(run.text().trim()).expect("a line of JSON");
    assert_eq!(line["position"], serde_json::json!([-1.5, 0.0, 0.0]));
    assert_eq!(line["class"], 3);
    assert_eq!(line["openness"], 1.0);
    assert_eq!(line["ambient_rays"], 8);
    assert_eq!(line["second_batch"], 1.0);
}

#[test]
fn order_and_count_are_kept_over_chunks() {
    let bench = Bench::new();
    let mut input = String::new();
    for i in 0..70_000 {
        input.push_str(&format!("{},0,0,0,1,0\n", -(i as f32) * 1e-5));
    }
    bench.write("many.csv", &input);
    let run =
        bench.run(&["query", "scene.obj", "--points=many.csv", "--spp=1", "--radius=1", "-q"]).succeeds();
    let text = run.text();
    assert_eq!(text.lines().count(), 70_001);
    assert!(text.lines().last().expect("a line").starts_with("-0.69999,") || text.contains("\n-0.69999"));
    let in_order = rows(&text).windows(2).all(|pair| pair[0][0] > pair[1][0]);
    assert!(in_order);
}

#[test]
fn bad_rows_name_file_and_line() {
    let bench = Bench::new();
    let query = ["query", "scene.obj", "--radius=1", "-o", "out.csv", "--points"];
    let check = |text: &str, parts: &[&str]| {
        bench.write("p.csv", text);
        bench.run(&[&query[..], &["p.csv"]].concat()).fails(parts);
        assert_eq!(bench.files(), ["p.csv"], "something half-written is left");
    };
    check("1,2,3,0,1,0\n1,2,3,0,one,0\n", &["p.csv:2: ny \"one\" is not a number"]);
    check("x,y,z,nx,ny,nz\n1,2,3\n", &["p.csv:2: 3 columns instead of 6"]);
    check("1,2,3,0,0,0\n", &["p.csv:1: normal"]);
    check("{\"position\":[0,0,0]}\n", &["p.csv:1:", "normal"]);
    bench.run(&[&query[..], &["none.csv"]].concat()).fails(&["points none.csv"]);
    bench.run(&[&query[..], &["."]].concat()).fails(&["points .", "folder"]);
    bench.run(&[&query[..], &["p.csv", "--points-format=csv"]].concat()).fails(&["p.csv:1:"]);
}

#[test]
fn no_points_give_no_results() {
    let bench = Bench::new();
    let run = bench.run(&["query", "scene.obj", "--points=-", "-q"]).succeeds();
    assert_eq!(run.text().lines().count(), 1);
}

#[test]
fn a_list_that_is_wrong_from_the_start_leaves_no_output() {
    let bench = Bench::new();
    for line in ["0,0,0,0,0,0", "0,0,0,0,1", "0,nan,0,0,1,0", "0,0,0,0,1,0,16"] {
        bench.write("points.csv", line);
        // `fails` holds stdout to be empty.
        bench.run(&["query", "scene.obj", "--points=points.csv"]).fails(&["ambray: error: points.csv:1: "]);
    }
    let run = bench.run_with_input(&["query", "scene.obj", "--points=-"], "").succeeds();
    assert!(run.text().starts_with("x,y,z,") && run.stderr.starts_with("0 points, 0 rays"), "{run:?}");
}
