//! Euler operators: the only way to change topology. Each keeps V - E + F - R = 2(S - H).
//!
//! Conventions are those of GML (Havemann 2005): a half-edge `e` runs from its **source** A to B with its face on the
//! left; `vertexCW(e) = next(mate e)`. The drawings show faces seen from outside.
//!
//! New edges and vertices carry no attributes. An edge that is split keeps its sharpness in both pieces.

use super::ids::{DEAD, FaceId, HalfEdgeId, NONE, Node, VertexId};
use super::log::Change;
use super::{HalfEdge, Mesh, is_place};
use glam::DVec3;
use std::fmt;

/// Why an Euler operator refused. The mesh is as it was.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EulerError {
    /// The half-edge was removed or never existed.
    NoSuchHalfEdge(HalfEdgeId),
    /// `makeEV` needs two half-edges out of one vertex.
    DifferentVertices(HalfEdgeId, VertexId, HalfEdgeId, VertexId),
    /// `makeEF` needs two half-edges of one face.
    DifferentFaces(HalfEdgeId, HalfEdgeId),
    /// `makeEF` would make an edge from a vertex to itself.
    LoopEdge(HalfEdgeId, HalfEdgeId, VertexId),
    /// The new edge would have the outside of the mesh on both sides.
    Outside(HalfEdgeId),
    /// `killEF` needs two different faces.
    SameFace(HalfEdgeId),
    /// `killEF` would join a face with the outside.
    BoundaryFace(HalfEdgeId),
    /// `killEV` would remove the last edge of a shell.
    LastEdge(HalfEdgeId),
    /// `killEV` would make an edge from a vertex to itself.
    WouldLoop(HalfEdgeId),
    /// `killVEFS` needs a shell of one edge.
    NotSingleEdge(HalfEdgeId),
    /// A position that is not a finite point.
    NotFinite,
    /// The mesh is full.
    Full,
}

impl EulerError {
    /// The message, with elements called as `name` calls them.
    pub fn message(self, name: impl Fn(Node) -> String) -> String {
        let edge = |h: HalfEdgeId| name(Node::HalfEdge(h));
        let vertex = |v: VertexId| name(Node::Vertex(v));
        match self {
            Self::NoSuchHalfEdge(h) => format!("{} does not exist", edge(h)),
            Self::DifferentVertices(a, v, b, w) => format!(
                "makeEV needs two half-edges out of the same vertex; {} leaves {} and {} leaves {}",
                edge(a),
                vertex(v),
                edge(b),
                vertex(w)
            ),
            Self::DifferentFaces(a, b) => format!(
                "makeEF needs two half-edges of the same face; {} and {} lie in different faces",
                edge(a),
                edge(b)
            ),
            Self::LoopEdge(a, b, v) => format!(
                "makeEF needs two different vertices; {} and {} both start at {}",
                edge(a),
                edge(b),
                vertex(v)
            ),
            Self::Outside(h) => format!(
                "an edge needs a face; at {} both sides of the new edge would be outside of the mesh",
                edge(h)
            ),
            Self::SameFace(h) => {
                format!(
                    "killEF needs an edge between two faces; both sides of {} lie in the same face",
                    edge(h)
                )
            }
            Self::BoundaryFace(h) => {
                format!("killEF cannot join a face with the outside of the mesh at {}", edge(h))
            }
            Self::LastEdge(h) => {
                format!("killEV cannot remove {}, the only edge of its shell; use killVEFS", edge(h))
            }
            Self::WouldLoop(h) => {
                format!("killEV cannot collapse {}: another edge joins its two vertices", edge(h))
            }
            Self::NotSingleEdge(h) => {
                format!("killVEFS needs a shell of a single edge; {} has neighbours", edge(h))
            }
            Self::NotFinite => "a vertex needs coordinates from -1e50 to 1e50".to_owned(),
            Self::Full => "the mesh has no ids left for new elements".to_owned(),
        }
    }
}

/// Elements by their ids.
impl fmt::Display for EulerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message(|node| match node {
            Node::Vertex(v) => format!("vertex {}", v.0),
            Node::HalfEdge(h) => format!("half-edge {}", h.0),
            Node::Face(face) => format!("face {}", face.index()),
        }))
    }
}

impl std::error::Error for EulerError {}

impl Mesh {
    /// A new shell of one edge and one face; the result runs `p1` -> `p0`.
    ///
    /// ```text
    ///    p1 o-------------->o p0      one face, all around
    /// ```
    ///
    /// # Errors
    /// [`EulerError::NotFinite`], [`EulerError::Full`].
    pub fn make_vefs(&mut self, p0: DVec3, p1: DVec3) -> Result<HalfEdgeId, EulerError> {
        self.check_room()?;
        if !is_place(p0) || !is_place(p1) {
            return Err(EulerError::NotFinite);
        }
        let (v0, v1) = (self.add_vertex(p0), self.add_vertex(p1));
        let e = self.add_edge();
        let m = e.mate();
        let face = self.add_face(None);
        self.write_half_edge(e, |r| {
            *r = HalfEdge { next: m.0, prev: m.0, source: v1.0, face: face.0 };
        });
        self.write_half_edge(m, |r| {
            *r = HalfEdge { next: e.0, prev: e.0, source: v0.0, face: face.0 };
        });
        self.write_vertex(v1, e.0);
        self.write_vertex(v0, m.0);
        self.write_face(face, e.0);
        Ok(e)
    }

    /// Undoes [`make_vefs`](Self::make_vefs): removes a shell that is a single edge.
    ///
    /// # Errors
    /// [`EulerError::NoSuchHalfEdge`], [`EulerError::NotSingleEdge`].
    pub fn kill_vefs(&mut self, e: HalfEdgeId) -> Result<(), EulerError> {
        self.check(e)?;
        let m = e.mate();
        if self.next(e) != m || self.next(m) != e {
            return Err(EulerError::NotSingleEdge(e));
        }
        let (v0, v1, face) = (self.source(m), self.source(e), self.face(e));
        self.remove_edge(e);
        self.remove_vertex(v0);
        self.remove_vertex(v1);
        self.remove_face(face);
        Ok(())
    }

    /// Splits vertex A: the half-edges from `e0` going `vertexCW` up to but without `e1` move to a new vertex P.
    /// The result `n` runs P -> A and `next(n) = e1`. With `e0 == e1` nothing moves (see
    /// [`make_ev_one`](Self::make_ev_one)). With `e1 = vertexCW(e0)` just `e0` moves: its edge is split.
    ///
    /// ```text
    ///      \   | e0                  \     P o--e0
    ///       \  |/                     \    n |  \
    ///     ---- A ---- e1    ==>     ---- A <-+    (moved)
    ///          |                         |\
    ///          |                         | e1
    /// ```
    ///
    /// # Errors
    /// [`EulerError::NoSuchHalfEdge`], [`EulerError::DifferentVertices`], [`EulerError::NotFinite`],
    /// [`EulerError::Outside`], [`EulerError::Full`].
    pub fn make_ev(
        &mut self,
        e0: HalfEdgeId,
        e1: HalfEdgeId,
        position: DVec3,
    ) -> Result<HalfEdgeId, EulerError> {
        self.check(e0)?;
        self.check(e1)?;
        self.check_room()?;
        let a = self.source(e0);
        if a != self.source(e1) {
            return Err(EulerError::DifferentVertices(e0, a, e1, self.source(e1)));
        }
        if !is_place(position) {
            return Err(EulerError::NotFinite);
        }
        if self.face(e0).is_boundary() && self.face(e1).is_boundary() {
            return Err(EulerError::Outside(e0));
        }
        let sharpness = self.edge_sharpness(e0);
        let splits_edge = e0 != e1 && self.vertex_cw(e0) == e1;
        let p = self.add_vertex(position);
        let n = self.add_edge();
        let m = n.mate();
        let (before0, before1) = (self.prev(e0), self.prev(e1));
        let (face0, face1) = (self.face(e0), self.face(e1));

        let mut moved = e0;
        while moved != e1 {
            let following = self.vertex_cw(moved);
            self.write_half_edge(moved, |r| r.source = p.0);
            moved = following;
        }
        if e0 == e1 {
            self.write_half_edge(n, |r| {
                *r = HalfEdge { next: e1.0, prev: m.0, source: p.0, face: face1.0 };
            });
            self.write_half_edge(m, |r| {
                *r = HalfEdge { next: n.0, prev: before0.0, source: a.0, face: face0.0 };
            });
            self.write_half_edge(before0, |r| r.next = m.0);
            self.write_half_edge(e1, |r| r.prev = n.0);
        } else {
            self.write_half_edge(n, |r| {
                *r = HalfEdge { next: e1.0, prev: before1.0, source: p.0, face: face1.0 };
            });
            self.write_half_edge(m, |r| {
                *r = HalfEdge { next: e0.0, prev: before0.0, source: a.0, face: face0.0 };
            });
            self.write_half_edge(before1, |r| r.next = n.0);
            self.write_half_edge(e1, |r| r.prev = n.0);
            self.write_half_edge(before0, |r| r.next = m.0);
            self.write_half_edge(e0, |r| r.prev = m.0);
            // The corner at A in e0's face now starts with m.
            if let Some(&texcoord) = self.corner_texcoords.get(e0.index()) {
                self.write_corner_texcoord(m, texcoord);
                self.write_corner_texcoord(e0, NONE);
            }
        }
        self.write_vertex(p, n.0);
        self.write_vertex(a, m.0);
        if splits_edge && sharpness > 0.0 {
            self.set_edge_sharpness(n, sharpness);
        }
        Ok(n)
    }

    /// Adds an antenna: a vertex P joined to the source A of `e` inside `e`'s face. The result runs P -> A.
    ///
    /// ```text
    ///     A o-----e---->        A o-----e---->
    ///       |            ==>      |\ n
    ///       |                     | o P
    /// ```
    ///
    /// # Errors
    /// As [`make_ev`](Self::make_ev).
    pub fn make_ev_one(&mut self, e: HalfEdgeId, position: DVec3) -> Result<HalfEdgeId, EulerError> {
        self.make_ev(e, e, position)
    }

    /// Splits the edge of `e` (A -> B) at a new vertex P. Afterwards `e` runs P -> B; the result runs A -> P before
    /// it in the same face. (GML: `e dup vertexCW p makeEV edgemate`.)
    ///
    /// # Errors
    /// As [`make_ev`](Self::make_ev).
    pub fn split_edge(&mut self, e: HalfEdgeId, position: DVec3) -> Result<HalfEdgeId, EulerError> {
        self.check(e)?;
        Ok(self.make_ev(e, self.vertex_cw(e), position)?.mate())
    }

    /// Splits a face by an edge. The result `n` runs source(`e1`) -> source(`e0`) in the **new** face
    /// `e0 .. prev(e1), n`; its mate stays in the old face. The new face takes over group and material.
    ///
    /// ```text
    ///      o-------o              o-------o
    ///      |       | ^            | new  /| ^
    ///      |       | |      ==>   |    /n | |
    ///   e1 |       |         e1   |  v    |       (e0 starts where n ends)
    ///      o-------o              o-------o
    ///           e0 ->
    /// ```
    ///
    /// # Errors
    /// [`EulerError::NoSuchHalfEdge`], [`EulerError::DifferentFaces`], [`EulerError::LoopEdge`],
    /// [`EulerError::Outside`], [`EulerError::Full`].
    pub fn make_ef(&mut self, e0: HalfEdgeId, e1: HalfEdgeId) -> Result<HalfEdgeId, EulerError> {
        self.check(e0)?;
        self.check(e1)?;
        self.check_room()?;
        let old_face = self.face(e0);
        if old_face != self.face(e1) {
            return Err(EulerError::DifferentFaces(e0, e1));
        }
        if old_face.is_boundary() {
            return Err(EulerError::Outside(e0));
        }
        let (a, c) = (self.source(e0), self.source(e1));
        if a == c {
            return Err(EulerError::LoopEdge(e0, e1, a));
        }
        let n = self.add_edge();
        let m = n.mate();
        let (before0, before1) = (self.prev(e0), self.prev(e1));
        let face = self.add_face(Some(old_face));
        self.write_half_edge(n, |r| {
            *r = HalfEdge { next: e0.0, prev: before1.0, source: c.0, face: face.0 };
        });
        self.write_half_edge(m, |r| {
            *r = HalfEdge { next: e1.0, prev: before0.0, source: a.0, face: old_face.0 };
        });
        self.write_half_edge(before1, |r| r.next = n.0);
        self.write_half_edge(e0, |r| r.prev = n.0);
        self.write_half_edge(before0, |r| r.next = m.0);
        self.write_half_edge(e1, |r| r.prev = m.0);
        let mut h = e0;
        while h != n {
            self.write_half_edge(h, |r| r.face = face.0);
            h = self.next(h);
        }
        self.write_face(face, n.0);
        self.write_face(old_face, m.0);
        if !self.corner_texcoords.is_empty() {
            // Both faces keep the texture coordinates of the corners where the new edge ends.
            self.write_corner_texcoord(n, self.corner_texcoords[e1.index()]);
            self.write_corner_texcoord(m, self.corner_texcoords[e0.index()]);
        }
        Ok(n)
    }

    /// Removes the edge of `e` and `e`'s face, which becomes part of the face on the other side.
    /// Undoes [`make_ef`](Self::make_ef) when given its result.
    ///
    /// ```text
    ///      o-------o              o-------o
    ///      | face(e)|             |       |
    ///      o---e-->o       ==>    |       |
    ///      | stays |              |       |
    ///      o-------o              o-------o
    /// ```
    ///
    /// # Errors
    /// [`EulerError::NoSuchHalfEdge`], [`EulerError::SameFace`], [`EulerError::BoundaryFace`] (one side is the
    /// outside of the mesh).
    pub fn kill_ef(&mut self, e: HalfEdgeId) -> Result<(), EulerError> {
        self.check(e)?;
        let m = e.mate();
        let (gone, stays) = (self.face(e), self.face(m));
        if gone == stays {
            return Err(EulerError::SameFace(e));
        }
        if gone.is_boundary() != stays.is_boundary() {
            return Err(EulerError::BoundaryFace(e));
        }
        let (en, ep, mn, mp) = (self.next(e), self.prev(e), self.next(m), self.prev(m));
        let mut h = en;
        while h != e {
            self.write_half_edge(h, |r| r.face = stays.0);
            h = self.next(h);
        }
        self.write_half_edge(ep, |r| r.next = mn.0);
        self.write_half_edge(mn, |r| r.prev = ep.0);
        self.write_half_edge(mp, |r| r.next = en.0);
        self.write_half_edge(en, |r| r.prev = mp.0);
        self.write_vertex(self.source(e), mn.0);
        self.write_vertex(self.source(m), en.0);
        self.write_face(stays, mn.0);
        self.remove_edge(e);
        self.remove_face(gone);
        Ok(())
    }

    /// Removes the edge of `e` (P -> A) and its source P; what left P leaves A afterwards.
    /// Undoes [`make_ev`](Self::make_ev) when given its result.
    ///
    /// ```text
    ///      P o----                ---- A ----
    ///        | e          ==>        / | \
    ///    --- A ---
    /// ```
    ///
    /// # Errors
    /// [`EulerError::NoSuchHalfEdge`], [`EulerError::LastEdge`], [`EulerError::WouldLoop`] (another edge joins the
    /// two vertices).
    pub fn kill_ev(&mut self, e: HalfEdgeId) -> Result<(), EulerError> {
        self.check(e)?;
        let m = e.mate();
        if self.next(e) == m && self.next(m) == e {
            return Err(EulerError::LastEdge(e));
        }
        let (p, a) = (self.source(e), self.source(m));
        if self.outgoing(p).any(|h| h != e && self.target(h) == a) {
            return Err(EulerError::WouldLoop(e));
        }
        let (en, ep, mn, mp) = (self.next(e), self.prev(e), self.next(m), self.prev(m));
        let (face_e, face_m) = (self.face(e), self.face(m));
        let moved: smallvec::SmallVec<[HalfEdgeId; 8]> = self.outgoing(p).filter(|&h| h != e).collect();
        for h in moved {
            self.write_half_edge(h, |r| r.source = a.0);
        }
        // A survivor at A and in each face; an antenna touches one face only.
        let (at_a, in_e, in_m);
        if ep == m {
            // P is the tip of an antenna: A -> P -> A leaves the face.
            self.write_half_edge(mp, |r| r.next = en.0);
            self.write_half_edge(en, |r| r.prev = mp.0);
            (at_a, in_e, in_m) = (en, en, en);
        } else if en == m {
            // A is the tip: P -> A -> P leaves the face, and A takes P's place.
            self.write_half_edge(ep, |r| r.next = mn.0);
            self.write_half_edge(mn, |r| r.prev = ep.0);
            (at_a, in_e, in_m) = (mn, mn, mn);
        } else {
            self.write_half_edge(ep, |r| r.next = en.0);
            self.write_half_edge(en, |r| r.prev = ep.0);
            self.write_half_edge(mp, |r| r.next = mn.0);
            self.write_half_edge(mn, |r| r.prev = mp.0);
            (at_a, in_e, in_m) = (en, en, mn);
            // The corner at A in m's face started with m; it starts with mn now.
            if let Some(&texcoord) = self.corner_texcoords.get(m.index()) {
                self.write_corner_texcoord(mn, texcoord);
            }
        }
        self.write_vertex(a, at_a.0);
        self.write_face(face_e, in_e.0);
        self.write_face(face_m, in_m.0);
        self.remove_edge(e);
        self.remove_vertex(p);
        Ok(())
    }

    fn check(&self, h: HalfEdgeId) -> Result<(), EulerError> {
        if self.has_half_edge(h) { Ok(()) } else { Err(EulerError::NoSuchHalfEdge(h)) }
    }

    fn check_room(&self) -> Result<(), EulerError> {
        const ROOM: usize = (1 << 31) - 4;
        if self.half_edges.len() < ROOM && self.vertices.len() < ROOM {
            Ok(())
        } else {
            Err(EulerError::Full)
        }
    }

    fn add_vertex(&mut self, position: DVec3) -> VertexId {
        self.vertices.push(NONE);
        self.positions.push(position);
        self.log.push(Change::VertexAdded);
        VertexId(self.vertices.len() as u32 - 1)
    }

    fn add_edge(&mut self) -> HalfEdgeId {
        self.half_edges.extend([HalfEdge::UNSET; 2]);
        if !self.corner_texcoords.is_empty() {
            self.corner_texcoords.extend([NONE; 2]);
        }
        self.log.push(Change::EdgeAdded);
        HalfEdgeId(self.half_edges.len() as u32 - 2)
    }

    /// A new face beside `like`, with its group and material.
    fn add_face(&mut self, like: Option<FaceId>) -> FaceId {
        let id = self.faces.len() as u32;
        self.faces.push(NONE);
        self.face_parents.push(like.map_or(id, |f| f.0));
        if !self.face_sets.is_empty() {
            let set = like.map_or(0, |f| self.face_sets[f.index()]);
            self.face_sets.push(set);
        }
        self.log.push(Change::FaceAdded);
        self.set_hole(FaceId(id), like.is_some_and(|f| self.is_hole(f)));
        FaceId(id)
    }

    fn remove_edge(&mut self, h: HalfEdgeId) {
        self.strip(Node::HalfEdge(h));
        self.strip(Node::HalfEdge(h.mate()));
        if self.edge_sharpness(h) > 0.0 {
            self.set_edge_sharpness(h, 0.0);
        }
        self.write_half_edge(h, |r| *r = HalfEdge::DEAD);
        self.write_half_edge(h.mate(), |r| *r = HalfEdge::DEAD);
        self.add_hole();
    }

    fn remove_vertex(&mut self, v: VertexId) {
        self.strip(Node::Vertex(v));
        if self.vertex_sharpness(v) > 0.0 {
            self.set_vertex_sharpness(v, 0.0);
        }
        self.write_vertex(v, DEAD);
        self.add_hole();
    }

    fn remove_face(&mut self, f: FaceId) {
        self.strip(Node::Face(f));
        self.set_hole(f, false);
        self.write_face(f, DEAD);
        self.add_hole();
    }

    /// Takes attributes and links off a node that is about to go.
    fn strip(&mut self, node: Node) {
        if self.attributes.is_empty() {
            return;
        }
        for name in self.attributes.names_of(node) {
            self.set_attribute(node, name, None);
        }
        for (from, label, to) in self.attributes.links_of(node) {
            self.set_link(from, label, to, false);
        }
    }
}
