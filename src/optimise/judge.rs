//! The last word on a fit: no part of the surface may be bent more than without one.
//!
//! Beside extraordinary vertices and folds curvature changes between the samples of the fit, and folds have several feet to
//! choose from. So where the samples of the fit see less than a clear gain, the surface is measured as a report measures it. The
//! mesh before the fit counts, sharp curves included.

use super::Target;
use super::parts::parts;
use super::samples::{Error, Samples, is_large};
use crate::job::Job;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::surface::{FreezeError, LimitSurface, SAMPLES, Sampling, deviation_samples};
use glam::DVec3;

/// Parts of the way from the start to the fit that are tried in turn where the whole way is too far.
const WAYS: [f64; 3] = [0.5, 0.25, 0.125];

/// Samples per side beside faces with many corners, where feet are dear.
const FEW: usize = 2;

/// The surface before a fit.
pub(super) struct Judge<'a> {
    active: &'a [VertexId],
    start: Vec<DVec3>,
    target: &'a Target,
    /// Weight of the slopes as a length.
    slope: f64,
}

impl<'a> Judge<'a> {
    /// Of a fit that may move the vertices of `active`, which are ascending; `slope` is the weight of the slopes in edges.
    pub(super) fn new(mesh: &Mesh, active: &'a [VertexId], target: &'a Target, slope: f64) -> Self {
        let start = active.iter().map(|&v| mesh.position(v)).collect();
        // The reach is two edges.
        Self { active, start, target, slope: 0.5 * slope * target.reach }
    }

    /// Takes each part of the surface that is worse than it was part of the way back, at last all of it; returns the numbers
    /// in `active` of the vertices that are back at the start.
    pub(super) fn settle(&self, mesh: &mut Mesh, job: &Job) -> Result<Vec<usize>, FreezeError> {
        let end: Vec<DVec3> = self.active.iter().map(|&v| mesh.position(v)).collect();
        // For its faces and what moves them; nothing is evaluated.
        let samples = Samples::new(mesh, self.active, self.target, 1, 0.0, true, false);
        let faces: Vec<FaceId> = samples.faces.iter().map(|face| face.face).collect();
        self.place(mesh, &self.start);
        let before = self.errors(mesh, &faces, job)?;
        self.place(mesh, &end);
        let mut now = self.errors(mesh, &faces, job)?;
        let is_worse = |now: &[Error], part: &Vec<usize>| {
            let sum = |errors: &[Error]| part.iter().map(|&k| errors[k]).fold(Error::default(), Error::plus);
            sum(now).exceeds(sum(&before), Error::default())
        };
        let mut worse: Vec<Vec<usize>> = parts(self.active, &samples);
        worse.retain(|part| is_worse(&now, part));
        for way in WAYS {
            if worse.is_empty() {
                return Ok(Vec::new());
            }
            for number in self.vertices(&samples, &worse) {
                mesh.set_position(self.active[number], self.start[number].lerp(end[number], way));
            }
            now = self.errors(mesh, &faces, job)?;
            worse.retain(|part| is_worse(&now, part));
        }
        let back = self.vertices(&samples, &worse);
        for &number in &back {
            mesh.set_position(self.active[number], self.start[number]);
        }
        Ok(back)
    }

    /// How far the surface of each of `faces`, which are ascending, is from the frozen one.
    fn errors(&self, mesh: &Mesh, faces: &[FaceId], job: &Job) -> Result<Vec<Error>, FreezeError> {
        let surface = LimitSurface::around_with(mesh, faces, job)?;
        let mut errors = vec![Error::default(); faces.len()];
        let target = &self.target.surface;
        let is_dear = mesh.grow_faces(faces).into_iter().any(|face| is_large(mesh, face));
        let per_side = if is_dear { FEW } else { SAMPLES };
        for sample in deviation_samples(&surface, |_| true, target, Sampling { per_side, threads: 1 }, job)? {
            if let Ok(number) = faces.binary_search(&sample.face) {
                let distance = sample.signed.powi(2);
                let slope = self.slope * sample.turn.to_radians().sin();
                let bend = sample.bend.unwrap_or_default().powi(2);
                let error = Error { distance, all: distance + slope.powi(2), bend };
                errors[number] = errors[number].plus(error.map(|square| square * sample.area));
            }
        }
        Ok(errors)
    }

    fn place(&self, mesh: &mut Mesh, positions: &[DVec3]) {
        self.active.iter().zip(positions).for_each(|(&v, &position)| mesh.set_position(v, position));
    }

    /// The active vertices of some parts, as numbers.
    fn vertices(&self, samples: &Samples, parts: &[Vec<usize>]) -> Vec<usize> {
        let control = parts.iter().flatten().flat_map(|&face| samples.faces[face].control.iter());
        let mut numbers: Vec<usize> = control.filter_map(|v| self.active.binary_search(v).ok()).collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }
}
