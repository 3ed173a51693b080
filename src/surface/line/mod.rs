//! Where a line meets the surface.

mod corner;
mod piece;
mod search;

use super::{Bicubic, LimitSurface};
use crate::mesh::FaceId;
use glam::{DMat3, DVec3};
use search::Search;

/// A point in which a line meets the surface.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Hit {
    /// Face in which it lies.
    pub face: FaceId,
    /// Patch of the face.
    pub corner: usize,
    /// Parameter in [0, 1].
    pub u: f64,
    /// Parameter in [0, 1].
    pub v: f64,
    /// Signed parameter on the line: the point is `origin + s * direction`.
    pub s: f64,
    /// Position on the surface.
    pub position: DVec3,
    /// Unit normal, or zero where the surface has none.
    pub normal: DVec3,
}

impl LimitSurface {
    /// All points in which the whole line meets the surface, by `s`. A point on an edge shared by faces, or at a
    /// vertex, is given once. A tangent line gives its point of contact, a line that lies in the surface some of its
    /// points. Empty for a direction that is zero and for numbers that are not finite.
    pub fn line_hits(&self, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        self.line_hits_between(origin, direction, f64::NEG_INFINITY, f64::INFINITY)
    }

    /// The hits with `first` <= s <= `last`, as [`line_hits`](Self::line_hits) gives them; none where a bound is NaN.
    pub fn line_hits_between(&self, origin: DVec3, direction: DVec3, first: f64, last: f64) -> Vec<Hit> {
        self.search_line(origin, direction, [first, last], false, None)
    }

    /// Of the hits with `first` <= s <= `last` the one with the smallest |s|: what a ray sees where `first` is 0.
    pub fn first_line_hit(&self, origin: DVec3, direction: DVec3, first: f64, last: f64) -> Option<Hit> {
        nearest(self.search_line(origin, direction, [first, last], true, None))
    }

    /// The hit with the smallest |s|, at most `max_abs_s`, whose normal m has m . `compatible_normal` > 0.
    pub fn nearest_line_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        max_abs_s: f64,
        compatible_normal: DVec3,
    ) -> Option<Hit> {
        let range = [-max_abs_s, max_abs_s];
        nearest(self.search_line(origin, direction, range, true, Some(compatible_normal)))
    }

    fn search_line(
        &self,
        origin: DVec3,
        direction: DVec3,
        range: [f64; 2],
        nearest: bool,
        compatible: Option<DVec3>,
    ) -> Vec<Hit> {
        let Some((low, high)) = self.index().tree.bounds() else {
            return Vec::new();
        };
        let length = direction.length();
        let Some(unit) = direction.try_normalize().filter(|_| length.is_finite()) else {
            return Vec::new();
        };
        if !origin.is_finite() || range.iter().any(|s| s.is_nan()) {
            return Vec::new();
        }
        let [first, last] = range.map(|s| s * length);
        let base_along = ((low + high) * 0.5 - origin).dot(unit);
        let (across, other) = unit.any_orthonormal_pair();
        let mut search = Search {
            surface: self,
            base: origin + unit * base_along,
            frame: DMat3::from_cols(across, other, unit).transpose(),
            base_along,
            first,
            last,
            reach: f64::INFINITY,
            nearest,
            compatible,
            found: Vec::new(),
            crossings: Vec::new(),
            parts: 0,
        };
        search.run(unit);
        search.into_hits(length)
    }
}

fn nearest(hits: Vec<Hit>) -> Option<Hit> {
    hits.into_iter().min_by(|a, b| a.s.abs().total_cmp(&b.s.abs()))
}
