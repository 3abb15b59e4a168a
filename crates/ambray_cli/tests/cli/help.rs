//! Help, version, completions, and the promise that what the help names is accepted.

use super::Bench;
use ambray_cli::args::{command, parse_from};

#[test]
fn help_names_commands_examples_and_exit_codes() {
    let bench = Bench::new();
    let help = bench.run(&["--help"]).succeeds().text();
    for part in [
        "render",
        "view",
        "query",
        "bench",
        "diff",
        "info",
        "completions",
        "ambray render scene.glb",
        "130 interrupted",
    ] {
        assert!(help.contains(part), "{part} is missing in\n{help}");
    }
    let short = bench.run(&["-h"]).succeeds().text();
    assert!(short.lines().count() < 25, "{short}");
    assert!(bench.run(&["--version"]).succeeds().text().starts_with("ambray "));
    assert_eq!(bench.files(), [""; 0]);
}

#[test]
fn every_option_is_explained() {
    for sub in command().get_subcommands() {
        for arg in sub.get_arguments().filter(|arg| !arg.is_hide_set()) {
            let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.len() > 8, "{} {} has no help", sub.get_name(), arg.get_id());
        }
    }
}

/// Values to try with an option that takes one.
fn samples(arg: &clap::Arg) -> Vec<String> {
    let possible: Vec<_> =
        arg.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    if !possible.is_empty() {
        return possible;
    }
    let name = arg.get_value_names().and_then(|names| names.first()).map_or("", |name| name.as_str());
    let sample = match name {
        "WIDTHxHEIGHT" => "64x36",
        "R,G,B" | "X,Y,Z" => "0.5,1,0.25",
        "LOW,HIGH" => "0.5,1",
        "PLANES" => "depth,all",
        "A..B" => "0..9",
        "COUNT" => "24",
        "RAYS" => "4096",
        _ => "1",
    };
    vec![sample.to_owned()]
}

#[test]
fn every_option_of_the_help_is_accepted() {
    for sub in command().get_subcommands() {
        for arg in
            sub.get_arguments().filter(|arg| arg.get_long().is_some_and(|l| l != "help" && l != "version"))
        {
            let long = arg.get_long().expect("a long flag");
            let flags: Vec<String> = if arg.get_action().takes_values() {
                samples(arg).iter().map(|value| format!("--{long}={value}")).collect()
            } else {
                vec![format!("--{long}")]
            };
            for flag in flags {
                let mut line = vec!["ambray", sub.get_name(), flag.as_str()];
                if sub.get_name() == "query" && long != "points" {
                    line.push("--points=-");
                }
                if sub.get_name() == "diff" {
                    line.extend(["a.png", "b.png"]);
                }
                assert!(parse_from(&line).is_ok(), "{line:?}: {}", parse_from(&line).unwrap_err());
            }
        }
    }
}

#[test]
fn completions_and_manual_are_printed() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = bench.run(&["completions", shell]).succeeds().text();
        assert!(script.contains("near-radiance"), "{shell}");
    }
    bench.run(&["completions", "csh"]).fails(&[" csh is not allowed", "SHELL", "bash"]);
    assert!(bench.run(&["man"]).succeeds().text().contains("ambray\\-render"));
}

#[test]
fn wrong_usage_names_option_value_and_choices() {
    let bench = Bench::new();
    bench.run(&["render", "--thin", "thick"]).fails(&[" thick is not allowed", "--thin", "sheet"]);
    bench.run(&["render", "--size", "640"]).fails(&[" 640 is not allowed", "--size", "WIDTHxHEIGHT"]);
    bench.run(&["render", "--spp", "many"]).fails(&[
        " many is not allowed",
        "--spp",
        "a whole number, 1 to 65536",
    ]);
    bench.run(&["render", "--aov", "opennes"]).fails(&[" opennes is not allowed", "--aov", "openness"]);
    bench.run(&["render", "--format", "jpg"]).fails(&[" jpg is not allowed", "--format", "png16"]);
    bench.run(&["render", "--threads", "-1"]).fails(&[" -1 is not allowed", "--threads", "0 to 1024"]);
    bench.run(&["render", "--exposure", "bright"]).fails(&[
        " bright is not allowed",
        "--exposure",
        "a number",
    ]);
    bench.run(&["render", "--threads", "9999"]).fails(&[" 9999 is not allowed", "--threads", "0 to 1024"]);
    bench.run(&["bench", "--frames", "0"]).fails(&[" 0 is not allowed", "--frames"]);
    bench.run(&["query"]).fails(&["--points"]);
    bench.run(&["paint"]).fails(&["no command paint", "hint: to render a scene: ambray render paint"]);
    bench.run(&["render", "--json", "--save-settings=-"]).fails(&["--json", "--save-settings -"]);
    bench.run(&["bench", "--json", "-o-"]).fails(&["--json"]);
    assert_eq!(bench.files(), [""; 0]);
}
