//! Rules: loading, matching, running.

use glam::DVec3;
use proptest::prelude::*;
use std::collections::BTreeMap;
use welt::grammar::{self, Limits, Outcome, RuleSet, RunError, RunOptions};
use welt::mesh::{Domain, Mesh, Node, Polygons, Value, VertexId};

/// The rule of the paper, section 5.2, as printed.
const EXAMPLE: &str = "rule Example { e1(color=\"red\") faceCCW> e2 faceCCW> e3 faceCCW> e4 faceCCW> e1 } action { e1 e3 makeEF pop }";

/// `n` x `n` unit quads; vertex (x, y) is number y (n + 1) + x, face (x, y) is number y n + x, from its lower left corner.
fn grid(n: u32) -> Mesh {
    let side = n + 1;
    let positions =
        (0..side * side).map(|i| DVec3::new(f64::from(i % side), f64::from(i / side), 0.0)).collect();
    let mut polygons = Polygons { positions, ..Polygons::default() };
    for y in 0..n {
        for x in 0..n {
            let corner = y * side + x;
            polygons.face_sizes.push(4);
            polygons.face_vertices.extend([corner, corner + 1, corner + side + 1, corner + side]);
        }
    }
    Mesh::from_polygons(&polygons).expect("a grid is a mesh")
}

fn mark(mesh: &mut Mesh, a: u32, b: u32, name: &str, value: Value) {
    let h = mesh.find_half_edge(VertexId(a), VertexId(b)).expect("the edge exists");
    let name = mesh.intern(name);
    mesh.set_attribute(Node::HalfEdge(h), name, Some(value));
}

fn rules(text: &str) -> RuleSet {
    RuleSet::parse("test.rules", text, &|_| None).unwrap_or_else(|error| panic!("{error}"))
}

fn run(text: &str, mesh: &mut Mesh) -> Result<Outcome, RunError> {
    grammar::run(&rules(text), mesh, &RunOptions::default())
}

#[test]
fn the_papers_example_splits_a_quad() {
    let mut mesh = grid(1);
    mark(&mut mesh, 0, 1, "color", Value::text("red"));
    let outcome = run(EXAMPLE, &mut mesh).expect("the rule runs");
    assert_eq!(outcome.applications, [("Example".to_owned(), 1)]);
    mesh.validate_control_mesh().expect("a control mesh");
    // The edge starts at 0 and e3 at 2: the diagonal is AC.
    assert_eq!(mesh.counts(), [4, 5, 2]);
    assert!(mesh.find_half_edge(VertexId(0), VertexId(3)).is_some());
    assert!(
        mesh.find_half_edge(VertexId(0), VertexId(2)).is_some()
            || mesh.find_half_edge(VertexId(2), VertexId(0)).is_some()
    );
    assert_eq!(outcome.touched.len(), 2);
}

#[test]
fn the_papers_example_on_a_grid() {
    let n = 20;
    let mut mesh = grid(n);
    for y in 0..n {
        for x in 0..n {
            mark(&mut mesh, y * (n + 1) + x, y * (n + 1) + x + 1, "color", Value::text("red"));
        }
    }
    let outcome = run(EXAMPLE, &mut mesh).expect("the rule runs");
    let n = n as usize;
    assert_eq!(outcome.steps, (n * n) as u64);
    assert_eq!(mesh.counts(), [(n + 1) * (n + 1), 2 * n * (n + 1) + n * n, 2 * n * n]);
    mesh.validate_control_mesh().expect("a control mesh");
}

#[test]
fn the_order_of_marks_does_not_matter_and_runs_are_equal() {
    let run_once = |reversed: bool| {
        let mut mesh = grid(6);
        let mut edges: Vec<u32> = (0..36).map(|i| i / 6 * 7 + i % 6).collect();
        if reversed {
            edges.reverse();
        }
        for a in edges {
            mark(&mut mesh, a, a + 1, "color", Value::text("red"));
        }
        run(EXAMPLE, &mut mesh).expect("the rule runs");
        mesh.to_polygons()
    };
    assert_eq!(run_once(false), run_once(false));
    assert_eq!(run_once(false), run_once(true));
}

/// Rule 1 and Rule 2 of the paper for any number of lines.
const STRAIGHT: &str = "
phase split
rule Split { e(cuts) }
action {
  usereg
  e edgemate !m
  e \"cuts\" attrget !ts
  e \"cuts\" attrdel :m \"cuts\" attrdel
  e vertexpos !a :m vertexpos !b
  0 !i
  :ts {
    !t
    e dup vertexCW :a :b :t lerp makeEV !n
    :i 0 eq { :n !first } if
    1 !i
  } forall
  e isboundary not { :first edgemate \"span\" e linkset  :first edgemate \"lines\" :ts length attrset } if
  :m isboundary not { :m \"span\" :first linkset  :m \"lines\" :ts length attrset } if
}
phase connect
rule Straight { a span> b faceCCW> c faceCCW> d span> e faceCCW> f faceCCW> a }
where { a \"lines\" attrget d \"lines\" attrget eq }
action {
  usereg
  a \"lines\" attrget !k
  a \"span\" b linkdel d \"span\" e linkdel
  b d faceCCW makeEF edgemate
  :k 1 sub { dup faceCW exch 2 faceCCW makeEF edgemate } repeat pop
}";

#[test]
fn three_lines_through_a_row_of_quads() {
    let n = 5;
    let mut mesh = grid(n);
    // The vertical edges of the middle row: the edge at (x, 2) upwards.
    for x in 0..=n {
        let (a, b) = (2 * (n + 1) + x, 3 * (n + 1) + x);
        for (a, b) in [(a, b), (b, a)] {
            mark(&mut mesh, a, b, "cuts", Value::Numbers([0.3, 0.5, 0.7].into()));
        }
    }
    let outcome = run(STRAIGHT, &mut mesh).expect("the rules run");
    let n = n as usize;
    assert_eq!(outcome.applications, [("Split".to_owned(), n as u64 + 1), ("Straight".to_owned(), n as u64)]);
    mesh.validate_control_mesh().expect("a control mesh");
    assert!(mesh.faces().all(|f| mesh.arity(f) == 4 || f.0 / 5 != 2), "the row holds quads only");
    let added = 3 * (n + 1);
    assert_eq!(mesh.counts(), [(n + 1) * (n + 1) + added, 2 * n * (n + 1) + added + 3 * n, n * n + 3 * n]);
    // The new vertices stand at heights 2.3, 2.5, 2.7.
    let mut heights: Vec<f64> = mesh.vertices().skip((n + 1) * (n + 1)).map(|v| mesh.position(v).y).collect();
    heights.sort_by(f64::total_cmp);
    assert!(
        heights.chunks(n + 1).zip([2.3, 2.5, 2.7]).all(|(row, y)| row.iter().all(|h| (h - y).abs() < 1e-12))
    );
    let span = mesh.symbol("span").expect("the rules use it");
    assert_eq!(mesh.nodes_with_link(Domain::HalfEdge, span).count(), 0);
}

#[test]
fn half_edges_outside_match_only_when_they_are_asked_for() {
    let set = |pattern: &str| {
        let mut mesh = grid(3);
        let rule = format!("rule R {{ {pattern} }} not {{ e(seen) }} action {{ e \"seen\" 1 attrset }}");
        run(&rule, &mut mesh).expect("the rule runs").steps
    };
    // 24 edges; 12 of their half-edges lie outside.
    assert_eq!(set("e"), 36);
    assert_eq!(set("e(boundary)"), 12);
    assert_eq!(set("e mate> m"), 24);
    assert_eq!(set("e mate> m(boundary)"), 12);
    assert_eq!(set("e(boundary) source> v(boundary)"), 12);
    // Three half-edges of a corner's quad do not start there; 4 corners have valence 2.
    assert_eq!(set("e source> v(boundary)"), 12 + 8);
}

#[test]
fn nodes_of_every_kind_can_be_anchors() {
    let mut mesh = grid(2);
    let (tag, far) = (mesh.intern("tag"), mesh.intern("far"));
    mesh.set_attribute(Node::Vertex(VertexId(4)), tag, Some(Value::Number(2.0)));
    let face = mesh.faces().nth(3).expect("four faces");
    mesh.set_attribute(Node::Face(face), tag, Some(Value::Number(3.0)));
    mesh.set_link(Node::Vertex(VertexId(4)), far, Node::Face(face), true);
    let count = |pattern: &str, mesh: &mut Mesh| {
        let rule = format!("rule R {{ {pattern} }} not {{ e(seen) }} action {{ e \"seen\" 1 attrset }}");
        let checkpoint = mesh.begin();
        let steps = run(&rule, mesh).expect("the rule runs").steps;
        mesh.rollback(checkpoint);
        steps
    };
    assert_eq!(count("e source> v(tag=2)", &mut mesh), 4);
    assert_eq!(count("e source> v(tag>=1, tag<3)", &mut mesh), 4);
    assert_eq!(count("e target> v(tag)", &mut mesh), 4);
    assert_eq!(count("e face> f(tag!=2)", &mut mesh), 4);
    assert_eq!(count("e face> f(tag>3)", &mut mesh), 0);
    assert_eq!(count("e(tag)", &mut mesh), 0);
    // The half-edges of the linked face; one of them starts at the vertex.
    assert_eq!(count("v far> f  x source> v  e face> f  x faceCCW> y", &mut mesh), 4);
    assert_eq!(count("v far> f  e source> v  e face> f", &mut mesh), 1);
}

#[test]
fn a_pattern_of_two_parts_pairs_them() {
    let mut mesh = grid(2);
    mark(&mut mesh, 0, 1, "left", Value::Number(1.0));
    mark(&mut mesh, 8, 7, "right", Value::Number(1.0));
    mark(&mut mesh, 4, 5, "right", Value::Number(1.0));
    let text = "rule Pair { a(left) b(right) } not { a pair> b } action { a \"pair\" b linkset }";
    assert_eq!(run(text, &mut mesh).expect("the rule runs").steps, 2);
}

#[test]
fn a_condition_that_looks_far_away_is_tried_again() {
    let mut mesh = grid(4);
    mark(&mut mesh, 0, 1, "wait", Value::Number(1.0));
    mark(&mut mesh, 18, 19, "go", Value::Number(1.0));
    // Wait comes first in the text; what it waits for is five steps away and set by the second rule.
    let text = "
rule Wait { e(wait) }
where { e { dup \"went\" attrhas { exit } if dup isboundary { exit } if 2 faceCCW edgemate faceCW edgemate faceCCW } loop \"went\" attrhas }
action { e \"wait\" attrdel }
rule Go { e(go) } action { e \"go\" attrdel e \"went\" 1 attrset }";
    let outcome = run(text, &mut mesh).expect("the rules run");
    assert_eq!(outcome.applications[1].1, 1);
}

fn failed(text: &str, mesh: &mut Mesh, limits: Limits) -> RunError {
    let carried = |mesh: &Mesh| {
        let nodes: Vec<Node> = mesh.half_edges().map(Node::HalfEdge).collect();
        let attributes: Vec<_> = nodes
            .iter()
            .flat_map(|&node| mesh.attribute_names(node).into_iter().map(move |name| (node, name)))
            .map(|(node, name)| (node, name, mesh.attribute(node, name).cloned()))
            .collect();
        let links: Vec<_> = mesh
            .symbol("l")
            .map(|label| nodes.iter().map(|&node| mesh.links(node, label).to_vec()).collect())
            .unwrap_or_default();
        (mesh.to_polygons(), attributes, links)
    };
    let l = mesh.intern("l");
    let (a, b) = (mesh.half_edges().next(), mesh.half_edges().nth(5));
    if let (Some(a), Some(b)) = (a, b) {
        mesh.set_link(Node::HalfEdge(a), l, Node::HalfEdge(b), true);
    }
    let before = carried(mesh);
    let options = RunOptions { limits, ..RunOptions::default() };
    let error = grammar::run(&rules(text), mesh, &options).expect_err("the run fails");
    assert_eq!(carried(mesh), before, "the mesh is as it was");
    mesh.validate_control_mesh().expect("a control mesh");
    error
}

#[test]
fn a_failing_action_names_rule_place_and_word() {
    let mut mesh = grid(2);
    mark(&mut mesh, 0, 1, "go", Value::Number(1.0));
    let text = "rule Cut { e(go) faceCCW> f }\naction { e f faceCCW makeEF pop e \"l\" f linkset e \"n\" 1 attrset\n  e \"none\" attrget pop }";
    let error = failed(text, &mut mesh, Limits::default());
    let RunError::Script { rule, place, diagnostic } = &error else { panic!("{error}") };
    assert_eq!(
        (rule.as_str(), diagnostic.line, diagnostic.column, diagnostic.word.as_str()),
        ("Cut", 3, 12, "attrget")
    );
    assert_eq!(place.to_string(), "e = edge 0 -> 1, f = edge 1 -> 4, near (0.5, 0, 0)");
    assert_eq!(
        error.to_string(),
        "rule Cut failed at e = edge 0 -> 1, f = edge 1 -> 4, near (0.5, 0, 0)\n\
         error: edge 0 -> 1 has no attribute `none`\n \
         --> test.rules:3:12\n  \
         |\n\
         3 |   e \"none\" attrget pop }\n  \
         |            ^^^^^^^"
    );
}

#[test]
fn a_throw_that_nothing_catches_ends_the_run() {
    let mut mesh = grid(2);
    mark(&mut mesh, 0, 1, "go", Value::Number(1.0));
    let error = failed(
        "rule T { e(go) } action { e \"go\" attrdel \"too narrow\" throw }",
        &mut mesh,
        Limits::default(),
    );
    assert!(
        error.to_string().contains(
            "rule T failed at e = edge 0 -> 1, near (0.5, 0, 0)\nerror: the script threw \"too narrow\" and nothing caught it"
        ),
        "{error}"
    );
}

#[test]
fn runaway_rules_end_with_their_name_and_place() {
    let limits = Limits { applications: 1000, ..Limits::default() };
    let error =
        failed("rule Grow { e }\naction { e dup vertexCW e vertexpos makeEV pop }", &mut grid(1), limits);
    let text = error.to_string();
    assert!(text.starts_with("the rules do not come to an end: more than 1000 applications. The last rule was Grow at e = edge "), "{text}");
    assert!(text.contains("--> test.rules:1:6"), "{text}");

    let limits = Limits { steps: 100_000, ..Limits::default() };
    let error = failed("rule Spin { e } action { { } loop }", &mut grid(1), limits);
    assert!(
        error
            .to_string()
            .contains("more than 100000 steps. The last rule was Spin at e = edge 0 -> 1, near (0.5, 0, 0)"),
        "{error}"
    );

    // Growth inside of one action, and by attributes.
    let limits = Limits { edits: 50_000, ..Limits::default() };
    for action in ["e dup vertexCW e vertexpos makeEV pop", "e /x 1 attrset"] {
        let text = format!("rule Swell {{ e }} action {{ {{ {action} }} loop }}");
        let error = failed(&text, &mut grid(1), limits).to_string();
        assert!(
            error.contains("more than 50000 changes of the mesh. The last rule was Swell at e = edge 0 -> 1"),
            "{error}"
        );
    }

    let limits = Limits { steps: 100_000, ..Limits::default() };
    // A search that does not end in practice is stopped, too.
    let error = failed(
        "rule Far { a b c d f(x) } action { }\nrule X { e } action { e /x 1 attrset }",
        &mut grid(30),
        limits,
    );
    assert!(matches!(error, RunError::Runaway { .. }), "{error}");

    let limits = Limits { time: Some(std::time::Duration::from_millis(20)), ..Limits::default() };
    let error = failed("rule Spin { e } action { { } loop }", &mut grid(1), limits);
    assert!(error.to_string().contains("more than 0.02 s"), "{error}");
}

#[test]
fn places_are_told_in_the_terms_of_the_file() {
    // The action changes the edge before it fails: the place is told as it was.
    let mut mesh = grid(2);
    mark(&mut mesh, 0, 1, "go", Value::Number(1.0));
    let text =
        "rule Cut { e(go) source> v e face> f } action { e dup vertexCW (0.25,0,0) makeEV pop 1 throw }";
    let error = failed(text, &mut mesh, Limits::default()).to_string();
    assert!(
        error.starts_with("rule Cut failed at e = edge 0 -> 1, v = vertex 0, f = face 0, near (0.5, 0, 0)\n"),
        "{error}"
    );
    // New elements have no number of the file: they are told by their places.
    let text =
        "rule Cut { e(go) } action { e \"go\" attrdel e dup vertexCW (0.25,0,0) makeEV \"far\" 1 attrset }
        rule Stop { e(far, boundary) source> v e face> f(boundary) } action { v \"x\" attrget pop }";
    let error = failed(text, &mut mesh, Limits::default()).to_string();
    let place = "rule Stop failed at e = edge (0.25, 0, 0) -> 0, v = the new vertex at (0.25, 0, 0), f = the boundary along edge ";
    assert!(error.starts_with(place), "{error}");
    // What a rule stumbles over is told the same way.
    for (action, message) in [
        (
            "e e faceCCW edgemate makeEF",
            "makeEF needs two half-edges of the same face; edge 0 -> 1 and edge 4 -> 1 lie in different faces",
        ),
        (
            "e dup vertexCW (0.25,0,0) makeEV source \"x\" attrget",
            "the new vertex at (0.25, 0, 0) has no attribute `x`",
        ),
        (
            "e 2 faceCCW e makeEF face \"x\" attrget",
            "the part of face 0 at (0.333333, 0.666667, 0) has no attribute `x`",
        ),
        ("e edgemate face \"x\" attrget", "the boundary along edge 1 -> 0 has no attribute `x`"),
        ("e killEF 1", "killEF cannot join a face with the outside of the mesh at edge 0 -> 1"),
    ] {
        let text = format!("rule R {{ e(go) }} action {{ {action} pop }}");
        let error = failed(&text, &mut mesh, Limits::default()).to_string();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn a_broken_face_names_the_last_rule_that_changed_it() {
    let mut mesh = grid(2);
    mark(&mut mesh, 0, 1, "go", Value::Number(1.0));
    let text = "rule Two { e(go) } action { e \"go\" attrdel e e faceCCW makeEF pop }";
    let error = failed(text, &mut mesh, Limits::default());
    assert!(
        error.to_string().starts_with("rule Two left a broken face near (0.5, 0, 0): the part of face 0 at (0.5, 0, 0) has only 2 vertices\n"),
        "{error}"
    );
    let text = "rule Antenna { e(go) } action { e \"go\" attrdel e (0.5,0.5,0) makeEVone pop }";
    let error = failed(text, &mut mesh, Limits::default());
    assert!(
        error.to_string().starts_with(
            "rule Antenna left a broken face near (0.416667, 0.416667, 0): face 0 meets vertex 0 twice\n"
        ),
        "{error}"
    );
}

#[test]
fn a_cancelled_run_leaves_the_mesh() {
    let job = welt::job::Job::new();
    job.cancel();
    let mut mesh = grid(2);
    let options = RunOptions { job: Some(&job), ..RunOptions::default() };
    let rule = rules("rule R { e } not { e(x) } action { e /x 1 attrset }");
    assert!(matches!(grammar::run(&rule, &mut mesh, &options), Err(RunError::Cancelled(_))));
    assert!(mesh.half_edges().all(|h| mesh.attribute_names(Node::HalfEdge(h)).is_empty()));
}

const WITH_PARAMETERS: &str = "
parameter height 2 range 0.5 10 unit length \"How far up\"
parameter open 3 range -inf inf unit count \"Any number\"
rule Up { e(go) } action { usereg e /go attrdel e vertexpos !p e :p getX :p getY height vector3 moveV }";

#[test]
fn parameters_have_defaults_ranges_and_names() {
    let set = rules(WITH_PARAMETERS);
    assert_eq!(set.parameters().len(), 2);
    let height = &set.parameters()[0];
    assert_eq!((height.name.as_str(), height.default, height.low, height.high), ("height", 2.0, 0.5, 10.0));
    assert_eq!((height.unit.as_str(), height.help.as_str()), ("length", "How far up"));
    assert_eq!(set.parameters()[1].low, f64::NEG_INFINITY);
    let run_with = |name: &str, value: f64| {
        let mut mesh = grid(2);
        mark(&mut mesh, 4, 5, "go", Value::Number(1.0));
        let parameters = BTreeMap::from([(name.to_owned(), value)]);
        let outcome = grammar::run(&set, &mut mesh, &RunOptions { parameters, ..RunOptions::default() })?;
        Ok::<_, RunError>((mesh.position(VertexId(4)).z, outcome.touched.len()))
    };
    // All four faces around the moved vertex were touched.
    assert_eq!(run_with("open", 0.0).expect("the default"), (2.0, 4));
    assert_eq!(run_with("height", 7.0).expect("in range"), (7.0, 4));
    let error = |name, value| run_with(name, value).expect_err("refused").to_string();
    assert_eq!(error("hight", 1.0), "the rules have no parameter `hight`; they have height, open");
    assert_eq!(error("height", 11.0), "parameter `height` is 11; it must lie in [0.5, 10]");
    assert_eq!(error("height", f64::NAN), "parameter `height` is NaN; it must lie in [0.5, 10]");
}

/// Definitions are words for the scripts below them, with registers of their own; parameters are known in them, nodes not.
#[test]
fn definitions() {
    let parse = |text: &str| RuleSet::parse("d.rules", text, &|_| None);
    let text = "parameter p 3 range 0 9 unit count \"h\"
        define twice { usereg !x :x :x add }
        define more { twice twice p add }
        rule A { e(go) } where { 1 more 7 eq } action { usereg 5 !x  e \"go\" attrdel  e \"n\" 1 more :x add attrset }";
    let mut mesh = grid(1);
    mark(&mut mesh, 0, 1, "go", Value::Number(1.0));
    run(text, &mut mesh).expect("runs");
    let e = mesh.find_half_edge(VertexId(0), VertexId(1)).expect("the edge exists");
    assert_eq!(mesh.attribute_named(Node::HalfEdge(e), "n"), Some(&Value::Number(12.0)));

    let message = |text: &str| {
        let error = parse(text).expect_err("a mistake");
        let first = &error.diagnostics[0];
        format!("{} {}", first.line, first.message)
    };
    assert_eq!(message("define a { b }\ndefine b { 1 }"), "1 unknown word `b`");
    assert_eq!(message("define a { a }"), "1 unknown word `a`");
    assert_eq!(message("define a { 1 }\ndefine a { 2 }"), "2 `a` is defined twice");
    assert!(message("define add { 1 }").starts_with("1 `add` is a word of the language"));
    assert_eq!(
        message("define a { 1 }\nrule R { a } action { }"),
        "2 `a` is defined above; a node needs another name"
    );
    assert_eq!(
        message("define a { :x }\nrule R { e } action { usereg 1 !x a pop }"),
        "1 register `x` needs `usereg` at the beginning of the script"
    );
    // What a definition does to the stack is checked where it is used.
    assert_eq!(
        message("define a { pop pop }\nrule R { e } action { 1 a }"),
        "2 `pop` needs more values than there are on the stack"
    );
    // A definition that a condition uses may not change the mesh.
    assert!(
        message("define a { e \"n\" attrdel }\nrule R { e } where { 1 } action { }")
            .contains("unknown word `e`")
    );
    assert!(
        message("define a { \"n\" attrdel }\nrule R { e } where { e a 1 } action { }")
            .contains("changes the mesh; a condition may only look at it")
    );
    // Definitions that use one another twice do not grow.
    let doubled: String = (1..60).map(|i| format!("define d{i} {{ d{} d{} }}\n", i - 1, i - 1)).collect();
    parse(&format!("define d0 {{ }}\n{doubled} rule R {{ e(go) }} action {{ d59 }}")).expect("read at once");
}

#[test]
fn includes_are_read_once_and_relative_to_their_file() {
    let files = BTreeMap::from([
        ("lib/a.rules", "include \"b.rules\" include \"../top.rules\" rule A { e } action { }"),
        ("lib/b.rules", "rule B { e } action { }"),
        ("top.rules", "rule Top { e } action { }"),
        ("lib/circle.rules", "include \"./circle.rules\""),
        ("lib/wrong.rules", "\nrule W { e } action { dupp }"),
    ]);
    let loader = |path: &str| files.get(path).map(|text| (*text).to_owned());
    let set = RuleSet::parse(
        "main.rules",
        "include \"lib/b.rules\" include \"lib/a.rules\" rule M { e } action { }",
        &loader,
    );
    let names: Vec<String> =
        set.expect("all is there").rules().iter().map(|rule| rule.name.clone()).collect();
    assert_eq!(names, ["B", "Top", "A", "M"]);
    let message = |text: &str| {
        let error = RuleSet::parse("main.rules", text, &loader).expect_err("a mistake");
        error
            .diagnostics
            .iter()
            .map(|d| format!("{}:{}:{} {}", d.file, d.line, d.column, d.message))
            .collect::<Vec<_>>()
            .join("; ")
    };
    assert_eq!(message("include \"no.rules\""), "main.rules:1:9 there is no file no.rules");
    assert_eq!(
        message("include \"lib/circle.rules\""),
        "lib/circle.rules:1:9 lib/circle.rules includes itself, by way of main.rules, lib/circle.rules"
    );
    assert_eq!(
        message("include \"lib/wrong.rules\""),
        "lib/wrong.rules:2:23 unknown word `dupp`; did you mean `dup`?"
    );
    let missing =
        RuleSet::load(std::path::Path::new("there/is/none.rules")).expect_err("no file").to_string();
    assert!(missing.starts_with("cannot read the rule file there/is/none.rules: "), "{missing}");
}

#[track_caller]
fn refused(text: &str, expected: &[&str]) {
    let error = RuleSet::parse("t", text, &|_| None).expect_err(text);
    let found: Vec<String> = error
        .diagnostics
        .iter()
        .map(|d| format!("{}:{} {} [{}]", d.line, d.column, d.message, d.word))
        .collect();
    assert_eq!(found, expected, "{text}");
}

#[test]
fn mistakes_at_load() {
    refused("rule A { e } action { x }", &["1:23 unknown word `x` [x]"]);
    refused(
        "rule A { e }\naction { e faceCWW pop }",
        &["2:12 unknown word `faceCWW`; did you mean `faceCCW`? [faceCWW]"],
    );
    refused(
        "rule A { e } action { 1 }",
        &["1:25 the action leaves 1 value on the stack; it must leave none [}]"],
    );
    refused(
        "rule A { e } action { e e makeEF }",
        &["1:34 the action leaves 1 value on the stack; it must leave none [}]"],
    );
    refused(
        "rule A { e } action { e makeEF pop }",
        &["1:25 `makeEF` needs more values than there are on the stack [makeEF]"],
    );
    refused(
        "rule A { e } action { e 1 makeEF pop }",
        &["1:27 `makeEF` needs a half-edge, not a number [makeEF]"],
    );
    refused(
        "rule A { e source> v } action { v edgemate pop }",
        &["1:35 `edgemate` needs a half-edge, not a vertex [edgemate]"],
    );
    refused(
        "rule A { e } action { e vertexpos 1 add pop }",
        &["1:37 `add` cannot take a vector and a number [add]"],
    );
    refused(
        "rule A { e } action { 1 { pop pop } repeat }",
        &["1:27 `pop` needs more values than there are on the stack [pop]"],
    );
    refused(
        "rule A { e } where { } action { }",
        &["1:22 the condition leaves 0 values on the stack; it must leave one number [}]"],
    );
    refused(
        "rule A { e } where { e } action { }",
        &["1:24 the condition leaves a half-edge; it must leave one number [}]"],
    );
    refused(
        "rule A { e } where { e /x 1 attrset 1 } action { }",
        &["1:29 `attrset` changes the mesh; a condition may only look at it [attrset]"],
    );
    refused(
        "rule A { e } action { usereg :x pop }",
        &["1:30 register `x` is used before anything is stored in it [:x]"],
    );
    refused("rule A { e } action { } rule A { e } action { }", &["1:30 rule `A` is there twice [A]"]);
    refused(
        "rule A { a source> b faceCCW> c } action { }",
        &["1:22 `b` is a half-edge here, but a vertex elsewhere in the rule [faceCCW>]"],
    );
    refused(
        "rule A { a } not { x(y) } action { }",
        &["1:14 a part of this `not` is not joined to the rule's pattern [not]"],
    );
    refused(
        "rule A { a source> v } not { v faceCCW> x } action { }",
        &["1:32 `v` is a half-edge here, but a vertex elsewhere in the rule [faceCCW>]"],
    );
    refused(
        "rule A { dup } action { }",
        &["1:10 `dup` is a word of the language; choose another name [dup]"],
    );
    refused(
        "parameter w 1 range 0 2 unit u \"h\" rule A { w } action { }",
        &["1:45 `w` is a parameter; a node needs a name of its own [w]"],
    );
    refused("rule A { a faceCCW> } action { }", &["1:12 a label must stand between two nodes [faceCCW>]"]);
    refused("rule A { faceCCW> a } action { }", &["1:10 a label must stand between two nodes [faceCCW>]"]);
    refused("rule A { } action { }", &["1:8 the pattern is empty [{]"]);
    refused("rule A { a(x=red) } action { }", &["1:14 expected a number or a text in quotes [r]"]);
    refused(
        "rule A { a(x<\"red\") } action { }",
        &["1:12 a text can be compared with `=` and `!=` only [x<\"red\"]"],
    );
    refused("rule A { a(x=1.2.3) } action { }", &["1:14 `1.2.3` is not a number [1.2.3]"]);
    refused("rule A { a(x y) } action { }", &["1:14 expected `,` or `)` after a test [y]"]);
    refused(
        "rule A { a",
        &[
            "1:8 this pattern is not closed: a `}` is missing [{]",
            "1:11 expected `not`, `where` or `action` of rule `A` here []",
        ],
    );
    refused("rule A { a } action { 1 pop", &["1:21 this script is not closed: a `}` is missing [{]"]);
    refused(
        "rule A { a } rule B { b } action { }",
        &["1:14 expected `not`, `where` or `action` of rule `A` here [rule]"],
    );
    refused("rule A { a } action { } phase p phase p", &["1:39 phase `p` was begun before [p]"]);
    refused(
        "rul A { a }",
        &[
            "1:1 `rul` has no meaning here; expected `define` or `example` or `include` or `input` or `parameter` or `phase` or `rule` or `straight` [rul]",
        ],
    );
    refused(
        "parameter p 1 range 0 2 unit u \"h\" parameter p 1 range 0 2 unit u \"h\"",
        &["1:46 parameter `p` is declared twice [p]"],
    );
    refused("parameter p 5 range 0 2 unit u \"h\"", &["1:13 the default must lie in the range 0 to 2 [5]"]);
    refused(
        "parameter p 5 range 9 2 unit u \"h\"",
        &["1:21 the range is empty: its low end must not be above its high end [9]"],
    );
    refused("parameter p five range 9 2 unit u \"h\"", &["1:13 expected a number [five]"]);
    refused("parameter p 5 range 0 9 unit u", &["1:31 expected one line of help in quotes []"]);
    refused(
        "parameter add 5 range 0 9 unit u \"h\"",
        &["1:11 `add` is a word of the language; choose another name [add]"],
    );
    // Many mistakes are reported together.
    refused(
        "rule A { a(x=) } action { foo }\nrule B { b } action { bar 1 }\nparameter p\nrule C { c } action { baz }",
        &[
            "1:14 expected a number or a text in quotes [)]",
            "1:27 unknown word `foo`; did you mean `for`? [foo]",
            "2:23 unknown word `bar` [bar]",
            "4:1 expected a number [rule]",
            "4:23 unknown word `baz` [baz]",
        ],
    );
}

#[test]
fn what_depends_on_values_is_checked_when_the_rule_runs() {
    let mut mesh = grid(1);
    let text = "rule A { e } action { 1 { 1 2 3 } if }";
    assert!(
        failed(text, &mut mesh, Limits::default())
            .to_string()
            .contains("the action must leave the stack empty, but leaves 1 2 3")
    );
    let text = "rule A { e } where { 1 { 1 2 3 } if } action { }";
    assert!(
        failed(text, &mut mesh, Limits::default())
            .to_string()
            .contains("a condition must leave one number, and nothing else")
    );
}

/// The words in the first columns of the tables of the section "Scripts" are those that the machine knows.
#[test]
fn the_reference_lists_every_word_and_no_other() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/rules.md");
    let text = std::fs::read_to_string(path).expect("the reference is there");
    let (_, scripts) = text.split_once("\n## Scripts\n").expect("a section");
    let (scripts, _) = scripts.split_once("\n## ").expect("a further section");
    let cells = scripts.lines().filter_map(|line| line.strip_prefix("| `")?.split(" |").next());
    let listed: Vec<&str> =
        cells.flat_map(|cell| cell.split('`').step_by(2)).filter(|word| !word.is_empty()).collect();
    let unique: std::collections::BTreeSet<&str> = listed.iter().copied().collect();
    assert_eq!(unique.len(), listed.len(), "a word is there twice");
    let known: std::collections::BTreeSet<&str> =
        welt::gml::words().filter(|word| !"[]".contains(word)).collect();
    assert_eq!(unique, known);
}

const TOKENS: &[&str] = &[
    "rule A",
    "rule B",
    "{ e }",
    "{ a faceCCW> b }",
    "{ a(x) mate> b source> v }",
    "{",
    "}",
    "(",
    ")",
    "not",
    "where",
    "action",
    "{ }",
    "{ 1 }",
    "{ e /x 1 attrset }",
    "{ e e 2 faceCCW makeEF pop }",
    "{ a b makeEF pop }",
    "phase p",
    "{ b(boundary) }",
    "{ a l> b }",
    "{ a \"l\" b linkset }",
    "{ e dup vertexCW (0,0,1) makeEV pop }",
    "a",
    "b>",
    "e",
    "parameter p 1 range 0 2 unit u \"h\"",
    "include \"t\"",
    "define",
    "\"",
    "%",
    "\n",
    "5",
    "=",
    "<",
    "{ e(x<5) }",
    "{ e killEV }",
    "{ e killEF }",
    "{ a source> v b target> v }",
];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    /// Whatever a rule file holds: reading and running end, nothing panics, and a failed run changes nothing.
    #[test]
    fn token_soup(tokens in prop::collection::vec(prop::sample::select(TOKENS), 0..16)) {
        soup(&tokens.join(" "));
    }

    /// Files that are rules more often than not.
    #[test]
    fn rule_soup(parts in prop::collection::vec((0..7usize, 0..8usize, any::<bool>()), 1..4)) {
        let patterns = ["{ e }", "{ e faceCCW> b }", "{ e(x) mate> b source> v }", "{ e(x<5) }", "{ e l> b }",
            "{ e source> v b target> v }", "{ e(boundary) faceCCW> b }"];
        let actions = ["{ }", "{ e /x 1 attrset }", "{ e /x attrdel }", "{ e e 2 faceCCW makeEF pop }",
            "{ e killEF }", "{ e killEV }", "{ e /l e edgemate linkset }", "{ e dup vertexCW (0,0,1) makeEV pop }"];
        let rules: Vec<String> = parts
            .iter()
            .enumerate()
            .map(|(i, (pattern, action, not))| {
                let not = if *not { "not { e(x) }" } else { "" };
                format!("rule R{i} {} {not} action {}", patterns[*pattern], actions[*action])
            })
            .collect();
        soup(&rules.join("\n"));
    }

    #[test]
    fn byte_soup(text in "\\PC{0,60}|[ -~\n]{0,60}") {
        soup(&text);
    }
}

fn soup(text: &str) {
    let Ok(set) = RuleSet::parse("soup", text, &|_| None) else { return };
    let mut mesh = grid(2);
    mark(&mut mesh, 0, 1, "x", Value::Number(1.0));
    let before = mesh.to_polygons();
    let limits = Limits { applications: 50, steps: 20_000, edits: 20_000, time: None, ..Limits::default() };
    let result = grammar::run(&set, &mut mesh, &RunOptions { limits, ..RunOptions::default() });
    mesh.validate().expect("a mesh");
    match result {
        Ok(outcome) => {
            mesh.validate_control_mesh().expect("a control mesh");
            let again = grammar::run(&set, &mut mesh, &RunOptions { limits, ..RunOptions::default() });
            assert_eq!(
                again.map(|outcome| outcome.steps),
                Ok(0),
                "after {} steps no rule matches: {text}",
                outcome.steps
            );
        }
        Err(_) => assert_eq!(mesh.to_polygons(), before, "{text}"),
    }
}

#[test]
fn large_hostile_files_are_refused_in_reasonable_time() {
    let size = 300_000;
    let texts = [
        format!("rule A {{ e }} action {{ {} }}", "x ".repeat(size)),
        format!("rule A {{ {} }} action {{ }}", "} ".repeat(size)),
        format!("rule A {{ e({}) }} action {{ }}", "=, ".repeat(size)),
        format!("rule A {{ {} }} action {{ }}", (0..size).map(|i| format!("n{i}> ")).collect::<String>()),
        format!("rule A {{ {} }} action {{ }}", (0..size).map(|i| format!("n{i} ")).collect::<String>()),
        "\"".repeat(size),
        "rule ".repeat(size),
        "{".repeat(size),
        (0..size).map(|i| format!("rule R{i} {{ e }} action {{ }} ")).collect(),
        (0..size).map(|i| format!("parameter p{i} 1 range 0 2 unit u \"h\" ")).collect(),
        (0..size / 10).map(|i| format!("rule R{} {{ e(a{i}) l{i}> f }} action {{ }} ", i % 5)).collect(),
    ];
    for text in texts {
        let clock = std::time::Instant::now();
        let error = RuleSet::parse("hostile", &text, &|_| None).expect_err("refused");
        assert!(error.diagnostics.len() <= 110, "{} mistakes", error.diagnostics.len());
        assert!(clock.elapsed().as_secs_f64() < 10.0, "{} ...: {:?}", &text[..40], clock.elapsed());
    }
}
