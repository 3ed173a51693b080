//! Marks on real cages: rings, two rings that cross, and a band between two T-junctions.

use rustc_hash::{FxHashMap, FxHashSet};
use welt::mark::{Mark, Selection, Selector, Shape};
use welt::mesh::{FaceId, Mesh};

/// Marks and the mean length of their edges.
pub struct Marked {
    pub selection: Selection,
    pub edge: f64,
}

impl Marked {
    fn new(mesh: &Mesh, marks: Vec<Mark>) -> Self {
        let edge =
            marks.iter().map(|mark| mesh.edge_length(mark.half_edge)).sum::<f64>() / marks.len() as f64;
        Self { selection: Selection { marks, ..Selection::default() }, edge }
    }

    /// The face behind each mark; on a ring the next mark is on its other side.
    fn faces(&self, mesh: &Mesh) -> Vec<FaceId> {
        self.selection.marks.iter().map(|mark| mesh.face(mark.half_edge)).collect()
    }
}

/// The closed rings of quads of 6 edges or more that cross no face twice and whose longest edge is under 8 times the
/// shortest.
pub fn rings(mesh: &Mesh) -> Vec<Marked> {
    let mut seen: FxHashSet<u32> = FxHashSet::default();
    let mut rings = Vec::new();
    for h in mesh.edges() {
        if seen.contains(&h.edge()) {
            continue;
        }
        let edge = (mesh.source(h).0, mesh.target(h).0);
        let selector = Selector { shape: Shape::Ring { edge }, kind: "red".into() };
        let Selection { marks, ends, .. } =
            Selection::resolve(mesh, &[selector]).expect("an edge of the mesh");
        seen.extend(marks.iter().map(|mark| mark.half_edge.edge()));
        let lengths = || marks.iter().map(|mark| mesh.edge_length(mark.half_edge));
        let (low, high) = lengths().fold((f64::INFINITY, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)));
        let faces: FxHashSet<FaceId> = marks.iter().map(|mark| mesh.face(mark.half_edge)).collect();
        if ends.is_empty() && marks.len() >= 6 && faces.len() == marks.len() && high < 8.0 * low {
            rings.push(Marked::new(mesh, marks));
        }
    }
    rings
}

/// Each ring with the first later one that crosses it, as numbers of `rings`.
pub fn crossing_pairs(mesh: &Mesh, rings: &[Marked]) -> Vec<[usize; 2]> {
    let mut of_face: FxHashMap<FaceId, Vec<usize>> = FxHashMap::default();
    for (number, ring) in rings.iter().enumerate() {
        for face in ring.faces(mesh) {
            of_face.entry(face).or_default().push(number);
        }
    }
    let partner = |(number, ring): (usize, &Marked)| {
        let there = ring.faces(mesh).into_iter().flat_map(|face| of_face[&face].iter().copied());
        there.filter(|&other| other > number).min().map(|other| [number, other])
    };
    rings.iter().enumerate().filter_map(partner).collect()
}

/// Both rings.
pub fn crossing(mesh: &Mesh, [a, b]: [&Marked; 2]) -> Marked {
    Marked::new(mesh, [a, b].iter().flat_map(|ring| ring.selection.marks.iter().cloned()).collect())
}

/// The ring `a` and of `b` what lies between two of their crossings, three edges or more: two T-junctions.
pub fn tees(mesh: &Mesh, [a, b]: [&Marked; 2]) -> Option<Marked> {
    let of_a: FxHashSet<FaceId> = a.faces(mesh).into_iter().collect();
    let behind = b.faces(mesh);
    let crossings: Vec<usize> = (0..behind.len()).filter(|&k| of_a.contains(&behind[k])).collect();
    let runs = crossings.windows(2).map(|pair| pair[0] + 1..pair[1] + 1);
    let run = runs.filter(|run| run.len() >= 3).min_by_key(|run| run.len())?;
    let marks = a.selection.marks.iter().chain(&b.selection.marks[run]);
    Some(Marked::new(mesh, marks.cloned().collect()))
}
