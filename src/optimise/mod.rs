//! Fits a changed control mesh to the limit surface that was frozen before the change (paper, section 5.3).
//!
//! For each active vertex the limit point is to lie on the frozen surface. The vertex moves along the frozen
//! surface's normal `m` at the foot of its first limit point. [`Method::Loop`] repeats the paper's update,
//! [`Method::Solve`] solves the sparse system whose solution that update converges to. [`Method::Fit`] and
//! [`Method::FitSlide`] fit the surface between the limit points too. Vertices of the boundary and of creases stay on the
//! frozen curves. `docs/optimisation.md` compares the methods.

mod assembly;
mod curves;
mod freedom;
mod guard;
mod judge;
mod linear;
mod lines;
mod parts;
mod rim;
mod samples;
mod surface_fit;
mod walk;

pub use curves::SharpCurves;
pub(crate) use curves::evaluate as evaluate_b_spline;
pub(crate) use linear::{LeastSquares, Row};

use crate::job::Job;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::surface::{FreezeError, LimitSurface};
use curves::is_on_curve;
use freedom::freedom;
use judge::Judge;
use rim::fit_rim;
use samples::Samples;
use serde::Serialize;
use surface_fit::SurfaceFit;
use walk::Beside;

/// How to fit.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Leave the vertices where the rules put them.
    None,
    /// The paper's iteration.
    Loop,
    /// The sparse system the iteration converges to.
    Solve,
    /// Least squares of distance and slope over samples of the surface; vertices move along the normal.
    Fit,
    /// The same; vertices that were there before may also slide along the surface, so that the new ones keep the width
    /// of a feature.
    FitSlide,
}

impl Method {
    /// All methods, with the names that the program and the C ABI use.
    pub const ALL: [(&'static str, Self); 5] = [
        ("none", Self::None),
        ("loop", Self::Loop),
        ("solve", Self::Solve),
        ("fit", Self::Fit),
        ("fit+slide", Self::FitSlide),
    ];

    /// The method called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|entry| entry.0 == name).map(|entry| entry.1)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|entry| entry.1 == self).map_or("", |entry| entry.0)
    }

    /// Rings of faces around the changed ones whose vertices may move.
    pub fn active_rings(self) -> usize {
        match self {
            Self::None | Self::Loop | Self::Solve => 1,
            Self::Fit => 1,
            Self::FitSlide => 2,
        }
    }

    /// Rings of faces around the changed ones that a [`Target`] must hold.
    pub fn frozen_rings(self) -> usize {
        match self {
            Self::None | Self::Loop | Self::Solve => 1,
            // The surface moves one face beyond the faces of the active vertices, and feet lie one further.
            Self::Fit | Self::FitSlide => self.active_rings() + 3,
        }
    }
}

/// Why the fit stopped.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stop {
    /// Nothing was asked for, or nothing was active.
    Nothing,
    /// So far from the origin numbers are too coarse for the edges: nothing could be measured, and nothing was moved.
    TooCoarse,
    /// Every limit point is closer to the frozen surface than the tolerance.
    Converged,
    /// The allowed number of steps was taken, or as many as came closer.
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
    /// Largest distance to the frozen surface after the last step, of a limit point along its line or, for the surface
    /// fits, of a sample (model units).
    pub residual: f64,
    /// Active vertices that were held where they are, because the surface would have become worse than without a fit.
    pub held: usize,
    /// Of these the ones that were moved and taken back to where they were, because the result was worse, ascending.
    #[serde(skip)]
    pub taken_back: Vec<VertexId>,
    /// Active vertices whose line and closest point found no frozen surface, at once or, where steps are many, again and
    /// again; they were not fitted, or no further.
    pub missed: Vec<u32>,
}

/// Steps of [`Method::Loop`] at most. The paper needs fewer than 20; the slowest mode of a flat grid has ratio 8/9.
const LOOP_STEPS: u32 = 100;
/// Outer steps of [`Method::Solve`] (docs/linear-features.md, section 3: the residual is at rounding level after two).
const SOLVE_STEPS: u32 = 3;
/// Samples per side of a quad in [`Method::Fit`] and [`Method::FitSlide`], at Gauss points.
const ORDER: usize = 3;
/// Weight of the slopes as a length, in edges, where vertices move along normals: more would move the surface further
/// off, less would make ripples.
const SLOPE: f64 = 0.3;
/// The same where they may slide.
const SLOPE_SLIDING: f64 = 0.5;
/// Nothing is fitted where rounding is beyond this share of `reach`.
const COARSE: f64 = 0.01;
/// Tolerance on the limit points, relative to `reach`.
const TOLERANCE: f64 = 1e-7;

/// The frozen surface that a fit aims at.
#[derive(Clone, Debug)]
pub struct Target {
    /// The surface.
    pub surface: LimitSurface,
    /// How its quads lie beside each other.
    beside: Beside,
    /// Its boundary and creases.
    pub curves: SharpCurves,
    /// Vertices below this number were there when it was frozen.
    pub vertices: usize,
    /// How far a limit point may be from it, in model units: twice the mean edge (a foot further away belongs to another part of the shape).
    pub reach: f64,
}

impl Target {
    /// Freezes the limit surface of `faces`.
    ///
    /// # Errors
    /// [`FreezeError`].
    pub fn freeze(mesh: &Mesh, faces: &[FaceId], job: &Job) -> Result<Self, FreezeError> {
        let (mut sum, mut count) = (0.0, 0u32);
        for h in faces.iter().flat_map(|&f| mesh.face_half_edges(f)) {
            sum += mesh.edge_length(h);
            count += 1;
        }
        Ok(Self {
            surface: LimitSurface::around_with(mesh, faces, job)?,
            beside: Beside::new(mesh, faces),
            curves: SharpCurves::around(mesh, faces),
            vertices: mesh.vertex_bound(),
            reach: 2.0 * sum / f64::from(count.max(1)),
        })
    }
}

/// What a fit may move: vertices of `changed` faces and of the faces around them, ascending.
pub fn active_set(mesh: &Mesh, changed: &[FaceId], method: Method) -> Vec<VertexId> {
    let faces = (0..method.active_rings()).fold(changed.to_vec(), |faces, _| mesh.grow_faces(&faces));
    let mut vertices: Vec<VertexId> = faces.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// Moves the `active` vertices of `mesh` so that its limit surface comes close to the frozen one.
///
/// Where that makes a face worse than it was, vertices are held, so no method ends further away than the
/// start.
///
/// # Errors
/// [`FreezeError`]; the mesh may have moved by then, so run this inside a transaction.
pub fn fit(
    mesh: &mut Mesh,
    active: &[VertexId],
    target: &Target,
    method: Method,
    job: &Job,
) -> Result<FitReport, FreezeError> {
    let mut report = FitReport {
        method,
        active: 0,
        steps: 0,
        stop: Stop::Nothing,
        residual: 0.0,
        held: 0,
        taken_back: Vec::new(),
        missed: Vec::new(),
    };
    if method == Method::None || active.is_empty() {
        return Ok(report);
    }
    report.active = active.len();
    if target.surface.rounding() > COARSE * target.reach {
        report.stop = Stop::TooCoarse;
        return Ok(report);
    }
    let (rim, mut inner): (Vec<VertexId>, Vec<VertexId>) =
        active.iter().partition(|&&v| is_on_curve(mesh, v));
    // Where the surface ends before the boundary, vertices of the boundary have no point on it.
    inner.retain(|&v| !mesh.is_boundary_vertex(v));
    let slide = method == Method::FitSlide;
    let mut samples = match method {
        // Beyond the active vertices the frozen surface may end.
        Method::None | Method::Loop | Method::Solve => {
            Samples::new(mesh, active, target, 1, SLOPE, false, false)
        }
        // Along normals alone curvature can hardly be kept: nearly everything would be held.
        Method::Fit => Samples::new(mesh, active, target, ORDER, SLOPE, true, false),
        Method::FitSlide => Samples::new(mesh, active, target, ORDER, SLOPE_SLIDING, true, true),
    };
    let judge = if slide {
        samples.evaluate(mesh, job)?;
        Some(Judge::new(mesh, active, target, &samples, SLOPE_SLIDING))
    } else {
        None
    };
    // The limit of a vertex on a sharp curve depends on such vertices only, so the rim comes first.
    let (rim_steps, rim_gap) = fit_rim(mesh, &rim, target, method, job)?;
    if rim_steps > 0 || !slide {
        samples.evaluate(mesh, job)?;
    }
    let mut missed = Vec::new();
    let outcome = match method {
        Method::None | Method::Loop | Method::Solve => {
            guard::guarded(mesh, &inner, &mut samples, false, |mesh, strikes, samples| {
                missed.clear();
                let free: Vec<VertexId> =
                    inner.iter().copied().filter(|v| !strikes.contains_key(v)).collect();
                let outcome = lines::run(mesh, &free, target, method, &mut missed, job)?;
                samples.evaluate(mesh, job)?;
                Ok(outcome)
            })?
        }
        Method::Fit | Method::FitSlide => {
            let mut freedoms = Vec::with_capacity(inner.len());
            // What is not sampled must not move unseen.
            let seen = |v: &VertexId| !mesh.outgoing(*v).any(|h| samples::is_large(mesh, mesh.face(h)));
            for &v in inner.iter().filter(|v| seen(v)) {
                match freedom(mesh, v, target, slide) {
                    Some(freedom) => freedoms.push((v, freedom)),
                    None => missed.push(v.0),
                }
            }
            guard::guarded(mesh, &inner, &mut samples, true, |mesh, strikes, samples| {
                SurfaceFit::new(mesh, &freedoms, strikes, samples, job).run(mesh)
            })?
        }
    };
    report.stop = outcome.stop;
    report.steps = outcome.steps.max(rim_steps);
    report.residual = outcome.residual.max(rim_gap);
    report.held = outcome.held;
    // Moved rims were not seen by the samples of the fit.
    if let Some(judge) = judge.filter(|_| !outcome.is_clear || rim_steps > 0) {
        report.taken_back = judge.settle(mesh, &samples, job)?;
        report.held = report.held.max(report.taken_back.len());
    }
    missed.sort_unstable();
    report.missed = missed;
    Ok(report)
}
