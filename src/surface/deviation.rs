//! How far one limit surface is from another.
//!
//! Every face is sampled at the centres of k x k cells; the distance is that to the closest point of the other surface
//! whose normal is compatible (angle below 90 degrees), signed by that point's normal. Normal and mean curvature are
//! compared with those at that point. Means weigh samples by area.

use super::{Foot, FreezeError, LimitSurface};
use crate::job::{Cancelled, Job};
use crate::memory::{self, OutOfMemory};
use crate::mesh::{FaceId, Mesh};
use crate::subdivision::SurfacePoint;
use crate::threads::in_ranges;
use glam::DVec3;
use serde::Serialize;

/// The usual number of samples per side of a face.
pub const SAMPLES: usize = 8;
/// Samples per side of the quadrants of faces with more than [`MANY`] corners, at most: such a face has enough quadrants.
const FEW: usize = 2;
const MANY: usize = 16;
/// Distances below this share of the size are looked for along the normal first.
const NEAR: f64 = 0.1;
/// Feet that are closer than this share of the width of a cell are followed from one sample to the next: no other part of
/// the surface is likely to be as close.
const CLOSE: f64 = 0.25;
/// Least cosine between the normals at a foot that is followed.
const ALONG: f64 = 0.9;

/// The distance at one point of the surface that is measured.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct DeviationSample {
    /// Face of the sample.
    pub face: FaceId,
    /// Patch of the face.
    pub corner: usize,
    /// Parameter in [0, 1].
    pub u: f64,
    /// Parameter in [0, 1].
    pub v: f64,
    /// The sample.
    pub position: DVec3,
    /// Area of the cell that the sample stands for.
    pub area: f64,
    /// Distance to the other surface, positive on the side of its normals.
    pub signed: f64,
    /// Angle between the normals, in degrees; 0 where one surface has none.
    pub turn: f64,
    /// Difference of the mean curvatures, here minus there, per model unit; `None` where one has none
    /// ([`SurfacePoint::curvature`](crate::subdivision::SurfacePoint::curvature)).
    pub bend: Option<f64>,
}

/// A summary of samples. Distances in model units, angles in degrees, curvatures per model unit.
#[derive(Clone, Copy, PartialEq, Default, Debug, Serialize)]
pub struct Deviation {
    /// Largest distance.
    pub max: f64,
    /// Root of the mean square distance, weighed by area.
    pub rms: f64,
    /// Distance that 95 % of the area does not exceed.
    pub p95: f64,
    /// Largest angle between the normals.
    pub normal: f64,
    /// Largest change of mean curvature. Beside an extraordinary vertex curvature is not bounded, so this figure grows
    /// with the number of samples there; the next one hardly does.
    pub curvature_max: f64,
    /// Root of the mean square change of mean curvature, weighed by area.
    pub curvature_rms: f64,
    /// Number of samples.
    pub samples: usize,
    /// Where the largest distance is; `None` without samples.
    #[serde(skip)]
    pub at: Option<DeviationSample>,
}

impl Deviation {
    /// The summary of `samples`.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    pub fn of(samples: &[DeviationSample]) -> Result<Self, OutOfMemory> {
        let parts = samples.iter().enumerate().map(|(i, s)| (s.signed.abs(), s.area, i));
        let mut sorted = memory::collected(samples.len(), parts)?;
        // Equal distances in the order of the samples, for which a stable sort would need memory.
        sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
        let area: f64 = sorted.iter().map(|entry| entry.1).sum();
        let square: f64 = sorted.iter().map(|entry| entry.1 * entry.0 * entry.0).sum();
        let mut covered = 0.0;
        let p95 = sorted.iter().find(|entry| {
            covered += entry.1;
            covered >= 0.95 * area
        });
        let at = samples.iter().max_by(|a, b| a.signed.abs().total_cmp(&b.signed.abs()));
        let bends = || samples.iter().filter_map(|s| Some((s.bend?.abs(), s.area)));
        let (bend_square, bend_area) =
            bends().fold((0.0, 0.0), |(square, sum), (bend, area)| (square + area * bend * bend, sum + area));
        let root_mean = |square: f64, area: f64| if area > 0.0 { (square / area).sqrt() } else { 0.0 };
        Ok(Self {
            max: at.map_or(0.0, |sample| sample.signed.abs()),
            rms: root_mean(square, area),
            p95: p95.map_or(0.0, |entry| entry.0),
            normal: samples.iter().fold(0.0, |most, sample| most.max(sample.turn)),
            curvature_max: bends().fold(0.0, |most, (bend, _)| most.max(bend)),
            curvature_rms: root_mean(bend_square, bend_area),
            samples: samples.len(),
            at: at.copied(),
        })
    }
}

/// How surfaces are compared.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sampling {
    /// Samples per side of a face: `per_side` x `per_side` to a quad and half as many each way to the quadrants of
    /// another face, at most 2 where it has more than 16 corners; 0 counts as 1.
    pub per_side: usize,
    /// Threads to use; 0 for as many as the machine has. The result does not depend on it.
    pub threads: usize,
}

impl Default for Sampling {
    fn default() -> Self {
        Self { per_side: SAMPLES, threads: 1 }
    }
}

/// Samples `from` in the faces that `choose` accepts and measures each sample to `to`. Samples for which `to` has no
/// answer (it is empty) are left out.
///
/// # Errors
/// [`FreezeError`].
pub fn deviation_samples(
    from: &LimitSurface,
    choose: impl Fn(FaceId) -> bool,
    to: &LimitSurface,
    sampling: Sampling,
    job: &Job,
) -> Result<Vec<DeviationSample>, FreezeError> {
    to.prepare()?;
    let faces: Vec<FaceId> = from.faces().filter(|&face| choose(face)).collect();
    let work = |range: std::ops::Range<usize>| {
        sample_faces(from, faces.get(range).unwrap_or_default(), to, sampling.per_side, job)
    };
    let mut samples = Vec::new();
    for part in in_ranges(faces.len(), sampling.threads, 1, work) {
        let mut part = part?;
        if samples.is_empty() {
            samples = part;
            continue;
        }
        memory::reserve(&mut samples, part.len())?;
        samples.append(&mut part);
    }
    Ok(samples)
}

/// The samples of `faces`, in order.
fn sample_faces(
    from: &LimitSurface,
    faces: &[FaceId],
    to: &LimitSurface,
    per_side: usize,
    job: &Job,
) -> Result<Vec<DeviationSample>, FreezeError> {
    let mut samples = Vec::new();
    for &face in faces {
        if job.is_cancelled() {
            return Err(Cancelled.into());
        }
        let patches = from.patch_count(face);
        let cells = match patches {
            1 => per_side,
            ..=MANY => per_side.div_ceil(2),
            _ => per_side.div_ceil(2).min(FEW),
        };
        let cells = cells.max(1);
        let width = 1.0 / cells as f64;
        memory::reserve(&mut samples, patches * cells * cells)?;
        for corner in 0..patches {
            // The foot of the sample before, and that of the first sample of the row.
            let (mut last, mut first) = (None, None);
            for cell in 0..cells * cells {
                let (u, v) = (((cell % cells) as f64 + 0.5) * width, ((cell / cells) as f64 + 0.5) * width);
                let Some(point) = from.evaluate(face, corner, u, v) else { continue };
                let area = point.du.cross(point.dv).length() * width * width;
                let start = if cell % cells == 0 { first } else { last };
                let Some(foot) = foot_on(to, start, &point, CLOSE * area.sqrt()) else { continue };
                last = Some(foot);
                if cell % cells == 0 {
                    first = last;
                }
                let there =
                    to.evaluate(foot.face, foot.corner, foot.u, foot.v).and_then(|there| there.curvature());
                let bend = point.curvature().zip(there).map(|(here, there)| here.mean - there.mean);
                samples.push(DeviationSample {
                    face,
                    corner,
                    u,
                    v,
                    position: point.position,
                    area,
                    signed: foot.distance.copysign((point.position - foot.position).dot(foot.normal)),
                    turn: angle(point.normal, foot.normal),
                    bend,
                });
            }
        }
    }
    Ok(samples)
}

/// The angle between two unit normals in degrees, 0 when one is zero.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

/// [`LimitSurface::compatible_foot`] of a point of another surface, fast where the surfaces are close: the foot near `start`,
/// where it is closer than `close` and they lie along each other; else that or the foot near the hit of the normal, where it
/// is no further away than the hit. Without a hit the whole surface is searched.
fn foot_on(to: &LimitSurface, start: Option<Foot>, point: &SurfacePoint, close: f64) -> Option<Foot> {
    let SurfacePoint { position, normal, .. } = *point;
    let near = |face, corner, u, v| {
        to.foot_near(face, corner, u, v, position).filter(|foot| foot.normal.dot(normal) > 0.0)
    };
    let followed = start.and_then(|start| near(start.face, start.corner, start.u, start.v));
    if let Some(foot) = followed.filter(|foot| foot.distance <= close && foot.normal.dot(normal) >= ALONG) {
        return Some(foot);
    }
    let hit = to.nearest_line_hit(position, normal, NEAR * to.size(), normal);
    let Some(hit) = hit else {
        let bound = followed.map_or(f64::INFINITY, |foot| foot.distance);
        return to.compatible_foot_within(position, normal, bound);
    };
    let bound = hit.s.abs();
    near(hit.face, hit.corner, hit.u, hit.v)
        .into_iter()
        .chain(followed)
        .filter(|foot| foot.distance <= bound)
        .min_by(|a, b| a.distance.total_cmp(&b.distance))
        .or_else(|| to.compatible_foot_within(position, normal, bound))
}

/// Two limit surfaces compared both ways.
#[derive(Clone, Copy, PartialEq, Default, Debug, Serialize)]
pub struct Comparison {
    /// All samples together.
    pub both: Deviation,
    /// Samples of the first, measured to the second.
    pub first_to_second: Deviation,
    /// Samples of the second, measured to the first.
    pub second_to_first: Deviation,
}

/// Compares the limit surfaces of two control meshes both ways.
///
/// # Errors
/// [`FreezeError`].
pub fn compare(
    first: &Mesh,
    second: &Mesh,
    sampling: Sampling,
    job: &Job,
) -> Result<Comparison, FreezeError> {
    const STAGE: &str = "deviation";
    job.step(STAGE, 0.0)?;
    let whole = |mesh: &Mesh| {
        let faces = memory::collected(mesh.face_bound(), mesh.faces())?;
        LimitSurface::prepared(mesh, &faces)
    };
    let (first, second) = (whole(first)?, whole(second)?);
    job.step(STAGE, 0.1)?;
    let mut samples = deviation_samples(&first, |_| true, &second, sampling, job)?;
    let first_to_second = Deviation::of(&samples)?;
    job.step(STAGE, 0.55)?;
    let back = deviation_samples(&second, |_| true, &first, sampling, job)?;
    let second_to_first = Deviation::of(&back)?;
    memory::reserve(&mut samples, back.len())?;
    samples.extend_from_slice(&back);
    drop(back);
    let both = Deviation::of(&samples)?;
    Ok(Comparison { both, first_to_second, second_to_first })
}
