//! Samples of the surface that a fit can move, and how far they are from the frozen surface.

use super::walk::Start;
use super::{TOLERANCE, Target};
use crate::job::{Cancelled, Job};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::subdivision::basis::{Control, Place, Table, Tables};
use crate::subdivision::{SurfacePoint, has_limit};
use crate::surface::{ClosestOptions, Facing, Foot, Hit};
use glam::DVec3;
use smallvec::SmallVec;
use std::rc::Rc;

/// A face is worse than before only if its error is above this part of the mean error before: a small loss beside the
/// feature is the price of the gain in it.
const WORSE: f64 = 4.0;

/// What is above by less than this factor is not worse, but rounding.
const MARGIN: f64 = 1.0 + 1e-6;

/// Curvature gains clearly where its mean square change falls to this part: to a half in rms.
const CLEAR: f64 = 0.25;

/// Feet closer than this share of a face's width are beyond doubt: no other part of the surface is likely to be as close.
const CLOSE: f64 = 0.05;

/// Faces with more corners, and at vertices with more edges, are not sampled: too many control vertices for the little
/// that a sample says about each.
const LARGE: usize = 16;

/// True for a face that is not sampled.
pub(super) fn is_large(mesh: &Mesh, face: FaceId) -> bool {
    mesh.arity(face) > LARGE || mesh.face_vertices(face).any(|v| mesh.valence(v) > LARGE)
}

/// A sampled face.
pub(super) struct Sampled {
    pub(super) face: FaceId,
    pub(super) control: Control,
    pub(super) table: Rc<Table>,
    /// Its first sample.
    first: usize,
    /// Over the samples that count.
    error: Error,
    area: f64,
}

/// Integrals of squares over an area: of the distance, of distance and weighed slopes together, and of the change of
/// mean curvature.
#[derive(Clone, Copy, Default)]
pub(super) struct Error {
    pub(super) distance: f64,
    pub(super) all: f64,
    pub(super) bend: f64,
}

impl Error {
    pub(super) fn map(self, change: impl Fn(f64) -> f64) -> Self {
        Self { distance: change(self.distance), all: change(self.all), bend: change(self.bend) }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            distance: self.distance + other.distance,
            all: self.all + other.all,
            bend: self.bend + other.bend,
        }
    }

    /// True when one of the three is above both of what `before` and `floor` say, by more than rounding.
    pub(super) fn exceeds(self, before: Self, floor: Self) -> bool {
        let more = |now: f64, before: f64, floor: f64| now > (MARGIN * before).max(floor);
        more(self.distance, before.distance, floor.distance)
            || more(self.all, before.all, floor.all)
            || more(self.bend, before.bend, floor.bend)
    }
}

/// The samples at some positions, to go back to.
pub(super) struct Snapshot {
    samples: Vec<Sample>,
    pub(super) errors: Vec<Error>,
}

/// What is known of a sample at the present positions.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    /// The foot; its `s` is the distance along its normal. `None` where there is none within reach.
    pub(super) foot: Option<Hit>,
    /// It had a foot at first, and counts.
    has_target: bool,
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
    /// Changes of curvature count.
    has_curvature: bool,
    pub(super) faces: Vec<Sampled>,
    samples: Vec<Sample>,
    is_evaluated: bool,
}

impl<'a> Samples<'a> {
    /// At most `order` x `order` samples on each face whose surface moves with `vertices`, which are ascending; only on
    /// faces between them, unless `beyond`. Changes of curvature count as errors if `has_curvature`.
    pub(super) fn new(
        mesh: &Mesh,
        vertices: &[VertexId],
        target: &'a Target,
        order: usize,
        slope: f64,
        beyond: bool,
        has_curvature: bool,
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
            faces.push(Sampled { face, control, table, first, error: Error::default(), area: 0.0 });
        }
        let zero = [DVec3::ZERO; 2];
        let samples = vec![
            Sample {
                foot: None,
                has_target: false,
                area: 0.0,
                factors: [0.0; 2],
                slopes: zero,
                turns: zero
            };
            count
        ];
        Self { target, slope, has_curvature, faces, samples, is_evaluated: false }
    }

    pub(super) fn of_face(&self, face: &Sampled) -> &[Sample] {
        &self.samples[face.first..][..face.table.samples().len()]
    }

    /// The largest distance of a sample.
    pub(super) fn residual(&self) -> f64 {
        let distances = self.samples.iter().filter_map(|sample| sample.foot.map(|foot| foot.s.abs()));
        distances.fold(0.0, f64::max)
    }

    /// The errors summed over all faces.
    pub(super) fn error(&self) -> Error {
        self.faces.iter().map(|face| face.error).fold(Error::default(), Error::plus)
    }

    /// The errors face by face.
    pub(super) fn errors(&self) -> Vec<Error> {
        self.faces.iter().map(|face| face.error).collect()
    }

    /// True where nothing escapes the samples of a face, neither now nor at those of `before`: curvature is smooth on both
    /// surfaces, and the feet are beyond doubt.
    pub(super) fn is_plain(&self, before: &Snapshot, number: usize) -> bool {
        let face = &self.faces[number];
        let close = CLOSE * face.area.sqrt();
        let surface = &self.target.surface;
        let is_plain = |sample: &Sample| {
            sample
                .foot
                .is_some_and(|foot| foot.s.abs() <= close && surface.is_bicubic(foot.face, foot.corner))
        };
        let range = face.first..face.first + face.table.samples().len();
        face.table.is_bicubic()
            && self.samples[range.clone()].iter().chain(&before.samples[range]).all(is_plain)
    }

    /// What is not above this in the sum over the faces with these numbers is rounding.
    pub(super) fn rounding(&self, faces: &[usize]) -> Error {
        self.rounding_on(faces.iter().map(|&k| self.faces[k].area).sum())
    }

    /// What is not above this in the sum over an area is rounding: in distance, along the slopes, in curvature.
    fn rounding_on(&self, area: f64) -> Error {
        let distance = (TOLERANCE * self.target.reach).powi(2) * area;
        Error { distance, all: distance, bend: TOLERANCE.powi(2) * area / self.target.reach.powi(2) }
    }

    /// The samples as they are.
    pub(super) fn snapshot(&self) -> Snapshot {
        Snapshot { samples: self.samples.clone(), errors: self.errors() }
    }

    /// Goes back to the samples of `before`, whose positions the mesh has, on the faces with these numbers.
    pub(super) fn restore(&mut self, before: &Snapshot, faces: impl Iterator<Item = usize>) {
        for number in faces {
            let face = &mut self.faces[number];
            let range = face.first..face.first + face.table.samples().len();
            face.error = before.errors[number];
            self.samples[range.clone()].copy_from_slice(&before.samples[range]);
        }
    }

    /// True when the change of curvature of the faces with these numbers is clearly less than it was.
    pub(super) fn is_clear(&self, before: &Snapshot, faces: &[usize]) -> bool {
        let bend = |error: &Error| error.bend;
        let now: f64 = faces.iter().map(|&k| bend(&self.faces[k].error)).sum();
        let was: f64 = faces.iter().map(|&k| bend(&before.errors[k])).sum();
        now <= (CLEAR * was).max(self.rounding(faces).bend)
    }

    /// True when the surface of the faces with these numbers is further from the frozen one than it was.
    pub(super) fn is_worse(&self, before: &Snapshot, faces: &[usize]) -> bool {
        let sum = |error: &dyn Fn(usize) -> Error| {
            faces.iter().map(|&k| error(k)).fold(Error::default(), Error::plus)
        };
        sum(&|k| self.faces[k].error).exceeds(sum(&|k| before.errors[k]), self.rounding(faces))
    }

    /// Numbers of the faces that are further from the frozen surface than they were, and than all faces were in the mean.
    /// Curvature counts only where it is worse in sum.
    pub(super) fn worse_faces(&self, before: &Snapshot) -> Vec<usize> {
        let area: f64 = self.faces.iter().map(|face| face.area).sum();
        let sum = before.errors.iter().copied().fold(Error::default(), Error::plus);
        let mean = sum.map(|sum| WORSE * sum / area);
        let bends = self.error().bend > MARGIN * sum.bend;
        let is_worse = |k: &usize| {
            let (face, rounding) = (&self.faces[*k], self.rounding_on(1.0));
            let floor = |mean: f64, rounding: f64| mean.max(rounding) * face.area;
            let floor = Error {
                distance: floor(mean.distance, rounding.distance),
                all: floor(mean.all, rounding.all),
                bend: if bends { floor(mean.bend, rounding.bend) } else { f64::INFINITY },
            };
            face.error.exceeds(before.errors[*k], floor)
        };
        (0..self.faces.len()).filter(is_worse).collect()
    }

    /// Finds the feet of all samples at the present positions, and what they say.
    pub(super) fn evaluate(&mut self, mesh: &Mesh, job: &Job) -> Result<(), Cancelled> {
        for index in 0..self.faces.len() {
            if index % 64 == 0 && job.is_cancelled() {
                return Err(Cancelled);
            }
            let face = &self.faces[index];
            let positions: SmallVec<[DVec3; 32]> = face.control.iter().map(|&v| mesh.position(v)).collect();
            let (mut error, mut area) = (Error::default(), 0.0);
            let corners = || positions.iter().take(mesh.arity(face.face));
            let diameter = corners().flat_map(|a| corners().map(move |b| a.distance(*b))).fold(0.0, f64::max);
            for (k, (place, weights)) in face.table.samples().enumerate() {
                let mut jet = [DVec3::ZERO; 6];
                for (&p, w) in positions.iter().zip(weights) {
                    jet.iter_mut().zip(w).for_each(|(sum, &w)| *sum += p * w);
                }
                let before = &self.samples[face.first + k];
                let search = match before.foot {
                    Some(foot) => Search { start: foot.into(), radius: diameter.min(self.target.reach) },
                    // What was not found once is not looked for again.
                    None if self.is_evaluated => {
                        Search { start: self.same_place(mesh, face.face, place), radius: 0.0 }
                    }
                    None => Search {
                        start: self.same_place(mesh, face.face, place),
                        radius: diameter.min(self.target.reach),
                    },
                };
                let (mut sample, bend) = self.sample(jet, place.share, search);
                sample.has_target = before.has_target || !self.is_evaluated && sample.foot.is_some();
                if sample.has_target {
                    let nowhere = self.target.reach.powi(2);
                    let here = sample.foot.map_or(Error { distance: nowhere, all: nowhere, bend }, |foot| {
                        let distance = foot.s.powi(2);
                        let slopes: f64 =
                            sample.slopes.iter().map(|slope| foot.normal.dot(*slope).powi(2)).sum();
                        Error { distance, all: distance + slopes, bend }
                    });
                    error = error.plus(here.map(|square| square * sample.area));
                    area += sample.area;
                }
                self.samples[face.first + k] = sample;
            }
            (self.faces[index].error, self.faces[index].area) = (error, area);
        }
        self.is_evaluated = true;
        Ok(())
    }

    /// Where a sample has its foot, if not far from there: its own place on a face that was there, the middle of the face
    /// that was there where rules made new ones. Which of those took its number is nothing to go by.
    fn same_place(&self, mesh: &Mesh, face: FaceId, place: Place) -> Start {
        let Place { patch, u, v, .. } = place;
        let was = mesh.original_face(face);
        let is_old = was == face && mesh.face_vertices(face).all(|v| (v.0 as usize) < self.target.vertices);
        if is_old { Start { face, corner: patch, u, v } } else { Start::middle(was) }
    }

    /// A sample, and its square change of mean curvature.
    fn sample(&self, jet: [DVec3; 6], share: f64, search: Search) -> (Sample, f64) {
        let [point, du, dv, uu, uv, vv] = jet;
        let cross = du.cross(dv);
        let (found, area) = (self.find_foot(search, point, cross), cross.length() * share);
        let (mut factors, mut slopes, mut turns) = ([0.0; 2], [DVec3::ZERO; 2], [DVec3::ZERO; 2]);
        let mut bend = 0.0;
        let (foot, there) = found.unzip();
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
        if let Some((there, second)) =
            there.filter(|_| self.has_curvature).and_then(|there| Some((there, there.second?)))
        {
            let now = mean_curvature([du, dv], [uu, uv, vv]);
            let was = mean_curvature([there.du, there.dv], [second.uu, second.uv, second.vv]);
            bend = Some((now - was).powi(2)).filter(|bend| bend.is_finite()).unwrap_or_default();
        }
        (Sample { foot, has_target: false, area, factors, slopes, turns }, bend)
    }

    /// The foot of a sample with a normal on the side of `direction`, and the frozen surface there.
    fn find_foot(&self, search: Search, point: DVec3, direction: DVec3) -> Option<(Hit, SurfacePoint)> {
        let (surface, beside) = (&self.target.surface, &self.target.beside);
        let Search { start, radius } = search;
        if radius <= 0.0 {
            return None;
        }
        let away = |found: &(Hit, SurfacePoint)| found.0.position.distance(point);
        let is_fit =
            |found: &(Hit, SurfacePoint)| found.0.normal.dot(direction) > 0.0 && away(found) < radius;
        let along_line = || {
            let hit = surface.nearest_line_hit(point, direction.normalize_or_zero(), radius, direction)?;
            beside.follow(surface, hit.into(), point).filter(|found| away(found) <= hit.s.abs())
        };
        let anywhere = || {
            let facing = Some(Facing { normal: direction, min_cosine: 0.0 });
            let foot = surface.closest(point, &ClosestOptions { radius, facing })?;
            let Foot { face, corner, u, v, position, normal, .. } = foot;
            let s = (position - point).dot(normal);
            let there = surface.evaluate(face, corner, u, v)?;
            Some((Hit { face, corner, u, v, s, position, normal }, there))
        };
        beside
            .follow(surface, start, point)
            .filter(is_fit)
            .or_else(|| along_line().filter(is_fit))
            .or_else(anywhere)
    }
}

/// Where a foot is looked for first, and how far away it may be.
struct Search {
    start: Start,
    radius: f64,
}

/// Mean curvature from first and second derivatives.
fn mean_curvature([du, dv]: [DVec3; 2], second: [DVec3; 3]) -> f64 {
    let cross = du.cross(dv);
    let [l, m, n] = second.map(|vector| vector.dot(cross) / cross.length());
    let (e, f, g) = (du.length_squared(), du.dot(dv), dv.length_squared());
    0.5 * (e * n - 2.0 * f * m + g * l) / cross.length_squared()
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
