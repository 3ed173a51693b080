//! Limit position and limit tangents of a vertex as weights.
//!
//! All masks are left eigenvectors of the subdivision matrix (Halstead, Kass, DeRose 1993), written for the ring after
//! one refinement and carried back to the present ring. Written in the vertex, its edges' ends and the *centres* of
//! its faces they hold for faces of any size: for quads they are the usual masks, identically, and elsewhere exactly
//! what refining once and applying the usual masks gives.
//!
//! At a boundary vertex with one or two faces the tangents are those of OpenSubdiv. With three faces and more the
//! masks of Biermann, Levin, Zorin (2000), which OpenSubdiv applies, belong to subdivision rules modified near the
//! boundary; under the rules in use they give another plane on each level. The masks here are eigenvectors of the
//! rules in use, and their plane is the one to which those of the levels converge.

use super::mask_sharp::{CatmullClark, SharpMasks};
use super::ring::{Ring, RingShape};
use super::sharpness::Around;
use crate::mesh::{Mesh, VertexId};
use smallvec::{SmallVec, smallvec};
use std::f64::consts::PI;

/// A linear combination of control vertices: ascending ids, each once.
pub type LimitMask = SmallVec<[(VertexId, f64); 20]>;

/// Weights by the roles that control points have in a ring.
#[derive(Clone, Debug)]
pub(super) struct RingMask {
    pub(super) vertex: f64,
    /// One per edge, for the vertex at its far end.
    pub(super) edges: SmallVec<[f64; 16]>,
    /// One per face, for the mean of its vertices.
    pub(super) faces: SmallVec<[f64; 16]>,
}

/// The weights of the limit position of `v`; their sum is 1. An isolated vertex stays where it is.
///
/// # Panics
/// When there is no such vertex.
pub fn limit_mask(mesh: &Mesh, v: VertexId) -> LimitMask {
    match Ring::new(mesh, v) {
        Some(ring) => match sharp_masks(mesh, &ring) {
            Some(masks) => expand(mesh, &ring, &masks.position),
            None => expand(mesh, &ring, &position_mask(ring.shape())),
        },
        None => smallvec![(v, 1.0)],
    }
}

/// The masks of a ring where something is sharp, else `None`.
pub(super) fn sharp_masks(mesh: &Mesh, ring: &Ring) -> Option<SharpMasks> {
    let around = Around::of(mesh, ring.center, &ring.edges)?;
    Some(SharpMasks::new::<CatmullClark>(ring.shape(), around, mesh.subdivision().creasing))
}

/// The weights of two tangents of the limit surface at `v`, whose cross product points outwards; `None` at an isolated
/// vertex and at a sharp vertex without a sharp edge (the surface has a spike there). The sum of each is 0. At a regular vertex, and on a regular boundary, they are the derivatives by the
/// parameters of the faces (along [`Mesh::vertex_half_edge`] and across it); elsewhere only their directions have a
/// meaning. On the boundary the first runs against the direction of the boundary loop's half-edges, the surface
/// on its left.
///
/// On an infinitely sharp crease they are those of one of its sides, the one with the face of
/// [`Mesh::vertex_half_edge`] or, at a boundary, with the first face counter-clockwise; at a vertex that stays in its
/// place they lead to two neighbouring vertices.
///
/// # Panics
/// When there is no such vertex.
pub fn limit_tangent_masks(mesh: &Mesh, v: VertexId) -> Option<[LimitMask; 2]> {
    let ring = Ring::new(mesh, v)?;
    if let Some(masks) = sharp_masks(mesh, &ring) {
        return Some(masks.tangents?.map(|mask| expand(mesh, &ring, &mask)));
    }
    Some(tangent_masks(ring.shape()).map(|mask| expand(mesh, &ring, &mask)))
}

pub(super) fn position_mask(ring: RingShape) -> RingMask {
    if ring.on_boundary {
        let mut mask = RingMask::zero(ring, 4.0 / 6.0);
        *mask.first_edge() += 1.0 / 6.0;
        *mask.last_edge() += 1.0 / 6.0;
        return mask;
    }
    // (n^2 v + 4 sum e + sum f) / (n (n + 5)) on the refined ring.
    let n = ring.faces as f64;
    let total = n * (n + 5.0);
    RingMask {
        vertex: (n - 1.0) / (n + 5.0),
        edges: smallvec![2.0 / total; ring.edges()],
        faces: smallvec![4.0 / total; ring.faces],
    }
}

pub(super) fn tangent_masks(ring: RingShape) -> [RingMask; 2] {
    if ring.on_boundary {
        [along_boundary(ring), across_boundary(ring)]
    } else if ring.faces == 2 {
        two_faces(ring)
    } else {
        interior_tangents(ring)
    }
}

impl RingMask {
    pub(super) fn zero(ring: RingShape, vertex: f64) -> Self {
        Self { vertex, edges: smallvec![0.0; ring.edges()], faces: smallvec![0.0; ring.faces] }
    }

    fn first_edge(&mut self) -> &mut f64 {
        &mut self.edges[0]
    }

    fn last_edge(&mut self) -> &mut f64 {
        let last = self.edges.len() - 1;
        &mut self.edges[last]
    }
}

/// The subdominant eigenvalue of a sector of the ring with the angle `theta` between edges.
pub(crate) fn eigenvalue(theta: f64) -> f64 {
    let cos = theta.cos();
    (5.0 + cos + (theta * 0.5).cos() * (18.0 + 2.0 * cos).sqrt()) / 16.0
}

/// With the wave w along the ring the mask is 4 w_i on edge points and (w_i + w_(i+1)) / (4 lambda - 1) on face
/// points; carried back to the unrefined ring, w_i / lambda on edges and 4 (w_i + w_(i+1)) / (4 lambda - 1) on centres.
fn interior_tangents(ring: RingShape) -> [RingMask; 2] {
    let n = ring.faces;
    let theta = 2.0 * PI / n as f64;
    let lambda = eigenvalue(theta);
    // The tangents of a regular vertex become derivatives.
    let scale = 4.0 / n as f64 / 12.0;
    let wave = |value: &dyn Fn(usize) -> f64| RingMask {
        vertex: 0.0,
        edges: (0..n).map(|i| scale / lambda * value(i)).collect(),
        faces: (0..n).map(|i| scale * 4.0 / (4.0 * lambda - 1.0) * (value(i) + value((i + 1) % n))).collect(),
    };
    if n == 4 {
        const COSINE: [f64; 4] = [1.0, 0.0, -1.0, 0.0];
        return [wave(&|i| COSINE[i]), wave(&|i| COSINE[(i + 3) % 4])];
    }
    [wave(&|i| (i as f64 * theta).cos()), wave(&|i| (i as f64 * theta).sin())]
}

/// Two faces: the eigenvalue 1/4 belongs to the difference of the edges and to that of the faces (and to an
/// alternating mode, so that the surface need not have a tangent plane here).
fn two_faces(ring: RingShape) -> [RingMask; 2] {
    let [mut edges, mut faces] = [RingMask::zero(ring, 0.0), RingMask::zero(ring, 0.0)];
    edges.edges.copy_from_slice(&[0.5, -0.5]);
    faces.faces.copy_from_slice(&[0.5, -0.5]);
    [edges, faces]
}

fn along_boundary(ring: RingShape) -> RingMask {
    let mut mask = RingMask::zero(ring, 0.0);
    *mask.first_edge() += 0.5;
    *mask.last_edge() -= 0.5;
    mask
}

/// The eigenvector that vanishes on the boundary in its inner part: a sine along the ring, as in the interior with
/// half the angle; the weights of the boundary's points follow from the boundary's columns of the matrix.
fn across_boundary(ring: RingShape) -> RingMask {
    let k = ring.faces;
    if k == 1 {
        let mut mask = RingMask::zero(ring, -1.0);
        *mask.first_edge() += 0.5;
        *mask.last_edge() += 0.5;
        return mask;
    }
    let theta = PI / k as f64;
    let lambda = eigenvalue(theta);
    let sine = |i: usize| if i == 0 || i == k { 0.0 } else { (i as f64 * theta).sin() };
    let sum = 1.0 / (theta * 0.5).tan();
    let face = 1.0 / (4.0 * lambda - 1.0);
    // Unknown weights b of the vertex and g of both boundary neighbours on the refined ring:
    // (lambda - 3/4) b - g = p, -b/8 + (lambda - 1/2) g = q.
    let p = 1.5 * sum + 0.5 * sum * face;
    let q = 0.25 * sine(1) * (1.0 + face);
    let determinant = (lambda - 1.0) * (lambda - 0.25);
    let b = (p * (lambda - 0.5) + q) / determinant;
    let g = (q * (lambda - 0.75) + p * 0.125) / determinant;
    let scale = 4.0 / (3.0 * k as f64) / 4.0;
    RingMask {
        vertex: scale * (0.75 * b + g + sum) / lambda,
        edges: (0..=k)
            .map(|i| if i == 0 || i == k { 0.125 * b + 0.5 * g } else { sine(i) })
            .map(|weight| scale * weight / lambda)
            .collect(),
        faces: (0..k).map(|i| scale * 4.0 * face * (sine(i) + sine(i + 1))).collect(),
    }
}

/// Spreads the weights of the faces over their vertices.
pub(super) fn expand(mesh: &Mesh, ring: &Ring, mask: &RingMask) -> LimitMask {
    let mut row = LimitMask::new();
    row.push((ring.center, mask.vertex));
    row.extend(ring.edges.iter().zip(&mask.edges).map(|(&h, &weight)| (mesh.target(h), weight)));
    for (&h, &weight) in ring.face_edges().iter().zip(&mask.faces) {
        if weight != 0.0 {
            let face = mesh.face(h);
            let share = weight / mesh.arity(face) as f64;
            row.extend(mesh.face_vertices(face).map(|v| (v, share)));
        }
    }
    // Stable, so that equal vertices are added in the order of the ring.
    row.sort_by_key(|&(v, _)| v);
    row.dedup_by(|later, kept| {
        let same = later.0 == kept.0;
        if same {
            kept.1 += later.1;
        }
        same
    });
    row.retain(|&mut (_, weight)| weight != 0.0);
    row
}
