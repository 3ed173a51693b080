//! How far patches are from the limit surface, and how their normals meet.

use super::cells::Cell;
use super::pieces::{Pieces, patch_of};
use super::regions::Region;
use super::spline::{SplinePatch, SplinePoint};
use crate::mesh::{FaceId, Mesh};
use crate::surface::LimitSurface;
use glam::{DVec2, DVec3};

/// Samples per side of a span beside an extraordinary vertex, and of the spans round that.
const FINE: usize = 9;
const COARSE: usize = 5;
/// Steps towards the foot of a sample.
const STEPS: usize = 3;

/// How far a patch is from the surface.
#[derive(Clone, Copy, Default)]
pub(super) struct Distance {
    /// Greatest distance in units of the model.
    pub(super) absolute: f64,
    /// The same in parts of the mean length of the control face's edges.
    pub(super) relative: f64,
    /// Greatest angle in degrees between the normals, where the patch deviates.
    pub(super) angle: f64,
    /// Sum of the squares of the relative distances in the spans beside extraordinary vertices, and number of samples there.
    pub(super) squares: f64,
    pub(super) samples: f64,
}

/// Measures patches of a surface.
pub(super) struct Ruler<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) surface: &'a LimitSurface,
    pub(super) cells: &'a [Cell],
}

/// Which spans of a patch are measured.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Spans {
    All,
    /// The three beside extraordinary vertices.
    Last,
}

impl Ruler<'_> {
    /// Measures a patch. Distances within rounding count as none.
    pub(super) fn distance(
        &self,
        pieces: &mut Pieces,
        region: &Region,
        patch: &SplinePatch,
        which: Spans,
    ) -> Distance {
        let mut worst = Distance::default();
        let (us, vs) = (spans(&patch.knots_u), spans(&patch.knots_v));
        for (j, &[v0, v1]) in vs.iter().enumerate() {
            for (i, &[u0, u1]) in us.iter().enumerate() {
                let (end_i, end_j) = (us.len() - 1 - i, vs.len() - 1 - j);
                let places = [(i, j), (end_i, j), (end_i, end_j), (i, end_j)];
                // How many spans lie between this one and an extraordinary corner.
                let steps = places.into_iter().zip(patch.irregular).filter(|&(_, irregular)| irregular);
                let count = match steps.map(|((i, j), _)| i.max(j)).min() {
                    Some(0) => FINE,
                    Some(1 | 2) => COARSE,
                    _ if which == Spans::Last => continue,
                    _ => 1,
                };
                // Beside a vertex also along the sides, where patches deviate most; else in the middle.
                let share = |k: usize| if count > 1 { k as f64 / (count - 1) as f64 } else { 0.5 };
                for k in 0..count * count {
                    let (x, y) = (share(k % count), share(k / count));
                    let at = DVec2::new(u0 + (u1 - u0) * x, v0 + (v1 - v0) * y);
                    let relative = self.sample(pieces, region, patch, at, &mut worst);
                    if count > 1 {
                        worst.squares += relative * relative;
                        worst.samples += 1.0;
                    }
                }
            }
        }
        worst
    }

    /// Takes a point of the patch into `worst`. Its distance in parts of the length of edges.
    fn sample(
        &self,
        pieces: &mut Pieces,
        region: &Region,
        patch: &SplinePatch,
        at: DVec2,
        worst: &mut Distance,
    ) -> f64 {
        let Some(found) = patch.evaluate(at.x, at.y) else { return 0.0 };
        let Some(foot) = self.foot(pieces, region, at, found.position) else { return 0.0 };
        let far = foot.position.distance(found.position);
        if far <= self.surface.tolerance.max(1e-13 * self.surface.size) {
            return 0.0;
        }
        let (base, _) = patch_of(self.cells, region, at);
        let length = edge_length(self.mesh, self.surface.places[base].face);
        worst.absolute = worst.absolute.max(far);
        worst.relative = worst.relative.max(far / length);
        worst.angle = worst.angle.max(angle(found, foot).unwrap_or(0.0));
        far / length
    }

    /// The nearest of the points of the surface that lie on the way from `at` to the foot of `point`; `None` at an
    /// extraordinary vertex.
    fn foot(&self, pieces: &mut Pieces, region: &Region, mut at: DVec2, point: DVec3) -> Option<SplinePoint> {
        let mut nearest = pieces.point(self.cells, region, at)?;
        let mut here = nearest;
        for _ in 0..STEPS {
            let offset = point - here.position;
            if offset.length() <= self.surface.tolerance {
                break;
            }
            let (uu, uv, vv) = (here.du.length_squared(), here.du.dot(here.dv), here.dv.length_squared());
            let (a, b) = (offset.dot(here.du), offset.dot(here.dv));
            let determinant = uu * vv - uv * uv;
            if determinant <= 1e-12 * uu * vv {
                break;
            }
            let step = DVec2::new(vv * a - uv * b, uu * b - uv * a) / determinant;
            let end = DVec2::new(region.size[0] as f64, region.size[1] as f64);
            at = (at + step).clamp(DVec2::ZERO, end);
            let Some(next) = pieces.point(self.cells, region, at) else { break };
            here = next;
            if here.position.distance(point) < nearest.position.distance(point) {
                nearest = here;
            }
        }
        Some(nearest)
    }
}

/// The angle in degrees between the normals of two points.
fn angle(a: SplinePoint, b: SplinePoint) -> Option<f64> {
    let [a, b] = [a, b].map(|point| point.du.cross(point.dv).try_normalize());
    let (a, b) = (a?, b?);
    Some(a.cross(b).length().atan2(a.dot(b)).to_degrees())
}

/// The spans of flat knots.
fn spans(knots: &[f64]) -> Vec<[f64; 2]> {
    knots.windows(2).filter(|pair| pair[0] < pair[1]).map(|pair| [pair[0], pair[1]]).collect()
}

fn edge_length(mesh: &Mesh, face: FaceId) -> f64 {
    let (sum, count) = mesh
        .face_half_edges(face)
        .fold((0.0, 0.0), |(sum, count), h| (sum + mesh.edge_length(h), count + 1.0));
    (sum / count).max(f64::MIN_POSITIVE)
}

/// Greatest angle in degrees between the normals of two patches along a shared side.
pub(super) fn normal_jump(patch: &SplinePatch, side: usize, other: &SplinePatch, there: usize) -> f64 {
    let own = patch.side_knots(side);
    let length = patch.side_length(side).unwrap_or(0.0);
    let mut worst: f64 = 0.0;
    for [low, high] in spans(own) {
        for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let t = low + share * (high - low);
            // Sides 2 and 3 run against the parameter, and the other patch has the side in the opposite sense.
            let along = if side < 2 { t } else { length - t };
            let both = patch.at_side(side, along).zip(other.at_side(there, length - along));
            worst = worst.max(both.and_then(|(a, b)| angle(a, b)).unwrap_or(0.0));
        }
    }
    worst
}
