//! What is wrong with a mesh, element by element.

use crate::memory::OutOfMemory;
use serde::Serialize;
use std::fmt;

/// A thing the half-edge kernel cannot hold. Numbers are 0-based.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Defect {
    /// The sizes of the faces do not add up to the number of face vertices.
    SizeMismatch {
        /// Sum of the face sizes.
        promised: u64,
        /// Face vertices that are there.
        found: u64,
    },
    /// More elements than 31-bit ids can number.
    TooLarge {
        /// How many.
        count: u64,
    },
    /// There is no memory for a list of the mesh.
    NoMemory {
        /// Size of the list.
        bytes: u64,
    },
    /// A face with fewer than three vertices.
    TooFewVertices {
        /// The face.
        face: u32,
        /// Its vertex count.
        size: u32,
    },
    /// A face that names a vertex which is not there.
    VertexOutOfRange {
        /// The face.
        face: u32,
        /// The vertex it names.
        vertex: u32,
    },
    /// A face that names a vertex twice.
    RepeatedVertex {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// A vertex with a coordinate that is not finite or beyond [`MOST_COORDINATE`](super::MOST_COORDINATE).
    NotFinite {
        /// The vertex.
        vertex: u32,
    },
    /// An edge with more than two faces.
    EdgeWithManyFaces {
        /// Its vertices.
        edge: (u32, u32),
        /// Its faces.
        faces: Vec<u32>,
    },
    /// Two faces that run along their common edge in the same direction.
    InconsistentOrientation {
        /// The edge's vertices.
        edge: (u32, u32),
        /// The two faces.
        faces: Vec<u32>,
    },
    /// A vertex where fans of faces meet that share no edge.
    SeparateFans {
        /// The vertex.
        vertex: u32,
        /// How many fans.
        fans: u32,
    },
}

impl Defect {
    /// The same defect with the numbers that `vertex` and `face` give; each is called in the order of the fields.
    pub fn renumbered(self, vertex: impl Fn(u32) -> u32, mut face: impl FnMut(u32) -> u32) -> Self {
        let ends = |edge: (u32, u32)| (vertex(edge.0), vertex(edge.1));
        match self {
            Self::SizeMismatch { .. } | Self::TooLarge { .. } | Self::NoMemory { .. } => self,
            Self::TooFewVertices { face: f, size } => Self::TooFewVertices { face: face(f), size },
            Self::VertexOutOfRange { face: f, vertex: v } => {
                Self::VertexOutOfRange { face: face(f), vertex: vertex(v) }
            }
            Self::RepeatedVertex { face: f, vertex: v } => {
                Self::RepeatedVertex { face: face(f), vertex: vertex(v) }
            }
            Self::NotFinite { vertex: v } => Self::NotFinite { vertex: vertex(v) },
            Self::EdgeWithManyFaces { edge, faces } => {
                Self::EdgeWithManyFaces { edge: ends(edge), faces: faces.into_iter().map(face).collect() }
            }
            Self::InconsistentOrientation { edge, faces } => Self::InconsistentOrientation {
                edge: ends(edge),
                faces: faces.into_iter().map(face).collect(),
            },
            Self::SeparateFans { vertex: v, fans } => Self::SeparateFans { vertex: vertex(v), fans },
        }
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |ids: &[u32]| {
            const SHOWN: usize = 8;
            let shown: Vec<String> = ids.iter().take(SHOWN).map(u32::to_string).collect();
            shown.join(", ") + if ids.len() > SHOWN { ", ..." } else { "" }
        };
        match self {
            Self::SizeMismatch { promised, found } => {
                write!(f, "the face sizes add up to {promised} but there are {found} face vertices")
            }
            Self::TooLarge { count } => {
                write!(f, "{count} elements are more than a mesh can number (2^31 - 2)")
            }
            &Self::NoMemory { bytes } => OutOfMemory { bytes }.fmt(f),
            Self::TooFewVertices { face, size } => {
                write!(f, "face {face} has {size} vertices; a face needs at least 3")
            }
            Self::VertexOutOfRange { face, vertex } => {
                write!(f, "face {face} names vertex {vertex}, which does not exist")
            }
            Self::RepeatedVertex { face, vertex } => {
                write!(f, "face {face} names vertex {vertex} twice")
            }
            Self::NotFinite { vertex } => {
                write!(f, "vertex {vertex} has a coordinate that is not a number from -1e50 to 1e50")
            }
            Self::EdgeWithManyFaces { edge, faces } => write!(
                f,
                "edge {}-{} has {} faces ({}); a surface has at most 2",
                edge.0,
                edge.1,
                faces.len(),
                list(faces)
            ),
            Self::InconsistentOrientation { edge, faces } => write!(
                f,
                "faces {} run along edge {}-{} in the same direction; one of them is inside out",
                list(faces),
                edge.0,
                edge.1
            ),
            Self::SeparateFans { vertex, fans } => {
                write!(f, "{fans} fans of faces meet in vertex {vertex} without sharing an edge")
            }
        }
    }
}

/// The defects that keep polygons from becoming a [`Mesh`](super::Mesh), in a fixed order.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("{}", summary(.0))]
pub struct Defects(pub Vec<Defect>);

impl From<OutOfMemory> for Defects {
    fn from(error: OutOfMemory) -> Self {
        Self(vec![Defect::NoMemory { bytes: error.bytes }])
    }
}

/// The first few defects in one line; the whole list stays available to the caller.
fn summary(defects: &[Defect]) -> String {
    const SHOWN: usize = 3;
    let mut text = defects.iter().take(SHOWN).map(Defect::to_string).collect::<Vec<_>>().join("; ");
    if defects.len() > SHOWN {
        text += &format!("; and {} more", defects.len() - SHOWN);
    }
    text
}
