//! Connectivity of one level of refinement, and how the next level follows from it.
//!
//! Everything is a flat array over the corners of the faces, so that the next level is a streaming computation
//! without searching: with `V`, `E`, `F` and `C` the vertices, edges, faces and corners of a level,
//!
//! - vertices of the next level: `V` vertex points, then `E` edge points, then `F` face points, each in the order of
//!   the elements they come from;
//! - faces: child face `c` belongs to corner `c`, and a corner `i` of face `f` gives the quad
//!   (vertex point of i, edge point of i, face point of f, edge point of i - 1), edge `i` being the one that leaves
//!   corner `i`;
//! - edges: the half of an edge next to the source of its half-edge `h` has number `h`, which numbers the `2 E`
//!   halves, then `2 E + c` runs from the edge point of corner `c` to the face point. Half-edge `2 e` of such an edge
//!   starts at the vertex point, or at the edge point where the edge lies inside a face.

use crate::memory::{self, OutOfMemory};

/// A half-edge on the outside of the surface. The surface lies on the right of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundaryEdge {
    pub(super) half_edge: u32,
    pub(super) source: u32,
    pub(super) target: u32,
    /// The half-edge before it on the same loop.
    pub(super) previous: u32,
    /// The vertex at which `previous` starts.
    pub(super) previous_source: u32,
}

/// One level of a [`Refinement`](super::Refinement). Level 0 is the control mesh, all others have quads only.
#[derive(Clone, Debug)]
pub struct Level {
    pub(super) vertex_count: u32,
    pub(super) edge_count: u32,
    /// First corner of each face and the number of corners; `None` where all faces are quads.
    pub(super) starts: Option<Vec<u32>>,
    pub(super) corner_vertices: Vec<u32>,
    /// The half-edge that leaves each corner inside its face; empty on the last level, where nothing follows.
    pub(super) corner_half_edges: Vec<u32>,
    pub(super) boundary: Vec<BoundaryEdge>,
}

impl Level {
    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertex_count as usize
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.edge_count as usize
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        match &self.starts {
            None => self.corner_vertices.len() / 4,
            Some(starts) => starts.len() - 1,
        }
    }

    /// The vertices of all faces, one after the other, counter-clockwise.
    pub fn face_vertices(&self) -> &[u32] {
        &self.corner_vertices
    }

    /// The faces as quads; `None` where some face is none (only on level 0).
    pub fn quads(&self) -> Option<&[[u32; 4]]> {
        self.starts.is_none().then(|| self.corner_vertices.as_chunks().0)
    }

    /// Number of vertices of each face.
    pub fn face_sizes(&self) -> impl Iterator<Item = u32> {
        (0..self.face_count()).map(|face| match &self.starts {
            None => 4,
            Some(starts) => starts[face + 1] - starts[face],
        })
    }

    /// The vertices of each face.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.face_count()).map(|face| &self.corner_vertices[self.corners(face)])
    }

    /// The corners of a face, as indices into [`face_vertices`](Self::face_vertices).
    pub(super) fn corners(&self, face: usize) -> std::ops::Range<usize> {
        match &self.starts {
            None => 4 * face..4 * face + 4,
            Some(starts) => starts[face] as usize..starts[face + 1] as usize,
        }
    }

    /// The face that has a corner, and the place of the corner in the face.
    pub(super) fn corner_place(&self, corner: u32) -> (u32, u32) {
        match &self.starts {
            None => (corner / 4, corner % 4),
            Some(starts) => {
                let face = starts.partition_point(|&start| start <= corner) as u32 - 1;
                (face, corner - starts[face as usize])
            }
        }
    }

    /// Vertices, edges and faces of the next level.
    pub(super) fn child_counts(&self) -> [u64; 3] {
        let (vertices, edges) = (u64::from(self.vertex_count), u64::from(self.edge_count));
        let corners = self.corner_vertices.len() as u64;
        [vertices + edges + self.face_count() as u64, 2 * edges + corners, corners]
    }

    /// The next level. The caller has seen to it that the numbers fit into 31 bits. `last` leaves out what only a
    /// further level would need.
    pub(super) fn child(&self, last: bool) -> Result<Self, OutOfMemory> {
        let [vertex_count, edge_count, face_count] = self.child_counts().map(|count| count as u32);
        let mut child = Self {
            vertex_count,
            edge_count,
            starts: None,
            corner_vertices: memory::room(4 * face_count as usize)?,
            corner_half_edges: memory::room(if last { 0 } else { 4 * face_count as usize })?,
            boundary: Vec::new(),
        };
        if self.starts.is_none() {
            self.split_quads(&mut child, last);
        } else {
            self.split_polygons(&mut child, last);
        }
        child.boundary = self.split_boundary()?;
        Ok(child)
    }

    fn split_quads(&self, child: &mut Self, last: bool) {
        let edge_point = self.vertex_count;
        let face_point = self.vertex_count + self.edge_count;
        let inner = 2 * self.edge_count;
        let vertices = self.corner_vertices.as_chunks::<4>().0;
        let half_edges = self.corner_half_edges.as_chunks::<4>().0;
        for ((v, h), f) in vertices.iter().zip(half_edges).zip(face_point..) {
            let e = h.map(|h| edge_point + (h >> 1));
            let quads =
                [[v[0], e[0], f, e[3]], [v[1], e[1], f, e[0]], [v[2], e[2], f, e[1]], [v[3], e[3], f, e[2]]];
            child.corner_vertices.extend_from_slice(quads.as_flattened());
        }
        if last {
            return;
        }
        for (h, start) in half_edges.iter().zip((inner..).step_by(4)) {
            let quad = |i: u32, before: u32| {
                let (leaving, arriving) = (h[i as usize], h[before as usize]);
                [2 * leaving, 2 * (start + i), 2 * (start + before) + 1, 2 * (arriving ^ 1) + 1]
            };
            let quads = [quad(0, 3), quad(1, 0), quad(2, 1), quad(3, 2)];
            child.corner_half_edges.extend_from_slice(quads.as_flattened());
        }
    }

    fn split_polygons(&self, child: &mut Self, last: bool) {
        let edge_point = self.vertex_count;
        let face_point = self.vertex_count + self.edge_count;
        let inner = 2 * self.edge_count;
        for face in 0..self.face_count() {
            let corners = self.corners(face);
            let mut before = corners.end - 1;
            for corner in corners {
                let (leaving, arriving) = (self.corner_half_edges[corner], self.corner_half_edges[before]);
                child.corner_vertices.extend_from_slice(&[
                    self.corner_vertices[corner],
                    edge_point + (leaving >> 1),
                    face_point + face as u32,
                    edge_point + (arriving >> 1),
                ]);
                if !last {
                    child.corner_half_edges.extend_from_slice(&[
                        2 * leaving,
                        2 * (inner + corner as u32),
                        2 * (inner + before as u32) + 1,
                        2 * (arriving ^ 1) + 1,
                    ]);
                }
                before = corner;
            }
        }
    }

    fn split_boundary(&self) -> Result<Vec<BoundaryEdge>, OutOfMemory> {
        let edge_point = |half_edge: u32| self.vertex_count + (half_edge >> 1);
        let halves = |parent: &BoundaryEdge| {
            let middle = edge_point(parent.half_edge);
            let first = 2 * parent.half_edge;
            [
                BoundaryEdge {
                    half_edge: first,
                    source: parent.source,
                    target: middle,
                    previous: 2 * (parent.previous ^ 1) + 1,
                    previous_source: edge_point(parent.previous),
                },
                BoundaryEdge {
                    half_edge: 2 * (parent.half_edge ^ 1) + 1,
                    source: middle,
                    target: parent.target,
                    previous: first,
                    previous_source: parent.source,
                },
            ]
        };
        memory::collected(2 * self.boundary.len(), self.boundary.iter().flat_map(halves))
    }
}
