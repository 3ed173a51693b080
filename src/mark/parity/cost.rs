//! What parity lines cost. One unit is the cost of a vertex on an edge far from the feature in a flat place.

use crate::mesh::{HalfEdgeId, Mesh, VertexId};
use crate::subdivision::vertex_normal;
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// A cost in fractions of a unit, so that sums are exact and do not depend on their order.
pub(super) type Cost = i64;

/// One unit.
const UNIT: Cost = 1 << 24;

/// A turn makes two extraordinary vertices, of valences 3 and 5; straight pieces make none.
pub(super) const TURN: Cost = UNIT;
/// Crossing an edge that ends in a corner of the band: a line there comes between the band and its surroundings.
const NEAR: f64 = 0.5;
/// Times one minus the cosine of the angle between the normals at the ends of a crossed edge: the vertex in its middle
/// is that far from the surface, and fitting it leaves a trace.
const BEND: f64 = 4.0;
/// In auto mode, what it costs to leave a face odd: a line that joins two odd faces may cost twice as much.
/// Measured on real cages (docs/linear-features.md, section 7): so far a line follows the surface better than two
/// irregular faces and saves two extraordinary vertices, for at most three more vertices.
pub(super) const LEAVE: Cost = 4 * UNIT;
/// In all-quad mode, what it costs to leave a face odd: more than all lines of a mesh together.
pub(super) const IMPOSSIBLE: Cost = 1 << 50;

/// The costs on one mesh, computed where they are asked for.
pub(super) struct Costs<'m> {
    mesh: &'m Mesh,
    /// Ends of marked edges.
    corners: FxHashSet<VertexId>,
    edges: FxHashMap<u32, Cost>,
    normals: FxHashMap<VertexId, DVec3>,
}

impl<'m> Costs<'m> {
    pub(super) fn new(mesh: &'m Mesh, marks: &[(HalfEdgeId, usize)]) -> Self {
        let corners = marks.iter().flat_map(|&(h, _)| [mesh.source(h), mesh.target(h)]).collect();
        Self { mesh, corners, edges: FxHashMap::default(), normals: FxHashMap::default() }
    }

    /// Of crossing an edge.
    pub(super) fn edge(&mut self, h: HalfEdgeId) -> Cost {
        if let Some(&cost) = self.edges.get(&h.edge()) {
            return cost;
        }
        let ends = [self.mesh.source(h), self.mesh.target(h)];
        let near = ends.iter().any(|v| self.corners.contains(v));
        let [a, b] = ends.map(|v| self.normal(v));
        let cost = 1.0 + if near { NEAR } else { 0.0 } + BEND * (1.0 - a.dot(b)).max(0.0);
        let cost = (cost * UNIT as f64).round() as Cost;
        self.edges.insert(h.edge(), cost);
        cost
    }

    fn normal(&mut self, v: VertexId) -> DVec3 {
        *self.normals.entry(v).or_insert_with(|| vertex_normal(self.mesh, v).unwrap_or_default())
    }
}

/// Of crossing a band of so many lines: a vertex on each.
pub(super) fn across_band(lines: usize) -> Cost {
    UNIT * lines as Cost
}

/// A cost in units.
pub(super) fn units(cost: Cost) -> f64 {
    cost as f64 / UNIT as f64
}
