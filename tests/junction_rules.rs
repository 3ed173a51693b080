//! The rules of linear features in single faces: every combination of split sides gives a valid mesh without folds.

use glam::DVec3;
use welt::feature;
use welt::grammar::{self, Outcome, RuleSet, RunOptions};
use welt::mesh::{Domain, HalfEdgeId, Mesh, Node, Polygons, Value, VertexId};

/// A side of the face: not split, a parity line, or this many lines of a feature.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Side {
    Whole,
    Parity,
    Lines(usize),
}
use Side::{Lines, Parity, Whole};

/// A regular polygon with its middle in the origin.
fn polygon(sides: usize) -> Mesh {
    let angle = |i: usize| (i as f64 - 0.5) * std::f64::consts::TAU / sides as f64 - std::f64::consts::FRAC_PI_2;
    let polygons = Polygons {
        positions: (0..sides).map(|i| DVec3::new(angle(i).cos(), angle(i).sin(), 0.0)).collect(),
        face_sizes: vec![sides as u32],
        face_vertices: (0..sides as u32).collect(),
        ..Polygons::default()
    };
    Mesh::from_polygons(&polygons).expect("a polygon")
}

/// Marks the sides as the feature stage does. Lines stand symmetrically, so that they can be counted from either end.
fn mark(mesh: &mut Mesh, sides: &[Side]) {
    let names = ["cuts", "lines", "mark", "color", "t"].map(|name| mesh.intern(name));
    let count = sides.len() as u32;
    for (i, side) in sides.iter().enumerate() {
        let (lines, kind) = match *side {
            Whole => continue,
            Parity => (1, "parity"),
            Lines(lines) => (lines, "red"),
        };
        let places: Vec<f64> = (1..=lines).map(|k| 0.2 + 0.6 * k as f64 / (lines + 1) as f64).collect();
        let h = mesh.find_half_edge(VertexId(i as u32), VertexId((i as u32 + 1) % count)).expect("an edge");
        for h in [h, HalfEdgeId(h.0 ^ 1)] {
            let values = [
                Value::Numbers(places.clone().into()),
                Value::Numbers((1..=places.len()).map(|line| line as f64).collect::<Vec<_>>().into()),
                Value::Number(i as f64),
                Value::text(kind),
                Value::Number(0.5),
            ];
            for (name, value) in names.into_iter().zip(values) {
                mesh.set_attribute(Node::HalfEdge(h), name, Some(value));
            }
        }
    }
}

struct Result {
    mesh: Mesh,
    outcome: Outcome,
    /// Vertices inside the face.
    inner: usize,
    /// Numbers of corners of the faces that are no quads, ascending.
    others: Vec<usize>,
}

impl Result {
    fn fired(&self, rule: &str) -> usize {
        self.outcome.applications.iter().filter(|(name, _)| *name == rule).map(|(_, count)| *count as usize).sum()
    }
}

fn run(rules: &RuleSet, sides: &[Side]) -> Result {
    let mut mesh = polygon(sides.len());
    mark(&mut mesh, sides);
    let outcome = grammar::run(rules, &mut mesh, &RunOptions::default())
        .unwrap_or_else(|error| panic!("{sides:?}: {error}"));
    mesh.validate_control_mesh().unwrap_or_else(|error| panic!("{sides:?}: {error}"));
    let inner = mesh.positions().iter().enumerate().filter(|(v, _)| !mesh.is_boundary_vertex(VertexId(*v as u32))).count();
    let mut others: Vec<usize> = mesh.faces().map(|f| mesh.arity(f)).filter(|&arity| arity != 4).collect();
    others.sort_unstable();
    Result { mesh, outcome, inner, others }
}

/// Twice the areas of the corners of a face: all positive where it is convex.
fn corners(mesh: &Mesh, f: welt::mesh::FaceId) -> Vec<f64> {
    let points: Vec<DVec3> = mesh.face_vertices(f).map(|v| mesh.position(v)).collect();
    let n = points.len();
    (0..n)
        .map(|i| (points[(i + 1) % n] - points[i]).cross(points[(i + n - 1) % n] - points[i]).z)
        .collect()
}

fn area(mesh: &Mesh, f: welt::mesh::FaceId) -> f64 {
    let points: Vec<DVec3> = mesh.face_vertices(f).map(|v| mesh.position(v)).collect();
    (0..points.len()).map(|i| points[i].cross(points[(i + 1) % points.len()]).z).sum()
}

fn rules() -> RuleSet {
    match std::env::var("RULES") {
        Ok(path) => RuleSet::load(path.as_ref()).unwrap_or_else(|e| panic!("{e}")),
        Err(_) => feature::linear_rules().expect("rules"),
    }
}

#[test]
fn every_combination_is_valid() {
    let rules = rules();
    let choices = [Whole, Parity, Lines(1), Lines(2), Lines(3), Lines(4), Lines(5)];
    let mut count = 0;
    let mut folded = std::collections::BTreeMap::new();
    for sides in 3..=6_usize {
        // All combinations on up to four sides; beyond, those of whole sides, parity and three lines.
        let choices: &[Side] = if sides <= 4 { &choices } else { &[Whole, Parity, Lines(3)] };
        for number in 1..choices.len().pow(sides as u32) {
            let combination: Vec<Side> =
                (0..sides).map(|i| choices[number / choices.len().pow(i as u32) % choices.len()]).collect();
            let result = run(&rules, &combination);
            count += 1;
            let bad = result.mesh.faces().filter(|&f| area(&result.mesh, f) <= 0.0).count();
            if bad > 0 {
                let fired: Vec<_> = result.outcome.applications.iter().filter(|a| a.1 > 0 && a.0 != "Split").map(|a| a.0.clone()).collect();
                folded.entry(fired).or_insert_with(Vec::new).push(combination.clone());
            }
            // Spans are gone, and places stay where the last resort was used.
            let span = result.mesh.symbol("span").expect("spans");
            assert_eq!(result.mesh.nodes_with_link(Domain::HalfEdge, span).count(), 0, "{combination:?}");
        }
    }
    println!("{count} combinations");
    for (rules, cases) in &folded {
        println!("folded {rules:?}: {} first {:?}", cases.len(), cases[0]);
    }
    assert!(folded.is_empty());
}
