//! Several models in one call of `welt apply`: one that is bad leaves the others alone.

use crate::folder::{Folder, Run, SHEET};
use std::fs;

/// A folder with good and bad models.
fn folder(test: &str) -> Folder {
    let folder = Folder::new(test);
    let write = |name: &str, content: &str| fs::write(folder.0.join(name), content).unwrap();
    write("b.obj", SHEET);
    write("torn.obj", "v 0 0 0\nf 1 2 9\n");
    // Without an edge 1,2.
    write("small.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3\n");
    write("notes.txt", "no mesh");
    folder
}

fn apply(folder: &Folder, inputs: &[&str], more: &[&str]) -> Run {
    let features = ["--feature", "groove", "--mark", "ring:1,2", "--set", "width=0.2", "--set", "depth=0.05"];
    folder.welt(&[&["apply"], inputs, &features, more].concat())
}

#[test]
fn a_batch_goes_on_after_bad_models() {
    let folder = folder("batch");
    let inputs = ["torn.obj", "sheet.obj", "absent.obj", "small.obj", "notes.txt", "b.obj"];
    let run = apply(&folder, &inputs, &["-o", "out"]);
    run.fails(
        1,
        &[
            "welt: torn.obj:2:",
            "welt: absent.obj: ",
            "welt: small.obj: ",
            "notes.txt",
            "welt: 2 of 6 models done; these failed: torn.obj, absent.obj, small.obj, notes.txt\n",
        ],
    );
    assert_eq!(run.out.lines().filter(|line| line.starts_with("out/")).count(), 2, "{}", run.out);
    let mut written: Vec<_> =
        fs::read_dir(folder.0.join("out")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    written.sort();
    assert_eq!(written, ["b.obj", "sheet.obj"], "what failed left nothing behind");
    // The same as one by one.
    apply(&folder, &["sheet.obj"], &["-o", "alone.obj"]).succeeds();
    assert_eq!(folder.read("out/sheet.obj"), folder.read("alone.obj"));
    assert_eq!(folder.read("out/b.obj"), folder.read("alone.obj"));

    let run = apply(&folder, &["sheet.obj", "b.obj"], &["-o", "out"]).succeeds();
    assert!(run.err.contains("welt: 2 of 2 models done"), "{}", run.err);
}

#[test]
fn reports_figures_and_traces_of_a_batch() {
    let folder = folder("batch_beside");
    let beside = ["--report", "reports", "--trace", "traces", "--figure", "out/", "--json", "-o", "out/"];
    let run = apply(&folder, &["torn.obj", "sheet.obj"], &beside);
    assert_eq!(run.code, 1);
    let lines: Vec<serde_json::Value> =
        run.out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert!(lines[0]["input"] == "torn.obj" && lines[0]["error"].as_str().unwrap().contains("torn.obj:2"));
    assert!(lines[1]["output"] == "out/sheet.obj" && lines[1]["report"]["after"]["faces"].as_u64() > Some(7));
    let report: serde_json::Value = serde_json::from_str(&folder.read("reports/sheet.json")).unwrap();
    assert_eq!(report["after"], lines[1]["report"]["after"]);
    assert!(folder.read("traces/sheet.trace").contains("\"rule\""));
    assert!(fs::read(folder.0.join("out/sheet.png")).unwrap().starts_with(b"\x89PNG"));
    // One model and a folder: named after the model, too.
    apply(&folder, &["b.obj"], &["-o", "out"]).succeeds();
    assert_eq!(folder.read("out/b.obj"), folder.read("out/sheet.obj"));
}

/// Before anything is read or written.
#[test]
fn batches_that_would_lose_something_are_refused() {
    let folder = folder("batch_refused");
    fs::create_dir(folder.0.join("other")).unwrap();
    fs::write(folder.0.join("other/b.obj"), SHEET).unwrap();
    let before = folder.files();
    let refused =
        |inputs: &[&str], more: &[&str], words: &[&str]| apply(&folder, inputs, more).fails(2, words);
    refused(&["sheet.obj", "b.obj"], &["-o", "."], &["sheet.obj would take the place of an input"]);
    refused(&["b.obj", "other/b.obj"], &["-o", "out"], &["out/b.obj would be written for two models"]);
    refused(&["b.obj", "b.obj"], &["-o", "out"], &["out/b.obj would be written for two models"]);
    refused(&["sheet.obj", "-"], &["-o", "out"], &["several models are read from files"]);
    refused(&["sheet.obj", "b.obj"], &["-o", "-"], &["written into a folder"]);
    refused(&["sheet.obj", "b.obj"], &["-o", "out", "--replay", "a.trace"], &["--replay", "one model"]);
    apply(&folder, &["sheet.obj", "b.obj"], &["-o", "notes.txt"]).fails(1, &["notes.txt", "folder"]);
    assert_eq!(folder.files(), before);
}
