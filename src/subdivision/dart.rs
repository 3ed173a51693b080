//! Limit masks of a dart: a vertex at which one infinitely sharp crease ends.
//!
//! The vertex moves by the smooth rule, but the crease's edge point is its middle, so that the smooth limit masks are
//! not exact. The exact ones are left eigenvectors of the dart's own subdivision matrix, found by iteration. The mode
//! that is odd about the crease vanishes on it and is that of the smooth vertex.

use super::mask::{RingMask, eigenvalue};
use super::mask_step::{Step, with_opposite_vertices};
use super::ring::RingShape;
use super::sharpness::VertexBlend;
use smallvec::{SmallVec, smallvec};
use std::f64::consts::PI;

/// Masks on the ring of quads of a dart, whose crease is spoke 0. Face weights are those of the vertices opposite to
/// the centre.
#[derive(Clone, Debug)]
pub(super) struct DartMasks {
    pub(super) position: RingMask,
    /// Tangent along the crease, outwards.
    pub(super) along: RingMask,
    /// Tangent across it, counter-clockwise.
    pub(super) across: RingMask,
}

/// Most iterations; the share of other modes halves within a few, but slowly for the tangent at large valences.
const MOST: usize = 4000;

impl DartMasks {
    /// The masks of a dart with `faces` faces.
    pub(super) fn new(faces: usize) -> Self {
        let shape = RingShape { faces, on_boundary: false };
        let step = dart_step(faces, 0);
        let once = |mask: &RingMask| with_opposite_vertices(shape, &step.carry_back(shape, mask));
        let n = faces as f64;
        let total = n * (n + 5.0);
        let smooth = RingMask {
            vertex: n * n / total,
            edges: smallvec![4.0 / total; faces],
            faces: smallvec![1.0 / total; faces],
        };
        let wave = |value: &dyn Fn(f64) -> f64| {
            let theta = 2.0 * PI / n;
            let spoke = 4.0 * (4.0 * eigenvalue(theta) - 1.0);
            let scale = 1.0 / (3.0 * n);
            let at = |i: usize| value(theta * i as f64);
            RingMask {
                vertex: 0.0,
                edges: (0..faces).map(|i| scale * spoke * at(i)).collect(),
                faces: (0..faces).map(|i| scale * (at(i) + at(i + 1))).collect(),
            }
        };
        Self::converged(smooth, [wave(&f64::cos), wave(&f64::sin)], &once)
    }

    /// The masks that refinement `once` leaves as they are but for a factor, from those of the smooth vertex, of which
    /// the tangent across the crease is one already.
    pub(super) fn converged(
        position: RingMask,
        [along, across]: [RingMask; 2],
        once: &dyn Fn(&RingMask) -> RingMask,
    ) -> Self {
        let position = converged(position, once);
        // Without the shares of the position's and of odd modes that rounding brings in, which would outgrow the rest.
        let without_others = |mask: &RingMask| {
            let mut next = once(mask);
            make_even(&mut next);
            let sum = next.vertex + next.edges.iter().chain(&next.faces).sum::<f64>();
            next.vertex -= sum * position.vertex;
            let weights = position.edges.iter().chain(&position.faces);
            for (weight, &share) in next.edges.iter_mut().chain(&mut next.faces).zip(weights) {
                *weight -= sum * share;
            }
            next
        };
        let along = converged(along, &without_others);
        Self { position, along, across }
    }
}

/// The rules at a dart whose crease is spoke `crease`.
pub(super) fn dart_step(faces: usize, crease: usize) -> Step {
    let mut shares: SmallVec<[f64; 16]> = smallvec![0.0; faces];
    shares[crease] = 1.0;
    Step { blend: VertexBlend::SMOOTH, shares }
}

fn size(mask: &RingMask) -> f64 {
    mask.vertex.abs() + mask.edges.iter().chain(&mask.faces).map(|w| w.abs()).sum::<f64>()
}

/// Makes a mask the same on both sides of spoke 0.
fn make_even(mask: &mut RingMask) {
    let count = mask.edges.len();
    for i in 1..count.div_ceil(2) {
        let mean = 0.5 * (mask.edges[i] + mask.edges[count - i]);
        (mask.edges[i], mask.edges[count - i]) = (mean, mean);
    }
    for i in 0..count / 2 {
        let mean = 0.5 * (mask.faces[i] + mask.faces[count - 1 - i]);
        (mask.faces[i], mask.faces[count - 1 - i]) = (mean, mean);
    }
}

/// Applies `once` until the mask, whose sum of amounts is kept, stays.
fn converged(mut mask: RingMask, once: &dyn Fn(&RingMask) -> RingMask) -> RingMask {
    let length = size(&mask);
    for _ in 0..MOST {
        let mut next = once(&mask);
        let scale = length / size(&next);
        next.vertex *= scale;
        next.edges.iter_mut().chain(&mut next.faces).for_each(|w| *w *= scale);
        let pairs = next.edges.iter().chain(&next.faces).zip(mask.edges.iter().chain(&mask.faces));
        let change = pairs.map(|(a, b)| (a - b).abs()).sum::<f64>() + (next.vertex - mask.vertex).abs();
        mask = next;
        if change <= 2.0 * f64::EPSILON * length {
            break;
        }
    }
    mask
}
