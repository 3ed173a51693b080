//! What closed loops of marks enclose.

use super::FeatureError;
use crate::mark::{Chains, Mark};
use crate::mesh::{Mesh, VertexId};
use rustc_hash::FxHashSet;

/// Vertices inside of the loops that the marks of one feature form; turns the marks so that their first vertices lie
/// inside.
///
/// Inside is the side with fewer vertices, that of the first mark's first vertex where both have the same number. The
/// cost follows the smaller side.
///
/// # Errors
/// [`FeatureError::OpenLoop`] when a chain ends inside the mesh, or does not separate it.
pub(super) fn enclosed(
    mesh: &Mesh,
    marks: &mut [Mark],
    chosen: &[usize],
    chains: &Chains,
    feature: &str,
) -> Result<Vec<VertexId>, FeatureError> {
    let marked: FxHashSet<u32> = chosen.iter().map(|&i| marks[i].half_edge.edge()).collect();
    let mut loops: Vec<usize> = chosen.iter().map(|&i| chains.of[i]).collect();
    loops.sort_unstable();
    loops.dedup();
    let mut inside: Vec<VertexId> = Vec::new();
    for chain in loops {
        let members: Vec<usize> = chosen.iter().copied().filter(|&i| chains.of[i] == chain).collect();
        let open = |ends| FeatureError::OpenLoop { feature: feature.to_owned(), ends };
        let mut ends: Vec<(u32, u32)> = chains
            .ends
            .iter()
            .filter(|(i, _)| members.contains(i))
            .map(|&(_, h)| (mesh.source(h).0, mesh.target(h).0))
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        if !ends.is_empty() {
            ends.sort_unstable();
            return Err(open(ends));
        }
        let sides = [false, true].map(|far| {
            let seeds = members.iter().map(|&i| {
                let h = marks[i].half_edge;
                if far { mesh.target(h) } else { mesh.source(h) }
            });
            Flood::from(seeds)
        });
        let (vertices, far) = smaller(mesh, &marked, sides).ok_or_else(|| open(Vec::new()))?;
        if far {
            for &i in &members {
                marks[i].half_edge = marks[i].half_edge.mate();
                marks[i].t = 1.0 - marks[i].t;
            }
        }
        inside.extend(vertices);
    }
    inside.sort_unstable();
    inside.dedup();
    Ok(inside)
}

/// Vertices reached so far.
struct Flood {
    seen: FxHashSet<VertexId>,
    found: Vec<VertexId>,
    next: usize,
}

impl Flood {
    fn from(seeds: impl Iterator<Item = VertexId>) -> Self {
        let mut flood = Self { seen: FxHashSet::default(), found: Vec::new(), next: 0 };
        seeds.for_each(|v| flood.reach(v));
        flood
    }

    fn reach(&mut self, v: VertexId) {
        if self.seen.insert(v) {
            self.found.push(v);
        }
    }

    /// Goes on from one vertex over unmarked edges; false when there is none left.
    fn step(&mut self, mesh: &Mesh, marked: &FxHashSet<u32>) -> bool {
        let Some(&v) = self.found.get(self.next) else { return false };
        self.next += 1;
        for h in mesh.outgoing(v) {
            if !marked.contains(&h.edge()) {
                self.reach(mesh.target(h));
            }
        }
        true
    }
}

/// The side that is exhausted first and whether it is the far one; `None` when the sides meet.
fn smaller(
    mesh: &Mesh,
    marked: &FxHashSet<u32>,
    [mut near, mut far]: [Flood; 2],
) -> Option<(Vec<VertexId>, bool)> {
    loop {
        let near_goes_on = near.step(mesh, marked);
        if !near_goes_on && near.found.len() <= far.found.len() {
            return near.found.iter().all(|v| !far.seen.contains(v)).then_some((near.found, false));
        }
        let far_goes_on = far.step(mesh, marked);
        if !far_goes_on && far.found.len() < near.found.len() {
            return far.found.iter().all(|v| !near.seen.contains(v)).then_some((far.found, true));
        }
        if !near_goes_on && !far_goes_on {
            return None;
        }
    }
}
