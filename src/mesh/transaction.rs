//! Transactions: every change to a mesh inside one can be taken back.

use super::ids::{FaceId, HalfEdgeId, Node, VertexId};
use super::log::{Change, Checkpoint};
use super::{HalfEdge, Mesh, set_or_remove};

impl Mesh {
    /// Opens a transaction. Transactions nest; close each with [`commit`](Self::commit) or
    /// [`rollback`](Self::rollback). Closing an outer one closes those inside it.
    pub fn begin(&mut self) -> Checkpoint {
        let checkpoint = self.log_position();
        self.log.depth += 1;
        checkpoint
    }

    /// Keeps what was done since `checkpoint`.
    pub fn commit(&mut self, checkpoint: Checkpoint) {
        self.log.depth = checkpoint.depth;
        if self.log.depth == 0 {
            self.log.changes.clear();
            self.log.positions.clear();
            self.log.values.clear();
        }
    }

    /// Takes back everything done since `checkpoint`: topology, positions, attributes, links, sharpness.
    pub fn rollback(&mut self, checkpoint: Checkpoint) {
        while self.log.changes.len() > checkpoint.changes {
            if let Some(change) = self.log.changes.pop() {
                self.undo(change);
            }
        }
        self.commit(checkpoint);
    }

    fn undo(&mut self, change: Change) {
        match change {
            Change::HalfEdge { id, old } => self.half_edges[id as usize] = old,
            Change::VertexHalfEdge { id, old } => self.vertices[id as usize] = old,
            Change::FaceHalfEdge { id, old } => self.face_table(FaceId(id))[FaceId(id).index()] = old,
            Change::Position { id } => {
                if let Some(old) = self.log.positions.pop() {
                    self.positions[id as usize] = old;
                }
            }
            Change::EdgeAdded => {
                self.half_edges.truncate(self.half_edges.len() - 2);
                if !self.corner_texcoords.is_empty() {
                    self.corner_texcoords.truncate(self.half_edges.len());
                }
            }
            Change::VertexAdded => {
                self.vertices.pop();
                self.positions.pop();
            }
            Change::FaceAdded => {
                self.faces.pop();
                self.face_parents.pop();
                if !self.face_sets.is_empty() {
                    self.face_sets.pop();
                }
            }
            Change::HoleAdded => self.holes -= 1,
            Change::Attribute { node, name } => {
                if let Some(old) = self.log.values.pop() {
                    self.attributes.set(node, name, old);
                }
            }
            Change::Link { from, label, to, added } => {
                self.attributes.set_link(from, label, to, !added);
            }
            Change::EdgeSharpness { edge, old } => {
                set_or_remove(&mut self.edge_sharpness, edge, old);
            }
            Change::VertexSharpness { vertex, old } => {
                set_or_remove(&mut self.vertex_sharpness, vertex, old);
            }
            Change::CornerTexcoord { id, old } => self.corner_texcoords[id as usize] = old,
            Change::Subdivision { old } => self.subdivision = old,
            Change::HoleFace { face, was } => self.write_hole(face, was),
        }
    }

    /// Half-edges whose connectivity changed since `checkpoint`, in order of change, with repetitions; some may have
    /// been removed since. Empty outside of a transaction.
    pub fn touched_since(&self, checkpoint: Checkpoint) -> impl Iterator<Item = HalfEdgeId> {
        self.log.changes[checkpoint.changes.min(self.log.changes.len())..].iter().filter_map(|change| {
            match change {
                Change::HalfEdge { id, .. } => Some(HalfEdgeId(*id)),
                _ => None,
            }
        })
    }

    /// A checkpoint at the present end of the log, for [`touched_since`](Self::touched_since) only.
    pub fn log_position(&self) -> Checkpoint {
        Checkpoint { changes: self.log.changes.len(), depth: self.log.depth }
    }

    /// Nodes whose attributes or links changed since `checkpoint`, in order of change, with repetitions.
    pub fn annotated_since(&self, checkpoint: Checkpoint) -> impl Iterator<Item = Node> {
        self.log.changes[checkpoint.changes.min(self.log.changes.len())..]
            .iter()
            .flat_map(|change| match change {
                Change::Attribute { node, .. } => [Some(*node), None],
                Change::Link { from, to, .. } => [Some(*from), Some(*to)],
                _ => [None, None],
            })
            .flatten()
    }

    /// Vertices that were moved since `checkpoint`, in order of change, with repetitions.
    pub fn moved_since(&self, checkpoint: Checkpoint) -> impl Iterator<Item = VertexId> {
        self.log.changes[checkpoint.changes.min(self.log.changes.len())..].iter().filter_map(|change| {
            match change {
                Change::Position { id } => Some(VertexId(*id)),
                _ => None,
            }
        })
    }

    /// One more id that nothing uses any longer.
    pub(super) fn add_hole(&mut self) {
        self.holes += 1;
        self.log.push(Change::HoleAdded);
    }

    // The Euler operators change the tables only through these.

    pub(super) fn write_half_edge(&mut self, h: HalfEdgeId, change: impl FnOnce(&mut HalfEdge)) {
        let old = self.half_edges[h.index()];
        self.log.push(Change::HalfEdge { id: h.0, old });
        change(&mut self.half_edges[h.index()]);
    }

    pub(super) fn write_vertex(&mut self, v: VertexId, half_edge: u32) {
        let old = std::mem::replace(&mut self.vertices[v.index()], half_edge);
        self.log.push(Change::VertexHalfEdge { id: v.0, old });
    }

    pub(super) fn write_face(&mut self, f: FaceId, half_edge: u32) {
        let old = std::mem::replace(&mut self.face_table(f)[f.index()], half_edge);
        self.log.push(Change::FaceHalfEdge { id: f.0, old });
    }

    pub(super) fn write_corner_texcoord(&mut self, h: HalfEdgeId, texcoord: u32) {
        if let Some(slot) = self.corner_texcoords.get_mut(h.index()) {
            let old = std::mem::replace(slot, texcoord);
            self.log.push(Change::CornerTexcoord { id: h.0, old });
        }
    }

    pub(super) fn face_table(&mut self, f: FaceId) -> &mut Vec<u32> {
        if f.is_boundary() { &mut self.loops } else { &mut self.faces }
    }
}
