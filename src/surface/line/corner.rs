//! Crossings beside an extraordinary vertex, below the pieces.

use super::Bicubic;
use super::piece::Crossing;
use super::search::Search;
use crate::subdivision::patch_corner::{Corner, Points};
use crate::surface::index::Rest;
use glam::DVec3;

/// Refinements beside an extraordinary vertex; see the same limit of evaluation.
const MAX_DEPTH: u32 = 128;

impl Search<'_> {
    /// Looks at what lies beside an extraordinary vertex, level by level.
    pub(super) fn visit_rest(&mut self, entry: &Rest) {
        let tolerance = self.surface.tolerance;
        let mut corner = entry.corner(self.surface);
        let mut domain = entry.domain;
        let position = self.frame * (corner.origin - self.base);
        let hit = position.truncate().length() <= tolerance;
        let mut reported = false;
        let mut scratch = Points::new();
        for _ in 0..MAX_DEPTH {
            let shift = corner.origin - self.base;
            let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let (low, high) = corner.control_points().fold(empty, |(low, high), p| {
                let p = self.frame * (p + shift);
                (low.min(p), high.max(p))
            });
            if !self.meets(low, high) {
                return;
            }
            if hit && !reported {
                reported = true;
                let normal = self.frame * entry.normal;
                self.take(&domain, Crossing { a: 0.0, b: 0.0, position, normal });
            }
            // The line goes through the vertex, and only there where the fan is seen along it without a fold.
            let extent = (high - low).truncate().length();
            if hit && (extent <= tolerance || self.sees_plain_fan(&corner)) {
                return;
            }
            let sides = corner.refine(&mut scratch);
            for (side, grid) in sides.iter().enumerate() {
                self.visit(&Bicubic::from_bspline(grid), corner.origin, &domain.side(side));
            }
            domain = domain.inner();
        }
    }

    /// True when all triangles of the fan round the vertex turn the same way, seen along the line, and none is seen
    /// at a grazing angle: then neither does the surface fold.
    fn sees_plain_fan(&self, corner: &Corner) -> bool {
        let direction = self.frame.row(2);
        let mut signs = [false; 2];
        let count = corner.spokes.len();
        for (j, &diagonal) in corner.diagonals.iter().enumerate() {
            let (a, b) = (corner.spokes[j], corner.spokes[if j + 1 == count { 0 } else { j + 1 }]);
            for (p, q) in [(a, diagonal), (diagonal, b)] {
                let normal = (p - corner.vertex).cross(q - corner.vertex);
                let seen = normal.dot(direction);
                signs[usize::from(seen > 0.0)] = true;
                if seen.abs() <= 0.25 * normal.length() {
                    return false;
                }
            }
        }
        signs[0] != signs[1]
    }
}
