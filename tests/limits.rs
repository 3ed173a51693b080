//! What is too large, or does not end, ends early: with a message that names what, where, the limit and the remedy, and with
//! nothing changed. What is large and allowed works.

use crate::common;
use crate::folder::Folder;
use std::time::{Duration, Instant};
use welt::grammar::{self, Limits, RuleSet, RunOptions};
use welt::io::{self, Format, ImportOptions};
use welt::mesh::{FaceId, Mesh, Node, Value, VertexId};
use welt::subdivision::Refinement;

/// The message of a file that must be refused, at once.
fn refused(format: Format, name: &str, content: &[u8]) -> String {
    let start = Instant::now();
    let error = io::import_bytes(name, format, content, &ImportOptions::default()).expect_err(name);
    assert!(start.elapsed() < Duration::from_secs(2), "{error}: {:?}", start.elapsed());
    error.to_string()
}

#[test]
fn a_file_that_promises_10_12_vertices_is_refused_at_once() {
    let header = |encoding: &str, vertices: &str, faces: &str| {
        format!(
            "ply\nformat {encoding} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
             property float z\nelement face {faces}\nproperty list uchar uint vertex_indices\nend_header\n"
        )
    };
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let text = header(encoding, "1000000000000", "0") + "0 0 0\n";
        assert_eq!(
            refused(Format::Ply, "a.ply", text.as_bytes()),
            "a.ply:3:1: 1000000000000 elements 'vertex' are more than the limit of 268435456; raise the limit if the \
             file is meant to be this large"
        );
        // Below the limit, and more than the file holds: nothing is reserved for them.
        let text = header(encoding, "200000000", "0") + "0 0 0\n";
        assert!(refused(Format::Ply, "a.ply", text.as_bytes()).contains(
            "a.ply:3:1: the header promises 200000000 elements 'vertex', but the file ends too early"
        ));
        let text = header(encoding, "0", "1000000000000");
        assert!(
            refused(Format::Ply, "a.ply", text.as_bytes())
                .starts_with("a.ply:7:1: 1000000000000 elements 'face' are more than the limit of 268435456")
        );
    }
}

#[test]
fn a_polygon_of_a_million_sides_is_refused_at_once() {
    const SIDES: u32 = 1_000_000;
    let mut text: String = (0..SIDES).map(|i| format!("v {i} {} 0\n", u64::from(i) * u64::from(i))).collect();
    text.push('f');
    (1..=SIDES).for_each(|i| text += &format!(" {i}"));
    assert!(
        refused(Format::Obj, "a.obj", text.as_bytes()).ends_with(
            "a face with more than 1024 vertices; split the face, or raise the limit for face sizes"
        )
    );
    let mut ply = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n\
        property uchar z\nelement face 1\nproperty list uint uint vertex_indices\nend_header\n\0\0\0\x01\0\0\0\x01\0"
        .to_vec();
    ply.extend(SIDES.to_le_bytes());
    (0..SIDES).for_each(|i| ply.extend((i % 3).to_le_bytes()));
    let message = refused(Format::Ply, "a.ply", &ply);
    assert!(
        message.starts_with("a.ply: face 0: 1000000 vertices are more than the limit of 1024"),
        "{message}"
    );

    // Raised, the limit lets it pass.
    let limits = io::Limits { max_arity: u64::from(SIDES), ..io::Limits::default() };
    let options = ImportOptions { limits, ..ImportOptions::default() };
    let import = io::import_bytes("a.obj", Format::Obj, text.as_bytes(), &options).expect("allowed");
    assert_eq!(import.mesh.arity(FaceId(0)), SIDES as usize);
}

fn marked(mesh: &mut Mesh, name: &str) {
    let h = mesh.find_half_edge(VertexId(1), VertexId(4)).expect("an edge");
    let name = mesh.intern(name);
    mesh.set_attribute(Node::HalfEdge(h), name, Some(Value::Number(0.0)));
}

/// The message of rules that must fail on a sheet with the attribute `n` at an edge; the sheet is as it was.
#[track_caller]
fn stopped(text: &str, limits: Limits) -> String {
    let mut mesh = common::flat_sheet(2);
    marked(&mut mesh, "n");
    let before = mesh.to_polygons();
    let rules = RuleSet::parse("a.rules", text, &|_| None).unwrap_or_else(|error| panic!("{error}"));
    let start = Instant::now();
    let error = grammar::run(&rules, &mut mesh, &RunOptions { limits, ..RunOptions::default() });
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    assert_eq!(mesh.to_polygons(), before, "the mesh was changed");
    error.expect_err("the run ends early").to_string()
}

/// Every application splits an edge of generation n into two of generation n + 1, up to 2^40.
const DOUBLE: &str = "rule Double { e(n<40) }\naction { usereg e dup vertexCW e vertexpos makeEV !h\n  \
    e \"n\" e \"n\" attrget 1 add attrset :h \"n\" e \"n\" attrget attrset }";

#[test]
fn rules_that_double_the_mesh_are_stopped() {
    let limits = Limits { growth: 4, extra: 100, ..Limits::default() };
    // 9 vertices, 12 edges, 4 faces and the boundary.
    let message = stopped(DOUBLE, limits);
    assert!(
        message.starts_with(
            "the rules do not come to an end: more than 204 vertices, edges and faces, which were 26. The last rule \
             was Double at e = "
        ),
        "{message}"
    );
    assert!(message.contains("; end the rules, or raise the limit\n"), "{message}");
    assert!(message.contains("--> a.rules:1:6"), "{message}");
    // By default, too.
    assert!(
        stopped(DOUBLE, Limits::default())
            .contains("more than 1000416 vertices, edges and faces, which were 26")
    );
    // As many elements as are allowed are allowed: 89 splits of two each.
    let text = DOUBLE.replace("<40", "<6");
    assert!(stopped(&text, Limits { extra: 125, growth: 0, ..Limits::default() }).contains("more than 125 "));
    let mut mesh = common::flat_sheet(2);
    marked(&mut mesh, "n");
    let rules = RuleSet::parse("a.rules", &text, &|_| None).expect("rules");
    // 2^6 - 1 splits.
    let limits = Limits { growth: 1, extra: 126, ..Limits::default() };
    let outcome = grammar::run(&rules, &mut mesh, &RunOptions { limits, ..RunOptions::default() });
    assert_eq!(outcome.expect("within the limit").steps, 63);
}

#[test]
fn a_script_that_loops_or_recurses_is_stopped() {
    let spin = "rule Spin { e(n) }\naction { { } loop }";
    let message = stopped(spin, Limits { steps: 100_000, ..Limits::default() });
    assert!(
        message.starts_with("the rules do not come to an end: more than 100000 steps. The last rule was Spin at e = edge 1 -> 4"),
        "{message}"
    );
    let message = stopped(spin, Limits { time: Some(Duration::from_millis(50)), ..Limits::default() });
    assert!(message.contains("more than 0.05 s"), "{message}");
    // Two procedures that call each other.
    let recurse = "rule Deep { e(n) }\naction { usereg { :b } !a { :a } !b :a }";
    for depth in [10, 1000, 5000] {
        let message = stopped(recurse, Limits { depth, ..Limits::default() });
        assert!(message.starts_with("rule Deep failed at e = edge 1 -> 4"), "{message}");
        let limit = format!(
            "more than {depth} procedures and loops inside one another; end the recursion, or raise the limit"
        );
        assert!(message.contains(&limit) && message.contains("--> a.rules:2:"), "{message}");
    }
    // A script that grows an array without end, and one that grows the stack.
    for script in ["[ 1 ] { dup append } loop", "{ 1 } loop"] {
        let message = stopped(&format!("rule Eat {{ e(n) }}\naction {{ {script} }}"), Limits::default());
        assert!(message.starts_with("rule Eat failed at e = edge 1 -> 4"), "{message}");
    }
}

#[test]
fn a_refinement_too_deep_is_refused_before_it_is_begun() {
    let mesh = common::flat_sheet(64);
    for (depth, message) in [
        (11, "level 9 would have 4295098368 elements, more than 2^31 - 1; ask for a lower level"),
        (1_000_000, "level 1000000 is too deep; the deepest is 16"),
    ] {
        let start = Instant::now();
        let error = Refinement::new(&mesh, depth).expect_err("too deep");
        assert!(start.elapsed() < Duration::from_secs(1));
        assert_eq!(error.to_string(), message);
    }
}

#[test]
fn limits_of_files_on_the_command_line() {
    let folder = Folder::new("limits");
    let check = |limit: &str| folder.welt(&["check", "sheet.obj", "--limit", limit]);
    // The sheet has exactly these.
    for (name, count) in [("vertices", 12), ("faces", 7), ("face-vertices", 4), ("vertex-faces", 5)] {
        for enough in [count, u64::MAX] {
            check(&format!("{name}={enough}")).succeeds();
        }
        for few in [0, count - 1] {
            check(&format!("{name}={few}")).fails(1, &["sheet.obj", "raise the limit"]);
        }
    }
    let known = "there are vertices, faces, face-vertices, vertex-faces";
    check("corners=3").fails(2, &["there is no limit corners", known]);
    check("faces").fails(2, &["write NAME=COUNT"]);
    for count in ["-1", "1e3", "", "many", "18446744073709551616"] {
        check(&format!("faces={count}"))
            .fails(2, &[&format!("'{count}' is no whole number from 0 to 2^64 - 1")]);
    }
}

#[test]
fn limits_of_rules_on_the_command_line() {
    let folder = Folder::new("rule_limits");
    let sizes = ["--mark", "ring:1,2", "--set", "width=0.2", "--set", "depth=0.05", "--no-deviation"];
    let groove = |limits: &[&str]| {
        let limits: Vec<&str> = limits.iter().flat_map(|limit| ["--rule-limit", limit]).collect();
        folder.groove(&[&sizes[..], &limits].concat())
    };
    let cases: [(&[&str], &str); 7] = [
        (&["applications=1"], "more than 1 applications"),
        (&["steps=5"], "more than 5 steps"),
        (&["changes=5"], "more than 5 changes"),
        (&["depth=0"], "more than 0 procedures and loops inside one another"),
        (&["growth=1", "extra=2"], "vertices, edges and faces"),
        (&["extra=3", "growth=1"], "vertices, edges and faces"),
        (&["seconds=0"], "more than 0 s"),
    ];
    for (limits, words) in cases {
        groove(limits).fails(1, &[words, "raise the limit"]);
        assert_eq!(folder.files(), ["sheet.obj"], "{limits:?}");
        let (name, _) = limits[0].split_once('=').expect("a limit");
        groove(&[&format!("{name}=18446744073709551615")]).succeeds();
        std::fs::remove_file(folder.0.join("out.obj")).expect("written");
    }
    groove(&["width=3"])
        .fails(2, &["there is no limit width", "applications, steps, changes, depth, growth, extra"]);
    groove(&["steps"]).fails(2, &["write NAME=COUNT"]);
    groove(&["seconds=0.5"]).fails(2, &["'0.5' is no whole number"]);
}
