//! Where a line meets the surface.

use super::freeze::{CornerEntry, Domain};
use super::line_piece::{Crossing, crossings};
use super::tree::{Content, Node};
use super::{Bicubic, LimitSurface};
use crate::mesh::FaceId;
use crate::subdivision::patch_corner::{Corner, Points};
use glam::{DMat3, DVec3};
use smallvec::SmallVec;

/// Refinements beside an extraordinary vertex; see the same limit of evaluation.
const MAX_DEPTH: u32 = 128;
/// Parts of pieces looked at with proof; beyond (a line that lies in the surface) they are no longer halved.
pub(super) const MAX_PARTS: u32 = 4000;

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

/// A crossing in the frame of the line.
struct Found {
    domain: Domain,
    a: f64,
    b: f64,
    /// Signed distance from the origin of the line.
    along: f64,
    position: DVec3,
    normal: DVec3,
}

struct Search<'a> {
    surface: &'a LimitSurface,
    /// The point of the line nearest to the middle of the surface: keeps numbers small when the origin is far away.
    base: DVec3,
    /// Rows: two directions across the line, and its own.
    frame: DMat3,
    /// Signed distance of `base` from the origin of the line.
    base_along: f64,
    /// Only |along| up to this counts.
    reach: f64,
    /// Only the nearest hit with a normal on the side of this direction is wanted.
    nearest: Option<DVec3>,
    found: Vec<Found>,
    crossings: Vec<Crossing>,
    parts: u32,
}

impl LimitSurface {
    /// All points in which the whole line meets the surface, by `s`. A point on an edge shared by faces, or at a
    /// vertex, is given once. A tangent line gives its point of contact, a line that lies in the surface some of its
    /// points. Empty for a direction that is zero and for numbers that are not finite.
    pub fn line_hits(&self, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        self.search_line(origin, direction, f64::INFINITY, None)
    }

    /// The hit with the smallest |s|, at most `max_abs_s`, whose normal m has m . `compatible_normal` > 0.
    pub fn nearest_line_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        max_abs_s: f64,
        compatible_normal: DVec3,
    ) -> Option<Hit> {
        let hits = self.search_line(origin, direction, max_abs_s, Some(compatible_normal));
        hits.into_iter().min_by(|a, b| a.s.abs().total_cmp(&b.s.abs()))
    }

    fn search_line(&self, origin: DVec3, direction: DVec3, max_s: f64, nearest: Option<DVec3>) -> Vec<Hit> {
        let Some((low, high)) = self.tree.bounds() else {
            return Vec::new();
        };
        let length = direction.length();
        let Some(unit) = direction.try_normalize().filter(|_| length.is_finite()) else {
            return Vec::new();
        };
        if !origin.is_finite() || max_s.is_nan() {
            return Vec::new();
        }
        let base_along = ((low + high) * 0.5 - origin).dot(unit);
        let (across, other) = unit.any_orthonormal_pair();
        let mut search = Search {
            surface: self,
            base: origin + unit * base_along,
            frame: DMat3::from_cols(across, other, unit).transpose(),
            base_along,
            reach: max_s * length,
            nearest,
            found: Vec::new(),
            crossings: Vec::new(),
            parts: 0,
        };
        search.run(unit);
        search.into_hits(length)
    }
}

/// The interval of distances along the line from `base` in which it is inside the box, or `None`.
fn box_interval(node: &Node, base: DVec3, unit: DVec3, tolerance: f64) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (low, high) = (node.low[axis] - tolerance - base[axis], node.high[axis] + tolerance - base[axis]);
        if unit[axis].abs() < 1e-14 {
            // The line drifts by at most the box's own rounding across this axis.
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (a, b) = (low / unit[axis], high / unit[axis]);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    (enter <= leave).then_some((enter, leave))
}

impl Search<'_> {
    /// The smallest |along| in an interval of distances from `base`.
    fn nearness(&self, (enter, leave): (f64, f64)) -> f64 {
        let (a, b) = (enter + self.base_along, leave + self.base_along);
        if a <= 0.0 && b >= 0.0 { 0.0 } else { a.abs().min(b.abs()) }
    }

    fn run(&mut self, unit: DVec3) {
        let surface = self.surface;
        let slack = 2.0 * surface.tolerance;
        let mut open: SmallVec<[(f64, u32); 64]> = SmallVec::new();
        open.push((0.0, 0));
        while let Some((nearness, index)) = open.pop() {
            if nearness > self.reach {
                continue;
            }
            match surface.tree.content(index) {
                Content::Children(children) => {
                    let mut inside: SmallVec<[(f64, u32); 2]> = SmallVec::new();
                    for child in children {
                        let node = surface.tree.node(child);
                        if let Some(interval) = box_interval(node, self.base, unit, slack) {
                            inside.push((self.nearness(interval), child));
                        }
                    }
                    inside.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
                    open.extend(inside);
                }
                Content::Leaf(items) => {
                    for &item in items {
                        match surface.pieces.get(item as usize) {
                            Some(piece) => self.visit(&piece.bicubic, DVec3::ZERO, &piece.domain),
                            None => self.visit_corner(&surface.corners[item as usize - surface.pieces.len()]),
                        }
                    }
                }
            }
        }
    }

    /// False when a box in the frame of the line is missed by the line or out of reach.
    fn meets(&self, low: DVec3, high: DVec3) -> bool {
        let tolerance = self.surface.tolerance;
        low.x <= tolerance
            && low.y <= tolerance
            && high.x >= -tolerance
            && high.y >= -tolerance
            && self.nearness((low.z, high.z)) <= self.reach
    }

    /// Looks at a patch whose points are relative to `origin`.
    fn visit(&mut self, bicubic: &Bicubic, origin: DVec3, domain: &Domain) {
        let shift = origin - self.base;
        let turned = Bicubic { points: bicubic.points.map(|row| row.map(|p| self.frame * (p + shift))) };
        let (low, high) = turned.bounds();
        if !self.meets(low, high) {
            return;
        }
        let mut crossings_found = std::mem::take(&mut self.crossings);
        crossings(&turned, self.surface.tolerance, &mut self.parts, &mut crossings_found);
        for crossing in crossings_found.drain(..) {
            self.take(domain, crossing);
        }
        self.crossings = crossings_found;
    }

    fn take(&mut self, domain: &Domain, crossing: Crossing) {
        let along = crossing.position.z + self.base_along;
        let back = self.frame.transpose();
        let normal = back * crossing.normal;
        if along.is_nan() || along.abs() > self.reach {
            return;
        }
        if let Some(compatible) = self.nearest {
            if normal.dot(compatible) <= 0.0 || normal.dot(compatible).is_nan() {
                return;
            }
            self.reach = along.abs();
        }
        let position = back * crossing.position + self.base;
        self.found.push(Found { domain: *domain, a: crossing.a, b: crossing.b, along, position, normal });
    }

    /// Looks at what lies beside an extraordinary vertex, level by level.
    fn visit_corner(&mut self, entry: &CornerEntry) {
        let tolerance = self.surface.tolerance;
        let mut corner = entry.corner.clone();
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

    /// The hits by `s`, each once.
    fn into_hits(mut self, length: f64) -> Vec<Hit> {
        let surface = self.surface;
        let direction = self.frame.row(2);
        self.found
            .sort_by(|a, b| a.along.total_cmp(&b.along).then_with(|| a.domain.patch.cmp(&b.domain.patch)));
        let mut hits: Vec<Hit> = Vec::with_capacity(self.found.len());
        let mut last = f64::NEG_INFINITY;
        for found in self.found {
            let normal = found.normal.normalize_or_zero();
            // Pieces that share the point find it within the tolerance across the line, which along the line is
            // more by the slope.
            let same = 4.0 * surface.tolerance / normal.dot(direction).abs().max(1e-7);
            if found.along - last <= same {
                last = found.along;
                continue;
            }
            last = found.along;
            let place = surface.places[found.domain.patch as usize];
            let (u, v) = found.domain.parameters(found.a, found.b);
            hits.push(Hit {
                face: place.face,
                corner: place.corner as usize,
                u,
                v,
                s: found.along / length,
                position: found.position,
                normal: if normal == DVec3::ZERO {
                    surface.evaluate_patch(found.domain.patch as usize, u, v).normal
                } else {
                    normal
                },
            });
        }
        hits
    }
}
