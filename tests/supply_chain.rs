//! What the library is built from: licences that a closed program may link, no crate in two versions but for those
//! known, and no dependency that needs a newer compiler than the one promised. Asks cargo, without a network.

use serde_json::Value;
use spdx::{Expression, LicenseReq, ParseMode};
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Licences that ask for a notice at most.
const LICENCES: &[&str] =
    &["0BSD", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "ISC", "MIT", "Unicode-3.0", "Zlib"];

/// Crates that are built in two versions, and who asks for the older one.
const TWICE: &[(&str, &str)] = &[
    ("equator", "nano-gemm, under faer"),
    ("equator-macro", "nano-gemm, under faer"),
    ("miniz_oxide", "png"),
    ("syn", "equator-macro, at build time"),
    ("winnow", "toml 0.9, which cbindgen needs too"),
];

/// Crates in a library without the program, at most: a new dependency is a decision.
const MOST_OF_LIBRARY: usize = 91;

/// The packages that welt is made of with `features`, itself left out.
fn packages(features: &[&str]) -> Vec<Value> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--offline", "--locked", "--format-version", "1"])
        .args(["--filter-platform", "x86_64-unknown-linux-gnu"])
        .args(features)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let nodes: BTreeMap<&str, &Value> = metadata["resolve"]["nodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|node| (node["id"].as_str().unwrap(), node))
        .collect();
    let root = metadata["resolve"]["root"].as_str().unwrap();
    let mut reached = BTreeSet::from([root]);
    let mut open = vec![root];
    while let Some(id) = open.pop() {
        for dependency in nodes[id]["deps"].as_array().unwrap() {
            let shipped =
                dependency["dep_kinds"].as_array().unwrap().iter().any(|kind| kind["kind"] != "dev");
            let id = dependency["pkg"].as_str().unwrap();
            if shipped && reached.insert(id) {
                open.push(id);
            }
        }
    }
    let all = metadata["packages"].as_array().unwrap();
    all.iter()
        .filter(|package| package["id"] != root && reached.contains(package["id"].as_str().unwrap()))
        .cloned()
        .collect()
}

fn name(package: &Value) -> &str {
    package["name"].as_str().unwrap()
}

#[test]
fn every_licence_asks_for_a_notice_at_most() {
    let all = packages(&[]);
    assert!(all.len() > 50, "{} packages", all.len());
    let allowed = |need: &LicenseReq| need.license.id().is_some_and(|id| LICENCES.contains(&id.name));
    for package in &all {
        let text =
            package["license"].as_str().unwrap_or_else(|| panic!("{} names no licence", name(package)));
        let licence = Expression::parse_mode(text, ParseMode::LAX).unwrap();
        assert!(licence.evaluate(allowed), "{}: {text}", name(package));
    }
}

#[test]
fn no_crate_is_built_in_two_versions_unless_known() {
    let all = packages(&[]);
    let mut versions: BTreeMap<&str, usize> = BTreeMap::new();
    all.iter().for_each(|package| *versions.entry(name(package)).or_default() += 1);
    let twice: Vec<&str> =
        versions.into_iter().filter(|(_, count)| *count > 1).map(|(name, _)| name).collect();
    let known: Vec<&str> = TWICE.iter().map(|(name, _)| *name).collect();
    assert_eq!(twice, known);
}

#[test]
fn the_library_needs_no_more_crates_than_decided() {
    let count = packages(&["--no-default-features"]).len();
    assert!(count <= MOST_OF_LIBRARY, "{count} crates");
}

#[test]
fn no_dependency_needs_a_newer_compiler() {
    let version = |text: &str| -> Vec<u32> { text.split('.').map(|part| part.parse().unwrap()).collect() };
    let promised = version(env!("CARGO_PKG_RUST_VERSION"));
    for package in packages(&[]) {
        // Crates that name none are older than the field.
        let Some(needed) = package["rust_version"].as_str() else { continue };
        assert!(version(needed)[..2] <= promised[..2], "{} needs {needed}", name(&package));
    }
}

#[test]
fn unsafe_code_is_refused_but_in_the_c_abi() {
    let source = |name: &str| {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(name);
        std::fs::read_to_string(path).unwrap()
    };
    let library = source("lib.rs");
    assert!(
        library.contains("\n#![deny(unsafe_code)]\n")
            && source("main.rs").contains("#![forbid(unsafe_code)]")
    );
    let allowed: Vec<&str> = library.split("#[allow(unsafe_code").skip(1).collect();
    assert!(allowed.len() == 1 && allowed[0].lines().nth(1) == Some("pub mod ffi;"), "{allowed:?}");
    // No other file takes it back.
    let mut folders = vec![std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with("src/lib.rs") {
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                assert!(!text.contains("allow(unsafe_code"), "{}", path.display());
            }
        }
    }
}
