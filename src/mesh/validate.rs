//! Checks that the tables describe a mesh.

use super::Mesh;
use super::ids::{DEAD, FaceId, HalfEdgeId, NONE, Node, VertexId};

/// A broken invariant, in words, with the ids it concerns.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{0}")]
pub struct Violation(pub String);

macro_rules! require {
    ($condition:expr, $($message:tt)*) => {
        if !$condition {
            return Err(Violation(format!($($message)*)));
        }
    };
}

impl Mesh {
    /// Checks every table against every other; linear time.
    ///
    /// # Errors
    /// The first broken invariant.
    pub fn validate(&self) -> Result<(), Violation> {
        self.validate_half_edges()?;
        self.validate_cycles()?;
        self.validate_rings()
    }

    /// Checks in addition that the mesh can serve as a control mesh: every real face has at least three vertices,
    /// all different.
    ///
    /// # Errors
    /// The first face that is none.
    pub fn validate_control_mesh(&self) -> Result<(), Violation> {
        self.validate()?;
        for f in self.faces() {
            self.validate_control_face(f)?;
        }
        Ok(())
    }

    /// The part of [`validate_control_mesh`](Self::validate_control_mesh) that concerns one face.
    ///
    /// # Errors
    /// The face has fewer than three vertices, or one of them twice.
    pub fn validate_control_face(&self, f: FaceId) -> Result<(), Violation> {
        let mut vertices: smallvec::SmallVec<[VertexId; 8]> = self.face_vertices(f).collect();
        require!(
            vertices.len() >= 3,
            "{} has only {} vertices",
            self.describe(Node::Face(f)),
            vertices.len()
        );
        vertices.sort_unstable();
        if let Some(twice) = vertices.windows(2).find(|pair| pair[0] == pair[1]) {
            let [face, vertex] = [Node::Face(f), Node::Vertex(twice[0])].map(|node| self.describe(node));
            return Err(Violation(format!("{face} meets {vertex} twice")));
        }
        Ok(())
    }

    fn validate_half_edges(&self) -> Result<(), Violation> {
        require!(self.half_edges.len().is_multiple_of(2), "odd number of half-edges");
        for id in 0..self.half_edges.len() as u32 {
            let h = HalfEdgeId(id);
            let record = self.half_edges[h.index()];
            let mate = self.half_edges[h.mate().index()];
            require!(
                (record.source == DEAD) == (mate.source == DEAD),
                "half-edge {id} was removed without its mate"
            );
            if record.source == DEAD {
                continue;
            }
            require!(self.has_vertex(VertexId(record.source)), "half-edge {id} leaves no vertex");
            require!(self.has_face(FaceId(record.face)), "half-edge {id} has no face");
            for other in [record.next, record.prev] {
                require!(self.has_half_edge(HalfEdgeId(other)), "half-edge {id} has no neighbour");
            }
            require!(self.prev(self.next(h)) == h, "next and prev disagree at half-edge {id}");
            require!(self.source(self.next(h)) == self.target(h), "half-edge {id} does not lead to its next");
            require!(
                self.face(self.next(h)) == self.face(h),
                "half-edge {id} and its next lie in different faces"
            );
            require!(self.source(h) != self.target(h), "half-edge {id} is a loop");
            require!(
                !(self.face(h).is_boundary() && self.face(h.mate()).is_boundary()),
                "the edge of half-edge {id} has no face"
            );
        }
        Ok(())
    }

    /// Every half-edge lies on the cycle of its face.
    fn validate_cycles(&self) -> Result<(), Violation> {
        let mut on_cycle = 0;
        for f in self.faces().chain(self.boundary_loops()) {
            let start = self.face_half_edge(f);
            require!(self.has_half_edge(start), "face {} has no half-edge", f.index());
            require!(self.face(start) == f, "face {} names a foreign half-edge", f.index());
            on_cycle += self.arity(f);
        }
        let alive = self.half_edges().count();
        require!(on_cycle == alive, "{alive} half-edges but {on_cycle} on face cycles");
        Ok(())
    }

    /// Every half-edge lies on the ring of its source.
    fn validate_rings(&self) -> Result<(), Violation> {
        let mut on_ring = 0;
        for v in self.vertices() {
            require!(super::is_place(self.position(v)), "vertex {} is not at a finite place", v.0);
            let stored = self.vertices[v.index()];
            if stored == NONE {
                continue;
            }
            let h = HalfEdgeId(stored);
            require!(self.has_half_edge(h), "vertex {} names a missing half-edge", v.0);
            require!(self.source(h) == v, "vertex {} names a foreign half-edge", v.0);
            on_ring += self.valence(v);
        }
        let alive = self.half_edges().count();
        require!(on_ring == alive, "{alive} half-edges but {on_ring} on vertex rings");
        Ok(())
    }
}
