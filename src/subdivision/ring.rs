//! The faces and edges round one vertex, counter-clockwise.

use crate::mesh::{HalfEdgeId, Mesh, VertexId};
use glam::DVec3;
use smallvec::SmallVec;

/// The ring of a vertex that has edges.
pub(super) struct Ring {
    pub(super) center: VertexId,
    /// Half-edges out of the centre, counter-clockwise from the one the vertex names; face `i` lies between edges `i`
    /// and `i + 1`. On the boundary the first and the last lie on it, and the last has no face.
    pub(super) edges: SmallVec<[HalfEdgeId; 16]>,
    pub(super) on_boundary: bool,
}

impl Ring {
    /// The ring of `v`, or `None` where it is isolated.
    pub(super) fn new(mesh: &Mesh, v: VertexId) -> Option<Self> {
        let mut edges: SmallVec<[HalfEdgeId; 16]> = mesh.outgoing(v).collect();
        if edges.is_empty() {
            return None;
        }
        edges[1..].reverse();
        let outside = edges.iter().position(|&h| mesh.face(h).is_boundary());
        if let Some(last) = outside {
            edges.rotate_left(last + 1);
        }
        Some(Self { center: v, edges, on_boundary: outside.is_some() })
    }

    /// The half-edges whose faces lie in the ring.
    pub(super) fn face_edges(&self) -> &[HalfEdgeId] {
        &self.edges[..self.edges.len() - usize::from(self.on_boundary)]
    }

    pub(super) fn face_count(&self) -> usize {
        self.face_edges().len()
    }
}

/// The mean of the vertices of the face of `h`.
pub(super) fn face_center(mesh: &Mesh, h: HalfEdgeId) -> DVec3 {
    let mut sum = DVec3::ZERO;
    let mut count = 0.0;
    for v in mesh.face_vertices(mesh.face(h)) {
        sum += mesh.position(v);
        count += 1.0;
    }
    sum / count
}
