//! Closing the holes that removed elements leave, and turning a mesh back into polygons.

use super::ids::{DEAD, FaceId, HalfEdgeId, NONE, Node, VertexId};
use super::{Mesh, Polygons};
use crate::memory::{self, OutOfMemory};

/// Old id -> new id per kind of element; `None` for what was removed.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Renumbering {
    /// Every id stays; the tables are empty then.
    identity: bool,
    vertices: Vec<u32>,
    edges: Vec<u32>,
    faces: Vec<u32>,
    loops: Vec<u32>,
}

impl Default for Renumbering {
    fn default() -> Self {
        Self { identity: true, vertices: vec![], edges: vec![], faces: vec![], loops: vec![] }
    }
}

impl Renumbering {
    fn lookup(&self, table: &[u32], index: usize) -> Option<u32> {
        if self.identity {
            return Some(index as u32);
        }
        table.get(index).copied().filter(|&id| id != NONE)
    }

    /// The new id of a vertex.
    pub fn vertex(&self, v: VertexId) -> Option<VertexId> {
        self.lookup(&self.vertices, v.index()).map(VertexId)
    }

    /// The new id of a half-edge.
    pub fn half_edge(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.lookup(&self.edges, h.edge() as usize).map(|e| HalfEdgeId((2 * e) | (h.0 & 1)))
    }

    /// The new id of a face or boundary loop.
    pub fn face(&self, f: FaceId) -> Option<FaceId> {
        if f.is_boundary() {
            self.lookup(&self.loops, f.index()).map(FaceId::boundary)
        } else {
            self.lookup(&self.faces, f.index()).map(FaceId)
        }
    }

    /// The new name of a node.
    pub fn node(&self, node: Node) -> Option<Node> {
        match node {
            Node::Vertex(v) => self.vertex(v).map(Node::Vertex),
            Node::HalfEdge(h) => self.half_edge(h).map(Node::HalfEdge),
            Node::Face(f) => self.face(f).map(Node::Face),
        }
    }
}

/// New numbers for what is alive, in the old order.
fn numbers(alive: impl Iterator<Item = bool>) -> impl Iterator<Item = u32> {
    alive.scan(0, |count, alive| {
        *count += u32::from(alive);
        Some(if alive { *count - 1 } else { NONE })
    })
}

impl Mesh {
    /// True when no id is a hole.
    pub fn is_compact(&self) -> bool {
        self.holes == 0
    }

    /// Renumbers all elements without holes, keeping their order, and forgets which faces were split off from which.
    /// Costs nothing on a mesh without holes. Must not be called inside a transaction.
    pub fn compact(&mut self) -> Renumbering {
        debug_assert!(self.log.depth == 0, "compact inside a transaction");
        if self.is_compact() {
            self.forget_history();
            return Renumbering::default();
        }
        let map = Renumbering {
            vertices: numbers(self.vertices.iter().map(|&h| h != DEAD)).collect(),
            edges: numbers(self.half_edges.chunks_exact(2).map(|pair| pair[0].source != DEAD)).collect(),
            faces: numbers(self.faces.iter().map(|&h| h != DEAD)).collect(),
            loops: numbers(self.loops.iter().map(|&h| h != DEAD)).collect(),
            identity: false,
        };
        let half_edge = |id: u32| map.half_edge(HalfEdgeId(id)).map_or(NONE, |h| h.0);
        self.half_edges.retain(|h| h.source != DEAD);
        for record in &mut self.half_edges {
            record.next = half_edge(record.next);
            record.prev = half_edge(record.prev);
            record.source = map.vertex(VertexId(record.source)).map_or(NONE, |v| v.0);
            record.face = map.face(FaceId(record.face)).map_or(NONE, |f| f.0);
        }
        retain_by(&mut self.corner_texcoords, |i| map.edges[i / 2] != NONE);
        retain_by(&mut self.positions, |i| map.vertices[i] != NONE);
        retain_by(&mut self.face_sets, |i| map.faces[i] != NONE);
        for table in [&mut self.vertices, &mut self.faces, &mut self.loops] {
            table.retain(|&h| h != DEAD);
            for h in table {
                *h = if *h == NONE { NONE } else { half_edge(*h) };
            }
        }
        self.forget_history();
        self.holes = 0;
        self.attributes.remap(|node| map.node(node));
        let edges = std::mem::take(&mut self.edge_sharpness);
        self.edge_sharpness = edges.into_iter().map(|(e, s)| (map.edges[e as usize], s)).collect();
        let vertices = std::mem::take(&mut self.vertex_sharpness);
        self.vertex_sharpness = vertices.into_iter().map(|(v, s)| (map.vertices[v as usize], s)).collect();
        self.hole_faces = self.hole_faces.iter().map(|&f| map.faces[f as usize]).collect();
        map
    }

    /// From here on what is there counts as there from the start.
    fn forget_history(&mut self) {
        self.first_new_vertex = self.vertices.len() as u32;
        self.first_new_face = self.faces.len() as u32;
        self.face_parents.clear();
    }

    /// The mesh as polygons, removed elements left out.
    ///
    /// The first vertex of each face is that of the half-edge the face names. A face keeps its texture coordinates
    /// only when all its corners have one.
    pub fn to_polygons(&self) -> Polygons {
        self.try_to_polygons().unwrap_or_else(|error| memory::give_up(error))
    }

    /// [`to_polygons`](Self::to_polygons), where there may be no memory for them.
    ///
    /// # Errors
    /// [`OutOfMemory`] where there is none for one of the large lists.
    pub fn try_to_polygons(&self) -> Result<Polygons, OutOfMemory> {
        let alive = self.vertices.iter().map(|&h| h != DEAD);
        let vertex_numbers = memory::collected(self.vertices.len(), numbers(alive))?;
        // With those of the boundary, which are few.
        let corners = self.half_edges.len();
        let mut polygons = Polygons {
            positions: memory::collected(self.vertices.len(), self.vertices().map(|v| self.position(v)))?,
            face_sizes: memory::room(self.faces.len())?,
            face_vertices: memory::room(corners)?,
            face_sets: memory::room(self.face_sets.len())?,
            face_texcoords: memory::room(if self.has_texcoords() { corners } else { 0 })?,
            sets: self.sets.clone(),
            texcoords: memory::copied(&self.texcoords)?,
            material_libraries: self.material_libraries.clone(),
            subdivision: self.subdivision,
            ..Polygons::default()
        };
        for f in self.faces() {
            let start = polygons.face_vertices.len();
            polygons.face_vertices.extend(self.face_vertices(f).map(|v| vertex_numbers[v.index()]));
            polygons.face_sizes.push((polygons.face_vertices.len() - start) as u32);
            if self.is_hole(f) {
                polygons.holes.push(polygons.face_sizes.len() as u32 - 1);
            }
            if let Some(&set) = self.face_sets.get(f.index()) {
                polygons.face_sets.push(set);
            }
            if self.has_texcoords() {
                let corners = self.face_half_edges(f).map(|h| self.corner_texcoords[h.index()]);
                polygons.face_texcoords.extend(corners);
                let corners = &mut polygons.face_texcoords[start..];
                if corners.contains(&NONE) {
                    corners.fill(NONE);
                }
            }
        }
        for h in self.edges().filter(|&h| self.edge_sharpness(h) > 0.0) {
            let [a, b] = [self.source(h), self.target(h)].map(|v| vertex_numbers[v.index()]);
            polygons.creases.push((a, b, self.edge_sharpness(h)));
        }
        for v in self.vertices().filter(|&v| self.vertex_sharpness(v) > 0.0) {
            polygons.corners.push((vertex_numbers[v.index()], self.vertex_sharpness(v)));
        }
        Ok(polygons)
    }
}

/// Keeps the entries whose index passes; leaves an empty table empty.
fn retain_by<T>(table: &mut Vec<T>, keep: impl Fn(usize) -> bool) {
    let mut index = 0;
    table.retain(|_| {
        index += 1;
        keep(index - 1)
    });
}
