//! Words that change the mesh: Euler operators, positions, sharpness.

use super::kind::Kinds;
use super::machine::{Execution, Fault, error};
use super::value::Value;
use crate::mesh::{Corner, EulerError, HalfEdgeId, Mesh, Node, VertexId, is_place};
use glam::DVec3;

/// Sharpness from which on an edge or a vertex is infinitely sharp (OpenSubdiv's scale).
const INFINITE: f32 = 10.0;

impl Execution<'_, '_, '_> {
    /// Asks for room for `more` vertices, edges and faces.
    fn grow(&mut self, more: u64) -> Result<(), Fault> {
        Ok(self.environment.budget.grow(self.environment.mesh.element_count(), more)?)
    }

    pub(super) fn make_vefs(&mut self) -> Result<(), Fault> {
        let p1 = self.pop_vec3()?;
        let p0 = self.pop_vec3()?;
        self.grow(4)?;
        let made = self.environment.mesh.make_vefs(p0, p1);
        let e = self.euler(made)?;
        self.push_half_edge(e)
    }

    pub(super) fn make_ev(&mut self) -> Result<(), Fault> {
        let p = self.pop_vec3()?;
        let e1 = self.pop_half_edge()?;
        let e0 = self.pop_half_edge()?;
        self.grow(2)?;
        let made = self.environment.mesh.make_ev(e0, e1, p);
        let n = self.euler(made)?;
        self.push_half_edge(n)
    }

    pub(super) fn make_ev_one(&mut self) -> Result<(), Fault> {
        let p = self.pop_vec3()?;
        let e = self.pop_half_edge()?;
        self.grow(2)?;
        let made = self.environment.mesh.make_ev_one(e, p);
        let n = self.euler(made)?;
        self.push_half_edge(n)
    }

    pub(super) fn make_ef(&mut self) -> Result<(), Fault> {
        let e1 = self.pop_half_edge()?;
        let e0 = self.pop_half_edge()?;
        self.grow(2)?;
        let made = self.environment.mesh.make_ef(e0, e1);
        let n = self.euler(made)?;
        self.push_half_edge(n)
    }

    /// `e points faces makeFaces`: tiles the face of e; see [`Mesh::tile_face`].
    pub(super) fn make_faces(&mut self) -> Result<(), Fault> {
        let faces = self.pop_array()?;
        let points = self.pop_array()?;
        let e = self.pop_half_edge()?;
        let heap = &self.machine.heap;
        let positions: Option<Vec<DVec3>> = (heap.array(points).iter())
            .map(|value| if let Value::Vec3(p) = value { Some(*p) } else { None })
            .collect();
        let positions = positions.ok_or_else(|| error("makeFaces needs an array of points"))?;
        let corner = |value: &Value| match value {
            Value::Number(x) if *x >= 0.0 && x.fract() == 0.0 => Some(Corner::Inner(*x as usize)),
            Value::Node(Node::Vertex(v)) => Some(Corner::Vertex(*v)),
            _ => None,
        };
        let faces: Option<Vec<Vec<Corner>>> = (heap.array(faces).iter())
            .map(|face| match face {
                Value::Array(corners) => heap.array(*corners).iter().map(corner).collect(),
                _ => None,
            })
            .collect();
        let faces = faces.ok_or_else(|| {
            error("makeFaces needs an array of faces, each an array of vertices and of numbers of points")
        })?;
        let corners: usize = faces.iter().map(Vec::len).sum();
        // Each round of the tiling looks at all faces that are left.
        self.environment.budget.spend_many((corners * faces.len().max(1)) as u64)?;
        self.grow(2 * (positions.len() + faces.len()) as u64)?;
        self.environment.budget.edit(2 * corners as u64)?;
        let tiled = self.environment.mesh.tile_face(e, &positions, &faces);
        let inner = tiled.map_err(|problem| error(format!("makeFaces: {problem}")))?;
        self.push_array(inner.into_iter().map(|v| Value::Node(Node::Vertex(v))).collect())
    }

    pub(super) fn kill(
        &mut self,
        kill: fn(&mut Mesh, HalfEdgeId) -> Result<(), EulerError>,
    ) -> Result<(), Fault> {
        let e = self.pop_half_edge()?;
        self.environment.budget.edit(2)?;
        let killed = kill(self.environment.mesh, e);
        self.euler(killed)
    }

    fn place_vertex(&mut self, v: VertexId, p: DVec3) -> Result<(), Fault> {
        if !is_place(p) {
            return self.euler(Err(EulerError::NotFinite));
        }
        self.environment.budget.edit(1)?;
        self.environment.mesh.set_position(v, p);
        Ok(())
    }

    fn shift_vertex(&mut self, v: VertexId, shift: DVec3) -> Result<(), Fault> {
        let p = self.environment.mesh.position(v) + shift;
        self.place_vertex(v, p)
    }

    /// `v p moveV`: to the place p.
    pub(super) fn move_vertex(&mut self) -> Result<(), Fault> {
        let p = self.pop_vec3()?;
        let v = self.pop_place()?;
        self.place_vertex(v, p)
    }

    /// `e d moveE`: both ends by d.
    pub(super) fn move_edge(&mut self) -> Result<(), Fault> {
        let shift = self.pop_vec3()?;
        let h = self.pop_half_edge()?;
        let [a, b] = [self.environment.mesh.source(h), self.environment.mesh.target(h)];
        self.shift_vertex(a, shift)?;
        self.shift_vertex(b, shift)
    }

    /// `f d moveF`: all vertices by d, each once.
    pub(super) fn move_face(&mut self) -> Result<(), Fault> {
        let shift = self.pop_vec3()?;
        let f = self.pop_side()?;
        let mut vertices: Vec<VertexId> = self.environment.mesh.face_vertices(f).collect();
        self.environment.budget.spend_many(vertices.len() as u64)?;
        vertices.sort_unstable();
        vertices.dedup();
        vertices.into_iter().try_for_each(|v| self.shift_vertex(v, shift))
    }

    /// A truth value as a sharpness: 0 smooth, else infinitely sharp.
    fn pop_flag(&mut self) -> Result<f32, Fault> {
        Ok(if self.pop_number()? == 0.0 { 0.0 } else { INFINITE })
    }

    /// `e 1 sharpE`: a crease; `e 0 sharpE`: none.
    pub(super) fn sharp_edge(&mut self) -> Result<(), Fault> {
        let sharpness = self.pop_flag()?;
        let h = self.pop_half_edge()?;
        self.environment.budget.edit(1)?;
        self.environment.mesh.set_edge_sharpness(h, sharpness);
        Ok(())
    }

    /// `f 1 sharpF`: all edges of the face.
    pub(super) fn sharp_face(&mut self) -> Result<(), Fault> {
        let sharpness = self.pop_flag()?;
        let f = self.pop_side()?;
        let edges: Vec<HalfEdgeId> = self.environment.mesh.face_half_edges(f).collect();
        self.environment.budget.spend_many(edges.len() as u64)?;
        self.environment.budget.edit(edges.len() as u64)?;
        edges.into_iter().for_each(|h| self.environment.mesh.set_edge_sharpness(h, sharpness));
        Ok(())
    }

    /// `v 1 sharpV`: a corner.
    pub(super) fn sharp_vertex(&mut self) -> Result<(), Fault> {
        let sharpness = self.pop_flag()?;
        let v = self.pop_place()?;
        self.environment.budget.edit(1)?;
        self.environment.mesh.set_vertex_sharpness(v, sharpness);
        Ok(())
    }

    /// `e s setsharpness`: of the edge of a half-edge, or of a vertex itself.
    pub(super) fn set_sharpness(&mut self) -> Result<(), Fault> {
        let sharpness = self.pop_number()?;
        if !(0.0..=f64::from(f32::MAX)).contains(&sharpness) {
            return Err(error(format!(
                "a sharpness of {sharpness} is out of range; it is 0 (smooth) or more"
            )));
        }
        self.environment.budget.edit(1)?;
        match self.pop_node()? {
            Node::HalfEdge(h) => self.environment.mesh.set_edge_sharpness(h, sharpness as f32),
            Node::Vertex(v) => self.environment.mesh.set_vertex_sharpness(v, sharpness as f32),
            other @ Node::Face(_) => return Err(self.mismatch(Kinds::PLACE, Value::Node(other))),
        }
        Ok(())
    }
}
