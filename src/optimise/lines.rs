//! The methods that put the limit points of control vertices on the frozen surface: the paper's loop and its solution.

use super::guard::Outcome;
use super::{LOOP_STEPS, LeastSquares, Method, SOLVE_STEPS, Stop, TOLERANCE, Target};
use crate::fault;
use crate::job::{Cancelled, Job};
use crate::mesh::{Mesh, VertexId};
use crate::subdivision::{LimitMask, limit_mask, vertex_normal};
use crate::surface::{ClosestOptions, Facing, Foot, Hit};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Hits nearer than this share of the reach are taken as they are.
const FAR: f64 = 0.05;
/// A hit this many times as far away as the closest point is not taken.
const GRAZING: f64 = 2.0;

/// Every so many steps the largest distance must have fallen to this part of what it was, or the rest is left.
const LOOK_BACK: u32 = 10;
const GAIN: f64 = 0.9;

/// A vertex whose line met nothing so often stays where it is.
const MISSES: u32 = 5;

/// Moves `vertices` by [`Method::Loop`] or [`Method::Solve`]; those that find no surface go to `missed`.
pub(super) fn run(
    mesh: &mut Mesh,
    vertices: &[VertexId],
    target: &Target,
    method: Method,
    missed: &mut Vec<u32>,
    job: &Job,
) -> Result<Outcome, Cancelled> {
    let mut lines = Lines::aim(mesh, vertices, target, missed);
    let system = (method == Method::Solve).then(|| lines.system()).flatten();
    let limit = if method == Method::Loop { LOOP_STEPS } else { SOLVE_STEPS };
    let mut outcome = Outcome { steps: 0, stop: Stop::StepLimit, residual: 0.0, held: 0, is_clear: false };
    let mut before = f64::INFINITY;
    for step in 0..=limit {
        job.step("fit", f64::from(step) / f64::from(limit + 1))?;
        (outcome.steps, outcome.residual) = (step, lines.measure(mesh, target));
        if outcome.residual <= TOLERANCE * target.reach {
            outcome.stop = Stop::Converged;
            break;
        }
        if step % LOOK_BACK == 0 {
            if outcome.residual > GAIN * before {
                break;
            }
            before = outcome.residual;
        }
        if step < limit {
            lines.advance(mesh, system.as_ref());
        }
    }
    missed.extend(lines.lost());
    Ok(outcome)
}

/// The lines along which the inner active vertices move.
struct Lines {
    vertices: Vec<VertexId>,
    masks: Vec<LimitMask>,
    /// Unit normals of the frozen surface at the first feet.
    normals: Vec<DVec3>,
    /// Signed distance along the normal from the limit point to the frozen surface.
    gaps: Vec<f64>,
    /// Where the lines met the frozen surface last.
    hits: Vec<Option<Hit>>,
    /// True where neither line nor closest point found the frozen surface at the last measurement.
    nothing: Vec<bool>,
    /// How often the line met nothing.
    misses: Vec<u32>,
}

impl Lines {
    /// Vertices whose limit points lost the frozen surface.
    fn lost(&self) -> impl Iterator<Item = u32> {
        self.vertices.iter().zip(&self.nothing).filter(|(_, nothing)| **nothing).map(|(v, _)| v.0)
    }

    /// Steps 1 to 4 of the paper: foot of each limit point along the control normal, and the normal there.
    fn aim(mesh: &Mesh, vertices: &[VertexId], target: &Target, missed: &mut Vec<u32>) -> Self {
        let mut lines = Self {
            vertices: Vec::new(),
            masks: Vec::new(),
            normals: Vec::new(),
            gaps: Vec::new(),
            hits: Vec::new(),
            nothing: Vec::new(),
            misses: Vec::new(),
        };
        for &v in vertices {
            let mask = limit_mask(mesh, v);
            let point = apply(mesh, &mask);
            let Some(normal) = foot_normal(target, point, vertex_normal(mesh, v)) else {
                missed.push(v.0);
                continue;
            };
            lines.vertices.push(v);
            lines.masks.push(mask);
            lines.normals.push(normal);
        }
        lines.gaps = vec![0.0; lines.vertices.len()];
        lines.hits = vec![None; lines.vertices.len()];
        lines.nothing = vec![false; lines.vertices.len()];
        lines.misses = vec![0; lines.vertices.len()];
        lines
    }

    /// The system of [`Method::Solve`]: shifts along the normals against limit shifts along the normals.
    fn system(&self) -> Option<LeastSquares> {
        let unknowns: FxHashMap<VertexId, u32> =
            self.vertices.iter().enumerate().map(|(i, &v)| (v, i as u32)).collect();
        let rows = self.masks.iter().zip(&self.normals).map(|(mask, normal)| {
            mask.iter()
                .filter_map(|(v, weight)| {
                    let &j = unknowns.get(v)?;
                    Some((j, weight * self.normals[j as usize].dot(*normal)))
                })
                .collect()
        });
        LeastSquares::new(rows.collect(), self.vertices.len())
    }

    /// Step 7: how far the limit points are from the frozen surface; returns the largest distance.
    fn measure(&mut self, mesh: &Mesh, target: &Target) -> f64 {
        let mut largest = 0.0_f64;
        for (i, (mask, normal)) in self.masks.iter().zip(&self.normals).enumerate() {
            let point = apply(mesh, mask);
            let near = self.hits[i].and_then(|hit| target.surface.line_hit_near(&hit, point, *normal));
            self.hits[i] = near
                .filter(|hit| hit.s.abs() <= target.reach && hit.normal.dot(*normal) > 0.0)
                .or_else(|| target.surface.nearest_line_hit(point, *normal, target.reach, *normal));
            if self.hits[i].is_some_and(|hit| is_grazing(target, point, &hit)) {
                self.hits[i] = None;
            }
            let gap = self.hits[i].map(|hit| hit.s).or_else(|| {
                self.misses[i] += 1;
                (self.misses[i] <= MISSES)
                    .then(|| closest(target, point, Some(*normal), target.reach))?
                    .map(|foot| (foot.position - point).dot(*normal))
            });
            self.nothing[i] = gap.is_none();
            self.gaps[i] = gap.unwrap_or(0.0);
            largest = largest.max(self.gaps[i].abs());
        }
        largest
    }

    /// Step 8, or the solved system in its place.
    fn advance(&self, mesh: &mut Mesh, system: Option<&LeastSquares>) {
        let shifts = match system {
            Some(system) => system.solve(self.gaps.iter().copied()),
            None => self.gaps.clone(),
        };
        for ((&v, normal), shift) in self.vertices.iter().zip(&self.normals).zip(shifts) {
            if shift.is_finite() {
                mesh.set_position(v, mesh.position(v) + *normal * shift);
                fault::point("fit");
            }
        }
    }
}

/// The limit point that `mask` describes.
pub(super) fn apply(mesh: &Mesh, mask: &LimitMask) -> DVec3 {
    mask.iter().map(|(v, weight)| mesh.position(*v) * *weight).sum()
}

/// The normal of the frozen surface where the line through `point` along `direction` meets it first, or at its
/// closest point when the line misses.
pub(super) fn foot_normal(target: &Target, point: DVec3, direction: Option<DVec3>) -> Option<DVec3> {
    direction
        .and_then(|n| target.surface.nearest_line_hit(point, n, target.reach, n))
        .filter(|hit| !is_grazing(target, point, hit))
        .map(|hit| hit.normal)
        .or_else(|| closest(target, point, direction, target.reach).map(|foot| foot.normal))
        .filter(|normal| *normal != DVec3::ZERO)
}

/// True when the surface is much nearer to `point` than the hit of its line: beside sharp folds the control normal may
/// run along the surface, and the hit is on a part that the point has nothing to do with.
fn is_grazing(target: &Target, point: DVec3, hit: &Hit) -> bool {
    hit.s.abs() > FAR * target.reach
        && closest(target, point, Some(hit.normal), hit.s.abs() / GRAZING).is_some()
}

/// The closest point nearer than `radius` whose normal is on the side of `direction`.
fn closest(target: &Target, point: DVec3, direction: Option<DVec3>, radius: f64) -> Option<Foot> {
    let facing = direction.map(|normal| Facing { normal, min_cosine: 0.0 });
    target.surface.closest(point, &ClosestOptions { radius: radius.min(target.reach), facing })
}
