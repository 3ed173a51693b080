//! The methods that fit the surface itself: least squares over samples of distance and slope.
//!
//! At each sample of the new surface P with foot S and normal n on the frozen one, the distance n.(P - S) and the slopes
//! n.Pu/|Pu| and n.Pv/|Pv| are to vanish, the slopes weighed by a part of the edge length. Distance alone would make
//! ripples (docs/optimisation.md). Feet are found anew after each solution (Gauss-Newton; for the distance it is the
//! tangent distance minimisation of Pottmann and Hofer 2003). While a sample slides, its foot does, and the normal
//! turns; that is in the equations of the slopes, or they would hold every vertex back.

use super::Stop;
use super::assembly::Assembly;
use super::freedom::Freedom;
use super::guard::{Outcome, Strikes};
use super::samples::{Sampled, Samples};
use crate::fault;
use crate::job::{Cancelled, Job};
use crate::mesh::{Mesh, VertexId};
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, MatMut, MatRef, Par};
use glam::DVec3;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

/// What a tangential shift costs beside the same distance of a sample.
const SLIDE_COST: f64 = 1e-4;
/// What a shift along the normal costs: nothing but definiteness where alternating modes have no limit.
const NORMAL_COST: f64 = 1e-6;
/// The costs of a vertex grow by this factor each time that a face at it became worse.
const STRIKE: f64 = 300.0;
/// A vertex at such a face slides by at most its shortest edge; its costs grow by this factor times the square of the
/// excess until it does not want more.
const RESTRAINT: f64 = 10.0;
/// Solutions with grown costs at most per step.
const RESTRAINTS: u32 = 4;
/// Solutions at most; more change nearly nothing.
const STEPS: u32 = 2;
/// The fit ends when a solution leaves more than this part of the error.
const GAIN: f64 = 0.98;

/// The problem.
pub(super) struct SurfaceFit<'a, 'b> {
    samples: &'b mut Samples<'a>,
    job: &'b Job,
    freedoms: &'b [(VertexId, Freedom)],
    /// Per vertex the factor of its costs.
    factors: Vec<f64>,
    /// Per vertex its shortest edge.
    shortest: Vec<f64>,
    /// Per sampled face the groups of unknowns of its control vertices that are free, in their order.
    groups: Vec<SmallVec<[u32; 32]>>,
    system: Assembly,
}

impl<'a, 'b> SurfaceFit<'a, 'b> {
    /// The samples are evaluated at the positions of the mesh.
    pub(super) fn new(
        mesh: &Mesh,
        freedoms: &'b [(VertexId, Freedom)],
        strikes: &Strikes,
        samples: &'b mut Samples<'a>,
        job: &'b Job,
    ) -> Self {
        let numbers: FxHashMap<VertexId, u32> =
            freedoms.iter().zip(0..).map(|(&(v, _), group)| (v, group)).collect();
        let of_face = |face: &Sampled| face.control.iter().filter_map(|v| numbers.get(v).copied()).collect();
        let groups: Vec<SmallVec<[u32; 32]>> = samples.faces.iter().map(of_face).collect();
        let sizes: Vec<usize> = freedoms.iter().map(|(_, freedom)| freedom.len()).collect();
        let system = Assembly::new(&sizes, groups.iter().map(SmallVec::as_slice));
        let factor = |v: &VertexId| STRIKE.powi(strikes.get(v).map_or(0, |&count| count as i32));
        let factors = freedoms.iter().map(|(v, _)| factor(v)).collect();
        let length =
            |v: VertexId| mesh.outgoing(v).map(|h| mesh.edge_length(h)).fold(f64::INFINITY, f64::min);
        let shortest = freedoms.iter().map(|&(v, _)| length(v)).collect();
        Self { samples, job, freedoms, factors, shortest, groups, system }
    }

    /// Moves the vertices and leaves the samples evaluated where they are then.
    pub(super) fn run(mut self, mesh: &mut Mesh) -> Result<Outcome, Cancelled> {
        let mut shifts = vec![0.0; self.system.unknowns()];
        let (mut steps, mut stop) = (0, Stop::StepLimit);
        let mut error = self.samples.error().all;
        while steps < STEPS {
            self.job.step("fit", f64::from(steps) / f64::from(STEPS))?;
            let share = self.assemble(&shifts)?;
            let Some(step) = self.restrained(&shifts, share) else { break };
            for (group, &(v, ref freedom)) in (0..).zip(self.freedoms) {
                let along = freedom.iter().zip(&step[self.system.of_group(group)]);
                let shift: DVec3 = along.map(|(&direction, &x)| direction * x).sum();
                if shift.is_finite() {
                    mesh.set_position(v, mesh.position(v) + shift);
                    fault::point("fit");
                }
            }
            shifts.iter_mut().zip(step).for_each(|(sum, x)| *sum += x);
            steps += 1;
            self.samples.evaluate(mesh, self.job)?;
            let now = self.samples.error().all;
            if now >= GAIN * error {
                stop = Stop::Converged;
                break;
            }
            error = now;
        }
        Ok(Outcome { steps, stop, residual: self.samples.residual(), held: 0, is_clear: false })
    }

    /// The step after `shifts` that lets no vertex of a face that became worse slide too far.
    fn restrained(&mut self, shifts: &[f64], share: f64) -> Option<Vec<f64>> {
        for repeat in 0.. {
            let step = self.system.solve()?;
            let mut is_restrained = false;
            for (group, (_, freedom)) in self.freedoms.iter().enumerate() {
                let unknowns = self.system.of_group(group as u32);
                let slide =
                    unknowns.clone().skip(1).map(|k| (shifts[k] + step[k]).powi(2)).sum::<f64>().sqrt();
                let excess = slide / self.shortest[group];
                if excess > 1.0 && self.factors[group] > 1.0 && repeat < RESTRAINTS {
                    is_restrained = true;
                    let more = self.factors[group] * (RESTRAINT * excess * excess - 1.0);
                    self.factors[group] += more;
                    self.add_costs(share * more, unknowns.take(freedom.len()), shifts);
                }
            }
            if !is_restrained {
                return Some(step);
            }
        }
        None
    }

    /// Adds to the costs of a vertex, whose unknowns these are.
    fn add_costs(&mut self, share: f64, unknowns: impl Iterator<Item = usize>, shifts: &[f64]) {
        for (k, unknown) in unknowns.enumerate() {
            let cost = share * if k == 0 { NORMAL_COST } else { SLIDE_COST };
            self.system.add_diagonal(unknown, cost);
            self.system.right[unknown] -= cost * shifts[unknown];
        }
    }

    /// The normal equations of a step after `shifts`; returns what the samples weigh per vertex in the mean.
    fn assemble(&mut self, shifts: &[f64]) -> Result<f64, Cancelled> {
        self.system.clear();
        let mut area = 0.0;
        let (mut columns, mut matrix, mut vector) = (Vec::new(), Vec::new(), Vec::new());
        // The equations of a face, each times the root of its weight, and their right-hand sides.
        let (mut equations, mut rights) = (Vec::new(), Vec::new());
        for (index, (face, groups)) in self.samples.faces.iter().zip(&self.groups).enumerate() {
            if index % 64 == 0 && self.job.is_cancelled() {
                return Err(Cancelled);
            }
            columns.clear();
            let mut left = groups.iter().peekable();
            for (i, &v) in face.control.iter().enumerate() {
                if let Some(&group) = left.next_if(|&&group| self.freedoms[group as usize].0 == v) {
                    columns.extend(self.freedoms[group as usize].1.iter().map(|&direction| (i, direction)));
                }
            }
            if columns.is_empty() {
                continue;
            }
            equations.clear();
            rights.clear();
            for (sample, (_, weights)) in self.samples.of_face(face).iter().zip(face.table.samples()) {
                let Some(foot) = sample.foot else { continue };
                area += sample.area;
                let root = sample.area.sqrt();
                let n = foot.normal * root;
                equations.extend(columns.iter().map(|&(i, direction)| weights[i][0] * n.dot(direction)));
                rights.push(foot.s * root);
                for k in 0..2 {
                    let (normal, turn) = (n * sample.factors[k], sample.turns[k] * root);
                    equations.extend(columns.iter().map(|&(i, direction): &(usize, DVec3)| {
                        (normal * weights[i][k + 1] - turn * weights[i][0]).dot(direction)
                    }));
                    rights.push(-n.dot(sample.slopes[k]));
                }
            }
            let (count, rows) = (columns.len(), rights.len());
            vector.clear();
            vector.resize(count, 0.0);
            for (row, right) in equations.chunks_exact(count).zip(&rights) {
                vector.iter_mut().zip(row).for_each(|(sum, x)| *sum += right * x);
            }
            matrix.resize(count * count, 0.0);
            let transposed = MatRef::from_column_major_slice(&equations, count, rows);
            // Row by row, the lower triangle is the upper one of the columns.
            triangular::matmul(
                MatMut::from_column_major_slice_mut(&mut matrix, count, count),
                BlockStructure::TriangularUpper,
                Accum::Replace,
                transposed,
                BlockStructure::Rectangular,
                transposed.transpose(),
                BlockStructure::Rectangular,
                1.0,
                Par::Seq,
            );
            self.system.add_block(index, groups, &matrix, &vector);
        }
        // As much cost per vertex as the samples weigh in the mean.
        let share = area / self.freedoms.len().max(1) as f64;
        for group in 0..self.freedoms.len() {
            self.add_costs(share * self.factors[group], self.system.of_group(group as u32), shifts);
        }
        Ok(share)
    }
}
