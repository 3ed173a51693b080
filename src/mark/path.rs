//! The shortest row of quads between two edges.

use crate::mesh::{HalfEdgeId, Mesh};
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Faces crossed, then turns taken: short first, straight among the short.
type Cost = (u32, u32);

/// The edges crossed on the way from `from` to `to`, both included, or `None` when no row of quads joins them.
/// Ties go to the path with fewer turns, then to lower ids. The result's half-edges all have the row on their left
/// where it goes on.
pub(super) fn shortest(mesh: &Mesh, from: HalfEdgeId, to: HalfEdgeId) -> Option<Vec<HalfEdgeId>> {
    // A state is a half-edge about to be crossed into the face on its left.
    let mut best: FxHashMap<HalfEdgeId, (Cost, Option<HalfEdgeId>)> = FxHashMap::default();
    let mut queue = BinaryHeap::new();
    for start in [from, from.mate()] {
        best.insert(start, ((0, 0), None));
        queue.push(Reverse(((0, 0), start)));
    }
    while let Some(Reverse((cost, h))) = queue.pop() {
        if best.get(&h).is_none_or(|entry| entry.0 < cost) {
            continue;
        }
        if h.edge() == to.edge() {
            return Some(trace(&best, h));
        }
        let face = mesh.face(h);
        if face.is_boundary() || mesh.face_half_edges(face).take(5).count() != 4 {
            continue;
        }
        let straight = mesh.next(mesh.next(h));
        for across in [mesh.next(h), straight, mesh.prev(h)] {
            let next = across.mate();
            let next_cost = (cost.0 + 1, cost.1 + u32::from(across != straight));
            if best.get(&next).is_none_or(|entry| next_cost < entry.0) {
                best.insert(next, (next_cost, Some(h)));
                queue.push(Reverse((next_cost, next)));
            }
        }
    }
    None
}

fn trace(best: &FxHashMap<HalfEdgeId, (Cost, Option<HalfEdgeId>)>, end: HalfEdgeId) -> Vec<HalfEdgeId> {
    let step = |h: &HalfEdgeId| best.get(h).and_then(|entry| entry.1);
    let mut strip: Vec<HalfEdgeId> = std::iter::successors(Some(end), step).collect();
    strip.reverse();
    strip
}
