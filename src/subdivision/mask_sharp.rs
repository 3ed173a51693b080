//! Limit masks at vertices where something is sharp.
//!
//! The ring is refined until nothing is semi-sharp, at most ten times; then the masks are those of infinite creases,
//! corners and darts, and they are carried back through the refinements.

use super::dart::{DartMasks, dart_step};
use super::mask::{RingMask, position_mask, tangent_masks};
use super::mask_step::{Step, with_opposite_vertices};
use super::ring::RingShape;
use super::sharpness::Around;
use crate::mesh::Creasing;

/// Position, and tangents where the vertex has a tangent plane.
pub(super) struct SharpMasks {
    pub(super) position: RingMask,
    pub(super) tangents: Option<[RingMask; 2]>,
}

/// What a scheme does at a vertex, as masks.
pub(super) trait RingScheme {
    /// Carries a mask on the refined ring back to the present one.
    fn carry_back(step: &Step, shape: RingShape, refined: &RingMask) -> RingMask;
    /// The limit position where nothing is sharp but the boundary.
    fn position(shape: RingShape) -> RingMask;
    /// Two tangents there.
    fn tangents(shape: RingShape) -> [RingMask; 2];
    /// The masks of a dart on the ring that [`carry_back`](Self::carry_back) takes, the crease being spoke 0.
    fn dart(faces: usize) -> DartMasks;
}

/// The Catmull-Clark scheme.
pub(super) struct CatmullClark;

impl RingScheme for CatmullClark {
    fn carry_back(step: &Step, shape: RingShape, refined: &RingMask) -> RingMask {
        step.carry_back(shape, &with_opposite_vertices(shape, refined))
    }

    fn position(shape: RingShape) -> RingMask {
        position_mask(shape)
    }

    fn tangents(shape: RingShape) -> [RingMask; 2] {
        tangent_masks(shape)
    }

    fn dart(faces: usize) -> DartMasks {
        let shape = RingShape { faces, on_boundary: false };
        let DartMasks { position, along, across } = DartMasks::new(faces);
        let step = dart_step(faces, 0);
        let [position, along, across] = [position, along, across].map(|mask| step.carry_back(shape, &mask));
        DartMasks { position, along, across }
    }
}

impl SharpMasks {
    /// The masks of a ring round which `around` is sharp.
    pub(super) fn new<S: RingScheme>(shape: RingShape, mut around: Around, creasing: Creasing) -> Self {
        let mut steps = Vec::new();
        while around.is_semi_sharp() {
            steps.push(Step::new(&around, creasing));
            around = around.refined(creasing);
        }
        let mut masks = Self::infinite::<S>(shape, &around);
        for step in steps.iter().rev() {
            let back = |mask: &RingMask| S::carry_back(step, shape, mask);
            masks.position = back(&masks.position);
            masks.tangents = masks.tangents.map(|tangents| tangents.map(|mask| back(&mask)));
        }
        masks
    }

    /// The masks where sharpness is 0 or infinite.
    fn infinite<S: RingScheme>(shape: RingShape, around: &Around) -> Self {
        let sharp = around.infinite_spokes();
        if around.is_fixed() {
            let position = RingMask::zero(shape, 1.0);
            let tangents = sector(shape, &sharp).map(|(first, _)| {
                [first, (first + 1) % shape.edges()].map(|spoke| {
                    let mut mask = RingMask::zero(shape, -1.0);
                    mask.edges[spoke] = 1.0;
                    mask
                })
            });
            return Self { position, tangents };
        }
        match sharp[..] {
            [a, b] => {
                let mut position = RingMask::zero(shape, 4.0 / 6.0);
                position.edges[a] += 1.0 / 6.0;
                position.edges[b] += 1.0 / 6.0;
                let tangents = sector(shape, &sharp).map(|(first, faces)| {
                    let part = RingShape { faces, on_boundary: true };
                    S::tangents(part).map(|mask| embedded(shape, &mask, first))
                });
                Self { position, tangents }
            }
            [crease] => {
                let masks = S::dart(shape.faces);
                let turned = |mask: &RingMask| embedded(shape, mask, crease);
                Self {
                    position: turned(&masks.position),
                    tangents: Some([turned(&masks.along), turned(&masks.across)]),
                }
            }
            _ => Self { position: S::position(shape), tangents: Some(S::tangents(shape)) },
        }
    }
}

/// First spoke and number of faces of the sector between sharp spokes that holds face 0; `None` without sharp spokes.
fn sector(shape: RingShape, sharp: &[usize]) -> Option<(usize, usize)> {
    let (&least, &greatest) = (sharp.first()?, sharp.last()?);
    let count = shape.edges();
    let (first, last) =
        if least > 0 { (greatest, least) } else { (least, sharp.get(1).copied().unwrap_or(least)) };
    let faces = (last + count - first) % count;
    Some((first, if faces == 0 { count } else { faces }))
}

/// A mask of some neighbouring faces as one of the whole ring.
fn embedded(shape: RingShape, part: &RingMask, first: usize) -> RingMask {
    let mut mask = RingMask::zero(shape, part.vertex);
    let count = mask.edges.len();
    for (i, &w) in part.edges.iter().enumerate() {
        mask.edges[(first + i) % count] += w;
    }
    let count = mask.faces.len();
    for (i, &w) in part.faces.iter().enumerate() {
        mask.faces[(first + i) % count] += w;
    }
    mask
}
