//! The control mesh: half-edges with boundaries as invisible faces, attributes, labelled links and an undo log.
//!
//! Half-edges come in pairs (`mate(h) = h ^ 1`), each with its face on the left, counter-clockwise; the record of a
//! half-edge is 16 bytes, so that a step of a walk touches one cache line. The boundary is one invisible face per
//! loop, which makes every vertex ring and every face cycle closed; rules never match invisible faces unless they ask.
//! Topology changes only through the Euler operators in [`euler`]. Ids stay valid through a rewrite: removed
//! elements leave holes, which [`Mesh::compact`] closes.

mod attributes;
mod build;
mod compact;
mod defect;
mod describe;
mod euler;
mod ids;
mod log;
mod polygons;
mod scheme;
mod tile;
mod transaction;
mod validate;
mod value;
mod walk;

pub use attributes::Symbol;
pub use compact::Renumbering;
pub use defect::{Defect, Defects};
pub use describe::show_point;
pub use euler::EulerError;
pub use ids::{Domain, FaceId, HalfEdgeId, Node, VertexId};
pub use log::Checkpoint;
pub use polygons::{FaceSet, Polygons};
pub use scheme::{BoundaryRule, Creasing, SubdivisionOptions};
pub use tile::{Corner, TileError};
pub use validate::Violation;
pub use value::Value;

use crate::memory::{self, OutOfMemory};
use attributes::Attributes;
use glam::{DVec2, DVec3};
use ids::{DEAD, NONE};
use log::{Change, Log};
use rustc_hash::{FxHashMap, FxHashSet};

/// One half-edge. `source` is where it starts; its face lies on its left.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct HalfEdge {
    pub(crate) next: u32,
    pub(crate) prev: u32,
    pub(crate) source: u32,
    pub(crate) face: u32,
}

impl HalfEdge {
    const UNSET: Self = Self { next: NONE, prev: NONE, source: NONE, face: NONE };
    const DEAD: Self = Self { next: DEAD, prev: DEAD, source: DEAD, face: DEAD };
}

/// A control mesh. See the [module](self) for its structure.
#[derive(Clone, Default, Debug)]
pub struct Mesh {
    half_edges: Vec<HalfEdge>,
    /// One outgoing half-edge per vertex, `NONE` for an isolated vertex, `DEAD` for a removed one.
    vertices: Vec<u32>,
    positions: Vec<DVec3>,
    /// One half-edge per face, `DEAD` for a removed one.
    faces: Vec<u32>,
    /// One half-edge per boundary loop, `DEAD` for a removed one.
    loops: Vec<u32>,
    /// Vertices from this id on were made since the mesh was built or compacted.
    first_new_vertex: u32,
    /// Faces from this id on were split off from others; the ones below were there from the start.
    first_new_face: u32,
    /// The face each face from `first_new_face` on was split off from.
    face_parents: Vec<u32>,
    /// Removed elements that still take up an id.
    holes: usize,
    attributes: Attributes,
    edge_sharpness: FxHashMap<u32, f32>,
    vertex_sharpness: FxHashMap<u32, f32>,
    subdivision: SubdivisionOptions,
    /// Faces that are no part of the surface.
    hole_faces: FxHashSet<u32>,
    texcoords: Vec<DVec2>,
    /// Per half-edge, the texture coordinate of the corner at its source; empty when the mesh has none.
    corner_texcoords: Vec<u32>,
    sets: Vec<FaceSet>,
    /// Per face, an index into `sets`; empty when the mesh has none.
    face_sets: Vec<u32>,
    material_libraries: Vec<String>,
    log: Log,
}

/// Vertices lie between minus this number and this number in every coordinate, so that products of lengths do not overflow.
pub const MOST_COORDINATE: f64 = 1e50;

/// True for a place where a vertex may lie.
pub fn is_place(place: DVec3) -> bool {
    place.to_array().iter().all(|x| x.abs() <= MOST_COORDINATE)
}

impl Mesh {
    /// A copy, as `clone` makes it.
    ///
    /// # Errors
    /// [`OutOfMemory`] where there is no memory for one of the large lists.
    pub fn try_clone(&self) -> Result<Self, OutOfMemory> {
        Ok(Self {
            half_edges: memory::copied(&self.half_edges)?,
            vertices: memory::copied(&self.vertices)?,
            positions: memory::copied(&self.positions)?,
            faces: memory::copied(&self.faces)?,
            loops: memory::copied(&self.loops)?,
            first_new_vertex: self.first_new_vertex,
            first_new_face: self.first_new_face,
            face_parents: memory::copied(&self.face_parents)?,
            holes: self.holes,
            attributes: self.attributes.clone(),
            edge_sharpness: self.edge_sharpness.clone(),
            vertex_sharpness: self.vertex_sharpness.clone(),
            subdivision: self.subdivision,
            hole_faces: self.hole_faces.clone(),
            texcoords: memory::copied(&self.texcoords)?,
            corner_texcoords: memory::copied(&self.corner_texcoords)?,
            sets: self.sets.clone(),
            face_sets: memory::copied(&self.face_sets)?,
            material_libraries: self.material_libraries.clone(),
            log: self.log.clone(),
        })
    }

    /// Number of vertex ids in use, removed ones included: ids are below it.
    pub fn vertex_bound(&self) -> usize {
        self.vertices.len()
    }

    /// Number of half-edge ids in use, removed ones included.
    pub fn half_edge_bound(&self) -> usize {
        self.half_edges.len()
    }

    /// Number of face ids in use, removed ones included, boundary loops not.
    pub fn face_bound(&self) -> usize {
        self.faces.len()
    }

    /// Number of vertices, edges, faces and boundary loops that exist, together.
    pub fn element_count(&self) -> usize {
        self.vertices.len() + self.half_edges.len() / 2 + self.faces.len() + self.loops.len() - self.holes
    }

    /// Number of boundary loop ids in use, removed ones included.
    pub fn loop_bound(&self) -> usize {
        self.loops.len()
    }

    /// True when `v` names a vertex that exists.
    pub fn has_vertex(&self, v: VertexId) -> bool {
        self.vertices.get(v.index()).is_some_and(|&h| h != DEAD)
    }

    /// True when `h` names a half-edge that exists.
    pub fn has_half_edge(&self, h: HalfEdgeId) -> bool {
        self.half_edges.get(h.index()).is_some_and(|record| record.source != DEAD)
    }

    /// True when `f` names a face or a boundary loop that exists.
    pub fn has_face(&self, f: FaceId) -> bool {
        let table = if f.is_boundary() { &self.loops } else { &self.faces };
        table.get(f.index()).is_some_and(|&h| h != DEAD)
    }

    /// True when `node` exists.
    pub fn has_node(&self, node: Node) -> bool {
        match node {
            Node::Vertex(v) => self.has_vertex(v),
            Node::HalfEdge(h) => self.has_half_edge(h),
            Node::Face(f) => self.has_face(f),
        }
    }

    /// The next half-edge of the same face, counter-clockwise (GML `faceCCW`).
    pub fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        HalfEdgeId(self.half_edges[h.index()].next)
    }

    /// The previous half-edge of the same face (GML `faceCW`).
    pub fn prev(&self, h: HalfEdgeId) -> HalfEdgeId {
        HalfEdgeId(self.half_edges[h.index()].prev)
    }

    /// The vertex at which `h` starts.
    pub fn source(&self, h: HalfEdgeId) -> VertexId {
        VertexId(self.half_edges[h.index()].source)
    }

    /// The vertex at which `h` ends.
    pub fn target(&self, h: HalfEdgeId) -> VertexId {
        self.source(h.mate())
    }

    /// The face on the left of `h`.
    pub fn face(&self, h: HalfEdgeId) -> FaceId {
        FaceId(self.half_edges[h.index()].face)
    }

    /// The next half-edge out of the same vertex, clockwise (GML `vertexCW`).
    pub fn vertex_cw(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.next(h.mate())
    }

    /// The next half-edge out of the same vertex, counter-clockwise (GML `vertexCCW`).
    pub fn vertex_ccw(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.prev(h).mate()
    }

    /// One half-edge out of `v`, or `None` for an isolated vertex.
    pub fn vertex_half_edge(&self, v: VertexId) -> Option<HalfEdgeId> {
        let h = self.vertices[v.index()];
        (h < DEAD).then_some(HalfEdgeId(h))
    }

    /// One half-edge of `f`.
    pub fn face_half_edge(&self, f: FaceId) -> HalfEdgeId {
        let table = if f.is_boundary() { &self.loops } else { &self.faces };
        HalfEdgeId(table[f.index()])
    }

    /// Position of `v`.
    pub fn position(&self, v: VertexId) -> DVec3 {
        self.positions[v.index()]
    }

    /// Positions of all vertex ids, removed ones included.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Moves `v` to `position`.
    pub fn set_position(&mut self, v: VertexId, position: DVec3) {
        if self.log.depth > 0 {
            self.log.changes.push(Change::Position { id: v.0 });
            self.log.positions.push(self.positions[v.index()]);
        }
        self.positions[v.index()] = position;
    }

    /// The face of the mesh as it was loaded in which `f` lies (`f` itself when it was there from the start or is a shell of its own).
    pub fn original_face(&self, f: FaceId) -> FaceId {
        let mut f = f;
        while !f.is_boundary() && f.0 >= self.first_new_face {
            let parent = self.face_parents[(f.0 - self.first_new_face) as usize];
            if parent == f.0 {
                break;
            }
            f = FaceId(parent);
        }
        f
    }

    /// The interned form of an attribute name or link label.
    pub fn intern(&mut self, name: &str) -> Symbol {
        self.attributes.intern(name)
    }

    /// The interned form of `name`, if it was ever used on this mesh.
    pub fn symbol(&self, name: &str) -> Option<Symbol> {
        self.attributes.symbol(name)
    }

    /// The text of an interned name.
    pub fn symbol_name(&self, symbol: Symbol) -> &str {
        self.attributes.name(symbol)
    }

    /// The attribute `name` of `node`.
    pub fn attribute(&self, node: Node, name: Symbol) -> Option<&Value> {
        self.attributes.get(node, name)
    }

    /// The attribute called `name` of `node`.
    pub fn attribute_named(&self, node: Node, name: &str) -> Option<&Value> {
        self.attribute(node, self.symbol(name)?)
    }

    /// Sets the attribute, or removes it with `None`.
    pub fn set_attribute(&mut self, node: Node, name: Symbol, value: Option<Value>) {
        let old = self.attributes.set(node, name, value);
        if self.log.depth > 0 {
            self.log.changes.push(Change::Attribute { node, name });
            self.log.values.push(old);
        }
    }

    /// Ids of the nodes of kind `domain` whose attribute equals `value`, ascending.
    pub fn nodes_with_value(&self, domain: Domain, name: Symbol, value: &Value) -> impl Iterator<Item = u32> {
        self.attributes.with_value(domain, name, value)
    }

    /// Ids of the nodes of kind `domain` that have the attribute, ascending.
    pub fn nodes_with_attribute(&self, domain: Domain, name: Symbol) -> Vec<u32> {
        self.attributes.with_name(domain, name)
    }

    /// Ids of the nodes of kind `domain` from which a link with this label starts, ascending.
    pub fn nodes_with_link(&self, domain: Domain, label: Symbol) -> impl Iterator<Item = u32> {
        self.attributes.with_link(domain, label)
    }

    /// Names of the attributes that `node` carries.
    pub fn attribute_names(&self, node: Node) -> Vec<Symbol> {
        self.attributes.names_of(node)
    }

    /// Nodes to which `from` is linked by `label`.
    pub fn links(&self, from: Node, label: Symbol) -> &[Node] {
        self.attributes.links(from, label)
    }

    /// All links that start at `from`, as label and target.
    pub fn links_from(&self, from: Node) -> Vec<(Symbol, Node)> {
        let links = self.attributes.links_of(from).into_iter();
        links.filter(|link| link.0 == from).map(|(_, label, to)| (label, to)).collect()
    }

    /// Nodes that are linked to `to` by `label`.
    pub fn back_links(&self, to: Node, label: Symbol) -> &[Node] {
        self.attributes.back_links(to, label)
    }

    /// Adds or removes the link `from -label-> to`. There is at most one per label between two nodes.
    pub fn set_link(&mut self, from: Node, label: Symbol, to: Node, present: bool) {
        if self.attributes.set_link(from, label, to, present) {
            self.log.push(Change::Link { from, label, to, added: present });
        }
    }

    /// Sharpness of the edge of `h`: 0 smooth, 10 and more infinitely sharp (OpenSubdiv's scale).
    pub fn edge_sharpness(&self, h: HalfEdgeId) -> f32 {
        self.edge_sharpness.get(&h.edge()).copied().unwrap_or(0.0)
    }

    /// Sets the sharpness of the edge of `h`.
    pub fn set_edge_sharpness(&mut self, h: HalfEdgeId, sharpness: f32) {
        let old = self.edge_sharpness(h);
        self.log.push(Change::EdgeSharpness { edge: h.edge(), old });
        set_or_remove(&mut self.edge_sharpness, h.edge(), sharpness);
    }

    /// Sharpness of the vertex itself (corners), on the same scale.
    pub fn vertex_sharpness(&self, v: VertexId) -> f32 {
        self.vertex_sharpness.get(&v.0).copied().unwrap_or(0.0)
    }

    /// Sets the sharpness of the vertex itself.
    pub fn set_vertex_sharpness(&mut self, v: VertexId, sharpness: f32) {
        let old = self.vertex_sharpness(v);
        self.log.push(Change::VertexSharpness { vertex: v.0, old });
        set_or_remove(&mut self.vertex_sharpness, v.0, sharpness);
    }

    /// True when any edge or vertex is sharp.
    pub fn has_sharpness(&self) -> bool {
        !self.edge_sharpness.is_empty() || !self.vertex_sharpness.is_empty()
    }

    /// Groups and materials of the mesh.
    pub fn face_sets(&self) -> &[FaceSet] {
        &self.sets
    }

    /// Group and material of a real face, if the mesh has any.
    pub fn face_set(&self, f: FaceId) -> Option<&FaceSet> {
        self.sets.get(*self.face_sets.get(f.index())? as usize)
    }

    /// True when the mesh carries texture coordinates.
    pub fn has_texcoords(&self) -> bool {
        !self.corner_texcoords.is_empty()
    }

    /// Texture coordinate of the corner of `h`'s face at `h`'s source.
    pub fn texcoord(&self, h: HalfEdgeId) -> Option<DVec2> {
        self.texcoords.get(*self.corner_texcoords.get(h.index())? as usize).copied()
    }
}

pub(crate) fn set_or_remove(map: &mut FxHashMap<u32, f32>, key: u32, sharpness: f32) {
    if sharpness > 0.0 {
        map.insert(key, sharpness);
    } else {
        map.remove(&key);
    }
}
