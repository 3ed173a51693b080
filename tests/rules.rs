//! Rules: loading, matching, running.

use glam::DVec3;
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
