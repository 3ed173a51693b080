//! The last word on a fit: no part of the surface may be bent more than without one.
//!
//! Beside extraordinary vertices and folds curvature changes between the samples of the fit, so where these see less than
//! a clear gain it is judged at others, as many as a report takes. The mesh before the fit counts, sharp curves included.

use super::Target;
use super::parts::parts;
use super::samples::Samples;
use crate::job::{Cancelled, Job};
use crate::mesh::{Mesh, VertexId};
use crate::subdivision::basis::Rule;
use crate::surface::SAMPLES;
use glam::DVec3;

/// Parts of the way from the start to the fit that are tried in turn where the whole way is too far.
const WAYS: [f64; 3] = [0.5, 0.25, 0.125];

/// The surface before a fit.
pub(super) struct Judge<'a> {
    active: &'a [VertexId],
    start: Vec<DVec3>,
    target: &'a Target,
    slope: f64,
}

impl<'a> Judge<'a> {
    /// Of a fit that may move the vertices of `active`, which are ascending.
    pub(super) fn new(mesh: &Mesh, active: &'a [VertexId], target: &'a Target, slope: f64) -> Self {
        Self { active, start: active.iter().map(|&v| mesh.position(v)).collect(), target, slope }
    }

    /// Takes each part of the surface that is worse than it was part of the way back, at last all of it; returns the numbers
    /// in `active` of the vertices that are back at the start.
    pub(super) fn settle(&self, mesh: &mut Mesh, job: &Job) -> Result<Vec<usize>, Cancelled> {
        let end: Vec<DVec3> = self.active.iter().map(|&v| mesh.position(v)).collect();
        let mut samples =
            Samples::new(mesh, self.active, self.target, Rule::Cells(SAMPLES), self.slope, true, true);
        self.place(mesh, &self.start);
        samples.evaluate(mesh, job)?;
        let before = samples.snapshot();
        self.place(mesh, &end);
        samples.evaluate(mesh, job)?;
        let mut worse: Vec<Vec<usize>> = parts(self.active, &samples);
        worse.retain(|part| samples.is_worse(&before, part));
        for way in WAYS {
            if worse.is_empty() {
                return Ok(Vec::new());
            }
            for number in self.vertices(&samples, &worse) {
                mesh.set_position(self.active[number], self.start[number].lerp(end[number], way));
            }
            samples.evaluate(mesh, job)?;
            worse.retain(|part| samples.is_worse(&before, part));
        }
        let back = self.vertices(&samples, &worse);
        for &number in &back {
            mesh.set_position(self.active[number], self.start[number]);
        }
        Ok(back)
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
