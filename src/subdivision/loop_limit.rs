//! Limit masks of Loop subdivision, in closed form where nothing but the boundary is sharp.
//!
//! Rings are written in the vertex and its edges' ends; the weights of faces in the masks are 0.

use super::dart::{DartMasks, dart_step};
use super::limit::LimitPoint;
use super::loop_refine::LoopSurface;
use super::mask::{LimitMask, RingMask, expand};
use super::mask_sharp::{RingScheme, SharpMasks};
use super::mask_step::Step;
use super::ring::{Ring, RingShape};
use super::sharpness::{Around, VertexBlend};
use crate::mesh::VertexId;
use glam::DVec3;
use smallvec::smallvec;
use std::f64::consts::PI;

/// Weight of each neighbour in the vertex point of an interior vertex of valence `count`.
pub(super) fn edge_weight(count: usize) -> f64 {
    if count == 6 {
        return 0.0625;
    }
    let n = count as f64;
    let beta = 0.375 + 0.25 * (2.0 * PI / n).cos();
    (0.625 - beta * beta) / n
}

/// The scheme of Loop.
struct Loop;

impl RingScheme for Loop {
    fn carry_back(step: &Step, shape: RingShape, refined: &RingMask) -> RingMask {
        let mut mask = RingMask::zero(shape, 0.0);
        let VertexBlend { corner, crease, crease_edges } = step.blend;
        let (w, smooth) = (refined.vertex, step.blend.smooth());
        let count = shape.edges();
        mask.vertex = w * (corner + 0.75 * crease);
        if crease > 0.0 {
            crease_edges.iter().for_each(|&j| mask.edges[j] += 0.125 * w * crease);
        }
        if !shape.on_boundary {
            let weight = edge_weight(count);
            mask.vertex += w * smooth * (1.0 - weight * count as f64);
            mask.edges.iter_mut().for_each(|edge| *edge += w * smooth * weight);
        }
        for (j, &w) in refined.edges.iter().enumerate() {
            let share = step.shares[j];
            let end = w * (0.5 * share + 0.375 * (1.0 - share));
            mask.vertex += end;
            mask.edges[j] += end;
            if share < 1.0 {
                let side = 0.125 * w * (1.0 - share);
                mask.edges[if j > 0 { j - 1 } else { count - 1 }] += side;
                mask.edges[if j + 1 < count { j + 1 } else { 0 }] += side;
            }
        }
        mask
    }

    fn position(shape: RingShape) -> RingMask {
        if shape.on_boundary {
            let mut mask = RingMask::zero(shape, 4.0 / 6.0);
            let last = mask.edges.len() - 1;
            mask.edges[0] += 1.0 / 6.0;
            mask.edges[last] += 1.0 / 6.0;
            return mask;
        }
        let n = shape.faces as f64;
        let weight = 1.0 / (n + 3.0 / (8.0 * edge_weight(shape.faces)));
        let mut mask = RingMask::zero(shape, 1.0 - n * weight);
        mask.edges.fill(weight);
        mask
    }

    fn tangents(shape: RingShape) -> [RingMask; 2] {
        if shape.on_boundary {
            return [along_boundary(shape), across_boundary(shape)];
        }
        let n = shape.faces as f64;
        let wave = |value: &dyn Fn(f64) -> f64| {
            let mut mask = RingMask::zero(shape, 0.0);
            mask.edges = (0..shape.faces).map(|i| 2.0 / n * value(2.0 * PI * i as f64 / n)).collect();
            mask
        };
        [wave(&f64::cos), wave(&f64::sin)]
    }

    fn dart(faces: usize) -> DartMasks {
        let shape = RingShape { faces, on_boundary: false };
        let step = dart_step(faces, 0);
        let once = |mask: &RingMask| Self::carry_back(&step, shape, mask);
        DartMasks::converged(Self::position(shape), Self::tangents(shape), &once)
    }
}

fn along_boundary(shape: RingShape) -> RingMask {
    let mut mask = RingMask::zero(shape, 0.0);
    let last = mask.edges.len() - 1;
    mask.edges[0] += 0.5;
    mask.edges[last] -= 0.5;
    mask
}

/// The eigenvector that is a sine along the inner edges; the weights of the boundary follow from its columns of the
/// matrix, as for Catmull-Clark.
fn across_boundary(shape: RingShape) -> RingMask {
    let k = shape.faces;
    if k == 1 {
        return RingMask { vertex: -1.0, edges: smallvec![0.5; 2], faces: smallvec![0.0] };
    }
    let theta = PI / k as f64;
    let lambda = 0.375 + 0.25 * theta.cos();
    let sine = |i: usize| (i as f64 * theta).sin();
    let sum = 1.0 / (theta * 0.5).tan();
    // Weights b of the vertex and g of both boundary neighbours: (lambda - 3/4) b - g = p, -b/8 + (lambda - 1/2) g = q.
    let (p, q) = (0.375 * sum, 0.125 * sine(1));
    let determinant = (lambda - 1.0) * (lambda - 0.25);
    let b = (p * (lambda - 0.5) + q) / determinant;
    let g = (q * (lambda - 0.75) + 0.125 * p) / determinant;
    let scale = 2.0 / k as f64;
    let edges = (0..=k).map(|i| scale * if i == 0 || i == k { g } else { sine(i) }).collect();
    RingMask { vertex: scale * b, edges, faces: smallvec![0.0; k] }
}

impl LoopSurface<'_> {
    fn masks(&self, v: VertexId) -> Option<(Ring, SharpMasks)> {
        let ring = Ring::new(self.mesh, v)?;
        let shape = ring.shape();
        let masks = match Around::of(self.mesh, v, &ring.edges) {
            Some(around) => SharpMasks::new::<Loop>(shape, around, self.mesh.subdivision().creasing),
            None => SharpMasks { position: Loop::position(shape), tangents: Some(Loop::tangents(shape)) },
        };
        Some((ring, masks))
    }

    /// The weights of the limit position of `v`; their sum is 1. An isolated vertex stays where it is.
    ///
    /// # Panics
    /// When there is no such vertex.
    pub fn limit_mask(&self, v: VertexId) -> LimitMask {
        match self.masks(v) {
            Some((ring, masks)) => expand(self.mesh, &ring, &masks.position),
            None => smallvec![(v, 1.0)],
        }
    }

    /// The weights of two tangents at `v`, whose cross product points outwards, for the side that
    /// [`limit_tangent_masks`](super::limit_tangent_masks) speaks of; `None` at an isolated vertex and at a spike.
    ///
    /// # Panics
    /// When there is no such vertex.
    pub fn limit_tangent_masks(&self, v: VertexId) -> Option<[LimitMask; 2]> {
        let (ring, masks) = self.masks(v)?;
        Some(masks.tangents?.map(|mask| expand(self.mesh, &ring, &mask)))
    }

    /// Position and tangents of the limit surface at `v`; no tangents where there are no masks for them.
    ///
    /// # Panics
    /// When there is no such vertex.
    pub fn limit_point(&self, v: VertexId) -> LimitPoint {
        let Some((ring, masks)) = self.masks(v) else {
            return LimitPoint { position: self.mesh.position(v), tangents: [DVec3::ZERO; 2] };
        };
        let apply = |mask: &RingMask| {
            let edges = ring.edges.iter().zip(&mask.edges);
            let sum: DVec3 = edges.map(|(&h, &w)| w * self.mesh.position(self.mesh.target(h))).sum();
            mask.vertex * self.mesh.position(v) + sum
        };
        let tangents = masks.tangents.as_ref().map_or([DVec3::ZERO; 2], |[a, b]| [apply(a), apply(b)]);
        LimitPoint { position: apply(&masks.position), tangents }
    }
}
