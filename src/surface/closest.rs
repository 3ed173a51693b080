//! The closest point: branch and bound over the pieces, Newton's method where it is certain.

use super::convexity::View;
use super::index::{Domain, Item, Rest};
use super::minimise::minimise;
use super::tree::Content;
use super::{Bicubic, LimitSurface, Parameter};
use crate::fault;
use crate::mesh::FaceId;
use crate::subdivision::patch_corner::Points;
use glam::DVec3;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// How often a piece is halved at most before Newton's method is trusted without proof.
const MAX_HALVINGS: u32 = 8;
/// Parts of pieces looked at before halving ends: bounds the time at centres of curvature, where everything is
/// equally close.
const MAX_PARTS: u32 = 2000;
/// Refinements beside an extraordinary vertex; see the same limit of evaluation.
const MAX_DEPTH: u32 = 128;

/// Largest coordinate of a query: products of distances stay finite.
const FARTHEST: f64 = 1e60;

/// Which normals a closest point may have.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Facing {
    /// Reference direction, of any length.
    pub normal: DVec3,
    /// Smallest cosine of the angle between the surface normal and the reference direction, exclusive.
    pub min_cosine: f64,
}

/// What [`LimitSurface::closest`] looks for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ClosestOptions {
    /// Points at this distance or farther do not count.
    pub radius: f64,
    /// With this, only points count where the distance is locally smallest (feet of perpendiculars, and points of
    /// the border) and the normal is compatible: a thin wall does not snap to its other side.
    pub facing: Option<Facing>,
}

impl Default for ClosestOptions {
    fn default() -> Self {
        Self { radius: f64::INFINITY, facing: None }
    }
}

/// A closest point.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Foot {
    /// Face in which it lies.
    pub face: FaceId,
    /// Patch of the face.
    pub corner: usize,
    /// Parameter in [0, 1].
    pub u: f64,
    /// Parameter in [0, 1].
    pub v: f64,
    /// Position on the surface.
    pub position: DVec3,
    /// Unit normal, or zero where the surface has none.
    pub normal: DVec3,
    /// Distance to the point asked for.
    pub distance: f64,
}

/// A part of a piece: the square from (s, t) of size `size`.
struct Part {
    bicubic: Bicubic,
    s: f64,
    t: f64,
    size: f64,
    halvings: u32,
}

struct Found {
    domain: Domain,
    s: f64,
    t: f64,
    position: DVec3,
    normal: DVec3,
}

struct Search<'a> {
    surface: &'a LimitSurface,
    point: DVec3,
    facing: Option<Facing>,
    radius: f64,
    /// Distance of the best foot so far.
    best: f64,
    /// A distance that some point of the surface is known to have or to undercut.
    bound: f64,
    found: Option<Found>,
    /// How far the way to `found` is from perpendicular, as a length.
    aside: f64,
    parts: u32,
    stack: Vec<Part>,
}

impl LimitSurface {
    /// The point of the surface closest to `point`. `None` when nothing lies within the radius or is compatible, when
    /// the surface is empty, and when a coordinate of `point` is NaN or beyond 1e60.
    ///
    /// At a point that is equally far from many points of the surface (the centre of a sphere) one of them.
    pub fn closest(&self, point: DVec3, options: &ClosestOptions) -> Option<Foot> {
        fault::point("closest");
        self.closest_within(point, options, f64::INFINITY)
    }

    /// The same point, sooner where `start` is near it; a start that is no place of the surface is passed over.
    pub fn closest_from(&self, start: Parameter, point: DVec3, options: &ClosestOptions) -> Option<Foot> {
        let Parameter { face, corner, u, v } = start;
        let near = || {
            let place = self.evaluate(face, corner as usize, u, v)?;
            let foot = self.foot_near(face, corner as usize, u, v, point);
            Some(foot.map_or(f64::INFINITY, |foot| foot.distance).min(place.position.distance(point)))
        };
        let bound = if options.facing.is_none() { near() } else { None };
        self.closest_within(point, options, bound.unwrap_or(f64::INFINITY))
    }

    /// `bound` is a distance that some point of the surface has, or infinity.
    fn closest_within(&self, point: DVec3, options: &ClosestOptions, bound: f64) -> Option<Foot> {
        let near_enough = point.abs().max_element() <= FARTHEST;
        if !near_enough || options.radius.is_nan() {
            return None;
        }
        let facing = match options.facing {
            Some(facing) => {
                let normal = facing.normal.try_normalize()?;
                Some(Facing { normal, ..facing })
            }
            None => None,
        };
        let mut search = Search {
            surface: self,
            point,
            facing,
            radius: options.radius,
            best: options.radius,
            bound,
            found: None,
            aside: f64::INFINITY,
            parts: 0,
            stack: Vec::with_capacity(8),
        };
        search.run();
        let found = search.found?;
        let place = self.places[found.domain.patch as usize];
        let (u, v) = found.domain.parameters(found.s, found.t);
        let normal = match found.normal.try_normalize() {
            Some(normal) => normal,
            None => self.evaluate_patch(found.domain.patch as usize, u, v).normal,
        };
        Some(Foot {
            face: place.face,
            corner: place.corner as usize,
            u,
            v,
            position: found.position,
            normal,
            distance: search.best,
        })
    }
}

/// A distance as a key of the queue.
#[derive(Clone, Copy, PartialEq)]
struct Nearness(f64);

impl Eq for Nearness {}

impl Ord for Nearness {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Nearness {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// What the queue holds: items come before nodes that may be as near.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Goal {
    /// A piece or, numbered after the pieces, an extraordinary corner.
    Item(u32),
    /// A node of the tree.
    Node(u32),
}

fn box_distance(low: DVec3, high: DVec3, point: DVec3) -> f64 {
    (low - point).max(point - high).max(DVec3::ZERO).length()
}

impl Search<'_> {
    /// Nothing farther than this is wanted. Distances that differ by rounding only are compared by how well they
    /// are perpendicular, for the distance is flat about its minimum: of two parts that share a border, one has the
    /// foot and the other the end of its own range, a square root of the rounding away.
    fn rounding(&self) -> f64 {
        0.01 * self.surface.tolerance + 4.0 * f64::EPSILON * self.best.min(self.bound)
    }

    fn hopeless(&self, at_least: f64) -> bool {
        at_least > self.best.min(self.bound) + self.rounding()
    }

    /// Visits the pieces, those first that may be nearest.
    fn run(&mut self) {
        let surface = self.surface;
        let index = surface.index();
        let node_entry = |number: u32, point: DVec3| {
            let node = index.tree.node(number);
            Reverse((Nearness(box_distance(node.low, node.high, point)), Goal::Node(number)))
        };
        let mut open = BinaryHeap::with_capacity(64);
        if index.tree.bounds().is_some() {
            open.push(node_entry(0, self.point));
        }
        while let Some(Reverse((Nearness(at_least), goal))) = open.pop() {
            if self.hopeless(at_least) {
                break;
            }
            match goal {
                Goal::Node(number) => match index.tree.content(number) {
                    Content::Children(children) => {
                        open.extend(children.map(|child| node_entry(child, self.point)));
                    }
                    Content::Leaf(items) => {
                        open.extend(items.iter().map(|&item| {
                            let nearness = match index.item(surface, item) {
                                Item::Piece(bicubic, _) => View::new(bicubic, self.point).at_least,
                                Item::Rest(_) => at_least,
                            };
                            Reverse((Nearness(nearness), Goal::Item(item)))
                        }));
                    }
                },
                Goal::Item(item) => match index.item(surface, item) {
                    Item::Piece(bicubic, domain) => self.visit(*bicubic, DVec3::ZERO, *domain),
                    Item::Rest(rest) => self.visit_rest(rest),
                },
            }
        }
    }

    /// Looks at a patch whose points are relative to `origin`.
    fn visit(&mut self, bicubic: Bicubic, origin: DVec3, domain: Domain) {
        let point = self.point - origin;
        // Minima on the border of a part do not count then, but those on the border of the surface do.
        let feet_only = self.facing.is_some() && self.surface.places[domain.patch as usize].rims == 0;
        let facing = self.facing.filter(|f| f.min_cosine >= 0.0).map_or(DVec3::ZERO, |f| f.normal);
        self.stack.clear();
        self.stack.push(Part { bicubic, s: 0.0, t: 0.0, size: 1.0, halvings: 0 });
        while let Some(part) = self.stack.pop() {
            let (low, high) = part.bicubic.bounds();
            if self.hopeless(box_distance(low, high, point)) {
                continue;
            }
            let view = View::new(&part.bicubic, point);
            if self.hopeless(view.at_least) {
                continue;
            }
            let convexity = view.convexity(facing);
            if !convexity.may_face || feet_only && !convexity.may_have_foot {
                continue;
            }
            self.parts += 1;
            let last = convexity.convex || part.halvings >= MAX_HALVINGS || self.parts > MAX_PARTS;
            // Newton's method from the middle of a whole piece mostly finds the foot at once; the search that
            // follows then only has to show that nothing is closer.
            if last || part.halvings == 0 {
                let (a, b, jet) = minimise(&part.bicubic, point);
                let (s, t) = (part.s + part.size * a, part.t + part.size * b);
                let normal = jet.du.cross(jet.dv);
                self.offer(
                    jet.position - point,
                    Found { domain, s, t, position: jet.position + origin, normal },
                );
            }
            if !last && !self.hopeless(view.at_least) {
                self.split(&part, point);
            }
        }
    }

    /// Puts the quarters of `part` on the stack, the nearest on top.
    fn split(&mut self, part: &Part, point: DVec3) {
        let quarters = part.bicubic.quarters();
        // The corner that all quarters share is a point of the surface.
        let middle = quarters[0].points[3][3].distance(point);
        if self.facing.is_none() {
            self.bound = self.bound.min(middle);
        }
        let size = 0.5 * part.size;
        let distances = quarters.map(|quarter| {
            let points = &quarter.points;
            (points[1][1] + points[2][2]).distance_squared(2.0 * point)
        });
        let mut order = [0, 1, 2, 3];
        order.sort_unstable_by(|&a: &usize, &b| distances[b].total_cmp(&distances[a]));
        for i in order {
            self.stack.push(Part {
                bicubic: quarters[i],
                s: part.s + if i % 2 == 1 { size } else { 0.0 },
                t: part.t + if i >= 2 { size } else { 0.0 },
                size,
                halvings: part.halvings + 1,
            });
        }
    }

    /// Takes the minimum over a part of a piece if it is the best so far and allowed; `way` leads to it.
    fn offer(&mut self, way: DVec3, found: Found) {
        let distance = way.length();
        if distance.is_nan() || distance >= self.radius || self.hopeless(distance) {
            return;
        }
        let unit = found.normal.normalize_or_zero();
        let aside = (way - unit * way.dot(unit)).length();
        if let Some(facing) = self.facing {
            let compatible = unit.dot(facing.normal) > facing.min_cosine;
            let foot = aside <= 1e3 * self.surface.tolerance || self.on_rim(&found);
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

    /// Looks at what lies beside an extraordinary vertex, level by level.
    fn visit_rest(&mut self, entry: &Rest) {
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
                self.visit(Bicubic::from_bspline(grid), corner.origin, domain.side(side));
            }
            domain = domain.inner();
        }
    }
}
