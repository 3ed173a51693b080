//! The faces and edges round one vertex, counter-clockwise.

use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;
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

    pub(super) fn shape(&self) -> RingShape {
        RingShape { faces: self.face_edges().len(), on_boundary: self.on_boundary }
    }
}

/// What the masks of a ring depend on.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct RingShape {
    pub(super) faces: usize,
    pub(super) on_boundary: bool,
}

impl RingShape {
    pub(super) fn edges(self) -> usize {
        self.faces + usize::from(self.on_boundary)
    }
}

/// Centres of faces with many vertices, so that a face of n vertices does not cost n^2 when all of them are asked for.
#[derive(Default)]
pub(super) struct LargeFaces(FxHashMap<FaceId, DVec3>);

impl LargeFaces {
    /// Faces with more vertices than this are remembered.
    const LARGE: usize = 32;

    /// The mean of the vertices of the face of `h`.
    pub(super) fn center(&mut self, mesh: &Mesh, h: HalfEdgeId) -> DVec3 {
        let face = mesh.face(h);
        if mesh.face_half_edges(face).nth(Self::LARGE).is_none() {
            return mean(mesh, face);
        }
        *self.0.entry(face).or_insert_with(|| mean(mesh, face))
    }
}

fn mean(mesh: &Mesh, face: FaceId) -> DVec3 {
    let (sum, count) = mesh
        .face_vertices(face)
        .fold((DVec3::ZERO, 0.0), |(sum, count), v| (sum + mesh.position(v), count + 1.0));
    sum / count
}
