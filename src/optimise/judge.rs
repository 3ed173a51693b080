//! The last word on a fit: no part of the surface may be bent more than without one.
//!
//! Beside extraordinary vertices and folds curvature changes between the samples of the fit, and folds have several feet to
//! choose from. There the surface is measured in the way of reports; where that does not show a sure gain, the whole part
//! is. The mesh before the fit counts, sharp curves included.

use super::Target;
use super::parts::parts;
use super::samples::{Error, Samples, Snapshot, is_large};
use crate::job::Job;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::surface::{FreezeError, LimitSurface, SAMPLES, Sampling, deviation_samples};
use glam::DVec3;

/// A gain is sure where the root mean squares fall to this part: where curvature is smooth, the samples of a fit and those
/// of a report agree within a few per cent.
const SURE: f64 = 0.9;

/// Parts of the way from the start to the fit that are tried in turn where the whole way is too far.
const WAYS: [f64; 3] = [0.5, 0.25, 0.125];

/// Places per side where faces with many corners or vertices with many edges are near, and feet dear.
const FEW: usize = 2;

/// The surface before a fit.
pub(super) struct Judge<'a> {
    active: &'a [VertexId],
    start: Vec<DVec3>,
    /// What the samples of the fit saw there.
    seen: Snapshot,
    target: &'a Target,
    /// Weight of the slopes as a length.
    slope: f64,
    /// Places per side of a face at which the surface is measured.
    per_side: usize,
}

impl<'a> Judge<'a> {
    /// Of a fit that may move the vertices of `active`, which are ascending; its `samples` are evaluated at the positions of
    /// the mesh. `slope` is the weight of the slopes in edges.
    pub(super) fn new(
        mesh: &Mesh,
        active: &'a [VertexId],
        target: &'a Target,
        samples: &Samples,
        slope: f64,
    ) -> Self {
        let start = active.iter().map(|&v| mesh.position(v)).collect();
        let faces: Vec<FaceId> = samples.faces.iter().map(|face| face.face).collect();
        let is_dear = mesh.grow_faces(&faces).into_iter().any(|face| is_large(mesh, face));
        // The reach is two edges.
        let slope = 0.5 * slope * target.reach;
        Self {
            active,
            start,
            seen: samples.snapshot(),
            target,
            slope,
            per_side: if is_dear { FEW } else { SAMPLES },
        }
    }

    /// Takes each part of the surface that is worse than it was part of the way back, at last all of it; returns the
    /// vertices that are back at the start, ascending. The samples are evaluated at the positions of the mesh.
    pub(super) fn settle(
        &self,
        mesh: &mut Mesh,
        samples: &Samples,
        job: &Job,
    ) -> Result<Vec<VertexId>, FreezeError> {
        let end: Vec<DVec3> = self.active.iter().map(|&v| mesh.position(v)).collect();
        let mut parts = parts(self.active, samples);
        let is_plain: Vec<bool> = (0..samples.faces.len()).map(|k| samples.is_plain(&self.seen, k)).collect();
        let (plain, rough): (Vec<usize>, Vec<usize>) = parts.iter().flatten().partition(|&&k| is_plain[k]);
        let mut before = self.errors_at(&self.start, mesh, samples, &rough, job)?;
        let mut now = self.errors_at(&end, mesh, samples, &rough, job)?;
        // The samples of the fit will do for the plain faces of parts that surely became better.
        let seen_now = samples.errors();
        for &k in &plain {
            (before[k], now[k]) = (self.seen.errors[k], seen_now[k]);
        }
        parts.retain(|part| {
            let sure = sum(&before, part).map(|square| SURE * SURE * square);
            sum(&now, part).exceeds(sure, samples.rounding(part))
        });
        let unsure: Vec<usize> = parts.iter().flatten().copied().filter(|k| is_plain[*k]).collect();
        let measured_before = self.errors_at(&self.start, mesh, samples, &unsure, job)?;
        let measured_now = self.errors_at(&end, mesh, samples, &unsure, job)?;
        for k in unsure {
            (before[k], now[k]) = (measured_before[k], measured_now[k]);
        }
        let is_worse =
            |now: &[Error], part: &Vec<usize>| sum(now, part).exceeds(sum(&before, part), Error::default());
        parts.retain(|part| is_worse(&now, part));
        for way in WAYS {
            if parts.is_empty() {
                return Ok(Vec::new());
            }
            for number in self.vertices(samples, &parts) {
                mesh.set_position(self.active[number], self.start[number].lerp(end[number], way));
            }
            let faces: Vec<usize> = parts.iter().flatten().copied().collect();
            let now = self.errors(mesh, samples, &faces, job)?;
            parts.retain(|part| is_worse(&now, part));
        }
        let back = self.vertices(samples, &parts);
        for &number in &back {
            mesh.set_position(self.active[number], self.start[number]);
        }
        Ok(back.into_iter().map(|number| self.active[number]).collect())
    }

    /// [`errors`](Self::errors) with the active vertices at `positions`, where they stay.
    fn errors_at(
        &self,
        positions: &[DVec3],
        mesh: &mut Mesh,
        samples: &Samples,
        numbers: &[usize],
        job: &Job,
    ) -> Result<Vec<Error>, FreezeError> {
        self.active.iter().zip(positions).for_each(|(&v, &position)| mesh.set_position(v, position));
        self.errors(mesh, samples, numbers, job)
    }

    /// How far the surface of the sampled faces with these numbers is from the frozen one; nothing for the others.
    fn errors(
        &self,
        mesh: &Mesh,
        samples: &Samples,
        numbers: &[usize],
        job: &Job,
    ) -> Result<Vec<Error>, FreezeError> {
        let mut errors = vec![Error::default(); samples.faces.len()];
        if numbers.is_empty() {
            return Ok(errors);
        }
        let mut numbers: Vec<(FaceId, usize)> = numbers.iter().map(|&k| (samples.faces[k].face, k)).collect();
        numbers.sort_unstable();
        let faces: Vec<FaceId> = numbers.iter().map(|entry| entry.0).collect();
        let surface = LimitSurface::around_during(mesh, &faces, job, "fit", 1.0)?;
        let target = &self.target.surface;
        let sampling = Sampling { per_side: self.per_side, threads: 1 };
        for sample in deviation_samples(&surface, |_| true, target, sampling, job)? {
            let number = numbers.binary_search_by_key(&sample.face, |entry| entry.0);
            if let Ok(number) = number.map(|index| numbers[index].1) {
                let distance = sample.signed.powi(2);
                let slope = self.slope * sample.turn.to_radians().sin();
                let bend = sample.bend.unwrap_or_default().powi(2);
                let error = Error { distance, all: distance + slope.powi(2), bend };
                errors[number] = errors[number].plus(error.map(|square| square * sample.area));
            }
        }
        Ok(errors)
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

/// The errors of a part of the surface.
fn sum(errors: &[Error], part: &[usize]) -> Error {
    part.iter().map(|&k| errors[k]).fold(Error::default(), Error::plus)
}
