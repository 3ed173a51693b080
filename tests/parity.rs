//! Parity lines: every face gets an even number of sides, at least cost; the report says what was done.

use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};
use welt::job::Job;
use welt::mark::parity::{self, End, Mode, Reason, Report};
use welt::mark::{Mark, Selection, Selector};
use welt::mesh::{FaceId, HalfEdgeId, Mesh, Polygons};

/// A flat sheet of `nx` x `ny` unit squares; vertex x + (nx + 1) y, face x + nx y.
fn sheet(nx: u32, ny: u32) -> Mesh {
    let side = nx + 1;
    let positions = (0..side * (ny + 1)).map(|i| DVec3::new(f64::from(i % side), f64::from(i / side), 0.0));
    let mut polygons = Polygons { positions: positions.collect(), ..Polygons::default() };
    for corner in (0..ny).flat_map(|y| (0..nx).map(move |x| x + side * y)) {
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([corner, corner + 1, corner + side + 1, corner + side]);
    }
    Mesh::from_polygons(&polygons).expect("a sheet is a mesh")
}

/// A closed tube of `m` rings of `n` quads, with an n-gon at either end: vertex i + n j, face i + n j, then the ends.
fn tube(n: u32, m: u32) -> Mesh {
    let mut polygons = Polygons::default();
    for (i, j) in (0..=m).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        polygons.positions.push(DVec3::new(angle.cos(), angle.sin(), f64::from(j)));
    }
    for corner in (0..m).flat_map(|j| (0..n).map(move |i| [i + n * j, (i + 1) % n + n * j])) {
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([corner[0], corner[1], corner[1] + n, corner[0] + n]);
    }
    polygons.face_sizes.extend([n, n]);
    polygons.face_vertices.extend((0..n).rev());
    polygons.face_vertices.extend(n * m..n * (m + 1));
    Mesh::from_polygons(&polygons).expect("a tube is a mesh")
}

fn marks(mesh: &Mesh, selectors: &[&str]) -> Vec<(HalfEdgeId, usize)> {
    let selectors: Vec<Selector> =
        selectors.iter().map(|s| Selector::parse(s).expect("a selector")).collect();
    let selection = Selection::resolve(mesh, &selectors).expect("edges of the mesh");
    selection.marks.iter().map(|mark| (mark.half_edge, 3)).collect()
}

fn route(mesh: &Mesh, marks: &[(HalfEdgeId, usize)], mode: Mode) -> (Vec<Mark>, Report) {
    parity::route(mesh, marks, mode, &Job::new()).expect("not cancelled")
}

/// Sides of a face after all marks are split.
fn sides(mesh: &Mesh, face: FaceId, marks: &[(HalfEdgeId, usize)], lines: &[Mark]) -> usize {
    let of = |h: HalfEdgeId| {
        let features = marks.iter().filter(|mark| mark.0.edge() == h.edge()).map(|mark| mark.1);
        1 + features.sum::<usize>() + lines.iter().filter(|line| line.half_edge.edge() == h.edge()).count()
    };
    mesh.face_half_edges(face).map(of).sum()
}

#[test]
fn a_dead_end_near_the_border_goes_on_to_it() {
    // The band comes from below and ends in the face (1, 1) of 3 x 3: one face is left above.
    let mesh = sheet(3, 3);
    let marks = marks(&mesh, &["edge:1,2", "edge:5,6"]);
    let (lines, report) = route(&mesh, &marks, Mode::Auto);
    assert_eq!(report.odd, 1);
    assert_eq!(report.lines.len(), 1, "{report}");
    let line = &report.lines[0];
    assert_eq!(
        (line.ends, &line.edges[..], line.turns),
        ([End::Face(4), End::Border], &[(10, 9), (14, 13)][..], 0)
    );
    assert!(lines.iter().all(|mark| mark.kind == "parity" && mark.t == 0.5));
    for face in mesh.faces() {
        assert_eq!(sides(&mesh, face, &marks, &lines) % 2, 0);
    }
    // Not asked for, it stays odd.
    let (lines, report) = route(&mesh, &marks, Mode::Local);
    assert!(lines.is_empty());
    assert_eq!(
        report.left.iter().map(|odd| (odd.face, odd.reason)).collect::<Vec<_>>(),
        [(4, Reason::Local)]
    );
}

#[test]
fn far_partners_are_left_to_local_patterns_unless_all_quads_are_asked_for() {
    let mesh = sheet(9, 30);
    let marks = marks(&mesh, &["edge:4,5", "edge:14,15"]);
    let (lines, report) = route(&mesh, &marks, Mode::Auto);
    assert!(lines.is_empty());
    assert_eq!(report.left[0].reason, Reason::Far);
    let (lines, report) = route(&mesh, &marks, Mode::AllQuad);
    assert!(report.left.is_empty() && report.exact);
    // To the side: 4 edges and a turn beat 29 edges ahead.
    assert_eq!((lines.len(), report.lines[0].turns, report.vertices), (6, 1, 6), "{report}");
}

#[test]
fn lines_go_round_marks_and_straight_across_bands() {
    // A band across the whole sheet, and a dead end below it that has to cross it.
    let mesh = sheet(5, 6);
    let across: Vec<String> = (0..6).map(|x| format!("edge:{},{}", x + 18, x + 24)).collect();
    let mut selectors: Vec<&str> = across.iter().map(String::as_str).collect();
    selectors.extend(["edge:2,3", "edge:8,9"]);
    let marks = marks(&mesh, &selectors);
    let (lines, report) = route(&mesh, &marks, Mode::AllQuad);
    assert_eq!(report.odd, 1);
    for face in mesh.faces() {
        assert_eq!(sides(&mesh, face, &marks, &lines) % 2, 0);
    }
    assert!(lines.iter().all(|line| marks.iter().all(|mark| mark.0.edge() != line.half_edge.edge())));
}

#[test]
fn irregular_faces_take_a_line_only_where_all_quads_are_asked_for() {
    // A band goes up from the lower end and stops: the end has 5 + 3 sides then, the face of the dead end 7.
    let mesh = tube(5, 8);
    let (low, high) = (FaceId(40), FaceId(41));
    let selectors = ["edge:0,1", "edge:5,6"];
    let (lines, report) = route(&mesh, &marks(&mesh, &selectors), Mode::Auto);
    assert!(lines.is_empty());
    assert_eq!(report.left.iter().map(|odd| (odd.face, odd.reason)).collect::<Vec<_>>(), [(5, Reason::Far)]);
    let marks = marks(&mesh, &selectors);
    let (lines, report) = route(&mesh, &marks, Mode::AllQuad);
    assert_eq!(report.lines[0].ends, [End::Face(5), End::Face(high.0)]);
    assert!(
        mesh.faces().all(|face| sides(&mesh, face, &marks, &lines).is_multiple_of(2)),
        "{low:?} has 8 sides"
    );
}

#[test]
fn an_odd_number_on_a_closed_surface_cannot_be_even() {
    // One band from the lower end, two from the upper end, all stop: three odd faces, and the ends serve as none.
    let mesh = tube(5, 8);
    let marks =
        marks(&mesh, &["edge:0,1", "edge:5,6", "edge:40,41", "edge:35,36", "edge:42,43", "edge:37,38"]);
    let (lines, report) = route(&mesh, &marks, Mode::AllQuad);
    assert_eq!((report.odd, report.lines.len()), (3, 1));
    // The two dead ends above are two faces apart, the third is further.
    assert_eq!(
        report.left.iter().map(|odd| (odd.face, odd.reason)).collect::<Vec<_>>(),
        [(5, Reason::OddNumber)]
    );
    assert_eq!(sides(&mesh, FaceId(30), &marks, &lines) % 2, 0);
    assert_eq!(sides(&mesh, FaceId(32), &marks, &lines) % 2, 0);
}

/// The least cost of any set of crossed edges, by trying all: sides that lines may cross as the documentation of the
/// module says, 1 per edge, half more where it ends in a corner of the band, 1 per turn, 3 per band crossed.
fn least(mesh: &Mesh, marks: &[(HalfEdgeId, usize)]) -> Option<f64> {
    let marked: FxHashSet<u32> = marks.iter().map(|mark| mark.0.edge()).collect();
    let corners: FxHashSet<u32> =
        marks.iter().flat_map(|mark| [mesh.source(mark.0).0, mesh.target(mark.0).0]).collect();
    let free: Vec<HalfEdgeId> = mesh.edges().filter(|h| !marked.contains(&h.edge())).collect();
    assert!(free.len() <= 22);
    let bit: FxHashMap<u32, u32> = free.iter().enumerate().map(|(i, h)| (h.edge(), 1 << i)).collect();
    let edge_cost: Vec<f64> = free
        .iter()
        .map(|&h| {
            let near = [mesh.source(h), mesh.target(h)].iter().any(|v| corners.contains(&v.0));
            if near { 1.5 } else { 1.0 }
        })
        .collect();
    // Per face and set of its crossed sides: the cost, or none where no line may go so.
    let patterns: Vec<[(u32, Option<f64>); 16]> = mesh
        .faces()
        .map(|face| {
            let sides: Vec<u32> = mesh.face_half_edges(face).map(HalfEdgeId::edge).collect();
            let is_marked: Vec<bool> = sides.iter().map(|side| marked.contains(side)).collect();
            let count = is_marked.iter().filter(|&&m| m).count();
            std::array::from_fn(|pattern| {
                let on = |i: usize| pattern >> (i % 4) & 1 == 1;
                let set = (0..4).filter(|&i| on(i)).map(|i| bit.get(&sides[i]).copied().unwrap_or(0)).sum();
                if (0..4).any(|i| on(i) && is_marked[i]) {
                    return (set, None);
                }
                let crossed: Vec<usize> = (0..4).filter(|&i| on(i)).collect();
                let opposite = crossed.len() == 2 && crossed[1] - crossed[0] == 2;
                let cost = match (count, crossed.len()) {
                    (0, 0) | (2 | 4, 0) | (0, 4) => Some(0.0),
                    (0, 2) => Some(if opposite { 0.0 } else { 1.0 }),
                    (1, 1) => is_marked[(crossed[0] + 2) % 4].then_some(0.0),
                    (3, 1) => Some(0.0),
                    (2, 2) => opposite.then_some(3.0),
                    _ => None,
                };
                (set, cost)
            })
        })
        .collect();
    let all: Vec<u32> = mesh
        .faces()
        .map(|face| mesh.face_half_edges(face).filter_map(|h| bit.get(&h.edge())).sum())
        .collect();
    (0..1_u32 << free.len())
        .filter_map(|set| {
            let mut cost: f64 = (0..free.len()).filter(|i| set >> i & 1 == 1).map(|i| edge_cost[i]).sum();
            for (face, table) in patterns.iter().enumerate() {
                cost += table.iter().find(|entry| entry.0 == set & all[face] && entry.1.is_some())?.1?;
            }
            Some(cost)
        })
        .min_by(f64::total_cmp)
}

#[test]
fn lines_cost_least() {
    let mesh = sheet(3, 3);
    // Vertex x + 4 y. One to four odd faces.
    for selectors in [
        vec!["edge:1,2", "edge:5,6"],
        vec!["edge:1,2", "edge:4,8", "edge:2,3"],
        vec!["edge:5,9", "edge:6,7"],
        vec!["edge:4,8", "edge:5,9", "edge:6,10", "edge:7,11", "edge:1,2"],
        vec!["edge:4,8", "edge:5,9", "edge:6,10", "edge:7,11", "edge:5,6", "edge:9,10"],
        vec!["edge:5,6", "edge:9,10", "edge:0,4"],
    ] {
        let marks = marks(&mesh, &selectors);
        let (lines, report) = route(&mesh, &marks, Mode::AllQuad);
        let cost: f64 = report.lines.iter().map(|line| line.cost).sum();
        match least(&mesh, &marks) {
            Some(least) => {
                assert!(report.left.is_empty(), "{selectors:?}: {report}");
                assert!((cost - least).abs() < 1e-6, "{selectors:?}: {cost} instead of {least}");
            }
            None => assert!(!report.left.is_empty(), "{selectors:?}: {report}"),
        }
        assert_eq!(lines.len(), report.vertices);
    }
}
