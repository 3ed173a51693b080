//! The closest point: branch and bound over the pieces, Newton's method where it is certain.

mod convexity;
mod corner;
mod minimise;
mod part;
mod search;

use super::{Bicubic, Jet, LimitSurface, Parameter};
use crate::fault;
use crate::mesh::FaceId;
use glam::DVec3;
use search::Search;

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

    /// `bound` is a distance that some point of the surface has, but for rounding, or infinity.
    pub(super) fn closest_within(&self, point: DVec3, options: &ClosestOptions, bound: f64) -> Option<Foot> {
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
        let (found, distance) = Search::new(self, point, facing, options.radius, bound).run()?;
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
            distance,
        })
    }
}
