//! The undo log: old values in the order in which they were overwritten.

use super::attributes::Symbol;
use super::ids::Node;
use super::value::Value;
use glam::DVec3;

/// A place in the log to roll back to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[must_use = "a checkpoint is given back to `commit` or `rollback`"]
pub struct Checkpoint {
    /// Length of the log.
    pub(crate) changes: usize,
    /// Transactions that were open around it.
    pub(crate) depth: u32,
}

/// One change, with what is needed to take it back. Bulky old values stand on stacks of their own, so that the
/// common topological entries stay small.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Change {
    HalfEdge { id: u32, old: super::HalfEdge },
    VertexHalfEdge { id: u32, old: u32 },
    FaceHalfEdge { id: u32, old: u32 },
    Position { id: u32 },
    EdgeAdded,
    VertexAdded,
    FaceAdded,
    HoleAdded,
    Attribute { node: Node, name: Symbol },
    Link { from: Node, label: Symbol, to: Node, added: bool },
    EdgeSharpness { edge: u32, old: f32 },
    VertexSharpness { vertex: u32, old: f32 },
    CornerTexcoord { id: u32, old: u32 },
    Subdivision { old: super::SubdivisionOptions },
    HoleFace { face: u32, was: bool },
}

#[derive(Clone, Default, Debug)]
pub(crate) struct Log {
    pub(crate) changes: Vec<Change>,
    pub(crate) positions: Vec<DVec3>,
    pub(crate) values: Vec<Option<Value>>,
    /// Open transactions; nothing is recorded outside of one.
    pub(crate) depth: u32,
}

impl Log {
    pub(crate) fn push(&mut self, change: Change) {
        if self.depth > 0 {
            self.changes.push(change);
        }
    }
}
