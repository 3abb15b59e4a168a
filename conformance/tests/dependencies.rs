//! Dependency policy: every crate of the lock file comes from the registry under a licence that `deny.toml` allows.

use std::process::Command;

use serde_json::Value;
use spdx::{Expression, ParseMode};

fn allowed() -> Vec<String> {
    let text = include_str!("../../deny.toml");
    let list =
        text.split("allow = [").nth(1).and_then(|rest| rest.split(']').next()).expect("a list of licences");
    list.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Whether the SPDX `expression` can be satisfied by `allowed` licences alone.
fn satisfied(expression: &str, allowed: &[String]) -> bool {
    // Old manifests separate alternatives by a slash.
    let parsed = Expression::parse_mode(expression, ParseMode::LAX);
    parsed.is_ok_and(|parsed| parsed.evaluate(|licence| allowed.contains(&licence.to_string())))
}

#[test]
fn licences_and_sources() {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let arguments = ["metadata", "--format-version", "1", "--locked", "--manifest-path"];
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml");
    let output = Command::new(cargo).args(arguments).arg(manifest).output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo prints JSON");
    let packages = metadata["packages"].as_array().expect("a list of packages");
    assert!(packages.len() > 50, "{} packages", packages.len());
    let allowed = allowed();
    for package in packages {
        let (name, license) = (&package["name"], package["license"].as_str().unwrap_or_default());
        let source = package["source"].as_str();
        assert!(source.is_none_or(|source| source.starts_with("registry+")), "{name} comes from {source:?}");
        assert!(satisfied(license, &allowed), "{name}: licence {license:?} is not in deny.toml");
    }
}

#[test]
fn expressions() {
    let allowed = ["MIT".to_owned(), "Zlib".to_owned()];
    assert!(satisfied("MIT OR Apache-2.0", &allowed));
    assert!(satisfied("GPL-3.0/MIT", &allowed));
    assert!(satisfied("(MIT OR Apache-2.0) AND Zlib", &allowed));
    assert!(!satisfied("(MIT OR Zlib) AND Apache-2.0", &allowed));
    assert!(!satisfied("", &allowed));
}
