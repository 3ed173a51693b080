//! Points of the limit surface at the vertices of a control mesh.

use super::mask::{RingMask, position_mask, sharp_masks, tangent_masks};
use super::ring::{LargeFaces, Ring, RingShape};
use super::sharpness::all_smooth;
use crate::fault;
use crate::mesh::{HalfEdgeId, Mesh, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

/// The limit surface at a vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct LimitPoint {
    /// Where the vertex goes.
    pub position: DVec3,
    /// Two tangents; see [`limit_tangent_masks`](super::limit_tangent_masks) for what they are. Zero where there are
    /// none.
    pub tangents: [DVec3; 2],
}

impl LimitPoint {
    /// The unit normal, or `None` where the tangents do not span a plane.
    pub fn normal(&self) -> Option<DVec3> {
        let noise = ROUNDING * self.position.abs().max_element();
        let sizes = self.tangents.map(|tangent| tangent.abs().max_element());
        if sizes.iter().any(|&size| size <= noise) {
            return None;
        }
        // Squares of products of others might overflow or vanish.
        let harmless = sizes.iter().all(|size| (1e-60..1e60).contains(size));
        let [first, second] = if harmless { self.tangents } else { self.tangents.map(scaled) };
        let cross = first.cross(second);
        let square = cross.length_squared();
        let least = PARALLEL * PARALLEL * first.length_squared() * second.length_squared();
        (square > least).then(|| cross / square.sqrt())
    }
}

/// Tangents shorter than this part of the coordinates are left over from the rounding of differences.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Tangents whose angle is below this (radians) are taken for parallel.
const PARALLEL: f64 = 1e-12;

/// The vector with its largest coordinate made 1, against underflow and overflow of its square; zero stays zero.
fn scaled(vector: DVec3) -> DVec3 {
    let size = vector.abs().max_element();
    if size > 0.0 { vector / size } else { DVec3::ZERO }
}

/// The point of the limit surface at `v`; an isolated vertex stays where it is.
///
/// # Panics
/// When there is no such vertex.
pub fn limit_position(mesh: &Mesh, v: VertexId) -> DVec3 {
    position(mesh, v, &mut Shared::new(mesh))
}

/// Position and tangents of the limit surface at `v`.
///
/// # Panics
/// When there is no such vertex.
pub fn limit_point(mesh: &Mesh, v: VertexId) -> LimitPoint {
    point(mesh, v, &mut Shared::new(mesh))
}

/// The unit normal of the limit surface at `v`, outwards; `None` at an isolated vertex and where the tangents do not
/// span a plane.
///
/// # Panics
/// When there is no such vertex.
pub fn limit_normal(mesh: &Mesh, v: VertexId) -> Option<DVec3> {
    limit_point(mesh, v).normal()
}

/// [`limit_position`] of every vertex id; a removed vertex keeps the position it had.
pub fn limit_positions(mesh: &Mesh) -> Vec<DVec3> {
    each_limit_position(mesh).collect()
}

/// The same, one after the other.
pub(crate) fn each_limit_position(mesh: &Mesh) -> impl ExactSizeIterator<Item = DVec3> {
    let mut shared = Shared::new(mesh);
    let ids = (0..mesh.vertex_bound() as u32).map(VertexId);
    ids.map(move |v| if mesh.has_vertex(v) { position(mesh, v, &mut shared) } else { mesh.position(v) })
}

/// [`limit_point`] of every vertex id; a removed vertex keeps the position it had and has no tangents.
pub fn limit_points(mesh: &Mesh) -> Vec<LimitPoint> {
    each_limit_point(mesh).collect()
}

/// The same, one after the other.
pub(crate) fn each_limit_point(mesh: &Mesh) -> impl ExactSizeIterator<Item = LimitPoint> {
    let mut shared = Shared::new(mesh);
    let ids = (0..mesh.vertex_bound() as u32).map(VertexId);
    ids.map(move |v| if mesh.has_vertex(v) { point(mesh, v, &mut shared) } else { fixed(mesh, v) })
}

/// What the vertices of one mesh can share.
struct Shared {
    /// Nothing but the boundary is sharp.
    smooth: bool,
    large: LargeFaces,
    tangents: FxHashMap<RingShape, [RingMask; 2]>,
}

impl Shared {
    fn new(mesh: &Mesh) -> Self {
        fault::point("limit");
        Self { smooth: all_smooth(mesh), large: LargeFaces::default(), tangents: FxHashMap::default() }
    }
}

/// The limit at a vertex where something is sharp, else `None`.
fn sharp_point(mesh: &Mesh, v: VertexId, shared: &mut Shared) -> Option<LimitPoint> {
    if shared.smooth {
        return None;
    }
    let ring = Ring::new(mesh, v)?;
    let masks = sharp_masks(mesh, &ring)?;
    let centers = centers(mesh, &ring, &mut shared.large);
    let tangents = match &masks.tangents {
        Some([first, second]) => [apply(mesh, &ring, &centers, first), apply(mesh, &ring, &centers, second)],
        None => [DVec3::ZERO; 2],
    };
    Some(LimitPoint { position: apply(mesh, &ring, &centers, &masks.position), tangents })
}

fn position(mesh: &Mesh, v: VertexId, shared: &mut Shared) -> DVec3 {
    if let Some(point) = sharp_point(mesh, v, shared) {
        return point.position;
    }
    if let Some(ring) = RegularRing::new(mesh, v) {
        return ring.position();
    }
    match Ring::new(mesh, v) {
        Some(ring) => {
            apply(mesh, &ring, &centers(mesh, &ring, &mut shared.large), &position_mask(ring.shape()))
        }
        None => mesh.position(v),
    }
}

fn point(mesh: &Mesh, v: VertexId, shared: &mut Shared) -> LimitPoint {
    if let Some(point) = sharp_point(mesh, v, shared) {
        return point;
    }
    if let Some(ring) = RegularRing::new(mesh, v) {
        return LimitPoint { position: ring.position(), tangents: ring.tangents() };
    }
    let Some(ring) = Ring::new(mesh, v) else { return fixed(mesh, v) };
    let centers = centers(mesh, &ring, &mut shared.large);
    let shape = ring.shape();
    let [first, second] = shared.tangents.entry(shape).or_insert_with(|| tangent_masks(shape));
    LimitPoint {
        position: apply(mesh, &ring, &centers, &position_mask(shape)),
        tangents: [apply(mesh, &ring, &centers, first), apply(mesh, &ring, &centers, second)],
    }
}

/// A vertex that stays where it is.
fn fixed(mesh: &Mesh, v: VertexId) -> LimitPoint {
    LimitPoint { position: mesh.position(v), tangents: [DVec3::ZERO; 2] }
}

fn centers(mesh: &Mesh, ring: &Ring, large: &mut LargeFaces) -> SmallVec<[DVec3; 16]> {
    ring.face_edges().iter().map(|&h| large.center(mesh, h)).collect()
}

fn apply(mesh: &Mesh, ring: &Ring, centers: &[DVec3], mask: &RingMask) -> DVec3 {
    let edges = ring.edges.iter().zip(&mask.edges).map(|(&h, &w)| w * mesh.position(mesh.target(h)));
    let faces = centers.iter().zip(&mask.faces).map(|(&center, &w)| w * center);
    mask.vertex * mesh.position(ring.center) + edges.sum::<DVec3>() + faces.sum::<DVec3>()
}

/// Four quads round a vertex: most vertices of most meshes, for which the masks are constants.
struct RegularRing {
    center: DVec3,
    /// Ends of the edges, counter-clockwise.
    edges: [DVec3; 4],
    /// Opposite corners of the faces, face `i` between edges `i` and `i + 1`.
    corners: [DVec3; 4],
}

impl RegularRing {
    // Inlined, so that the ring stays in registers: twice as fast.
    #[inline(always)]
    fn new(mesh: &Mesh, v: VertexId) -> Option<Self> {
        let start = mesh.vertex_half_edge(v)?;
        let mut ring = Self { center: mesh.position(v), edges: [DVec3::ZERO; 4], corners: [DVec3::ZERO; 4] };
        let mut h = start;
        for i in 0..4 {
            let [second, third, last] = quad_after(mesh, h)?;
            ring.edges[i] = mesh.position(mesh.source(second));
            ring.corners[i] = mesh.position(mesh.source(third));
            h = last.mate();
            if (h == start) != (i == 3) {
                return None;
            }
        }
        Some(ring)
    }

    fn position(&self) -> DVec3 {
        let edges: DVec3 = self.edges.iter().sum();
        let corners: DVec3 = self.corners.iter().sum();
        (16.0 * self.center + 4.0 * edges + corners) / 36.0
    }

    fn tangents(&self) -> [DVec3; 2] {
        let [e0, e1, e2, e3] = self.edges;
        let [f0, f1, f2, f3] = self.corners;
        [(e0 - e2) / 3.0 + ((f0 + f3) - (f1 + f2)) / 12.0, (e1 - e3) / 3.0 + ((f0 + f1) - (f2 + f3)) / 12.0]
    }
}

/// The other three half-edges of the face of `h`, if it is a real face with four. The last is looked up first and by itself,
/// so that a walk round a vertex waits for one table access per face and no more.
#[inline(always)]
fn quad_after(mesh: &Mesh, h: HalfEdgeId) -> Option<[HalfEdgeId; 3]> {
    let last = mesh.prev(h);
    let second = mesh.next(h);
    let third = mesh.next(second);
    (mesh.next(third) == last && !mesh.face(h).is_boundary()).then_some([second, third, last])
}
