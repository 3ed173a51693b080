//! Words that look at the mesh.

use super::kind::Kinds;
use super::machine::{Execution, Fault, error};
use super::value::Value;
use crate::mesh::{FaceId, HalfEdgeId, Mesh, Node, VertexId};
use glam::DVec3;

impl Execution<'_, '_, '_> {
    /// A node that exists.
    pub(super) fn pop_node(&mut self) -> Result<Node, Fault> {
        match self.pop()? {
            Value::Node(node) if self.environment.mesh.has_node(node) => Ok(node),
            Value::Node(node) => Err(error(format!("this {} was removed", Value::Node(node).kind()))),
            other => Err(self.mismatch(Kinds::NODE, other)),
        }
    }

    pub(super) fn pop_half_edge(&mut self) -> Result<HalfEdgeId, Fault> {
        match self.pop_node()? {
            Node::HalfEdge(h) => Ok(h),
            other => Err(self.mismatch(Kinds::HALF_EDGE, Value::Node(other))),
        }
    }

    /// A vertex, or the source of a half-edge.
    pub(super) fn pop_place(&mut self) -> Result<VertexId, Fault> {
        match self.pop_node()? {
            Node::Vertex(v) => Ok(v),
            Node::HalfEdge(h) => Ok(self.environment.mesh.source(h)),
            other => Err(self.mismatch(Kinds::PLACE, Value::Node(other))),
        }
    }

    /// A face, or the face of a half-edge.
    pub(super) fn pop_side(&mut self) -> Result<FaceId, Fault> {
        match self.pop_node()? {
            Node::Face(f) => Ok(f),
            Node::HalfEdge(h) => Ok(self.environment.mesh.face(h)),
            other => Err(self.mismatch(Kinds::SIDE, Value::Node(other))),
        }
    }

    pub(super) fn push_half_edge(&mut self, h: HalfEdgeId) -> Result<(), Fault> {
        self.push(Value::Node(Node::HalfEdge(h)))
    }

    pub(super) fn vertex_of(&mut self, end: fn(&Mesh, HalfEdgeId) -> VertexId) -> Result<(), Fault> {
        let h = self.pop_half_edge()?;
        let v = end(self.environment.mesh, h);
        self.push(Value::Node(Node::Vertex(v)))
    }

    pub(super) fn face_of(&mut self) -> Result<(), Fault> {
        let h = self.pop_half_edge()?;
        let f = self.environment.mesh.face(h);
        self.push(Value::Node(Node::Face(f)))
    }

    pub(super) fn vertex_position(&mut self) -> Result<(), Fault> {
        let v = self.pop_place()?;
        let p = self.environment.mesh.position(v);
        self.push(Value::Vec3(p))
    }

    pub(super) fn edge_direction(&mut self) -> Result<(), Fault> {
        let h = self.pop_half_edge()?;
        let mesh = &self.environment.mesh;
        let direction = mesh.position(mesh.target(h)) - mesh.position(mesh.source(h));
        let unit = direction.try_normalize();
        self.push_vec3(
            unit.ok_or_else(|| error(format!("{} has length zero", mesh.describe(Node::HalfEdge(h)))))?,
        )
    }

    /// Half-edges of a face; each is a step of the budget.
    fn around_face(&mut self, f: FaceId) -> Result<Vec<HalfEdgeId>, Fault> {
        let edges: Vec<HalfEdgeId> = self.environment.mesh.face_half_edges(f).collect();
        self.environment.budget.spend_many(edges.len() as u64)?;
        Ok(edges)
    }

    /// Half-edges out of a vertex; each is a step of the budget.
    fn around_vertex(&mut self, v: VertexId) -> Result<Vec<HalfEdgeId>, Fault> {
        let edges: Vec<HalfEdgeId> = self.environment.mesh.outgoing(v).collect();
        self.environment.budget.spend_many(edges.len() as u64)?;
        Ok(edges)
    }

    /// Normal by Newell's sum: twice the vector area.
    pub(super) fn face_normal(&mut self) -> Result<(), Fault> {
        let f = self.pop_side()?;
        let edges = self.around_face(f)?;
        let mesh = &self.environment.mesh;
        let origin = edges.first().map_or(DVec3::ZERO, |&h| mesh.position(mesh.source(h)));
        let area: DVec3 = edges
            .iter()
            .map(|&h| [mesh.source(h), mesh.target(h)].map(|v| mesh.position(v) - origin))
            .map(|[a, b]| a.cross(b))
            .sum();
        let unit = area.try_normalize();
        self.push_vec3(unit.ok_or_else(|| error(format!("{} has no area", mesh.describe(Node::Face(f)))))?)
    }

    pub(super) fn face_midpoint(&mut self) -> Result<(), Fault> {
        let f = self.pop_side()?;
        let edges = self.around_face(f)?;
        let mesh = &self.environment.mesh;
        let sum: DVec3 = edges.iter().map(|&h| mesh.position(mesh.source(h))).sum();
        self.push_vec3(sum / edges.len() as f64)
    }

    /// Normal of the control mesh at a vertex: the faces' corners count by their areas.
    pub(super) fn vertex_normal(&mut self) -> Result<(), Fault> {
        let v = self.pop_place()?;
        let edges = self.around_vertex(v)?;
        let mesh = &self.environment.mesh;
        let centre = mesh.position(v);
        let sum: DVec3 = edges
            .iter()
            .filter(|&&h| !mesh.face(h).is_boundary())
            .map(|&h| [mesh.target(h), mesh.source(mesh.prev(h))].map(|end| mesh.position(end) - centre))
            .map(|[a, b]| a.cross(b))
            .sum();
        let unit = sum.try_normalize();
        self.push_vec3(
            unit.ok_or_else(|| error(format!("{} has no normal", mesh.describe(Node::Vertex(v)))))?,
        )
    }

    pub(super) fn face_degree(&mut self) -> Result<(), Fault> {
        let f = self.pop_side()?;
        let degree = self.around_face(f)?.len();
        self.push(Value::Number(degree as f64))
    }

    pub(super) fn valence(&mut self) -> Result<(), Fault> {
        let v = self.pop_place()?;
        let valence = self.around_vertex(v)?.len();
        self.push(Value::Number(valence as f64))
    }

    /// A half-edge outside of the mesh, a boundary loop, a vertex on one.
    pub(super) fn is_boundary(&mut self) -> Result<(), Fault> {
        let answer = match self.pop_node()? {
            Node::HalfEdge(h) => self.environment.mesh.face(h).is_boundary(),
            Node::Face(f) => f.is_boundary(),
            Node::Vertex(v) => {
                let edges = self.around_vertex(v)?;
                edges.iter().any(|&h| self.environment.mesh.face(h).is_boundary())
            }
        };
        self.push_boolean(answer)
    }

    pub(super) fn same_edge(&mut self) -> Result<(), Fault> {
        let b = self.pop_half_edge()?;
        let a = self.pop_half_edge()?;
        self.push_boolean(a.edge() == b.edge())
    }

    pub(super) fn same_face(&mut self) -> Result<(), Fault> {
        let b = self.pop_side()?;
        let a = self.pop_side()?;
        self.push_boolean(a == b)
    }

    pub(super) fn same_vertex(&mut self) -> Result<(), Fault> {
        let b = self.pop_place()?;
        let a = self.pop_place()?;
        self.push_boolean(a == b)
    }

    /// Sharpness of the edge of a half-edge, or of a vertex itself.
    pub(super) fn sharpness(&mut self) -> Result<f64, Fault> {
        match self.pop_node()? {
            Node::HalfEdge(h) => Ok(f64::from(self.environment.mesh.edge_sharpness(h))),
            Node::Vertex(v) => Ok(f64::from(self.environment.mesh.vertex_sharpness(v))),
            other @ Node::Face(_) => Err(self.mismatch(Kinds::PLACE, Value::Node(other))),
        }
    }
}
