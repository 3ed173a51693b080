//! Where a line meets the surface.

use super::index::{Domain, Item, Rest};
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
    /// Only signed distances from the origin in this interval count, whose bounds may be infinite.
    first: f64,
    last: f64,
    /// Of those, only such up to this amount.
    reach: f64,
    /// Only the hit nearest to the origin is wanted.
    nearest: bool,
    /// Only hits with a normal on the side of this direction are wanted.
    compatible: Option<DVec3>,
    found: Vec<Found>,
    crossings: Vec<Crossing>,
    parts: u32,
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
    /// The smallest amount that counts in an interval of distances from `base`, or infinity.
    fn nearness(&self, (enter, leave): (f64, f64)) -> f64 {
        let (a, b) = ((enter + self.base_along).max(self.first), (leave + self.base_along).min(self.last));
        if a > b {
            f64::INFINITY
        } else if a <= 0.0 && b >= 0.0 {
            0.0
        } else {
            a.abs().min(b.abs())
        }
    }

    fn is_beyond(&self, nearness: f64) -> bool {
        nearness > self.reach || nearness == f64::INFINITY
    }

    fn run(&mut self, unit: DVec3) {
        let surface = self.surface;
        let content = surface.index();
        let slack = 2.0 * surface.tolerance;
        let mut open: SmallVec<[(f64, u32); 64]> = SmallVec::new();
        open.push((0.0, 0));
        while let Some((nearness, index)) = open.pop() {
            if self.is_beyond(nearness) {
                continue;
            }
            match content.tree.content(index) {
                Content::Children(children) => {
                    let mut inside: SmallVec<[(f64, u32); 2]> = SmallVec::new();
                    for child in children {
                        let node = content.tree.node(child);
                        if let Some(interval) = box_interval(node, self.base, unit, slack) {
                            inside.push((self.nearness(interval), child));
                        }
                    }
                    inside.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
                    open.extend(inside);
                }
                Content::Leaf(items) => {
                    for &item in items {
                        match content.item(surface, item) {
                            Item::Piece(bicubic, domain) => self.visit(bicubic, DVec3::ZERO, domain),
                            Item::Rest(rest) => self.visit_rest(rest),
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
            && !self.is_beyond(self.nearness((low.z, high.z)))
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
        let counts = along >= self.first && along <= self.last && along.abs() <= self.reach;
        let compatible = self.compatible.is_none_or(|direction| normal.dot(direction) > 0.0);
        if !counts || !compatible {
            return;
        }
        if self.nearest {
            self.reach = along.abs();
        }
        let position = back * crossing.position + self.base;
        self.found.push(Found { domain: *domain, a: crossing.a, b: crossing.b, along, position, normal });
    }

    /// Looks at what lies beside an extraordinary vertex, level by level.
    fn visit_rest(&mut self, entry: &Rest) {
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
