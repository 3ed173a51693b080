//! Marks of one chain, all counting in the same direction.
//!
//! A feature runs from marked edge to marked edge through the faces between them. Its lines keep their order only if
//! the marks agree on which side of the feature an edge's first vertex lies.

use super::Mark;
use crate::mesh::{HalfEdgeId, Mesh};
use rustc_hash::FxHashMap;

/// The chains that marks form.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Chains {
    /// The chain of each mark, numbered by their first marks.
    pub of: Vec<usize>,
    /// Marks with a face on a side where their chain does not go on: `(mark, half-edge in that face)`.
    pub ends: Vec<(usize, HalfEdgeId)>,
    /// Number of chains.
    pub count: usize,
}

/// Turns marks round so that within a chain all first vertices lie on the same side, that of the chain's first mark.
/// A chain that closes with a twist keeps one place where they do not.
pub fn orient(mesh: &Mesh, marks: &mut [Mark]) -> Chains {
    let mut mark_at: FxHashMap<u32, usize> = FxHashMap::default();
    for (i, mark) in marks.iter().enumerate() {
        mark_at.insert(mark.half_edge.edge(), i);
    }
    let mut of = vec![usize::MAX; marks.len()];
    let mut ends = Vec::new();
    let mut count = 0;
    for first in 0..marks.len() {
        if of[first] != usize::MAX {
            continue;
        }
        of[first] = count;
        let mut open = vec![first];
        while let Some(i) = open.pop() {
            let h = marks[i].half_edge;
            for side in [h, h.mate()] {
                if mesh.face(side).is_boundary() {
                    continue;
                }
                let Some(partner) = partner(mesh, side, &marks[i].kind, marks, &mark_at) else {
                    ends.push((i, side));
                    continue;
                };
                let j = mark_at[&partner.edge()];
                if of[j] != usize::MAX {
                    continue;
                }
                of[j] = count;
                // What lies at the start of an edge on the way in lies at its end on the way out.
                let along = if side == h { partner.mate() } else { partner };
                if marks[j].half_edge != along {
                    marks[j].half_edge = along;
                    marks[j].t = 1.0 - marks[j].t;
                }
                open.push(j);
            }
        }
        count += 1;
    }
    Chains { of, ends, count }
}

/// The marked half-edge by which a feature that comes in through `side` leaves the face: the only other one of its
/// kind, or the opposite one of a quad.
fn partner(
    mesh: &Mesh,
    side: HalfEdgeId,
    kind: &str,
    marks: &[Mark],
    mark_at: &FxHashMap<u32, usize>,
) -> Option<HalfEdgeId> {
    let marked = |h: HalfEdgeId| mark_at.get(&h.edge()).is_some_and(|&i| marks[i].kind == kind);
    let mut others = mesh.face_half_edges(mesh.face(side)).filter(|&h| h != side && marked(h));
    let first = others.next()?;
    if others.next().is_none() {
        return Some(first);
    }
    let across = mesh.next(mesh.next(side));
    (mesh.next(mesh.next(across)) == side && marked(across)).then_some(across)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mark::{DEFAULT_KIND, Selection, Selector};
    use crate::mesh::Polygons;

    /// A sheet of 4 x 4 cells, vertex (i, j) is number 5 j + i.
    fn sheet() -> Mesh {
        let positions = (0..25).map(|k| glam::DVec3::new(f64::from(k % 5), f64::from(k / 5), 0.0)).collect();
        let mut polygons = Polygons { positions, ..Polygons::default() };
        for (i, j) in (0..4_u32).flat_map(|j| (0..4_u32).map(move |i| (i, j))) {
            polygons.face_sizes.push(4);
            let at = |i: u32, j: u32| 5 * j + i;
            polygons.face_vertices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
        Mesh::from_polygons(&polygons).expect("a sheet")
    }

    fn marks(mesh: &Mesh, edges: &[(u32, u32)]) -> Vec<Mark> {
        let selectors: Vec<Selector> = edges
            .iter()
            .map(|(a, b)| Selector::parse(&format!("edge:{a},{b}@0.4")).expect("a selector"))
            .collect();
        Selection::resolve(mesh, &selectors).expect("marks").marks
    }

    fn ends(mesh: &Mesh, mark: &Mark) -> (u32, u32) {
        (mesh.source(mark.half_edge).0, mesh.target(mark.half_edge).0)
    }

    #[test]
    fn a_column_agrees_with_its_first_mark() {
        let mesh = sheet();
        let mut column = marks(&mesh, &[(1, 2), (7, 6), (11, 12), (17, 16)]);
        let chains = orient(&mesh, &mut column);
        let found: Vec<(u32, u32)> = column.iter().map(|m| ends(&mesh, m)).collect();
        assert_eq!(found, [(1, 2), (6, 7), (11, 12), (16, 17)]);
        let places: Vec<f64> = column.iter().map(|m| m.t).collect();
        assert_eq!(places, [0.4, 0.6, 0.4, 0.6]);
        // It goes on towards the fifth row, which is not marked.
        assert_eq!((chains.count, chains.ends.len()), (1, 1));
    }

    #[test]
    fn a_loop_keeps_its_inside_on_one_side() {
        let mesh = sheet();
        // Around vertex 12, named in mixed directions.
        let mut around = marks(&mesh, &[(12, 13), (17, 12), (12, 11), (7, 12)]);
        let chains = orient(&mesh, &mut around);
        assert!(around.iter().all(|m| ends(&mesh, m).0 == 12));
        assert_eq!((chains.count, chains.ends.len()), (1, 0));
    }

    #[test]
    fn a_crossing_is_two_chains() {
        let mesh = sheet();
        let mut cross = marks(&mesh, &[(1, 2), (6, 7), (11, 12), (5, 10), (11, 6), (7, 12)]);
        let chains = orient(&mesh, &mut cross);
        assert_eq!(chains.of, [0, 0, 0, 1, 1, 1]);
        assert_eq!(ends(&mesh, &cross[4]), (6, 11));
        assert_eq!(cross[0].kind, DEFAULT_KIND);
    }
}
