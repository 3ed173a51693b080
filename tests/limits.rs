//! What is too large, or does not end, ends early: with a message that names what, where, the limit and the remedy, and with
//! nothing changed. What is large and allowed works.

use crate::common;
use glam::DVec3;
use std::time::{Duration, Instant};
use welt::feature::{self, FeatureError, Options, Report, Request};
use welt::grammar::{self, Limits, RuleSet, RunOptions};
use welt::io::{self, Format, ImportOptions};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::{FaceId, Mesh, Node, Polygons, Value, VertexId};
use welt::subdivision::{Refinement, limit_normal, limit_points, limit_position, refine};
use welt::surface::{ClosestOptions, LimitSurface, PatchOptions, Patches, Sampling, compare};

/// Faces at the pole of [`pole`].
const VALENCE: u32 = 64;

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

/// A disk round a pole in which 64 triangles meet, with two rings of quads; flat, unless `height` lifts the pole. Vertex 0 is
/// the pole, 1 to 64 the first ring.
fn pole(height: f64) -> Mesh {
    let at = |ring: u32, i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(VALENCE);
        DVec3::new(angle.cos(), angle.sin(), 0.0) * f64::from(ring)
    };
    let mut positions = vec![DVec3::Z * height];
    positions.extend((1..=3).flat_map(|ring| (0..VALENCE).map(move |i| at(ring, i))));
    let mut polygons = Polygons { positions, ..Polygons::default() };
    for i in 0..VALENCE {
        let next = (i + 1) % VALENCE;
        polygons.face_sizes.extend([3, 4, 4]);
        polygons.face_vertices.extend([0, 1 + i, 1 + next]);
        for ring in 0..2 {
            let (inner, outer) = (1 + ring * VALENCE, 1 + (ring + 1) * VALENCE);
            polygons.face_vertices.extend([inner + i, outer + i, outer + next, inner + next]);
        }
    }
    Mesh::from_polygons(&polygons).expect("a disk")
}

fn apply(mesh: &mut Mesh, marks: &[&str], features: &[&str], set: &[&str]) -> Result<Report, FeatureError> {
    let selectors: Vec<Selector> = marks.iter().map(|m| Selector::parse(m).expect("a selector")).collect();
    let selection = Selection::resolve(mesh, &selectors).expect("marks");
    let request = Request::features(features, set).expect("a request");
    feature::apply(mesh, &selection, &request, &Options::default(), &Job::new())
}

#[track_caller]
fn finite(points: impl IntoIterator<Item = DVec3>) {
    assert!(points.into_iter().all(DVec3::is_finite));
}

/// By symmetry the pole of the flat disk is its own limit, and normals point upwards.
#[test]
fn a_pole_of_64_faces_can_be_refined_evaluated_and_queried() {
    let mesh = pole(0.0);
    assert_eq!(mesh.valence(VertexId(0)), VALENCE as usize);
    assert!(limit_position(&mesh, VertexId(0)).length() < 1e-12);
    assert!(limit_normal(&mesh, VertexId(0)).expect("a normal").distance(DVec3::Z) < 1e-12);
    let refined = refine(&mesh, 4).expect("fits");
    assert!(refined.positions[0].length() < 1e-12);
    assert!(refined.positions.iter().all(|p| p.is_finite() && p.z == 0.0 && p.length() <= 3.0 + 1e-12));
    finite(limit_points(&mesh).iter().map(|point| point.position));

    let surface = LimitSurface::new(&mesh);
    for face in mesh.faces() {
        for corner in 0..surface.patch_count(face) {
            for (u, v) in [(0.0, 0.0), (1e-9, 1e-9), (0.5, 0.5), (1.0, 1.0)] {
                let point = surface.evaluate(face, corner, u, v).expect("a point");
                assert!(point.position.is_finite() && point.position.z.abs() < 1e-12);
            }
        }
    }
    let foot = surface.closest(DVec3::new(0.001, 0.002, 5.0), &ClosestOptions::default()).expect("a foot");
    assert!((foot.distance - 5.0).abs() < 1e-9, "{}", foot.distance);
    let hits = surface.line_hits(DVec3::new(1e-4, 2e-4, 1.0), DVec3::NEG_Z);
    assert!(!hits.is_empty() && hits.iter().all(|hit| (hit.s - 1.0).abs() < 1e-9));
    let deviation =
        compare(&mesh, &pole(0.0), Sampling { per_side: 2, threads: 1 }, &Job::new()).expect("not cancelled");
    assert!(deviation.both.max < 1e-9);
    let faces: Vec<FaceId> = mesh.faces().collect();
    let patches = Patches::new(&mesh, &faces, &PatchOptions::default(), &Job::new()).expect("patches");
    assert!(patches.patches.iter().all(|patch| patch.poles.iter().all(|pole| pole.is_finite())));
    // Out and in again.
    let mut text = Vec::new();
    io::obj::write(&mesh.to_polygons(), &mut text).expect("written");
    let again = io::import_bytes("a.obj", Format::Obj, &text, &ImportOptions::default()).expect("read").mesh;
    assert_eq!(again.to_polygons(), mesh.to_polygons());
}

/// Features round the pole, beside it, and through it: done, or refused in words, and then nothing has changed.
#[test]
fn features_meet_a_pole_of_64_faces() {
    let all: Vec<String> = (1..=VALENCE).map(|v| format!("edge:0,{v}")).collect();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    let cases: [(&str, Vec<&str>); 5] = [
        ("all edges round it", vec!["cut:0"]),
        ("each of them", all),
        ("one", vec!["edge:0,1"]),
        ("two opposite ones", vec!["edge:0,1", "edge:0,33"]),
        ("a ring beside it", vec!["ring:1,65"]),
    ];
    let mut done = 0;
    for (name, marks) in cases {
        for feature in ["groove", "ridge", "dent", "loop"] {
            let mut mesh = pole(0.3);
            let before = mesh.to_polygons();
            let start = Instant::now();
            match apply(&mut mesh, &marks, &[feature], &[]) {
                Ok(report) => {
                    mesh.validate_control_mesh().expect(name);
                    finite(mesh.vertices().map(|v| mesh.position(v)));
                    assert!(report.leftovers.is_empty(), "{name}: {report}");
                    done += 1;
                }
                Err(error) => {
                    assert!(error.to_string().contains(' '), "{name}: {error}");
                    assert_eq!(mesh.to_polygons(), before, "{name}");
                }
            }
            assert!(start.elapsed() < Duration::from_secs(5), "{name}, {feature}: {:?}", start.elapsed());
        }
    }
    assert!(done >= 12, "{done} of 20 were applied");
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
