//! Fits a changed control mesh to the limit surface that was frozen before the change (paper, section 5.3).
//!
//! For each active vertex the limit point is to lie on the frozen surface. The vertex moves along the frozen
//! surface's normal `m` at the foot of its first limit point. [`Method::Loop`] repeats the paper's update,
//! [`Method::Solve`] solves the sparse system whose solution that update converges to. Boundary vertices stay on the
//! frozen boundary curve.

mod boundary;
mod linear;

pub use boundary::BoundaryCurves;
pub(crate) use boundary::evaluate as evaluate_b_spline;
pub(crate) use linear::{LeastSquares, Row};

use crate::fault;
use crate::job::{Cancelled, Job};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::subdivision::{LimitMask, limit_mask, vertex_normal};
use crate::surface::{ClosestOptions, Facing, Foot, Hit, LimitSurface};
use glam::DVec3;
use rustc_hash::FxHashMap;
use serde::Serialize;

/// How to fit.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Leave the vertices where the rules put them.
    None,
    /// The paper's iteration.
    Loop,
    /// The sparse system the iteration converges to (default).
    Solve,
}

impl Method {
    /// All methods, with the names that the program and the C ABI use.
    pub const ALL: [(&'static str, Self); 3] =
        [("none", Self::None), ("loop", Self::Loop), ("solve", Self::Solve)];

    /// The method called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|entry| entry.0 == name).map(|entry| entry.1)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Loop => "loop",
            Self::Solve => "solve",
        }
    }
}

/// Why the fit stopped.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stop {
    /// Nothing was asked for, or nothing was active.
    Nothing,
    /// Every limit point is closer to the frozen surface than the tolerance.
    Converged,
    /// The allowed number of steps was taken.
    StepLimit,
}

/// What the fit did.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct FitReport {
    /// The method.
    pub method: Method,
    /// Vertices that were free to move.
    pub active: usize,
    /// Steps taken.
    pub steps: u32,
    /// Why it stopped.
    pub stop: Stop,
    /// Largest distance of a limit point to the frozen surface along its line, after the last step (model units).
    pub residual: f64,
    /// Active vertices whose line and closest point found no frozen surface; they were not fitted.
    pub missed: Vec<u32>,
}

/// Steps of [`Method::Loop`] at most. The paper needs fewer than 20; the slowest mode of a flat grid has ratio 8/9.
const LOOP_STEPS: u32 = 100;
/// Outer steps of [`Method::Solve`] (docs/linear-features.md, section 3: the residual is at rounding level after two).
const SOLVE_STEPS: u32 = 3;
/// Tolerance on the limit points, relative to `reach`.
const TOLERANCE: f64 = 1e-7;

/// Hits nearer than this share of the reach are taken as they are.
const FAR: f64 = 0.05;
/// A hit this many times as far away as the closest point is not taken.
const GRAZING: f64 = 2.0;

/// The frozen surface that a fit aims at.
#[derive(Clone, Debug)]
pub struct Target {
    /// The surface.
    pub surface: LimitSurface,
    /// Its boundary curves.
    pub boundary: BoundaryCurves,
    /// How far a limit point may be from it, in model units: twice the mean edge (a foot further away belongs to another part of the shape).
    pub reach: f64,
}

impl Target {
    /// Freezes the limit surface of `faces`.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn freeze(mesh: &Mesh, faces: &[FaceId], job: &Job) -> Result<Self, Cancelled> {
        let (mut sum, mut count) = (0.0, 0u32);
        for h in faces.iter().flat_map(|&f| mesh.face_half_edges(f)) {
            sum += mesh.edge_length(h);
            count += 1;
        }
        Ok(Self {
            surface: LimitSurface::around_with(mesh, faces, job)?,
            boundary: BoundaryCurves::around(mesh, faces),
            reach: 2.0 * sum / f64::from(count.max(1)),
        })
    }
}

/// Vertices of `changed` faces and of the faces around them, ascending: what a fit may move.
pub fn active_set(mesh: &Mesh, changed: &[FaceId]) -> Vec<VertexId> {
    let faces = mesh.grow_faces(changed);
    let mut vertices: Vec<VertexId> = faces.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// Moves the `active` vertices of `mesh` so that their limit points lie on the frozen surface.
///
/// # Errors
/// [`Cancelled`]; the mesh may have moved by then, so run this inside a transaction.
pub fn fit(
    mesh: &mut Mesh,
    active: &[VertexId],
    target: &Target,
    method: Method,
    job: &Job,
) -> Result<FitReport, Cancelled> {
    let mut report =
        FitReport { method, active: 0, steps: 0, stop: Stop::Nothing, residual: 0.0, missed: Vec::new() };
    if method == Method::None || active.is_empty() {
        return Ok(report);
    }
    report.active = active.len();
    let (rim, inner): (Vec<VertexId>, Vec<VertexId>) =
        active.iter().partition(|&&v| mesh.is_boundary_vertex(v));
    // The limit of a boundary vertex depends on boundary vertices only, so the rim comes first.
    let (rim_steps, rim_gap) = fit_rim(mesh, &rim, target, method, job)?;
    let mut lines = Lines::aim(mesh, &inner, target, &mut report.missed);
    let system = (method == Method::Solve).then(|| lines.system()).flatten();
    let limit = if method == Method::Loop { LOOP_STEPS } else { SOLVE_STEPS };
    let tolerance = TOLERANCE * target.reach;
    report.stop = Stop::StepLimit;
    for step in 0..=limit {
        job.step("fit", f64::from(step) / f64::from(limit + 1))?;
        report.residual = lines.measure(mesh, target).max(rim_gap);
        report.steps = step.max(rim_steps);
        if report.residual <= tolerance {
            report.stop = Stop::Converged;
            break;
        }
        if step < limit {
            lines.advance(mesh, system.as_ref());
        }
    }
    report.missed.extend(lines.lost());
    report.missed.sort_unstable();
    Ok(report)
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
                closest(target, point, Some(*normal)).map(|foot| (foot.position - point).dot(*normal))
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
fn apply(mesh: &Mesh, mask: &LimitMask) -> DVec3 {
    mask.iter().map(|(v, weight)| mesh.position(*v) * *weight).sum()
}

/// The normal of the frozen surface where the line through `point` along `direction` meets it first, or at its
/// closest point when the line misses.
fn foot_normal(target: &Target, point: DVec3, direction: Option<DVec3>) -> Option<DVec3> {
    direction
        .and_then(|n| target.surface.nearest_line_hit(point, n, target.reach, n))
        .filter(|hit| !is_grazing(target, point, hit))
        .map(|hit| hit.normal)
        .or_else(|| closest(target, point, direction).map(|foot| foot.normal))
        .filter(|normal| *normal != DVec3::ZERO)
}

/// True when the surface is much nearer to `point` than the hit of its line: beside sharp folds the control normal may
/// run along the surface, and the hit is on a part that the point has nothing to do with.
fn is_grazing(target: &Target, point: DVec3, hit: &Hit) -> bool {
    hit.s.abs() > FAR * target.reach
        && closest(target, point, Some(hit.normal)).is_some_and(|foot| hit.s.abs() > GRAZING * foot.distance)
}

/// The closest point within reach whose normal is on the side of `direction`.
fn closest(target: &Target, point: DVec3, direction: Option<DVec3>) -> Option<Foot> {
    let facing = direction.map(|normal| Facing { normal, min_cosine: 0.0 });
    target.surface.closest(point, &ClosestOptions { radius: target.reach, facing })
}

/// Moves boundary vertices so that their limit points lie on the frozen boundary curve; returns the steps taken and the
/// largest distance that is left.
fn fit_rim(
    mesh: &mut Mesh,
    rim: &[VertexId],
    target: &Target,
    method: Method,
    job: &Job,
) -> Result<(u32, f64), Cancelled> {
    let masks: Vec<LimitMask> = rim.iter().map(|&v| limit_mask(mesh, v)).collect();
    let unknowns: FxHashMap<VertexId, u32> = rim.iter().enumerate().map(|(i, &v)| (v, i as u32)).collect();
    let rows = masks.iter().map(|mask| {
        mask.iter().filter_map(|(v, weight)| Some((*unknowns.get(v)?, *weight))).collect::<Row>()
    });
    let system = (method == Method::Solve).then(|| LeastSquares::new(rows.collect(), rim.len())).flatten();
    let limit = if method == Method::Loop { LOOP_STEPS } else { SOLVE_STEPS };
    for step in 0..=limit {
        job.step("fit", 0.0)?;
        let gaps: Vec<DVec3> = masks
            .iter()
            .map(|mask| {
                let point = apply(mesh, mask);
                target.boundary.closest(point).map_or(DVec3::ZERO, |foot| foot - point)
            })
            .collect();
        let largest = gaps.iter().fold(0.0, |largest: f64, gap| largest.max(gap.length()));
        if largest <= TOLERANCE * target.reach || step == limit {
            return Ok((step, largest));
        }
        let axes = |axis: usize| gaps.iter().map(move |gap| gap[axis]);
        let shifts: [Vec<f64>; 3] = [0, 1, 2].map(|axis| match &system {
            Some(system) => system.solve(axes(axis)),
            None => axes(axis).collect(),
        });
        for (i, &v) in rim.iter().enumerate() {
            let shift = DVec3::new(shifts[0][i], shifts[1][i], shifts[2][i]);
            if shift.is_finite() {
                mesh.set_position(v, mesh.position(v) + shift);
            }
        }
    }
    Ok((limit, 0.0))
}
