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
    let angle =
        |i: usize| (i as f64 - 0.5) * std::f64::consts::TAU / sides as f64 - std::f64::consts::FRAC_PI_2;
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
        self.outcome
            .applications
            .iter()
            .filter(|(name, _)| *name == rule)
            .map(|(_, count)| *count as usize)
            .sum()
    }
}

fn run(rules: &RuleSet, sides: &[Side]) -> Result {
    let mut mesh = polygon(sides.len());
    mark(&mut mesh, sides);
    let outcome = grammar::run(rules, &mut mesh, &RunOptions::default())
        .unwrap_or_else(|error| panic!("{sides:?}: {error}"));
    mesh.validate_control_mesh().unwrap_or_else(|error| panic!("{sides:?}: {error}"));
    let inner = mesh
        .positions()
        .iter()
        .enumerate()
        .filter(|(v, _)| !mesh.is_boundary_vertex(VertexId(*v as u32)))
        .count();
    let mut others: Vec<usize> = mesh.faces().map(|f| mesh.arity(f)).filter(|&arity| arity != 4).collect();
    others.sort_unstable();
    Result { mesh, outcome, inner, others }
}

/// Twice the area.
fn area(mesh: &Mesh, f: welt::mesh::FaceId) -> f64 {
    let points: Vec<DVec3> = mesh.face_vertices(f).map(|v| mesh.position(v)).collect();
    (0..points.len()).map(|i| points[i].cross(points[(i + 1) % points.len()]).z).sum()
}

#[test]
fn every_combination_is_valid() {
    let rules = feature::linear_rules().expect("rules");
    let choices = [Whole, Parity, Lines(1), Lines(2), Lines(3), Lines(4), Lines(5)];
    let mut count = 0;
    for sides in 3..=6_usize {
        // All combinations on up to four sides; beyond, those of whole sides, parity and three lines.
        let choices: &[Side] = if sides <= 4 { &choices } else { &[Whole, Parity, Lines(3)] };
        for number in 1..choices.len().pow(sides as u32) {
            let combination: Vec<Side> =
                (0..sides).map(|i| choices[number / choices.len().pow(i as u32) % choices.len()]).collect();
            let result = run(&rules, &combination);
            count += 1;
            assert!(
                result.mesh.faces().all(|f| area(&result.mesh, f) > 0.0),
                "a face of {combination:?} is turned over"
            );
            // No span is left, and places stay just where the last resort was used.
            let [span, places] = ["span", "places"].map(|name| result.mesh.symbol(name).expect("known"));
            assert_eq!(result.mesh.nodes_with_link(Domain::HalfEdge, span).count(), 0, "{combination:?}");
            let unresolved = result.mesh.nodes_with_attribute(Domain::HalfEdge, places).len();
            let marked = combination.iter().filter(|side| !matches!(side, Whole | Parity)).count();
            assert_eq!(unresolved, result.fired("Unlike") * marked, "{combination:?}");
        }
    }
    assert_eq!(count, 342 + 2400 + 242 + 728);
}

/// Which rule takes a face, how many vertices it puts inside, and what it leaves besides quads. Sides are counted from the
/// bottom, counter-clockwise. The numbers are those of the drawings: I and Q of docs/junctions.md, section 1, where it
/// has the pattern, else counted by hand.
#[test]
fn each_combination_has_its_rule() {
    let rules = feature::linear_rules().expect("rules");
    let l = Lines(3);
    let cases: &[(&str, &[Side], usize, &[usize])] = &[
        ("Straight", &[l, Whole, l, Whole], 0, &[]),
        ("Straight", &[Parity, Whole, Parity, Whole], 0, &[]),
        ("Corner", &[l, l, Whole, Whole], 3, &[]),
        ("Corner", &[Parity, Parity, Whole, Whole], 1, &[]),
        ("Crossing", &[l, l, l, l], 9, &[]),
        ("Crossing", &[Parity, Lines(5), Parity, Lines(5)], 5, &[]),
        ("Crossing", &[Parity, Parity, Parity, Parity], 1, &[]),
        ("CrossingThrough", &[l, Lines(5), l, Lines(5)], 7, &[]),
        ("CrossingThrough", &[Lines(5), Lines(5), Lines(5), Lines(5)], 13, &[]),
        ("Tee", &[l, l, Whole, l], 4, &[5]),
        ("Tee", &[l, l, Parity, l], 4, &[]),
        ("Tee", &[l, Lines(5), Whole, Lines(5)], 6, &[5]),
        ("Tee", &[Lines(5), Lines(5), Whole, Lines(5)], 7, &[5]),
        ("TeeEven", &[Lines(4), l, Whole, l], 8, &[]),
        ("TeeEven", &[Lines(2), Lines(2), Whole, Lines(2)], 6, &[]),
        ("DeadEnd", &[l, Whole, Whole, Whole], 5, &[3]),
        ("DeadEnd", &[Lines(5), Whole, Whole, Whole], 8, &[3]),
        ("DeadEndOpen", &[l, Whole, Parity, Whole], 4, &[]),
        ("DeadEndOpen", &[l, Parity, Whole, Whole], 4, &[]),
        ("DeadEndEven", &[Lines(4), Whole, Whole, Whole], 4, &[]),
        ("DeadEndEven", &[Lines(2), Whole, Whole, Whole], 2, &[]),
        ("DeadEndSingle", &[Lines(1), Whole, Whole, Whole], 1, &[3]),
        // A parity line that passes behind a corner, and through a corner of a feature in a triangle.
        ("Corner", &[l, l, Parity, Parity], 3, &[]),
        ("Corner", &[l, l, Parity], 3, &[]),
        // Triangles and faces with more sides.
        ("Across", &[l, l, Whole], 0, &[3]),
        ("Hub", &[l, l, l], 4, &[]),
        ("Hub", &[Parity, Parity, Parity], 1, &[]),
        ("DeadEndTriangle", &[l, Whole, Whole], 3, &[]),
        ("Across", &[l, Whole, l, Whole, Whole], 0, &[5]),
        ("Corner", &[l, l, Whole, Whole, Whole], 3, &[5]),
        ("Corner", &[l, l, Whole, Whole, Whole, Whole], 3, &[]),
        ("Tee", &[l, l, Whole, Whole, l], 4, &[]),
        ("Hub", &[l, Whole, l, Whole, l, Whole], 4, &[5, 5, 5]),
        ("ParityEnd", &[Parity, Whole, Whole], 0, &[]),
        ("ParityEnd", &[Parity, Whole, Whole, Whole, Whole], 0, &[]),
    ];
    for &(rule, sides, inner, others) in cases {
        let result = run(&rules, sides);
        assert_eq!(result.fired(rule), 1, "{rule} for {sides:?}: {:?}", result.outcome.applications);
        assert_eq!((result.inner, result.others.as_slice()), (inner, others), "{rule} for {sides:?}");
    }
}
