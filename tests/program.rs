//! The program as a user meets it: the messages of first mistakes, exit codes, and files that stay whole.

use crate::folder::{Folder, SHEET};
use std::fs;
use std::path::Path;

#[test]
fn marks_that_do_not_fit_the_mesh() {
    let folder = Folder::new("marks");
    folder.groove(&["--mark", "edge:1,4"]).fails(1, &["no edge 1,4", "vertex 1 has edges to 0, 2, 5"]);
    folder.groove(&["--mark", "edge:1,99"]).fails(1, &["vertex 99 does not exist", "0 to 11"]);
    folder.groove(&["--mark", "loop:1,2"]).fails(2, &["no selector 'loop'", "ring:A,B"]);
    folder.groove(&["--mark", "select:absent.json"]).fails(1, &["absent.json"]);
    #[cfg(target_os = "linux")]
    folder.groove(&["--mark", "select:/dev/zero"]).fails(1, &["larger than 64 MiB"]);
    assert_eq!(folder.files(), ["sheet.obj"]);
}

#[test]
fn a_ring_that_ends_at_a_triangle_is_applied_and_says_where() {
    let folder = Folder::new("triangle");
    // From the lower side upwards through the last column: its second face is the triangle, face 5.
    let sizes = ["--set", "width=0.2", "--set", "depth=0.05"];
    let run = folder.groove(&[&["--mark", "ring:2,3", "--mark", "ring:6,7"], &sizes[..]].concat()).succeeds();
    let told = run.out + &run.err;
    assert_eq!(told.matches("ends at edge 6,7: face 5 is a triangle").count(), 1, "{told}");
    assert_eq!(told.matches("ends at edge 3,2: the mesh has a border there").count(), 1, "{told}");
    assert!(folder.read("out.obj").lines().filter(|line| line.starts_with("v ")).count() > 12);
}

#[test]
fn parameters_that_a_feature_cannot_take() {
    let folder = Folder::new("parameters");
    let set = |setting| folder.groove(&["--mark", "ring:1,2", "--set", setting]);
    set("width=3").fails(1, &["edge ", "0.", "width"]);
    set("breadth=0.2").fails(2, &["no parameter 'breadth'", "width, depth"]);
    set("width").fails(2, &["NAME=VALUE"]);
    set("width=wide").fails(2, &["wide"]);
    set("depth=1e200").fails(2, &["1e200", "out of range", "at most 1e50"]);
    set("depth=1e50").fails(1, &["of the result would lie beyond 1e50", "ask for less"]);
    set("width=-1").fails(2, &["not be less than 0"]);
    folder
        .welt(&["apply", "sheet.obj", "-o", "out.obj", "--feature", "grove", "--mark", "ring:1,2"])
        .fails(2, &["no feature 'grove'", "groove, ridge"]);
    assert_eq!(folder.files(), ["sheet.obj"]);
}

#[test]
fn marks_that_no_rule_handles_are_said_or_refused() {
    // Three lines and five meet in the corner of face 0.
    let folder = Folder::new("unresolved");
    let marks = ["--mark", "edge:0,1", "--mark", "edge:1,5#piping", "--no-deviation"];
    let strict = [&marks[..], &["--strict"]].concat();
    folder.groove(&strict).fails(1, &["no rule handles", "edges 0,1 1,5;", "without strict"]);
    assert_eq!(folder.files(), ["sheet.obj"]);
    let run = folder.groove(&[&marks[..], &["--figure", "figure.png"]].concat()).succeeds();
    for mark in ["marked at 0,1#groove; no rule", "marked at 1,5#piping; no rule"] {
        assert!(run.out.contains(mark), "{}", run.out);
    }
    assert_eq!(folder.files(), ["figure.png", "out.obj", "sheet.obj"]);
}

#[test]
fn an_odd_face_gets_a_line_or_an_irregular_face() {
    let folder = Folder::new("parity");
    let groove = |more: &[&str]| {
        folder.groove(&[&["--mark", "edge:1,2", "--no-deviation"], more].concat()).succeeds().out
    };
    let triangles = || {
        let is_triangle = |line: &&str| line.starts_with("f ") && line.split(' ').count() == 4;
        folder.read("out.obj").lines().filter(is_triangle).count()
    };
    // The dead end goes on through the face behind it to the border.
    let report = groove(&[]);
    assert!(report.contains("1 odd faces, 1 lines with 2 vertices and 0 turns"), "{report}");
    assert_eq!(triangles(), 2, "those of the sheet");
    let report = groove(&["--parity", "local"]);
    assert!(report.contains("1 faces stay odd (first: 1): no lines were asked for"), "{report}");
    assert_eq!(triangles(), 3, "and the one that closes the dead end");
    folder.groove(&["--mark", "edge:1,2", "--parity", "none"]).fails(2, &["all-quad"]);
}

#[test]
fn a_typo_in_a_rule_file() {
    let folder = Folder::new("rules");
    fs::write(folder.0.join("typo.rules"), "% a comment\nruel x {\n}\n").unwrap();
    let apply =
        folder.welt(&["apply", "sheet.obj", "-o", "out.obj", "--rules", "typo.rules", "--mark", "ring:1,2"]);
    for run in [folder.welt(&["rules", "check", "typo.rules"]), apply] {
        run.fails(1, &["`ruel`", "typo.rules:2:1\n", "2 | ruel x {\n", "| ^^^^\n"]);
    }
    let run = folder.welt(&["rules", "check", "absent.rules"]);
    run.fails(1, &["cannot read the rule file absent.rules"]);
    assert!(!run.err.contains("-->"), "an unreadable file has no place: {}", run.err);
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("rules/linear.rules");
    folder.welt(&["rules", "check", shipped.to_str().unwrap()]).succeeds();
}

/// Each names rule, file and place, and nothing is written. (Runaway rules: tests/rules.rs.)
#[test]
fn rules_that_fail_while_they_run() {
    let folder = Folder::new("failing");
    let cases = [
        ("rule Tear { e(color) }\naction {\n  e vertexCW killEV\n  e killEF e killEF\n}\n", "Tear"),
        (
            "rule Flat { e(color) }\naction { e \"color\" attrdel e e vertexpos makeEVone pop e killEF }\n",
            "Flat",
        ),
        ("rule Throw { e(color) }\naction {\n  \"no way\" throw\n}\n", "Throw"),
    ];
    for (text, rule) in cases {
        fs::write(folder.0.join("own.rules"), text).unwrap();
        let run = folder.welt(&[
            "apply",
            "sheet.obj",
            "-o",
            "out.obj",
            "--rules",
            "own.rules",
            "--mark",
            "edge:1,5",
        ]);
        run.fails(1, &[&format!("rule {rule} "), "own.rules:", "near (1, ", "|"]);
        assert_eq!(folder.files(), ["own.rules", "sheet.obj"], "{rule}");
    }
}

#[test]
fn files_that_cannot_be_read_or_written() {
    let folder = Folder::new("files");
    folder.welt(&["check", "absent.obj"]).fails(1, &["absent.obj"]);
    folder.welt(&["check", "."]).fails(1, &["."]);
    folder.welt(&["deviation", "sheet.obj", "absent.obj"]).fails(1, &["absent.obj"]);
    let apply = |out| {
        folder.welt(&[
            "apply",
            "sheet.obj",
            "-o",
            out,
            "--feature",
            "groove",
            "--mark",
            "ring:1,2",
            "--set",
            "width=0.2",
        ])
    };
    apply("absent/out.obj").fails(1, &["absent", "does not exist", "create it first"]);
    apply("out.xyz").fails(1, &["out.xyz", ".obj or .ply"]);
    folder.welt(&["limit", "sheet.obj", "-o", "out.xyz"]).fails(1, &["out.xyz", ".obj or .ply"]);
    folder.welt(&["limit", "sheet.obj", "-o", "absent/out.obj"]).fails(1, &["absent", "create it first"]);
    // No mesh without the report and the figure that were asked for.
    for more in [["--report", "absent/r.json"], ["--figure", "absent/f.png"]] {
        let run = folder.groove(&[&["--mark", "ring:1,2", "--set", "width=0.2"], &more[..]].concat());
        run.fails(1, &["absent", "create it first"]);
    }
    folder.groove(&["--mark", "ring:1,2", "--report", "."]).fails(1, &[".: cannot be written"]);
    folder.groove(&["--mark", "ring:1,2", "--figure", "f.jpg"]).fails(1, &["f.jpg", ".png"]);
    assert_eq!(folder.files(), ["sheet.obj"]);
}

#[test]
fn a_failure_leaves_an_output_that_was_there() {
    let folder = Folder::new("kept");
    fs::write(folder.0.join("out.obj"), "precious").unwrap();
    folder.groove(&["--mark", "ring:1,2", "--set", "width=3"]).fails(1, &["width"]);
    folder.groove(&["--mark", "edge:1,99"]).fails(1, &["99"]);
    assert_eq!(folder.read("out.obj"), "precious");
    assert_eq!(folder.files(), ["out.obj", "sheet.obj"]);
}

#[test]
fn bad_usage_ends_with_2() {
    let folder = Folder::new("usage");
    folder.welt(&[]).fails(2, &["Usage"]);
    folder.welt(&["polish"]).fails(2, &["polish"]);
    folder.groove(&[]).fails(2, &["--mark"]);
    folder.welt(&["apply", "sheet.obj", "-o", "out.obj", "--mark", "ring:1,2"]).fails(2, &["--feature"]);
    folder.groove(&["--mark", "ring:1,2", "--optimise", "best"]).fails(2, &["none, loop, solve"]);
    folder.groove(&["--mark", "ring:1,2", "--report", "-"]).fails(2, &["--json"]);
    for twice in [["--report", "sheet.obj"], ["--trace", "./sheet.obj"], ["--report", "out.obj"]] {
        let before = folder.read("sheet.obj");
        folder
            .groove(&[&["--mark", "ring:1,2"], &twice[..]].concat())
            .fails(2, &["named twice", "file of its own"]);
        assert_eq!(folder.read("sheet.obj"), before);
    }
    let before = folder.read("sheet.obj");
    folder.welt(&["patches", "sheet.obj", "-o", "./sheet.obj"]).fails(2, &["named twice"]);
    folder.welt(&["quality", "sheet.obj", "--picture", "sheet.obj"]).fails(1, &[".png"]);
    folder.welt(&["limit", "sheet.obj", "-o", "new.ply", "--zebra", "new.ply"]).fails(1, &[".png"]);
    assert_eq!(folder.read("sheet.obj"), before);
    folder.welt(&["limit", "sheet.obj", "-o", "out.obj", "--level", "11"]).fails(2, &["11", "0..=10"]);
    folder.welt(&["deviation", "sheet.obj", "sheet.obj", "--samples", "0"]).fails(2, &["1..=64"]);
    assert_eq!(
        folder.welt(&["--version"]).succeeds().out.trim(),
        concat!("welt ", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn check_tells_defects_by_its_exit_code() {
    let folder = Folder::new("check");
    folder.welt(&["check", "sheet.obj"]).succeeds();
    // A third face at an edge.
    fs::write(folder.0.join("bad.obj"), format!("{SHEET}v 1 0 1\nf 2 6 13\n")).unwrap();
    let run = folder.welt(&["check", "bad.obj"]);
    assert_eq!(run.code, 1);
    assert!(run.out.contains("1,5") || run.out.contains("1 and 5") || run.out.contains("1-5"), "{}", run.out);
    for (file, defects) in [("sheet.obj", 0), ("bad.obj", 1)] {
        let run = folder.welt(&["check", file, "--json"]);
        let json: serde_json::Value = serde_json::from_str(&run.out).unwrap();
        assert_eq!(json["defects"].as_array().unwrap().len(), defects, "{json}");
        assert_eq!(run.code, i32::from(defects > 0));
    }
}

#[test]
fn a_dash_stands_for_standard_input_and_output() {
    let folder = Folder::new("dash");
    let more = ["--feature", "groove", "--mark", "ring:1,2", "--set", "width=0.2", "--set", "depth=0.05"];
    let apply = |input, output, fed| {
        let mut arguments = vec!["apply", input, "-o", output];
        arguments.extend(more);
        folder.welt_fed(&arguments, fed).succeeds()
    };
    apply("sheet.obj", "out.obj", "");
    let piped = apply("-", "-", SHEET);
    assert_eq!(piped.out, folder.read("out.obj"), "the mesh alone is on standard output");
    assert!(piped.err.contains("groove"), "the report is on standard error: {}", piped.err);
    folder.welt_fed(&["check", "-"], SHEET).succeeds();
    folder.welt_fed(&["check", "-"], "f 1 2 9\n").fails(1, &["standard input", "1"]);
    assert!(folder.welt(&["limit", "sheet.obj", "-o", "-"]).succeeds().out.contains("\nf "));
}

#[test]
fn a_reader_may_stop_early() {
    let folder = Folder::new("unread");
    let commands: [&[&str]; 5] = [
        &["check", "--json", "sheet.obj"],
        &["rules", "list"],
        &["rules", "list", "--json"],
        &["deviation", "sheet.obj", "sheet.obj"],
        &["limit", "sheet.obj", "-o", "-"],
    ];
    for arguments in commands {
        let run = folder.welt_unread(arguments).succeeds();
        assert_eq!(run.err, "", "{arguments:?}");
    }
}

#[test]
fn limit_at_level_0_keeps_vertices_and_faces() {
    let folder = Folder::new("limit");
    folder.welt(&["limit", "sheet.obj", "-o", "out.obj", "--level", "0"]).succeeds();
    let lines = |text: &str, key: &str| -> Vec<String> {
        text.lines().filter(|line| line.starts_with(key)).map(str::to_owned).collect()
    };
    let out = folder.read("out.obj");
    assert_eq!(lines(&out, "f "), lines(SHEET, "f "));
    let points: Vec<Vec<f64>> = lines(&out, "v ")
        .iter()
        .map(|line| line.split_whitespace().skip(1).map(|word| word.parse().unwrap()).collect())
        .collect();
    assert_eq!(points.len(), 12);
    // Border vertices follow the cubic B-spline of the border, (a + 4 b + c) / 6, and 1 lies between 0 and 2.
    assert!((points[1][0] - 1.0).abs() < 1e-12 && points[1][1].abs() < 1e-12, "{:?}", points[1]);
    // An inner vertex with four squares round it stays the centre of its neighbours.
    assert!((points[5][0] - 1.0).abs() < 1e-12 && (points[5][1] - 1.0).abs() < 1e-12, "{:?}", points[5]);
}

#[test]
fn the_boundary_rule_decides_about_corners() {
    let folder = Folder::new("boundary");
    let mut grid = String::new();
    for i in 0..16 {
        grid += &format!("v {} {} 0\n", i % 4, i / 4);
    }
    for i in (1..12).filter(|i| i % 4 != 0) {
        grid += &format!("f {} {} {} {}\n", i, i + 1, i + 5, i + 4);
    }
    fs::write(folder.0.join("grid.obj"), &grid).unwrap();
    fs::write(folder.0.join("cornered.obj"), grid + "t interpolateboundary 1/0/0 1\n").unwrap();
    let corner = |file, more: &[&str]| -> Vec<f64> {
        let run = folder.welt(&[&["limit", file, "-o", "-", "--level", "0"], more].concat()).succeeds();
        let line = run.out.lines().find(|line| line.starts_with("v ")).unwrap().to_owned();
        line.split_whitespace().skip(1).map(|word| word.parse().unwrap()).collect()
    };
    let stays = [0.0, 0.0, 0.0];
    assert_eq!(corner("grid.obj", &["--boundary", "corner"]), stays);
    assert_eq!(corner("cornered.obj", &[]), stays);
    // The cubic B-spline of the border has ((1, 0) + 4 (0, 0) + (0, 1)) / 6 there.
    for rounded in [corner("grid.obj", &[]), corner("cornered.obj", &["--boundary", "edge"])] {
        assert!(
            (rounded[0] - 1.0 / 6.0).abs() < 1e-12 && (rounded[1] - 1.0 / 6.0).abs() < 1e-12,
            "{rounded:?}"
        );
    }
    folder
        .welt(&["limit", "grid.obj", "-o", "out.obj", "--boundary", "round"])
        .fails(2, &["none, edge, corner"]);
}

#[test]
fn two_runs_write_the_same_bytes() {
    let folder = Folder::new("twice");
    let run = |out: &str| {
        folder
            .welt(&[
                "apply",
                "sheet.obj",
                "-o",
                out,
                "--feature",
                "ridge",
                "--mark",
                "ring:1,2",
                "--set",
                "width=0.3",
            ])
            .succeeds()
    };
    run("first.obj");
    run("second.obj");
    assert_eq!(folder.read("first.obj"), folder.read("second.obj"));
}

#[test]
fn quality_and_reflection_lines() {
    let folder = Folder::new("quality");
    let text = folder.welt(&["quality", "sheet.obj", "--worst", "1"]).succeeds().out;
    // The triangles' longest edge is their diagonal.
    assert!(text.contains("extraordinary vertices:") && text.contains("3 edges  1.41"), "{text}");
    let json = folder.welt(&["quality", "sheet.obj", "--json"]).succeeds().out;
    assert!(json.contains("\"median_aspect\": 1.0") && json.contains("\"extraordinary\""), "{json}");
    folder.welt(&["limit", "sheet.obj", "-o", "out.obj", "--zebra", "absent/z.png"]).fails(1, &["absent"]);
    folder.welt(&["limit", "sheet.obj", "-o", "out.obj", "--zebra", "z.png"]).succeeds();
    assert!(fs::read(folder.0.join("z.png")).unwrap().starts_with(b"\x89PNG"));
    folder.welt(&["quality", "sheet.obj", "--picture", "q.png"]).succeeds();
    assert!(fs::read(folder.0.join("q.png")).unwrap().starts_with(b"\x89PNG"));
    folder
        .welt(&["limit", "sheet.obj", "-o", "out.obj", "--curvature", "mean"])
        .fails(2, &["--curvature", ".ply"]);
    folder.welt(&["limit", "sheet.obj", "-o", "out.ply", "--curvature", "mean"]).succeeds();
    assert!(String::from_utf8_lossy(&fs::read(folder.0.join("out.ply")).unwrap()).contains("quality"));
}

#[test]
fn a_mesh_does_not_deviate_from_itself() {
    let folder = Folder::new("deviation");
    let run = folder.welt(&["deviation", "sheet.obj", "sheet.obj", "--json"]).succeeds();
    let json: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    for value in ["max", "rms", "p95"] {
        let value = json["both"][value].as_f64().unwrap();
        assert!(value <= 1e-12, "{json}");
    }
}
