//! Walks round faces and vertices, and what follows from them.

use super::Mesh;
use super::ids::{FaceId, HalfEdgeId, VertexId};
use glam::DVec3;

impl Mesh {
    /// Vertices that exist, ascending.
    pub fn vertices(&self) -> impl DoubleEndedIterator<Item = VertexId> {
        (0..self.vertex_bound() as u32).map(VertexId).filter(|&v| self.has_vertex(v))
    }

    /// Half-edges that exist, ascending.
    pub fn half_edges(&self) -> impl DoubleEndedIterator<Item = HalfEdgeId> {
        (0..self.half_edge_bound() as u32).map(HalfEdgeId).filter(|&h| self.has_half_edge(h))
    }

    /// Numbers of vertices, edges and real faces that exist; no cost on a mesh without holes.
    pub fn counts(&self) -> [usize; 3] {
        if self.is_compact() {
            return [self.vertex_bound(), self.half_edge_bound() / 2, self.face_bound()];
        }
        [self.vertices().count(), self.edges().count(), self.faces().count()]
    }

    /// One half-edge (the even one) of each edge that exists, ascending.
    pub fn edges(&self) -> impl DoubleEndedIterator<Item = HalfEdgeId> {
        (0..self.half_edge_bound() as u32 / 2).map(|e| HalfEdgeId(2 * e)).filter(|&h| self.has_half_edge(h))
    }

    /// Real faces that exist, ascending.
    pub fn faces(&self) -> impl DoubleEndedIterator<Item = FaceId> {
        (0..self.face_bound() as u32).map(FaceId).filter(|&f| self.has_face(f))
    }

    /// Boundary loops that exist, ascending.
    pub fn boundary_loops(&self) -> impl DoubleEndedIterator<Item = FaceId> {
        (0..self.loop_bound() as u32).map(FaceId::boundary).filter(|&f| self.has_face(f))
    }

    /// The half-edges of a face or a boundary loop, counter-clockwise, from the one the face names.
    pub fn face_half_edges(&self, f: FaceId) -> impl Iterator<Item = HalfEdgeId> {
        let start = self.face_half_edge(f);
        std::iter::successors(Some(start), move |&h| {
            let next = self.next(h);
            (next != start).then_some(next)
        })
    }

    /// The vertices of a face, counter-clockwise.
    pub fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.face_half_edges(f).map(|h| self.source(h))
    }

    /// Number of edges of a face or loop.
    pub fn arity(&self, f: FaceId) -> usize {
        self.face_half_edges(f).count()
    }

    /// The half-edges out of `v`, clockwise, boundary ones included.
    pub fn outgoing(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> {
        let start = self.vertex_half_edge(v);
        std::iter::successors(start, move |&h| {
            let next = self.vertex_cw(h);
            (Some(next) != start).then_some(next)
        })
    }

    /// Number of edges at `v`.
    pub fn valence(&self, v: VertexId) -> usize {
        self.outgoing(v).count()
    }

    /// True when `v` lies on a boundary loop.
    pub fn is_boundary_vertex(&self, v: VertexId) -> bool {
        self.outgoing(v).any(|h| self.face(h).is_boundary())
    }

    /// True when one side of the edge of `h` is the outside of the mesh.
    pub fn is_boundary_edge(&self, h: HalfEdgeId) -> bool {
        self.face(h).is_boundary() || self.face(h.mate()).is_boundary()
    }

    /// The half-edge from `a` to `b`, if there is an edge between them.
    pub fn find_half_edge(&self, a: VertexId, b: VertexId) -> Option<HalfEdgeId> {
        if !self.has_vertex(a) {
            return None;
        }
        self.outgoing(a).find(|&h| self.target(h) == b)
    }

    /// [`find_half_edge`](Self::find_half_edge) for many pairs of vertices: walks round each vertex once, so that a
    /// pole with many pairs does not cost its square.
    pub fn find_edges(&self, pairs: &[(u32, u32)]) -> Vec<Option<HalfEdgeId>> {
        let mut order: Vec<(u32, u32, usize)> =
            pairs.iter().enumerate().map(|(i, &(a, b))| (a.min(b), a.max(b), i)).collect();
        order.sort_unstable();
        let mut found = vec![None; pairs.len()];
        for group in order.chunk_by(|x, y| x.0 == y.0) {
            let low = VertexId(group[0].0);
            if !self.has_vertex(low) {
                continue;
            }
            for h in self.outgoing(low) {
                let target = self.target(h).0;
                let first = group.partition_point(|pair| pair.1 < target);
                for pair in group[first..].iter().take_while(|pair| pair.1 == target) {
                    let forwards = pairs[pair.2].0 == low.0;
                    found[pair.2] = Some(if forwards { h } else { h.mate() });
                }
            }
        }
        found
    }

    /// The point at `t` in [0, 1] along `h`.
    pub fn point_along(&self, h: HalfEdgeId, t: f64) -> DVec3 {
        self.position(self.source(h)).lerp(self.position(self.target(h)), t)
    }

    /// Length of the edge of `h`.
    pub fn edge_length(&self, h: HalfEdgeId) -> f64 {
        self.position(self.source(h)).distance(self.position(self.target(h)))
    }

    /// Diagonal of the bounding box of all vertices: the size that tolerances refer to. 0 for an empty mesh.
    pub fn size(&self) -> f64 {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for v in self.vertices() {
            low = low.min(self.position(v));
            high = high.max(self.position(v));
        }
        if low.x <= high.x { low.distance(high) } else { 0.0 }
    }

    /// Faces that share a vertex with one of `faces`, these included; ascending, without repetition.
    pub fn grow_faces(&self, faces: &[FaceId]) -> Vec<FaceId> {
        let mut grown: Vec<FaceId> = faces
            .iter()
            .flat_map(|&f| self.face_vertices(f))
            .flat_map(|v| self.outgoing(v))
            .map(|h| self.face(h))
            .filter(|f| !f.is_boundary())
            .collect();
        grown.sort_unstable();
        grown.dedup();
        grown
    }
}
