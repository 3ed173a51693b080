//! No fit may make the surface worse: where it does, vertices are held and the fit is done again.
//!
//! Beside sharp folds, where normals turn from vertex to vertex and edges are of very different lengths, the limit points
//! may lie on the surface and the surface between them far from it, further than without a fit.

use super::Stop;
use super::samples::Samples;
use crate::job::{Cancelled, Job};
use crate::mesh::{Mesh, VertexId};
use glam::DVec3;

/// Times that a fit is repeated with vertices held; then the better of the fit and the start is kept.
const REPEATS: u32 = 3;

/// What a fit came to.
pub(super) struct Outcome {
    pub(super) steps: u32,
    pub(super) stop: Stop,
    /// Largest distance after the last step.
    pub(super) residual: f64,
    /// Vertices that were held, because the surface would have become worse.
    pub(super) held: usize,
}

/// Runs `fit` on `free` vertices, and again on fewer of them as long as some faces are worse than at the start. It gets
/// samples that are evaluated at the positions of the mesh, and leaves them so.
pub(super) fn guarded<'a>(
    mesh: &mut Mesh,
    mut free: Vec<VertexId>,
    samples: &mut Samples<'a>,
    job: &Job,
    mut fit: impl FnMut(&mut Mesh, &[VertexId], &mut Samples<'a>) -> Result<Outcome, Cancelled>,
) -> Result<Outcome, Cancelled> {
    let start: Vec<(VertexId, DVec3)> = free.iter().map(|&v| (v, mesh.position(v))).collect();
    samples.evaluate(mesh, job)?;
    let (errors, error) = (samples.errors(), samples.error());
    for repeat in 0..=REPEATS {
        let outcome = fit(mesh, &free, samples)?;
        let worse = samples.worse_than(mesh, &errors);
        let is_last = worse.is_empty() || repeat == REPEATS;
        if is_last && samples.is_as_near(error) {
            return Ok(Outcome { held: start.len() - free.len(), ..outcome });
        }
        for &(v, position) in &start {
            mesh.set_position(v, position);
        }
        samples.evaluate(mesh, job)?;
        if is_last {
            break;
        }
        free.retain(|v| !worse.contains(v));
    }
    Ok(Outcome { steps: 0, stop: Stop::Nothing, residual: samples.residual(), held: start.len() })
}
