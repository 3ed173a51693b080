//! From a curve to marks.

use super::track::{Beside, Track};
use crate::feature::FeatureError;
use crate::mark::{Curve, Mark};
use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};
use crate::subdivision::limit_position;
use crate::surface::{ClosestOptions, LimitSurface};
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// A vertex moves by at most this fraction of its shortest edge.
const LONGEST_MOVE: f64 = 0.4;
/// Two vertices of an edge look at one stretch of the curve if their feet are this many edge lengths apart at most.
const SAME_STRETCH: f64 = 3.0;

/// What a curve asks for.
pub(in super::super) struct Traced {
    /// The crossed edges.
    pub(in super::super) marks: Vec<Mark>,
    /// Vertices that lie in the way of the band, and where they go.
    pub(in super::super) moved: Vec<(VertexId, DVec3)>,
    /// Sides of crossed edges behind which the curve ends in a face, and how far in: a fraction of the way to the other
    /// side of the face.
    pub(in super::super) ends: Vec<(HalfEdgeId, f64)>,
    pub(in super::super) track: Track,
}

/// Finds the edges that a curve crosses. `room` gives the distance that vertices are to keep from it, for a
/// typical edge.
///
/// # Errors
/// [`FeatureError::Curve`] when the curve does not lie along the surface, or crosses no edge.
pub(in super::super) fn trace(
    mesh: &Mesh,
    curve: &Curve,
    index: usize,
    room: impl Fn(f64) -> f64,
) -> Result<Traced, FeatureError> {
    let error = |problem: &str| FeatureError::Curve { curve: index, problem: problem.into() };
    let faces = near(mesh, curve);
    let edge = mean_edge(mesh, &faces).ok_or_else(|| {
        error("it is far from the surface; give points on or near the limit surface, in model units")
    })?;
    let surface = LimitSurface::prepared(mesh, &faces)?;
    // Also bounds the number of samples.
    let reach = ClosestOptions { radius: surface.size(), facing: None };
    if let Some(far) = curve.points.iter().position(|&point| surface.closest(point, &reach).is_none()) {
        return Err(error(&format!(
            "point {far} lies far from the surface; give points on or near the limit surface, in model units"
        )));
    }
    let (track, feet) = Track::project(&surface, curve, edge).ok_or_else(|| {
        error("it does not lie along the surface; give points on or near the limit surface, in model units")
    })?;

    let mut crossed: Vec<FaceId> = feet.iter().map(|foot| foot.face).collect();
    crossed.sort_unstable();
    crossed.dedup();
    let edge = mean_edge(mesh, &crossed).unwrap_or(edge);
    let around = mesh.grow_faces(&mesh.grow_faces(&crossed));
    let mut vertices: Vec<VertexId> = around.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
    vertices.sort_unstable();
    vertices.dedup();

    let mut beside: FxHashMap<VertexId, Beside> =
        vertices.iter().filter_map(|&v| Some((v, track.beside(limit_position(mesh, v))?))).collect();
    // Nearest first: whether a vertex can move depends on those that moved before, and not on its number.
    let mut nearest: Vec<(f64, VertexId)> =
        vertices.iter().filter_map(|&v| Some((beside.get(&v)?.distance.abs(), v))).collect();
    nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
    let moved = make_room(mesh, nearest.into_iter().map(|entry| entry.1), &mut beside, room(edge));

    let mut marks: Vec<(f64, Mark)> = Vec::new();
    let mut seen: FxHashSet<u32> = FxHashSet::default();
    for h in vertices.iter().flat_map(|&v| mesh.outgoing(v)) {
        let (Some(a), Some(b)) = (beside.get(&mesh.source(h)), beside.get(&mesh.target(h))) else { continue };
        // From the right of the curve to its left: all marks count in the same direction.
        if !(a.distance < 0.0 && b.distance > 0.0) {
            continue;
        }
        let breadth = b.distance - a.distance;
        let t = -a.distance / breadth;
        if !(a.inside && b.inside) {
            // Beside an end of the curve: what counts is where the edge is crossed.
            let [from, to] = [h, h.mate()].map(|h| limit_position(mesh, mesh.source(h)));
            if (!a.inside && !b.inside) || !track.beside(from.lerp(to, t)).is_some_and(|at| at.inside) {
                continue;
            }
        }
        if !seen.insert(h.edge()) {
            continue;
        }
        if track.between(a.along, b.along) > SAME_STRETCH * breadth.max(mesh.edge_length(h)) {
            continue;
        }
        let mark = Mark { half_edge: h, t, kind: curve.kind.clone(), breadth: Some(breadth) };
        marks.push((a.along + t * (b.along - a.along), mark));
    }
    // In the order in which the curve crosses them.
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut ends = Vec::new();
    if let (Some((start, first)), Some((stop, last)), Some(length)) =
        (marks.first(), marks.last(), track.open_length())
    {
        // The face of a mark's half-edge lies behind, that of its mate ahead.
        let behind = (first.half_edge, first.t, *start);
        let ahead = (last.half_edge.mate(), 1.0 - last.t, length - stop);
        for (h, t, rest) in [behind, ahead] {
            let depth = depth_of_face(mesh, h, t);
            if !mesh.face(h).is_boundary() && depth > 0.0 {
                ends.push((h, rest / depth));
            }
        }
    }
    let marks: Vec<Mark> = marks.into_iter().map(|(_, mark)| mark).collect();
    if marks.is_empty() {
        return Err(error("it crosses no edge; it must reach from face to face"));
    }
    Ok(Traced { marks, moved, ends, track })
}

/// How far it is through the face of `h`, from the place `t` on `h` to the same place between the neighbours of its ends:
/// the frame in which the rules place an end.
fn depth_of_face(mesh: &Mesh, h: HalfEdgeId, t: f64) -> f64 {
    let near = mesh.position(mesh.source(h)).lerp(mesh.position(mesh.target(h)), t);
    let [left, right] = [mesh.source(mesh.prev(h)), mesh.target(mesh.next(h))].map(|v| mesh.position(v));
    near.distance(left.lerp(right, t))
}

/// Faces whose control points come near the curve's bounding box.
fn near(mesh: &Mesh, curve: &Curve) -> Vec<FaceId> {
    let (low, high) = curve
        .points
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    mesh.faces()
        .filter(|&f| {
            let (a, b) = mesh
                .face_vertices(f)
                .map(|v| mesh.position(v))
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
            let margin = DVec3::splat((b - a).length());
            (a - margin).cmple(high).all() && (b + margin).cmpge(low).all()
        })
        .collect()
}

fn mean_edge(mesh: &Mesh, faces: &[FaceId]) -> Option<f64> {
    let lengths = || faces.iter().flat_map(|&f| mesh.face_half_edges(f)).map(|h| mesh.edge_length(h));
    let count = lengths().count();
    let mean = lengths().sum::<f64>() / count as f64;
    (count > 0 && mean > 0.0 && mean.is_finite()).then_some(mean)
}

/// Moves vertices that lie nearer to the curve than `room` away from it, in the surface; those of the boundary along the
/// boundary. Faces stay convex.
fn make_room(
    mesh: &Mesh,
    vertices: impl Iterator<Item = VertexId>,
    beside: &mut FxHashMap<VertexId, Beside>,
    room: f64,
) -> Vec<(VertexId, DVec3)> {
    let mut moved: FxHashMap<VertexId, DVec3> = FxHashMap::default();
    let mut order = Vec::new();
    for v in vertices {
        let Some(at) = beside.get_mut(&v) else { continue };
        if !at.inside || at.distance.abs() >= room {
            continue;
        }
        let away = at.left * if at.distance < 0.0 { -1.0 } else { 1.0 };
        let wanted = room - at.distance.abs();
        let shift = match boundary_direction(mesh, v) {
            Some(along) => {
                let part = along.dot(away);
                if part.abs() < 0.1 {
                    continue;
                }
                along * (wanted / part)
            }
            None => away * wanted,
        };
        let shortest = mesh.outgoing(v).map(|h| mesh.edge_length(h)).fold(f64::INFINITY, f64::min);
        let mut factor = (LONGEST_MOVE * shortest / shift.length()).min(1.0);
        for _ in 0..4 {
            moved.insert(v, mesh.position(v) + shift * factor);
            if stays_convex(mesh, v, at.normal, &moved) {
                break;
            }
            factor /= 2.0;
            moved.remove(&v);
        }
        if moved.contains_key(&v) {
            at.distance += at.distance.signum() * wanted * factor;
            order.push(v);
        }
    }
    order.into_iter().filter_map(|v| Some((v, *moved.get(&v)?))).collect()
}

/// Direction of the boundary at one of its vertices.
fn boundary_direction(mesh: &Mesh, v: VertexId) -> Option<DVec3> {
    let out = mesh.outgoing(v).find(|&h| mesh.face(h).is_boundary())?;
    let (next, previous) = (mesh.target(out), mesh.source(mesh.prev(out)));
    Some((mesh.position(next) - mesh.position(previous)).normalize_or_zero())
}

/// True when the faces around a moved vertex that were convex, seen along `normal`, still are.
fn stays_convex(mesh: &Mesh, v: VertexId, normal: DVec3, moved: &FxHashMap<VertexId, DVec3>) -> bool {
    let after = |v: VertexId| moved.get(&v).copied().unwrap_or_else(|| mesh.position(v));
    let before = |v: VertexId| mesh.position(v);
    let turns = |f: FaceId, position: &dyn Fn(VertexId) -> DVec3| {
        mesh.face_half_edges(f).all(|h| {
            let [a, b, c] = [mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))].map(position);
            (b - a).cross(c - b).dot(normal) > 0.0
        })
    };
    mesh.outgoing(v)
        .map(|h| mesh.face(h))
        .filter(|f| !f.is_boundary())
        .all(|f| turns(f, &after) || !turns(f, &before))
}
