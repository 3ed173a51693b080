//! One refinement of a ring, seen from its masks: what a mask on the refined ring is on the present one.

use super::mask::RingMask;
use super::ring::RingShape;
use super::sharpness::{Around, VertexBlend};
use crate::mesh::Creasing;
use smallvec::SmallVec;

/// The rules that one refinement of a ring applies.
pub(super) struct Step {
    pub(super) blend: VertexBlend,
    /// Per spoke the share of the crease's mask.
    pub(super) shares: SmallVec<[f64; 16]>,
}

impl Step {
    pub(super) fn new(around: &Around, creasing: Creasing) -> Self {
        let shares = (0..around.spokes.len()).map(|j| around.crease_share(creasing, j)).collect();
        Self { blend: around.blend(creasing), shares }
    }

    /// Carries a mask on the refined ring, whose face weights are those of the vertices opposite to the centre (the
    /// face points of the present ring), back to the present ring, where they are those of the faces' centres.
    pub(super) fn carry_back(&self, shape: RingShape, refined: &RingMask) -> RingMask {
        let mut mask = RingMask::zero(shape, 0.0);
        let VertexBlend { corner, crease, crease_edges, .. } = self.blend;
        let (w, smooth) = (refined.vertex, self.blend.smooth());
        mask.vertex = w * (corner + 0.75 * crease);
        if crease > 0.0 {
            crease_edges.iter().for_each(|&j| mask.edges[j] += 0.125 * w * crease);
        }
        if !shape.on_boundary {
            let n = shape.faces as f64;
            mask.vertex += w * smooth * (n - 2.0) / n;
            let share = w * smooth / (n * n);
            mask.edges.iter_mut().chain(&mut mask.faces).for_each(|weight| *weight += share);
        }
        for (j, &w) in refined.edges.iter().enumerate() {
            let share = self.shares[j];
            let end = w * (0.5 * share + 0.25 * (1.0 - share));
            mask.vertex += end;
            mask.edges[j] += end;
            let side = 0.25 * w * (1.0 - share);
            if side != 0.0 {
                mask.faces[j] += side;
                mask.faces[if j > 0 { j - 1 } else { shape.faces - 1 }] += side;
            }
        }
        for (weight, &w) in mask.faces.iter_mut().zip(&refined.faces) {
            *weight += w;
        }
        mask
    }
}

/// A mask on a ring of quads with the weights of their opposite vertices in place of those of their centres.
pub(super) fn with_opposite_vertices(shape: RingShape, centred: &RingMask) -> RingMask {
    let mut mask = RingMask::zero(shape, centred.vertex);
    mask.edges.copy_from_slice(&centred.edges);
    let count = mask.edges.len();
    for (j, &w) in centred.faces.iter().enumerate() {
        let quarter = 0.25 * w;
        mask.vertex += quarter;
        mask.edges[j] += quarter;
        mask.edges[if j + 1 == count { 0 } else { j + 1 }] += quarter;
        mask.faces[j] = quarter;
    }
    mask
}
