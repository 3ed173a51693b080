//! Why a call failed, before it becomes an error handle.

use super::status::*;
use crate::job::Cancelled;
use crate::mesh::{Defect, Defects};
use crate::subdivision::RefineError;

/// What an error handle is made of.
#[derive(Debug)]
pub(super) struct Failure {
    pub(super) code: i32,
    pub(super) message: String,
    pub(super) places: Vec<Place>,
}

/// One place that an error speaks of, and what is wrong there.
#[derive(Debug)]
pub(super) struct Place {
    pub(super) location: Location,
    pub(super) message: String,
}

/// Where a place is. Numbers of elements are 0-based.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Location {
    Whole,
    Vertex(u32),
    /// An edge by its two vertices.
    Edge(u32, u32),
    Face(u32),
}

impl Failure {
    pub(super) fn new(code: i32, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), places: Vec::new() }
    }

    pub(super) fn argument(message: impl Into<String>) -> Self {
        Self::new(WELT_ERROR_ARGUMENT, message)
    }
}

impl From<Defects> for Failure {
    fn from(defects: Defects) -> Self {
        let place = |defect: &Defect| Place {
            message: defect.to_string(),
            location: match *defect {
                Defect::SizeMismatch { .. } | Defect::TooLarge { .. } => Location::Whole,
                Defect::TooFewVertices { face, .. }
                | Defect::VertexOutOfRange { face, .. }
                | Defect::RepeatedVertex { face, .. } => Location::Face(face),
                Defect::NotFinite { vertex } | Defect::SeparateFans { vertex, .. } => {
                    Location::Vertex(vertex)
                }
                Defect::EdgeWithManyFaces { edge, .. } | Defect::InconsistentOrientation { edge, .. } => {
                    Location::Edge(edge.0, edge.1)
                }
            },
        };
        let code = match defects.0.as_slice() {
            [Defect::TooLarge { .. }] => WELT_ERROR_TOO_LARGE,
            [Defect::SizeMismatch { .. }] => WELT_ERROR_ARGUMENT,
            _ => WELT_ERROR_MESH,
        };
        Self { code, message: defects.to_string(), places: defects.0.iter().map(place).collect() }
    }
}

impl From<RefineError> for Failure {
    fn from(error: RefineError) -> Self {
        Self::new(WELT_ERROR_TOO_LARGE, error.to_string())
    }
}

impl From<Cancelled> for Failure {
    fn from(cancelled: Cancelled) -> Self {
        Self::new(WELT_ERROR_CANCELLED, cancelled.to_string())
    }
}
