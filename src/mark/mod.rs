//! Marks: which edges a feature crosses, and where.
//!
//! A [`Selector`] is what a user writes (`ring:12,13`); resolved on a mesh it gives [`Mark`]s, one per crossed edge.
//! [`place`] stores them as attributes on both half-edges of each edge (paper, section 6: "the designer marks the
//! affected edges"), where the rules find them.

mod curve;
mod file;
mod orient;
pub mod parity;
mod path;
mod resolve;
mod selector;

pub use curve::{Course, Curve};
pub use orient::{Chains, orient};
pub use resolve::{MarkError, Selection, StopReason, StripEnd};
pub use selector::{Selector, SelectorError, Shape};

use crate::fault;
use crate::mesh::{HalfEdgeId, Mesh, Node, Value};

/// The kind of a mark that names none, as in the paper's figures.
pub const DEFAULT_KIND: &str = "red";

/// An edge that a feature crosses.
#[derive(Clone, PartialEq, Debug)]
pub struct Mark {
    /// The edge, in the direction in which `t` counts.
    pub half_edge: HalfEdgeId,
    /// Where the middle of the feature crosses, in (0, 1) along `half_edge`.
    pub t: f64,
    /// The kind of the mark: which feature it asks for.
    pub kind: String,
    /// Extent of the edge across the feature, model units, where a curve decides it; otherwise it follows from the
    /// faces beside the edge.
    pub breadth: Option<f64>,
}

/// Sets `color` and `t` on both half-edges of every mark.
pub fn place(mesh: &mut Mesh, marks: &[Mark]) {
    let (color, t) = (mesh.intern("color"), mesh.intern("t"));
    for mark in marks {
        for (h, along) in [(mark.half_edge, mark.t), (mark.half_edge.mate(), 1.0 - mark.t)] {
            let node = Node::HalfEdge(h);
            mesh.set_attribute(node, color, Some(Value::text(&mark.kind)));
            mesh.set_attribute(node, t, Some(Value::Number(along)));
            fault::point("mark");
        }
    }
}
