//! Applications of the paper's Example rule per second on a grid of 1000 x 1000 quads, one mark per quad.

use glam::DVec3;
use std::time::Instant;
use welt::grammar::{self, RuleSet, RunOptions};
use welt::mesh::{Domain, HalfEdgeId, Mesh, Node, Polygons, Value};

const RULE: &str = "rule Example { e1(color=\"red\") faceCCW> e2 faceCCW> e3 faceCCW> e4 faceCCW> e1 } action { e1 e3 makeEF pop }";

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

fn main() {
    let rules = RuleSet::parse("example.rules", RULE, &|_| None).expect("the rule of the paper");
    for (n, marks) in [(32, 10), (1000, 10), (1000, 1_000_000)] {
        let mut mesh = grid(n);
        let color = mesh.intern("color");
        let faces: Vec<_> = mesh.faces().collect();
        let marked: Vec<HalfEdgeId> = faces
            .iter()
            .step_by((faces.len() / marks).max(1))
            .take(marks)
            .map(|&f| mesh.face_half_edge(f))
            .collect();
        let red = Value::text("red");
        for h in marked {
            mesh.set_attribute(Node::HalfEdge(h), color, Some(red.clone()));
        }
        assert_eq!(mesh.nodes_with_value(Domain::HalfEdge, color, &red).count(), marks);
        let clock = Instant::now();
        let outcome = grammar::run(&rules, &mut mesh, &RunOptions::default()).expect("the rule runs");
        let seconds = clock.elapsed().as_secs_f64();
        println!(
            "{n} x {n} quads, {marks} marks: {} applications in {:.6} s, {:.2} million per second",
            outcome.steps,
            seconds,
            outcome.steps as f64 / seconds / 1e6
        );
    }
}
