//! No fit may make the surface worse: where it does, vertices are held and the fit is done again.
//!
//! Beside sharp folds, where normals turn from vertex to vertex and edges are of very different lengths, the limit points
//! may lie on the surface and the surface between them far from it, further than without a fit. What is held follows
//! from all faces at once, so it does not depend on their order.

use super::Stop;
use super::parts::parts;
use super::samples::Samples;
use crate::job::Cancelled;
use crate::mesh::{Mesh, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Times that a fit is repeated with vertices held; then each part of the surface is left as it was where the fit makes it
/// worse in sum.
const REPEATS: u32 = 4;

/// How often each vertex was at a face that became worse.
pub(super) type Strikes = FxHashMap<VertexId, u32>;

/// What a fit came to.
pub(super) struct Outcome {
    pub(super) steps: u32,
    pub(super) stop: Stop,
    /// Largest distance after the last step.
    pub(super) residual: f64,
    /// Vertices that were held, because the surface would have become worse.
    pub(super) held: usize,
    /// Nothing was held, and curvature gained clearly everywhere.
    pub(super) is_clear: bool,
}

/// Runs `fit`, which moves vertices of `free`, and again with those held that strikes name as long as some faces are
/// worse than at the start. It gets samples that are evaluated at the positions of the mesh, and leaves them so. `in_degrees`
/// says that it holds a vertex the more the more strikes it has.
pub(super) fn guarded<'a>(
    mesh: &mut Mesh,
    free: &[VertexId],
    samples: &mut Samples<'a>,
    in_degrees: bool,
    mut fit: impl FnMut(&mut Mesh, &Strikes, &mut Samples<'a>) -> Result<Outcome, Cancelled>,
) -> Result<Outcome, Cancelled> {
    let start: Vec<DVec3> = free.iter().map(|&v| mesh.position(v)).collect();
    let before = samples.snapshot();
    let mut strikes = Strikes::default();
    let mut repeat = 0;
    let mut outcome = loop {
        let outcome = fit(mesh, &strikes, samples)?;
        let worse = samples.worse_faces(&before);
        if worse.is_empty() || repeat == REPEATS {
            break outcome;
        }
        let mut struck: Vec<VertexId> =
            worse.iter().flat_map(|&k| mesh.face_vertices(samples.faces[k].face)).collect();
        struck.sort_unstable();
        struck.dedup();
        // The same once more would come to the same.
        if !in_degrees && struck.iter().all(|v| strikes.contains_key(v)) {
            break outcome;
        }
        struck.into_iter().for_each(|v| *strikes.entry(v).or_default() += 1);
        free.iter().zip(&start).for_each(|(&v, &position)| mesh.set_position(v, position));
        samples.restore(&before, 0..before.errors.len());
        repeat += 1;
    };
    // Parts of the surface that no free vertex joins are judged one by one.
    outcome.is_clear = strikes.is_empty();
    for part in parts(free, samples) {
        outcome.is_clear &= samples.is_clear(&before, &part);
        if samples.is_worse(&before, &part) {
            for &k in &part {
                for v in samples.faces[k].control.iter() {
                    if let Ok(number) = free.binary_search(v) {
                        mesh.set_position(*v, start[number]);
                        *strikes.entry(*v).or_default() += 1;
                    }
                }
            }
            samples.restore(&before, part.into_iter());
        }
    }
    outcome.held = free.iter().filter(|v| strikes.contains_key(v)).count();
    outcome.residual = outcome.residual.max(samples.residual());
    Ok(outcome)
}
