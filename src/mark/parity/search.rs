//! The shortest ways from one odd face to its nearest partners and to the border.

use super::cost::{Cost, Costs, TURN, across_band};
use super::faces::{Faces, Passage};
use crate::mesh::{FaceId, HalfEdgeId, Mesh};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A way for a parity line.
#[derive(Clone)]
pub(super) struct Path {
    pub(super) cost: Cost,
    /// The half-edges that it crosses, from the first to the last, each with the face that is entered on its left.
    pub(super) crossed: Vec<HalfEdgeId>,
}

/// The partners of an odd face, the nearest first.
#[derive(Default)]
pub(super) struct Found {
    pub(super) border: Option<Path>,
    pub(super) faces: Vec<(FaceId, Path)>,
    /// There can be more partners further away.
    pub(super) is_cut: bool,
}

/// How far to search.
pub(super) struct Reach {
    /// The nearest partners, this many.
    pub(super) partners: usize,
    /// What not to pair costs, at most, at either end: ways are searched while they cost less than both.
    pub(super) leave: Cost,
}

/// Dijkstra's algorithm from the sides `exits` of an odd face, over them. `is_partner` tells which of the
/// faces in which lines may end still look for one.
pub(super) fn search(
    mesh: &Mesh,
    faces: &Faces,
    costs: &mut Costs,
    exits: impl Iterator<Item = HalfEdgeId>,
    reach: &Reach,
    is_partner: impl Fn(FaceId) -> bool,
) -> Found {
    let mut best: FxHashMap<HalfEdgeId, (Cost, Option<HalfEdgeId>)> = FxHashMap::default();
    let mut queue = BinaryHeap::new();
    for start in exits.map(HalfEdgeId::mate) {
        let cost = costs.edge(start);
        best.insert(start, (cost, None));
        queue.push(Reverse((cost, start)));
    }
    let mut limit = reach.leave.saturating_mul(2);
    let mut found = Found::default();
    while let Some(Reverse((cost, h))) = queue.pop() {
        if cost >= limit {
            break;
        }
        if found.faces.len() >= reach.partners {
            found.is_cut = true;
            break;
        }
        if best.get(&h).is_none_or(|entry| entry.0 < cost) {
            continue;
        }
        let mut ways: SmallVec<[(HalfEdgeId, Cost); 3]> = SmallVec::new();
        match faces.passage(h) {
            Passage::Closed => {}
            Passage::Across(opposite, lines) => ways.push((opposite, across_band(lines))),
            Passage::Free => {
                let [right, straight, left] = [mesh.next(h), mesh.next(mesh.next(h)), mesh.prev(h)];
                ways.extend([(right, TURN), (straight, 0), (left, TURN)]);
            }
            Passage::Border => {
                if found.border.is_none() && cost < reach.leave {
                    found.border = Some(trace(&best, h, cost));
                    limit = limit.min(cost.saturating_add(reach.leave));
                }
            }
            Passage::End(face) => {
                if is_partner(face) && found.faces.iter().all(|entry| entry.0 != face) {
                    found.faces.push((face, trace(&best, h, cost)));
                }
            }
        }
        for (side, extra) in ways {
            let next = side.mate();
            let next_cost = cost + extra + costs.edge(next);
            if best.get(&next).is_none_or(|entry| next_cost < entry.0) {
                best.insert(next, (next_cost, Some(h)));
                queue.push(Reverse((next_cost, next)));
            }
        }
    }
    found
}

fn trace(best: &FxHashMap<HalfEdgeId, (Cost, Option<HalfEdgeId>)>, end: HalfEdgeId, cost: Cost) -> Path {
    let step = |h: &HalfEdgeId| best.get(h).and_then(|entry| entry.1);
    let mut crossed: Vec<HalfEdgeId> = std::iter::successors(Some(end), step).collect();
    crossed.reverse();
    Path { cost, crossed }
}
