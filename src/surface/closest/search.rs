//! The search: nodes and pieces in the order of their least distance, halved until Newton's method is certain.

use super::convexity::View;
use super::minimise::minimise;
use super::part::{Part, Piece, Square};
use super::{Bicubic, Facing, LimitSurface};
use crate::surface::index::{Domain, Item};
use crate::surface::tree::Content;
use glam::DVec3;
use smallvec::SmallVec;

/// How often a piece is halved at most before Newton's method is trusted without proof.
const MAX_HALVINGS: u32 = 8;
/// Parts of pieces looked at before halving ends: bounds the time at centres of curvature, where everything is
/// equally close.
const MAX_PARTS: u32 = 2000;

/// The foot in a piece, at (s, t) of it.
pub(super) struct Found {
    pub(super) domain: Domain,
    pub(super) s: f64,
    pub(super) t: f64,
    pub(super) position: DVec3,
    /// Not normalised.
    pub(super) normal: DVec3,
}

/// See the [module](self).
pub(super) struct Search<'a> {
    pub(super) surface: &'a LimitSurface,
    pub(super) point: DVec3,
    facing: Option<Facing>,
    radius: f64,
    /// Distance of the best foot so far.
    best: f64,
    /// A distance that some point of the surface has or undercuts, but for rounding.
    bound: f64,
    found: Option<Found>,
    /// How far the way to `found` is from perpendicular, as a length.
    aside: f64,
    parts: u32,
    stack: Vec<Part>,
}

pub(super) fn box_distance(low: DVec3, high: DVec3, point: DVec3) -> f64 {
    (low - point).max(point - high).max(DVec3::ZERO).length()
}

impl<'a> Search<'a> {
    /// A search for points nearer than `radius`; `bound` is a distance that some point of the surface has, but for
    /// rounding, or infinity.
    pub(super) fn new(
        surface: &'a LimitSurface,
        point: DVec3,
        facing: Option<Facing>,
        radius: f64,
        bound: f64,
    ) -> Self {
        Self {
            surface,
            point,
            facing,
            radius,
            best: radius,
            bound,
            found: None,
            aside: f64::INFINITY,
            parts: 0,
            stack: Vec::new(),
        }
    }

    /// Distances of feet that differ by less are compared by how well they are perpendicular, for the distance is flat
    /// about its minimum: of two parts that share a border, one has the foot and the other the end of its own range, a
    /// square root of the rounding away.
    pub(super) fn rounding(&self) -> f64 {
        0.01 * self.surface.tolerance + 4.0 * f64::EPSILON * self.best.min(self.bound)
    }

    /// True when nothing at this distance or farther is wanted. What gave the bound may have been evaluated in another
    /// way than the feet, and have other errors: it excludes only what is farther by more than these.
    pub(super) fn hopeless(&self, at_least: f64) -> bool {
        // From very far away all points are equally close, and nothing else would end the search early.
        if self.found.is_some() && self.rounding() > self.surface.size {
            return true;
        }
        let bound = self.bound * (1.0 + 4.0 * f64::EPSILON) + self.surface.tolerance;
        at_least > bound.min(self.best + self.rounding())
    }

    /// Visits the pieces, of two nodes the nearer first. The foot and its distance.
    pub(super) fn run(mut self) -> Option<(Found, f64)> {
        let surface = self.surface;
        let index = surface.index();
        let (point, tolerance) = (self.point, surface.tolerance);
        let mut open: SmallVec<[(f64, u32); 64]> = SmallVec::new();
        if index.tree.bounds().is_some() {
            open.push((0.0, 0));
        }
        while let Some((at_least, number)) = open.pop() {
            if self.hopeless(at_least) {
                continue;
            }
            match index.tree.content(number) {
                Content::Children(children) => {
                    let mut nodes = children.map(|child| {
                        let node = index.tree.node(child);
                        let apart = box_distance(node.low, node.high, point);
                        if self.hopeless(apart) {
                            return (apart, child);
                        }
                        (apart.max(index.at_least(child, point, tolerance)), child)
                    });
                    if nodes[0].0 < nodes[1].0 {
                        nodes.swap(0, 1);
                    }
                    open.extend(nodes);
                }
                Content::Leaf(items) => {
                    for &item in items {
                        match index.item(surface, item) {
                            Item::Piece(bicubic, domain) => self.visit(bicubic, DVec3::ZERO, *domain),
                            Item::Rest(rest) => self.visit_rest(rest),
                        }
                    }
                }
            }
        }
        Some((self.found?, self.best))
    }

    /// Looks at a patch whose points are relative to `origin`.
    pub(super) fn visit(&mut self, bicubic: &Bicubic, origin: DVec3, domain: Domain) {
        let piece = Piece {
            point: self.point - origin,
            origin,
            domain,
            // Minima on the border of a part do not count then, but those on the border of the surface do.
            feet_only: self.facing.is_some() && self.surface.places[domain.patch as usize].rims == 0,
            facing: self.facing.filter(|f| f.min_cosine >= 0.0).map_or(DVec3::ZERO, |f| f.normal),
        };
        self.stack.clear();
        if self.look(&piece, bicubic, Square::WHOLE) {
            self.split(&piece, bicubic, Square::WHOLE);
        }
        while let Some(part) = self.stack.pop() {
            let (low, high) = part.bicubic.bounds();
            if !self.hopeless(box_distance(low, high, piece.point))
                && self.look(&piece, &part.bicubic, part.square)
            {
                self.split(&piece, &part.bicubic, part.square);
            }
        }
    }

    /// Looks at a part of a piece: true when it must be halved.
    fn look(&mut self, piece: &Piece, bicubic: &Bicubic, square: Square) -> bool {
        let view = View::new(bicubic, piece.point);
        if self.hopeless(view.at_least) {
            return false;
        }
        let convexity = view.convexity(piece.facing);
        if !convexity.may_face || piece.feet_only && !convexity.may_have_foot {
            return false;
        }
        self.parts += 1;
        let is_rounding = || {
            let (low, high) = bicubic.bounds();
            (high - low).length() <= self.surface.tolerance
        };
        let last =
            convexity.convex || square.halvings >= MAX_HALVINGS || self.parts > MAX_PARTS || is_rounding();
        // Newton's method from the middle of a whole piece mostly finds the foot at once; the search that
        // follows then only has to show that nothing is closer.
        if last || square.halvings == 0 {
            let (a, b, jet) = minimise(bicubic, piece.point);
            let (s, t) = (square.s + square.size * a, square.t + square.size * b);
            let (position, normal) = (jet.position + piece.origin, jet.du.cross(jet.dv));
            self.offer(jet.position - piece.point, Found { domain: piece.domain, s, t, position, normal });
        }
        !last && !self.hopeless(view.at_least)
    }

    /// Puts the quarters of a part on the stack, the nearest on top.
    fn split(&mut self, piece: &Piece, bicubic: &Bicubic, square: Square) {
        let point = piece.point;
        let quarters = bicubic.quarters();
        // The corner that all quarters share is a point of the surface.
        let middle = quarters[0].points[3][3].distance(point);
        if self.facing.is_none() {
            self.bound = self.bound.min(middle);
        }
        let distances = quarters.map(|quarter| {
            let points = &quarter.points;
            (points[1][1] + points[2][2]).distance_squared(2.0 * point)
        });
        let mut order = [0, 1, 2, 3];
        order.sort_unstable_by(|&a: &usize, &b| distances[b].total_cmp(&distances[a]));
        self.stack.extend(order.map(|i| Part { bicubic: quarters[i], square: square.quarter(i) }));
    }

    /// Takes the minimum over a part of a piece if it is the best so far and allowed; `way` leads to it.
    pub(super) fn offer(&mut self, way: DVec3, found: Found) {
        let distance = way.length();
        if distance.is_nan() || distance >= self.radius || self.hopeless(distance) {
            return;
        }
        let unit = found.normal.normalize_or_zero();
        let aside = (way - unit * way.dot(unit)).length();
        if let Some(facing) = self.facing {
            let compatible = unit.dot(facing.normal) > facing.min_cosine;
            // From far away the way has the rounding of its own length, at last more than the surface is large.
            let rounding = 4.0 * f64::EPSILON * distance;
            let foot = aside <= 1e3 * (self.surface.tolerance + rounding)
                || rounding > self.surface.size
                || self.on_rim(&found);
            if !compatible || unit == DVec3::ZERO || !foot {
                return;
            }
        }
        let better = if self.found.is_none() {
            true
        } else if (distance - self.best).abs() <= self.rounding() {
            aside < self.aside
        } else {
            distance < self.best
        };
        if better {
            self.best = distance;
            self.bound = self.bound.min(distance);
            self.aside = aside;
            self.found = Some(found);
        }
    }

    /// True where the frozen surface ends.
    fn on_rim(&self, found: &Found) -> bool {
        let (u, v) = found.domain.parameters(found.s, found.t);
        let rims = self.surface.places[found.domain.patch as usize].rims;
        let sides = [v <= 0.0, u >= 1.0, v >= 1.0, u <= 0.0];
        sides.iter().enumerate().any(|(bit, &on)| on && rims & (1 << bit) != 0)
    }
}
