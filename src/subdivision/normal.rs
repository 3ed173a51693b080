//! Normals of the control mesh itself.

use crate::mesh::{FaceId, Mesh, VertexId};
use glam::DVec3;

/// Normal of a polygon that need not be plane (Newell's method); its length is twice the polygon's area.
///
/// # Panics
/// When there is no such face.
pub fn face_normal(mesh: &Mesh, f: FaceId) -> DVec3 {
    let origin = mesh.position(mesh.source(mesh.face_half_edge(f)));
    mesh.face_half_edges(f)
        .map(|h| (mesh.position(mesh.source(h)) - origin).cross(mesh.position(mesh.target(h)) - origin))
        .sum()
}

/// Unit normal of the control mesh at `v`: the mean of the normals of its faces, weighted by their areas. `None` at
/// an isolated vertex and where the mean vanishes.
///
/// # Panics
/// When there is no such vertex.
pub fn vertex_normal(mesh: &Mesh, v: VertexId) -> Option<DVec3> {
    mesh.outgoing(v)
        .map(|h| mesh.face(h))
        .filter(|f| !f.is_boundary())
        .map(|f| face_normal(mesh, f))
        .sum::<DVec3>()
        .try_normalize()
}
