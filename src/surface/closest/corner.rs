//! What lies beside an extraordinary vertex below the pieces, level by level.

use super::Bicubic;
use super::search::{Found, Search, box_distance};
use crate::subdivision::patch_corner::Points;
use crate::surface::index::Rest;
use glam::DVec3;

/// Refinements beside an extraordinary vertex; see the same limit of evaluation.
const MAX_DEPTH: u32 = 128;

impl Search<'_> {
    /// Looks at what lies beside an extraordinary vertex, level by level.
    pub(super) fn visit_rest(&mut self, entry: &Rest) {
        let mut corner = entry.corner(self.surface);
        // The vertex itself; its distance is taken relative to the point, for the precision of small ones.
        let way = corner.origin - self.point;
        let unit = entry.normal;
        let aside = (way - unit * way.dot(unit)).length();
        let position = corner.origin;
        self.offer(way, Found { domain: entry.domain, s: 0.0, t: 0.0, position, normal: unit });
        // Where the vertex is the foot itself, what is left round it differs by rounding only.
        let is_foot = unit != DVec3::ZERO && aside <= self.surface.tolerance;
        let direction = way.normalize_or_zero();

        let mut domain = entry.domain;
        let mut scratch = Points::new();
        for _ in 0..MAX_DEPTH {
            let (low, high) = corner.bounds();
            let point = self.point - corner.origin;
            let (mut ahead, mut radius) = (f64::INFINITY, 0.0f64);
            for p in corner.control_points() {
                ahead = ahead.min((p - point).dot(direction));
                radius = radius.max(p.length_squared());
            }
            let slack = if is_foot { 2.0 * self.rounding() } else { 0.0 };
            // The surface curves less towards the point than a sphere round it, with room to spare; as the rings
            // beside a vertex are similar from level to level, nothing closer than the vertex is left.
            let curves_little =
                || corner.control_points().all(|p| 2.0 * p.dot(way) >= -0.25 * p.length_squared());
            if self.hopeless(box_distance(low, high, self.point))
                || self.hopeless(ahead + slack)
                || is_foot && curves_little()
                || radius.sqrt() <= 0.05 * self.surface.tolerance
            {
                return;
            }
            let sides = corner.refine(&mut scratch);
            for (side, grid) in sides.iter().enumerate() {
                self.visit(&Bicubic::from_bspline(grid), corner.origin, domain.side(side));
            }
            domain = domain.inner();
        }
    }
}
