//! A small mesh with named vertices, as a case describes it.

use crate::mesh::{HalfEdgeId, Mesh, Node, Polygons, Value, VertexId};
use glam::DVec3;

/// An element, by the vertices of the sketch: one for a vertex, two for a half-edge, more for a face.
pub(super) type Element = Vec<usize>;

#[derive(Clone, PartialEq, Debug)]
pub(super) struct NamedVertex {
    pub(super) name: String,
    pub(super) position: DVec3,
}

#[derive(Clone, Default, Debug)]
pub(super) struct Sketch {
    pub(super) vertices: Vec<NamedVertex>,
    pub(super) faces: Vec<Element>,
    pub(super) attributes: Vec<(Element, String, Value)>,
    pub(super) links: Vec<(Element, String, Element)>,
    /// Sharpness of edges (two vertices, in either direction) and of vertices.
    pub(super) sharp: Vec<(Element, f64)>,
}

impl Sketch {
    pub(super) fn vertex(&self, name: &str) -> Option<usize> {
        self.vertices.iter().position(|vertex| vertex.name == name)
    }

    /// The names of an element, as a case writes them. A face begins with its least name.
    pub(super) fn names(&self, element: &[usize]) -> String {
        let mut names: Vec<&str> = element.iter().map(|&v| self.vertices[v].name.as_str()).collect();
        if element.len() > 2
            && let Some(least) = (0..names.len()).min_by_key(|&i| names[i])
        {
            names.rotate_left(least);
        }
        names.join(" ")
    }

    /// True when the faces have this element.
    pub(super) fn has(&self, element: &[usize]) -> bool {
        let side = |face: &Element, a: usize, b: usize| {
            (0..face.len()).any(|i| face[i] == a && face[(i + 1) % face.len()] == b)
        };
        match *element {
            [_] => true,
            [a, b] => self.faces.iter().any(|face| side(face, a, b) || side(face, b, a)),
            [first, ..] => self.faces.iter().any(|face| {
                let at = face.iter().position(|&v| v == first).unwrap_or(0);
                face.len() == element.len()
                    && (0..face.len()).all(|i| face[(at + i) % face.len()] == element[i])
            }),
            [] => false,
        }
    }

    /// The mesh that the sketch describes. Vertices keep their order.
    pub(super) fn mesh(&self) -> Result<Mesh, String> {
        let polygons = Polygons {
            positions: self.vertices.iter().map(|vertex| vertex.position).collect(),
            face_sizes: self.faces.iter().map(|face| face.len() as u32).collect(),
            face_vertices: self.faces.iter().flatten().map(|&v| v as u32).collect(),
            ..Polygons::default()
        };
        let mut mesh = Mesh::from_polygons(&polygons).map_err(|defects| defects.to_string())?;
        for (element, name, value) in &self.attributes {
            let node = self.node(&mesh, element)?;
            let name = mesh.intern(name);
            mesh.set_attribute(node, name, Some(value.clone()));
        }
        for (from, label, to) in &self.links {
            let (from, to) = (self.node(&mesh, from)?, self.node(&mesh, to)?);
            let label = mesh.intern(label);
            mesh.set_link(from, label, to, true);
        }
        for (element, sharpness) in &self.sharp {
            match self.node(&mesh, element)? {
                Node::HalfEdge(h) => mesh.set_edge_sharpness(h, *sharpness as f32),
                Node::Vertex(v) => mesh.set_vertex_sharpness(v, *sharpness as f32),
                Node::Face(_) => {}
            }
        }
        Ok(mesh)
    }

    /// An element of the mesh of this sketch.
    fn node(&self, mesh: &Mesh, element: &[usize]) -> Result<Node, String> {
        let vertex = |v: usize| VertexId(v as u32);
        match *element {
            [v] => Ok(Node::Vertex(vertex(v))),
            [a, b] => mesh
                .find_half_edge(vertex(a), vertex(b))
                .map(Node::HalfEdge)
                .ok_or_else(|| format!("no face has an edge {}", self.names(element))),
            [a, b, ..] => mesh
                .find_half_edge(vertex(a), vertex(b))
                .map(|h| mesh.face(h))
                .filter(|&f| mesh.arity(f) == element.len())
                .map(Node::Face)
                .ok_or_else(|| format!("there is no face {}", self.names(element))),
            [] => Err("an element has no vertices".to_owned()),
        }
    }

    /// What `mesh` holds; `name` gives the names of its vertices.
    pub(super) fn of_mesh(mesh: &Mesh, mut name: impl FnMut(DVec3) -> String) -> Self {
        let mut sketch = Self::default();
        let mut numbers = vec![0; mesh.vertex_bound()];
        for v in mesh.vertices() {
            numbers[v.index()] = sketch.vertices.len();
            let position = mesh.position(v);
            sketch.vertices.push(NamedVertex { name: name(position), position });
        }
        let edge = |h: HalfEdgeId| vec![numbers[mesh.source(h).index()], numbers[mesh.target(h).index()]];
        let element = |node: Node| match node {
            Node::Vertex(v) => vec![numbers[v.index()]],
            Node::HalfEdge(h) => edge(h),
            Node::Face(f) => mesh.face_vertices(f).map(|v| numbers[v.index()]).collect(),
        };
        sketch.faces = mesh.faces().map(|f| element(Node::Face(f))).collect();
        let nodes = (mesh.vertices().map(Node::Vertex))
            .chain(mesh.half_edges().map(Node::HalfEdge))
            .chain(mesh.faces().map(Node::Face))
            .chain(mesh.boundary_loops().map(Node::Face));
        for node in nodes {
            for symbol in mesh.attribute_names(node) {
                if let Some(value) = mesh.attribute(node, symbol) {
                    let name = mesh.symbol_name(symbol).to_owned();
                    sketch.attributes.push((element(node), name, value.clone()));
                }
            }
            for (label, to) in mesh.links_from(node) {
                sketch.links.push((element(node), mesh.symbol_name(label).to_owned(), element(to)));
            }
        }
        let edges = mesh.edges().map(|h| (edge(h), mesh.edge_sharpness(h)));
        let corners = mesh.vertices().map(|v| (vec![numbers[v.index()]], mesh.vertex_sharpness(v)));
        sketch.sharp = edges
            .chain(corners)
            .filter(|(_, sharpness)| *sharpness > 0.0)
            .map(|(element, sharpness)| (element, f64::from(sharpness)))
            .collect();
        sketch
    }
}
