//! What a run of rules leaves behind: leftovers, working attributes, and which faces it touched.

use super::displace::LineVertex;
use super::report::{Leftover, LeftoverMark};
use crate::mark;
use crate::mesh::{Domain, FaceId, HalfEdgeId, Mesh, Node, Value, VertexId};
use std::collections::BTreeMap;

/// Turns what the rules left over into the attribute `unresolved`, and takes the working attributes away.
/// `edges` are the marked edges by number of the mark.
pub(super) fn settle(mesh: &mut Mesh, has_features: bool, edges: &[(u32, u32)]) -> Vec<Leftover> {
    let waiting = if has_features { "places" } else { "color" };
    let waiting = mesh.intern(waiting);
    let mut half_edges: Vec<HalfEdgeId> =
        mesh.nodes_with_attribute(Domain::HalfEdge, waiting).into_iter().map(HalfEdgeId).collect();
    half_edges.retain(|&h| mesh.has_half_edge(h) && !mesh.face(h).is_boundary());
    let unresolved = mesh.intern("unresolved");
    let kind = mesh.intern(if has_features { "kind" } else { "color" });
    let mut marks: BTreeMap<FaceId, Vec<LeftoverMark>> = BTreeMap::new();
    for &h in &half_edges {
        let kind = mesh.attribute(Node::HalfEdge(h), kind).cloned();
        let kind = kind.unwrap_or_else(|| Value::text(mark::DEFAULT_KIND));
        // The mark is known by its first vertex where the edge was split.
        let number = mesh.attribute_named(Node::Vertex(mesh.target(h)), "mark").and_then(Value::as_number);
        let split = number.filter(|_| has_features).and_then(|number| edges.get(number as usize).copied());
        marks.entry(mesh.face(h)).or_default().push(LeftoverMark {
            edge: split.unwrap_or((mesh.source(h).0, mesh.target(h).0)),
            kind: kind.as_text().unwrap_or_default().to_owned(),
        });
        mesh.set_attribute(Node::HalfEdge(h), unresolved, Some(kind));
    }
    for (domain, names) in [
        (
            Domain::HalfEdge,
            &["cuts", "lines", "mark", "places", "kind", "color", "skew", "end", "adjusted", "t"][..],
        ),
        (Domain::Vertex, &["mark", "line", "kind", "cross", "crosskind", "hold", "away"][..]),
    ] {
        for name in names {
            let name = mesh.intern(name);
            for id in mesh.nodes_with_attribute(domain, name) {
                mesh.set_attribute(Node::new(domain, id), name, None);
            }
        }
    }
    let span = mesh.intern("span");
    for &h in &half_edges {
        for to in mesh.links(Node::HalfEdge(h), span).to_vec() {
            mesh.set_link(Node::HalfEdge(h), span, to, false);
        }
    }
    marks
        .into_iter()
        .map(|(face, marks)| Leftover {
            face: face.0,
            vertices: mesh.face_vertices(face).map(|v| v.0).collect(),
            marks,
        })
        .collect()
}

/// How many of the changed faces have a corner without a texture coordinate, on a mesh that has some.
pub(super) fn without_texcoords(mesh: &Mesh, changed: &[FaceId]) -> usize {
    if !mesh.has_texcoords() {
        return 0;
    }
    let bare = |f: &&FaceId| mesh.face_half_edges(**f).any(|h| mesh.texcoord(h).is_none());
    changed.iter().filter(bare).count()
}

/// Faces whose limit surface can have changed: the surface of a face depends on the vertices of the faces around it,
/// and the vertices of the changed faces and of so many rings of faces around them may have moved.
pub(super) fn affected_faces(mesh: &Mesh, changed: &[FaceId], active_rings: usize) -> Vec<FaceId> {
    (0..active_rings + 2).fold(changed.to_vec(), |faces, _| mesh.grow_faces(&faces))
}

/// Edges between vertices of one line, other than the pieces of marked edges.
pub(super) fn feature_edges(mesh: &Mesh, lines: &[LineVertex]) -> Vec<(u32, u32)> {
    let of = |v: VertexId| lines.binary_search_by_key(&v, |entry| entry.vertex).ok().map(|i| &lines[i]);
    let mut edges = Vec::new();
    for a in lines {
        for b in mesh.outgoing(a.vertex).filter_map(|h| of(mesh.target(h))) {
            let pieces_of_one_mark = a.mark.is_some() && a.mark == b.mark;
            if a.vertex < b.vertex && a.shares_line(b) && !pieces_of_one_mark {
                edges.push((a.vertex.0, b.vertex.0));
            }
        }
    }
    edges
}
