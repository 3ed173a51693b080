//! The search: nodes in their order along the line, then the crossings of the pieces.

use super::piece::{Crossing, crossings};
use super::{Bicubic, Hit, LimitSurface};
use crate::surface::index::{Domain, Item};
use crate::surface::tree::{Content, Node};
use glam::{DMat3, DVec3};
use smallvec::SmallVec;

/// A crossing in the frame of the line.
pub(super) struct Found {
    domain: Domain,
    a: f64,
    b: f64,
    /// Signed distance from the origin of the line.
    along: f64,
    position: DVec3,
    normal: DVec3,
}

/// See the [module](self).
pub(super) struct Search<'a> {
    pub(super) surface: &'a LimitSurface,
    /// The point of the line nearest to the middle of the surface: keeps numbers small when the origin is far away.
    pub(super) base: DVec3,
    /// Rows: two directions across the line, and its own.
    pub(super) frame: DMat3,
    /// Signed distance of `base` from the origin of the line.
    pub(super) base_along: f64,
    /// Only signed distances from the origin in this interval count, whose bounds may be infinite.
    pub(super) first: f64,
    pub(super) last: f64,
    /// Of those, only such up to this amount.
    pub(super) reach: f64,
    /// Only the hit nearest to the origin is wanted.
    pub(super) nearest: bool,
    /// Only hits with a normal on the side of this direction are wanted.
    pub(super) compatible: Option<DVec3>,
    pub(super) found: Vec<Found>,
    pub(super) crossings: Vec<Crossing>,
    pub(super) parts: u32,
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

    pub(super) fn run(&mut self, unit: DVec3) {
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
    pub(super) fn meets(&self, low: DVec3, high: DVec3) -> bool {
        let tolerance = self.surface.tolerance;
        low.x <= tolerance
            && low.y <= tolerance
            && high.x >= -tolerance
            && high.y >= -tolerance
            && !self.is_beyond(self.nearness((low.z, high.z)))
    }

    /// Looks at a patch whose points are relative to `origin`.
    pub(super) fn visit(&mut self, bicubic: &Bicubic, origin: DVec3, domain: &Domain) {
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

    pub(super) fn take(&mut self, domain: &Domain, crossing: Crossing) {
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

    /// The hits by `s`, each once.
    pub(super) fn into_hits(mut self, length: f64) -> Vec<Hit> {
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
