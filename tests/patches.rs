//! Olsen's patch templates as rules: counts of the paper, valences, and Figure 10 of Thaller, Augsdoerfer, Fellner 2016:
//! general refinement against rules made for the feature.

use glam::DVec3;
use std::path::Path;
use welt::feature::{self, Options, Report, Request};
use welt::grammar::{self, RuleSet, RunOptions};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::{Mesh, Node, Polygons, Value, VertexId};
use welt::optimise::Method;

fn rules() -> RuleSet {
    RuleSet::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("rules/patches.rules")).expect("rules")
}

/// `n` x `n` unit quads in the plane.
fn sheet(n: u32) -> Mesh {
    let mut polygons = Polygons::default();
    for (i, j) in (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j))) {
        polygons.positions.push(DVec3::new(i.into(), j.into(), 0.0));
        if i < n && j < n {
            let a = j * (n + 1) + i;
            polygons.face_sizes.push(4);
            polygons.face_vertices.extend([a, a + 1, a + n + 2, a + n + 1]);
        }
    }
    Mesh::from_polygons(&polygons).expect("a sheet")
}

/// A sphere of 6 x 8 x 8 = 384 quads, as many as the spheres of Olsen's Table 1 begin with.
fn sphere() -> Mesh {
    const N: i32 = 8;
    let mut polygons = Polygons::default();
    let vertex = |p: [i32; 3], polygons: &mut Polygons| {
        let position = DVec3::from_array(p.map(f64::from)).normalize();
        let known = polygons.positions.iter().position(|q| q.distance(position) < 1e-9);
        known.unwrap_or_else(|| {
            polygons.positions.push(position);
            polygons.positions.len() - 1
        }) as u32
    };
    for (axis, sign) in (0..3).flat_map(|axis| [(axis, N), (axis, -N)]) {
        for (i, j) in (0..N).flat_map(|j| (0..N).map(move |i| (i, j))) {
            let mut corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(a, b)| {
                let mut p = [0; 3];
                p[axis] = sign;
                p[(axis + 1) % 3] = 2 * (i + a) - N;
                p[(axis + 2) % 3] = 2 * (j + b) - N;
                vertex(p, &mut polygons)
            });
            if sign < 0 {
                corners.reverse();
            }
            polygons.face_sizes.push(4);
            polygons.face_vertices.extend(corners);
        }
    }
    Mesh::from_polygons(&polygons).expect("a sphere")
}

/// Refines the faces (x, y) of a sheet; gives quads, triangles and the greatest valence inside.
fn refine(n: u32, faces: &[(u32, u32)], parameters: &[(&str, f64)]) -> [usize; 3] {
    let mut mesh = sheet(n);
    let refine = mesh.intern("refine");
    let depth = parameters.iter().find(|(name, _)| *name == "depth").map_or(1.0, |(_, depth)| *depth);
    for (x, y) in faces {
        let f = mesh.faces().nth((y * n + x) as usize).expect("a face");
        mesh.set_attribute(Node::Face(f), refine, Some(Value::Number(depth)));
    }
    let parameters = parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let options = RunOptions { parameters, ..RunOptions::default() };
    grammar::run(&rules(), &mut mesh, &options).expect("the rules run");
    mesh.validate_control_mesh().expect("a control mesh");
    let count = |sides: usize| mesh.faces().filter(|&f| mesh.arity(f) == sides).count();
    assert_eq!(count(3) + count(4), mesh.faces().count(), "no polygon is left");
    let valence = mesh.vertices().map(|v| mesh.valence(v)).max().expect("vertices");
    for f in mesh.faces() {
        assert!(mesh.attribute_names(Node::Face(f)).is_empty(), "nothing stays behind");
    }
    [count(4), count(3), valence]
}

/// "Over all cases ... our templates produce 13 quads and only 4 triangles", "valence of no more than n = 5".
#[test]
fn the_templates_hold_13_quads_and_4_triangles() {
    // The face in the middle of 3 x 3 quads is patched; its neighbours' own patches are those of known cases.
    let middle = |neighbours: &[(u32, u32)]| {
        let [quads, triangles, valence] = refine(3, neighbours, &[]);
        assert!(valence <= 5, "{neighbours:?}: valence {valence}");
        [quads, triangles]
    };
    let [south, east, north, west] = [(1, 0), (2, 1), (1, 2), (0, 1)];
    // Faces of the sheet without the middle: refined ones are 4 quads; a corner face with one refined neighbour is
    // 2 quads and a triangle, with two adjacent ones 3 quads.
    let rest = |refined: usize, one: usize, adjacent: usize| {
        [4 * refined + 2 * one + 3 * adjacent + (8 - refined - one - adjacent), one]
    };
    let cases = [
        (vec![south], rest(1, 2, 0)),
        (vec![south, north], rest(2, 4, 0)),
        (vec![south, east], rest(2, 2, 1)),
        (vec![south, east, west], rest(3, 2, 2)),
        (vec![south, east, north, west], rest(4, 0, 4)),
    ];
    let mut total = [0, 0];
    for (neighbours, rest) in &cases {
        let [quads, triangles] = middle(neighbours);
        total = [total[0] + quads - rest[0], total[1] + triangles - rest[1]];
    }
    assert_eq!(total, [13, 4]);
}

/// Incremental refinement costs faces and keeps valences low (paper: 755 faces against 561, Figure 5).
#[test]
fn incremental_refinement_patches_no_patched_face_again() {
    let stroke: Vec<(u32, u32)> = (4..16).map(|i| (i, i / 2 + 4)).collect();
    let run = |incremental: f64| refine(20, &stroke, &[("depth", 3.0), ("incremental", incremental)]);
    let ([vanilla_quads, vanilla_triangles, vanilla], [quads, triangles, incremental]) = (run(0.0), run(1.0));
    println!("vanilla: {vanilla_quads} quads, {vanilla_triangles} triangles, valence {vanilla}");
    println!("incremental: {quads} quads, {triangles} triangles, valence {incremental}");
    assert!(incremental < vanilla, "{incremental} {vanilla}");
    assert!(quads + triangles > vanilla_quads + vanilla_triangles);
    assert!(triangles < vanilla_triangles);
}

fn apply(request: &Request, method: Method) -> Report {
    let mut mesh = sphere();
    let at = |p: [f64; 3]| {
        let p = DVec3::from_array(p).normalize();
        let distance = |v: &VertexId| mesh.position(*v).distance(p);
        mesh.vertices().min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("vertices").0
    };
    let selector = Selector::parse(&format!("ring:{},{}", at([8.0, 0.0, 0.0]), at([8.0, 0.0, 2.0])))
        .expect("a selector");
    let selection = Selection::resolve(&mesh, &[selector]).expect("an edge");
    assert_eq!(selection.marks.len(), 32);
    let options = Options { method, samples: 4, ..Options::default() };
    feature::apply(&mut mesh, &selection, request, &options, &Job::new()).expect("it runs")
}

/// Figure 10: "Compared to specialized rules, this usually leads to a greater increase in resolution". The table stands
/// in docs/patches.md.
#[test]
fn general_refinement_costs_more_than_rules_for_the_feature() {
    // Lines at a quarter, a half and three quarters of the crossed edges, by both.
    let special = Request::features(&["groove"], &["width=40%", "depth=0"]).expect("a request");
    let general = |depth: &str, incremental: &str| {
        let settings = [format!("depth={depth}"), format!("incremental={incremental}")];
        Request::rules(rules(), &settings).expect("a request")
    };
    let rows = [
        ("rules of linear features", special),
        ("refinement, 2 rounds", general("2", "0")),
        ("refinement, 2 rounds, incremental", general("2", "1")),
    ];
    let mut found = Vec::new();
    for (name, request) in &rows {
        for (fit, method) in [("none", Method::None), ("solve", Method::Solve)] {
            let report = apply(request, method);
            let deviation = report.fitted.as_ref().expect("it was measured").total;
            let added =
                [report.after.vertices - report.before.vertices, report.after.faces - report.before.faces];
            println!(
                "| {name} | {fit} | {} | {} | {} | {:.2e} | {:.2e} |",
                added[0],
                added[1],
                report.non_quads.len(),
                deviation.max,
                deviation.rms
            );
            found.push((added, deviation.max));
        }
    }
    // Three vertices per crossed edge, three quads per crossed face.
    assert_eq!(found[0].0, [96, 96]);
    for general in [&found[2..4], &found[4..6]] {
        assert!(general[0].0[0] >= 8 * found[0].0[0], "{general:?}");
        // Not fitted, and fitted: the rules for the feature disturb the surface less.
        assert!(general[0].1 > found[0].1 && general[1].1 > found[1].1, "{general:?}");
    }
    // docs/patches.md says so.
    assert!(found[1].1 < 1.2e-3 && found[3].1 < 3.2e-3 && found[5].1 < 1.5e-3, "{found:?}");
}
