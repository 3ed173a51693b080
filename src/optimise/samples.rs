//! Samples of the surface that a fit can move, and how far they are from the frozen surface.

use super::{TOLERANCE, Target};
use crate::job::{Cancelled, Job};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::subdivision::basis::{Control, Place, Table, Tables};
use crate::subdivision::{SurfacePoint, has_limit};
use crate::surface::{ClosestOptions, Facing, Foot, Hit};
use glam::DVec3;
use rustc_hash::FxHashSet;
use smallvec::SmallVec;
use std::rc::Rc;

/// A face is worse than before only if its error is above this part of the mean error before: a small loss beside the
/// feature is the price of the gain in it.
const WORSE: f64 = 4.0;

/// Faces with more corners, and at vertices with more edges, are not sampled: too many control vertices for the little
/// that a sample says about each.
const LARGE: usize = 16;

/// True for a face that is not sampled.
pub(super) fn is_large(mesh: &Mesh, face: FaceId) -> bool {
    mesh.arity(face) > LARGE || mesh.face_vertices(face).any(|v| mesh.valence(v) > LARGE)
}

/// A sampled face.
pub(super) struct Sampled {
    face: FaceId,
    pub(super) control: Control,
    pub(super) table: Rc<Table>,
    /// Its first sample.
    first: usize,
    error: Error,
}

/// Mean squares over an area: of the distance, and of distance and weighed slopes together.
#[derive(Clone, Copy, Default)]
pub(super) struct Error {
    pub(super) distance: f64,
    pub(super) all: f64,
}

impl Error {
    fn map(self, change: impl Fn(f64) -> f64) -> Self {
        Self { distance: change(self.distance), all: change(self.all) }
    }

    fn plus(self, other: Self) -> Self {
        Self { distance: self.distance + other.distance, all: self.all + other.all }
    }
}

/// What is known of a sample at the present positions.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    /// The foot; its `s` is the distance along its normal. `None` where there is none within reach.
    pub(super) foot: Option<Hit>,
    pub(super) area: f64,
    /// Weight of the slopes over the lengths of the tangents.
    pub(super) factors: [f64; 2],
    /// Tangents of the new surface times these.
    pub(super) slopes: [DVec3; 2],
    /// Products with a shift of the sample are the changes of n.slopes by the turning of n, with opposite sign.
    pub(super) turns: [DVec3; 2],
}

/// All samples of the faces whose surface moves with some vertices.
pub(super) struct Samples<'a> {
    target: &'a Target,
    /// Weight of the slopes as a length, in edges.
    slope: f64,
    pub(super) faces: Vec<Sampled>,
    samples: Vec<Sample>,
    is_evaluated: bool,
}

impl<'a> Samples<'a> {
    /// At most `order` x `order` samples on each face whose surface moves with `vertices`, which are ascending; only on
    /// faces between them, unless `beyond`.
    pub(super) fn new(
        mesh: &Mesh,
        vertices: &[VertexId],
        target: &'a Target,
        order: usize,
        slope: f64,
        beyond: bool,
    ) -> Self {
        let is_between = |face| mesh.face_vertices(face).all(|v| vertices.binary_search(&v).is_ok());
        let at = vertices.iter().flat_map(|&v| mesh.outgoing(v)).map(|h| mesh.face(h));
        let mut around: Vec<FaceId> = at.filter(|f| !f.is_boundary()).collect();
        around.sort_unstable();
        around.dedup();
        // A vertex moves the surface of the faces round its faces too.
        let (mut tables, mut faces, mut count) = (Tables::new(order), Vec::new(), 0);
        for face in mesh.grow_faces(&around).into_iter().filter(|&face| has_limit(mesh, face)) {
            if is_large(mesh, face) || !(beyond || is_between(face)) {
                continue;
            }
            let Some((control, table)) = tables.of_face(mesh, face) else { continue };
            let first = count;
            count += table.samples().len();
            faces.push(Sampled { face, control, table, first, error: Error::default() });
        }
        let zero = [DVec3::ZERO; 2];
        let samples =
            vec![Sample { foot: None, area: 0.0, factors: [0.0; 2], slopes: zero, turns: zero }; count];
        Self { target, slope, faces, samples, is_evaluated: false }
    }

    pub(super) fn of_face(&self, face: &Sampled) -> &[Sample] {
        &self.samples[face.first..][..face.table.samples().len()]
    }

    /// The largest distance of a sample.
    pub(super) fn residual(&self) -> f64 {
        let distances = self.samples.iter().filter_map(|sample| sample.foot.map(|foot| foot.s.abs()));
        distances.fold(0.0, f64::max)
    }

    fn area(&self, face: &Sampled) -> f64 {
        self.of_face(face).iter().map(|sample| sample.area).sum()
    }

    /// The errors summed over the area.
    pub(super) fn error(&self) -> Error {
        let errors = self.faces.iter().map(|face| face.error.map(|error| error * self.area(face)));
        errors.fold(Error::default(), Error::plus)
    }

    /// Mean squares below this are rounding.
    fn rounding(&self) -> f64 {
        (TOLERANCE * self.target.reach).powi(2)
    }

    /// True when the surface as a whole is as near as it was with the error `before`.
    pub(super) fn is_as_near(&self, before: Error) -> bool {
        let rounding = self.rounding() * self.faces.iter().map(|face| self.area(face)).sum::<f64>();
        let now = self.error();
        now.distance <= before.distance.max(rounding) && now.all <= before.all.max(rounding)
    }

    /// The errors of the faces.
    pub(super) fn errors(&self) -> Vec<Error> {
        self.faces.iter().map(|face| face.error).collect()
    }

    /// Vertices of the faces that are further from the frozen surface than they were, by their errors before, and than
    /// the faces were in the mean.
    pub(super) fn worse_than(&self, mesh: &Mesh, before: &[Error]) -> FxHashSet<VertexId> {
        let areas = || self.faces.iter().map(|face| self.area(face));
        let total: f64 = areas().sum();
        let sums = areas().zip(before).map(|(area, error)| error.map(|error| error * area / total));
        let mean = sums.fold(Error::default(), Error::plus);
        let rounding = self.rounding();
        let worse = self.faces.iter().zip(before).filter(|(face, before)| {
            face.error.distance > before.distance.max(WORSE * mean.distance).max(rounding)
                || face.error.all > before.all.max(WORSE * mean.all).max(rounding)
        });
        worse.flat_map(|(face, _)| mesh.face_vertices(face.face)).collect()
    }

    /// Finds the feet of all samples at the present positions, and what they say.
    pub(super) fn evaluate(&mut self, mesh: &Mesh, job: &Job) -> Result<(), Cancelled> {
        for index in 0..self.faces.len() {
            if index % 64 == 0 && job.is_cancelled() {
                return Err(Cancelled);
            }
            let face = &self.faces[index];
            let positions: SmallVec<[DVec3; 32]> = face.control.iter().map(|&v| mesh.position(v)).collect();
            let (mut sum, mut total) = (Error::default(), 0.0);
            let corners = || positions.iter().take(mesh.arity(face.face));
            let diameter = corners().flat_map(|a| corners().map(move |b| a.distance(*b))).fold(0.0, f64::max);
            let mut last = None;
            for (k, (place, weights)) in face.table.samples().enumerate() {
                let mut jet = [DVec3::ZERO; 3];
                for (&p, w) in positions.iter().zip(weights) {
                    jet.iter_mut().zip(w).for_each(|(sum, &w)| *sum += p * w);
                }
                let before = &self.samples[face.first + k];
                let search = match before.foot {
                    Some(foot) => Search { start: foot, radius: diameter.min(self.target.reach) },
                    // What was not found once is not looked for again.
                    None if self.is_evaluated => Search { start: same_place(face.face, place), radius: 0.0 },
                    None => Search {
                        start: last.unwrap_or_else(|| same_place(face.face, place)),
                        radius: diameter.min(self.target.reach),
                    },
                };
                let sample = self.sample(jet, place.share, search);
                let [along_u, along_v] = sample.slopes;
                let square = |foot: Hit| {
                    let distance = foot.s.powi(2);
                    let slopes = foot.normal.dot(along_u).powi(2) + foot.normal.dot(along_v).powi(2);
                    Error { distance, all: distance + slopes }
                };
                let nowhere = self.target.reach.powi(2);
                let here = sample.foot.map_or(Error { distance: nowhere, all: nowhere }, square);
                sum = sum.plus(here.map(|error| error * sample.area));
                total += sample.area;
                last = sample.foot.or(last);
                self.samples[face.first + k] = sample;
            }
            self.faces[index].error = if total > 0.0 { sum.map(|sum| sum / total) } else { Error::default() };
        }
        self.is_evaluated = true;
        Ok(())
    }

    fn sample(&self, [point, du, dv]: [DVec3; 3], share: f64, search: Search) -> Sample {
        let cross = du.cross(dv);
        let (foot, area) = (self.find_foot(search, point, cross), cross.length() * share);
        let (mut factors, mut slopes, mut turns) = ([0.0; 2], [DVec3::ZERO; 2], [DVec3::ZERO; 2]);
        let there =
            foot.and_then(|foot| self.target.surface.evaluate(foot.face, foot.corner, foot.u, foot.v));
        if let Some(there) = there {
            let weight = self.slope * there.du.cross(there.dv).length().sqrt();
            for (k, tangent) in [du, dv].into_iter().enumerate() {
                let factor = weight / tangent.length();
                if factor.is_finite() {
                    (factors[k], slopes[k]) = (factor, tangent * factor);
                    turns[k] = turn(&there, slopes[k]);
                }
            }
        }
        Sample { foot, area, factors, slopes, turns }
    }

    /// The foot of a sample with a normal on the side of `direction`.
    fn find_foot(&self, search: Search, point: DVec3, direction: DVec3) -> Option<Hit> {
        let surface = &self.target.surface;
        let Search { start, radius } = search;
        let is_fit = |foot: &Foot| foot.normal.dot(direction) > 0.0 && foot.distance < radius;
        let along_line = || {
            let hit = surface.nearest_line_hit(point, direction.normalize_or_zero(), radius, direction)?;
            surface
                .foot_near(hit.face, hit.corner, hit.u, hit.v, point)
                .filter(|foot| foot.distance <= hit.s.abs())
        };
        let anywhere = || {
            let facing = Some(Facing { normal: direction, min_cosine: 0.0 });
            surface.closest(point, &ClosestOptions { radius, facing })
        };
        if radius <= 0.0 {
            return None;
        }
        let foot = surface
            .foot_near(start.face, start.corner, start.u, start.v, point)
            .filter(is_fit)
            .or_else(|| along_line().filter(is_fit))
            .or_else(anywhere)?;
        let s = (foot.position - point).dot(foot.normal);
        let (face, corner, u, v) = (foot.face, foot.corner, foot.u, foot.v);
        Some(Hit { face, corner, u, v, s, position: foot.position, normal: foot.normal })
    }
}

/// Where a foot is looked for first, and how far away it may be.
struct Search {
    start: Hit,
    radius: f64,
}

/// Where a face that was not changed has its foot, as a start for the search.
fn same_place(face: FaceId, place: Place) -> Hit {
    let Place { patch, u, v, .. } = place;
    Hit { face, corner: patch, u, v, s: 0.0, position: DVec3::ZERO, normal: DVec3::ZERO }
}

/// The vector whose product with a shift of the foot is the change of n.tangent by the turning of the normal n: the
/// second fundamental form with `tangent` in one place, with the sign of the change reversed.
fn turn(there: &SurfacePoint, tangent: DVec3) -> DVec3 {
    let Some(second) = there.second else { return DVec3::ZERO };
    let n = there.normal;
    let (e, f, g) = (there.du.length_squared(), there.du.dot(there.dv), there.dv.length_squared());
    let determinant = e * g - f * f;
    let dual = [(there.du * g - there.dv * f) / determinant, (there.dv * e - there.du * f) / determinant];
    let (a, b) = (dual[0].dot(tangent), dual[1].dot(tangent));
    let (uu, uv, vv) = (n.dot(second.uu), n.dot(second.uv), n.dot(second.vv));
    let turn = dual[0] * (uu * a + uv * b) + dual[1] * (uv * a + vv * b);
    if turn.is_finite() { turn } else { DVec3::ZERO }
}
