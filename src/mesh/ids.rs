//! Ids of mesh elements: plain 0-based indices, one type per element so that they cannot be mixed up.

/// The index that stands for "none" in the kernel's tables.
pub(crate) const NONE: u32 = u32::MAX;
/// The index that stands for "removed" in the kernel's tables.
pub(crate) const DEAD: u32 = u32::MAX - 1;
/// Bit that tells a boundary loop from a real face.
const LOOP: u32 = 1 << 31;

/// A vertex. Input order is kept: vertex `i` of a file is `VertexId(i)`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct VertexId(pub u32);

/// A half-edge: one of the two directions of an edge, with its face on the left.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct HalfEdgeId(pub u32);

/// A face, or one of the invisible faces that fill the boundary loops. The two kinds are numbered apart, so that
/// real faces keep the numbers of the file.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct FaceId(pub u32);

impl VertexId {
    /// The id as an index into arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl HalfEdgeId {
    /// The id as an index into arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The other direction of the same edge (GML `edgemate`).
    pub fn mate(self) -> Self {
        Self(self.0 ^ 1)
    }

    /// Number of the undirected edge.
    pub fn edge(self) -> u32 {
        self.0 >> 1
    }
}

impl FaceId {
    /// The invisible face of boundary loop `index`.
    pub(crate) fn boundary(index: u32) -> Self {
        Self(index | LOOP)
    }

    /// True for the invisible face of a boundary loop.
    pub fn is_boundary(self) -> bool {
        self.0 & LOOP != 0
    }

    /// The id as an index into the arrays of its kind (real faces, or boundary loops).
    pub fn index(self) -> usize {
        (self.0 & !LOOP) as usize
    }
}

/// Any node of the mesh graph that can carry attributes and links (paper, Definition 1).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Node {
    /// A vertex.
    Vertex(VertexId),
    /// A half-edge.
    HalfEdge(HalfEdgeId),
    /// A face or a boundary loop.
    Face(FaceId),
}

/// The kind of a [`Node`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Domain {
    /// Vertices.
    Vertex,
    /// Half-edges.
    HalfEdge,
    /// Faces and boundary loops.
    Face,
}

impl Node {
    /// The kind of this node.
    pub fn domain(self) -> Domain {
        match self {
            Self::Vertex(_) => Domain::Vertex,
            Self::HalfEdge(_) => Domain::HalfEdge,
            Self::Face(_) => Domain::Face,
        }
    }

    /// The id within its kind.
    pub fn id(self) -> u32 {
        match self {
            Self::Vertex(v) => v.0,
            Self::HalfEdge(h) => h.0,
            Self::Face(f) => f.0,
        }
    }

    /// The node of kind `domain` with number `id`.
    pub fn new(domain: Domain, id: u32) -> Self {
        match domain {
            Domain::Vertex => Self::Vertex(VertexId(id)),
            Domain::HalfEdge => Self::HalfEdge(HalfEdgeId(id)),
            Domain::Face => Self::Face(FaceId(id)),
        }
    }
}
