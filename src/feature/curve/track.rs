//! A curve on the limit surface, as a fine polyline with the surface's normal and the direction to its left.

use crate::mark::Curve;
use crate::surface::{ClosestOptions, Foot, LimitSurface};
use glam::DVec3;

/// Samples per edge length.
const PER_EDGE: f64 = 8.0;
/// A sample whose foot is this far aside, in edge lengths, lies beyond the border of the surface.
const ASIDE: f64 = 0.02;

/// A curve on the surface.
#[derive(Clone, Debug)]
pub(in super::super) struct Track {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// Unit vectors in the tangent plane, to the left of the direction of travel.
    lefts: Vec<DVec3>,
    /// Length of the curve up to each point.
    lengths: Vec<f64>,
    /// Total length.
    length: f64,
    closed: bool,
}

/// Where a point lies beside a track.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Beside {
    /// Distance in the surface, positive to the left.
    pub(in super::super) distance: f64,
    /// Length along the track.
    pub(super) along: f64,
    /// Unit direction to the left.
    pub(super) left: DVec3,
    /// Unit normal of the surface.
    pub(super) normal: DVec3,
    /// False beyond the ends of an open track.
    pub(super) inside: bool,
}

impl Track {
    /// Projects a curve to the surface; `edge` is the typical length of an edge there. Also gives the feet that lie on
    /// the surface. `None` when less than two samples do.
    pub(super) fn project(surface: &LimitSurface, curve: &Curve, edge: f64) -> Option<(Self, Vec<Foot>)> {
        let sampled = curve.sample(edge / PER_EDGE);
        let options = ClosestOptions { radius: f64::INFINITY, facing: None };
        let feet: Vec<(Foot, bool)> = sampled
            .iter()
            .filter_map(|&p| {
                let foot = surface.closest(p, &options)?;
                let offset = p - foot.position;
                let aside = (offset - foot.normal * offset.dot(foot.normal)).length();
                Some((foot, aside <= ASIDE * edge))
            })
            .collect();
        let first = feet.iter().position(|foot| foot.1)?;
        let last = feet.iter().rposition(|foot| foot.1)?;
        let on: Vec<Foot> = feet[first..=last].iter().filter(|foot| foot.1).map(|foot| foot.0).collect();
        let closed = curve.closed && on.len() == sampled.len();
        let mut points: Vec<DVec3> = on.iter().map(|foot| foot.position).collect();
        let mut normals: Vec<DVec3> = on.iter().map(|foot| foot.normal).collect();
        points.dedup_by(|b, a| a.distance(*b) < 1e-9 * edge);
        if points.len() != normals.len() {
            normals =
                points.iter().filter_map(|&p| surface.closest(p, &options)).map(|foot| foot.normal).collect();
        }
        if points.len() < 2 || points.len() != normals.len() {
            return None;
        }
        if !closed {
            // A curve that leaves the surface goes on straight, so that edges of the border are beside it.
            let count = points.len();
            let (start, end) = (points[0] - points[1], points[count - 1] - points[count - 2]);
            if first > 0 {
                points.insert(0, points[0] + start.normalize_or_zero() * edge);
                normals.insert(0, normals[0]);
            }
            if last + 1 < feet.len() {
                points.push(points[points.len() - 1] + end.normalize_or_zero() * edge);
                normals.push(normals[normals.len() - 1]);
            }
        }
        Some((Self::through(points, normals, closed), on))
    }

    fn through(points: Vec<DVec3>, normals: Vec<DVec3>, closed: bool) -> Self {
        let count = points.len();
        let at = |i: isize| {
            let i = if closed { i.rem_euclid(count as isize) } else { i.clamp(0, count as isize - 1) };
            points[i as usize]
        };
        let lefts = (0..count as isize)
            .map(|i| normals[i as usize].cross(at(i + 1) - at(i - 1)).normalize_or_zero())
            .collect();
        let mut length = 0.0;
        let lengths = (0..count as isize)
            .map(|i| {
                let so_far = length;
                length += at(i).distance(at(i + 1));
                so_far
            })
            .collect();
        Self { points, normals, lefts, lengths, length, closed }
    }

    /// Where `point` lies beside the track: seen from the nearest point of it.
    pub(in super::super) fn beside(&self, point: DVec3) -> Option<Beside> {
        let count = self.points.len();
        let segments = if self.closed { count } else { count - 1 };
        let mut best: Option<(f64, usize, f64, bool)> = None;
        for i in 0..segments {
            let (a, b) = (self.points[i], self.points[(i + 1) % count]);
            let direction = b - a;
            let t = (point - a).dot(direction) / direction.length_squared().max(f64::MIN_POSITIVE);
            let clamped = t.clamp(0.0, 1.0);
            let squared = point.distance_squared(a + direction * clamped);
            if best.is_none_or(|best| squared < best.0) {
                let beyond = !self.closed && ((i == 0 && t < 0.0) || (i + 1 == segments && t > 1.0));
                best = Some((squared, i, clamped, !beyond));
            }
        }
        let (_, i, t, inside) = best?;
        let j = (i + 1) % count;
        let (a, b) = (self.points[i], self.points[j]);
        let left = self.lefts[i].lerp(self.lefts[j], t).normalize_or_zero();
        let normal = self.normals[i].lerp(self.normals[j], t).normalize_or_zero();
        let offset = point - a.lerp(b, t);
        let in_surface = offset - normal * offset.dot(normal);
        // Beyond an end the curve counts as going on straight.
        let across = offset.dot(left);
        let distance = if inside { across.signum() * in_surface.length() } else { across };
        Some(Beside { distance, along: self.lengths[i] + t * a.distance(b), left, normal, inside })
    }

    /// Length of a track that does not close.
    pub(super) fn open_length(&self) -> Option<f64> {
        (!self.closed).then_some(self.length)
    }

    /// Distance, in the surface, of `point` from the nearer end of an open track.
    pub(in super::super) fn off_end(&self, point: DVec3) -> Option<f64> {
        let last = self.points.len().checked_sub(1)?;
        let distance = |i: usize| {
            let (end, normal) = (self.points.get(i)?, self.normals.get(i)?);
            let offset = point - *end;
            Some((offset - *normal * offset.dot(*normal)).length())
        };
        (!self.closed).then(|| Some(distance(0)?.min(distance(last)?))).flatten()
    }

    /// Length of the track between two places on it, the shorter way.
    pub(super) fn between(&self, a: f64, b: f64) -> f64 {
        let straight = (a - b).abs();
        if self.closed { straight.min(self.length - straight) } else { straight }
    }
}
