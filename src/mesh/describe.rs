//! Elements in the user's terms: by the vertices of the file, and by their places where they are new.

use super::{FaceId, HalfEdgeId, Mesh, Node, VertexId};
use glam::DVec3;

impl Mesh {
    /// True when `v` was there when the mesh was built or compacted last, so that its number is known to the user.
    pub fn is_original_vertex(&self, v: VertexId) -> bool {
        v.0 < self.first_new_vertex
    }

    /// An element in words: `vertex 3`, `edge 0 -> 1`, `face 5`; new vertices by their places, parts of a split face
    /// by the face they come from and a place.
    pub fn describe(&self, node: Node) -> String {
        match node {
            _ if !self.has_node(node) => "an element that was removed".to_owned(),
            Node::Vertex(v) if self.is_original_vertex(v) => format!("vertex {}", v.0),
            Node::Vertex(v) => format!("the new vertex at {}", show_point(self.position(v))),
            Node::HalfEdge(h) => format!("edge {}", self.describe_ends(h)),
            Node::Face(f) => self.describe_face(f),
        }
    }

    fn describe_ends(&self, h: HalfEdgeId) -> String {
        let end = |v: VertexId| {
            if self.is_original_vertex(v) { v.0.to_string() } else { show_point(self.position(v)) }
        };
        format!("{} -> {}", end(self.source(h)), end(self.target(h)))
    }

    fn describe_face(&self, f: FaceId) -> String {
        if f.is_boundary() {
            return format!("the boundary along edge {}", self.describe_ends(self.face_half_edge(f)));
        }
        let original = self.original_face(f);
        if f == original && f.0 < self.first_new_face {
            return format!("face {}", f.0);
        }
        let middle = show_point(self.place(Node::Face(f)));
        if original.0 < self.first_new_face {
            format!("the part of face {} at {middle}", original.0)
        } else {
            format!("the new face at {middle}")
        }
    }

    /// A point to look at: a vertex itself, the middle of an edge, the mean of the vertices of a face.
    pub fn place(&self, node: Node) -> DVec3 {
        match node {
            _ if !self.has_node(node) => DVec3::ZERO,
            Node::Vertex(v) => self.position(v),
            Node::HalfEdge(h) => self.point_along(h, 0.5),
            Node::Face(f) => {
                let (sum, count) = self
                    .face_vertices(f)
                    .fold((DVec3::ZERO, 0.0), |(sum, count), v| (sum + self.position(v), count + 1.0));
                sum / count
            }
        }
    }
}

/// A point with six significant digits per coordinate.
pub fn show_point(p: DVec3) -> String {
    let short = |x: f64| format!("{x:.5e}").parse::<f64>().unwrap_or(x) + 0.0;
    format!("({}, {}, {})", short(p.x), short(p.y), short(p.z))
}
