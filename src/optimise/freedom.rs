//! Along what a vertex may move when the surface is fitted.

use super::Target;
use super::lines::{apply, foot_normal};
use crate::mesh::{HalfEdgeId, Mesh, VertexId};
use crate::subdivision::{limit_mask, vertex_normal};
use glam::DVec3;
use smallvec::SmallVec;

/// The normal of the frozen surface at the vertex's foot, then unit tangents along which the vertex may slide.
pub(super) type Freedom = SmallVec<[DVec3; 3]>;

/// What `v` may do; `None` when it finds no surface.
pub(super) fn freedom(mesh: &Mesh, v: VertexId, target: &Target, slide: bool) -> Option<Freedom> {
    let point = apply(mesh, &limit_mask(mesh, v));
    let normal = foot_normal(target, point, vertex_normal(mesh, v))?;
    let mut freedom = Freedom::from_slice(&[normal]);
    if slide {
        freedom.extend(sliding(mesh, v, normal, target.vertices));
    }
    Some(freedom)
}

/// Longest row of new vertices on an old edge that is followed.
const MOST_LINES: usize = 64;

/// The unit tangents along which `v` may slide. A vertex that was inserted on an edge keeps its place along that edge,
/// on which the width of a feature depends, and slides along the line to which it belongs.
fn sliding(mesh: &Mesh, v: VertexId, normal: DVec3, old: usize) -> SmallVec<[DVec3; 2]> {
    let any = || {
        let (x, y) = normal.any_orthonormal_pair();
        SmallVec::from([x, y])
    };
    if v.index() < old {
        return any();
    }
    let edges: SmallVec<[HalfEdgeId; 8]> = mesh.outgoing(v).collect();
    if edges.len() != 4 {
        let on_edge = edges.iter().any(|&h| mesh.target(h).index() < old);
        return if on_edge { SmallVec::new() } else { any() };
    }
    let length = |i: usize| Some(steps_to_old(mesh, edges[i], old)? + steps_to_old(mesh, edges[i + 2], old)?);
    let across = match (length(0), length(1)) {
        (Some(first), Some(second)) => usize::from(second < first),
        (Some(_), None) => 0,
        (None, Some(_)) => 1,
        (None, None) => return any(),
    };
    let ends = [edges[1 - across], edges[3 - across]].map(|h| mesh.position(mesh.target(h)));
    let along = (ends[1] - ends[0]).reject_from_normalized(normal).normalize_or_zero();
    if along == DVec3::ZERO { SmallVec::new() } else { SmallVec::from_slice(&[along]) }
}

/// How many edges a straight walk along `h` takes to a vertex that was there before; `None` when it gets to none.
fn steps_to_old(mesh: &Mesh, mut h: HalfEdgeId, old: usize) -> Option<usize> {
    for steps in 1..=MOST_LINES {
        let v = mesh.target(h);
        if v.index() < old {
            return Some(steps);
        }
        if mesh.valence(v) != 4 || mesh.is_boundary_vertex(v) {
            return None;
        }
        h = mesh.vertex_cw(mesh.vertex_cw(h.mate()));
    }
    None
}
