//! Distances with a sign.

use super::{ClosestOptions, Facing, Foot, LimitSurface};
use glam::DVec3;

/// Directions of rays, in no relation to the axes and to each other.
const WAYS: [DVec3; 6] = [
    DVec3::new(0.5207, 0.3419, 0.7823),
    DVec3::new(-0.2861, 0.9017, 0.3242),
    DVec3::new(0.8931, -0.4072, 0.1913),
    DVec3::new(0.1178, 0.6154, -0.7793),
    DVec3::new(-0.7336, -0.2287, 0.6399),
    DVec3::new(0.3767, -0.7981, -0.4703),
];

impl LimitSurface {
    /// The distance of `point` to the surface, positive on the side of its normals: that to its
    /// [`compatible_foot`](Self::compatible_foot). `None` when the surface is empty or a coordinate is not finite.
    pub fn signed_distance(&self, point: DVec3, normal: DVec3) -> Option<f64> {
        let foot = self.compatible_foot(point, normal)?;
        Some(foot.distance.copysign((point - foot.position).dot(foot.normal)))
    }

    /// The distance of `point` to a closed surface, negative inside: where the winding number of the surface is
    /// positive. Parts that overlap count as one solid, and what lies in a hollow, whose normals point inwards, is
    /// outside; the distance is always that of the nearest point of the surface, also where this lies in another part.
    /// `None` where the surface has a border and where [`closest`](Self::closest) gives none.
    ///
    /// The side of the nearest point of the surface decides for points within rounding of the surface, and where parts
    /// of the surface lie on each other, so that lines do not leave it as often as they enter it.
    pub fn solid_distance(&self, point: DVec3) -> Option<f64> {
        if !self.closed {
            return None;
        }
        let foot = self.closest(point, &ClosestOptions::default())?;
        Some(if self.is_inside(point, &foot) { -foot.distance } else { foot.distance })
    }

    fn is_inside(&self, point: DVec3, foot: &Foot) -> bool {
        let in_box = |(low, high): (DVec3, DVec3)| point.cmpge(low).all() && point.cmple(high).all();
        if !self.index().tree.bounds().is_some_and(in_box) {
            return false;
        }
        let below = (point - foot.position).dot(foot.normal) < 0.0;
        if foot.distance <= 100.0 * self.tolerance {
            return below;
        }
        WAYS.iter().find_map(|&way| self.winding_number(point, way)).map_or(below, |number| number > 0)
    }

    /// How often a ray from `point` leaves the surface more often than it enters it. `None` where the line touches the
    /// surface, by which an entry or an exit is lost.
    fn winding_number(&self, point: DVec3, direction: DVec3) -> Option<i32> {
        let (mut ahead, mut all) = (0, 0);
        for hit in self.line_hits(point, direction) {
            let slope = hit.normal.dot(direction);
            if slope == 0.0 {
                return None;
            }
            let step = if slope > 0.0 { 1 } else { -1 };
            all += step;
            ahead += if hit.s > 0.0 { step } else { 0 };
        }
        (all == 0).then_some(ahead)
    }

    /// The point of the surface that belongs to `point`, which lies on another surface with `normal`.
    ///
    /// The closest point, unless its normal is opposite to `normal`: then a foot whose normal has an angle below 90
    /// degrees counts, so that a thin wall does not snap to its other side, if there is one at most ten times as far
    /// away (else the point belongs to a small fold). `None` when the surface is empty or a coordinate is not finite.
    pub fn compatible_foot(&self, point: DVec3, normal: DVec3) -> Option<Foot> {
        self.compatible_foot_within(point, normal, f64::INFINITY)
    }

    /// The same point, sooner where `bound` is a distance that some point of the surface has, but for rounding.
    pub(super) fn compatible_foot_within(&self, point: DVec3, normal: DVec3, bound: f64) -> Option<Foot> {
        const FARTHER: f64 = 10.0;
        let foot = self.closest_within(point, &ClosestOptions::default(), bound)?;
        if foot.normal.dot(normal) > 0.0 {
            return Some(foot);
        }
        let facing = Some(Facing { normal, min_cosine: 0.0 });
        let radius = FARTHER * foot.distance;
        Some(self.closest(point, &ClosestOptions { radius, facing }).unwrap_or(foot))
    }
}
