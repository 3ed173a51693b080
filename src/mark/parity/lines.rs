//! From the set of crossed edges to lines.

use super::cost::{Cost, Costs, TURN, across_band, units};
use super::faces::{Faces, Passage};
use super::report::{End, Line, Report};
use crate::mesh::{FaceId, HalfEdgeId, Mesh};
use rustc_hash::FxHashSet;
use std::collections::BTreeMap;

/// Follows the lines over the edges of `join` (by number of the edge) from the odd faces in their order, writes them
/// into the report and returns the crossed half-edges, ascending. Edges on closed lines, which join nothing, are left
/// out.
pub(super) fn trace(
    mesh: &Mesh,
    faces: &Faces,
    costs: &mut Costs,
    join: &BTreeMap<u32, HalfEdgeId>,
    report: &mut Report,
) -> Vec<HalfEdgeId> {
    let mut ended: FxHashSet<FaceId> = FxHashSet::default();
    let mut crossed = Vec::new();
    for &face in faces.odd() {
        let Some(exit) = faces.exits(face).find(|exit| join.contains_key(&exit.edge())) else { continue };
        if !ended.insert(face) {
            continue;
        }
        let mut line =
            Line { ends: [End::Face(face.0), End::Border], edges: Vec::new(), turns: 0, cost: 0.0 };
        let mut cost: Cost = 0;
        let mut out = Some(exit);
        while let Some(side) = out {
            line.edges.push((mesh.source(side).0, mesh.target(side).0));
            crossed.push(side);
            cost += costs.edge(side);
            let h = side.mate();
            out = match faces.passage(h) {
                Passage::Border | Passage::Closed => None,
                Passage::End(face) => {
                    ended.insert(face);
                    line.ends[1] = End::Face(face.0);
                    None
                }
                Passage::Across(opposite, lines) => {
                    cost += across_band(lines);
                    Some(opposite)
                }
                Passage::Free => {
                    // Straight where there is a choice: the rules make a crossing of four crossed sides.
                    let straight = mesh.next(mesh.next(h));
                    let goes_on = |side: &HalfEdgeId| join.contains_key(&side.edge());
                    let next = [straight, mesh.next(h), mesh.prev(h)].into_iter().find(goes_on);
                    if next.is_some_and(|next| next != straight) {
                        line.turns += 1;
                        cost += TURN;
                    }
                    next
                }
            };
        }
        line.cost = units(cost);
        report.vertices += line.edges.len();
        report.lines.push(line);
    }
    crossed.sort_unstable();
    crossed
}
