//! Vertices of sharp curves stay on them.

use super::lines::apply;
use super::{LOOP_STEPS, LeastSquares, Method, Row, SOLVE_STEPS, TOLERANCE, Target};
use crate::job::{Cancelled, Job};
use crate::mesh::{Mesh, VertexId};
use crate::subdivision::{LimitMask, limit_mask};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Moves boundary vertices so that their limit points lie on the frozen boundary curve; returns the steps taken and the
/// largest distance that is left.
pub(super) fn fit_rim(
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
    let system = (method != Method::Loop).then(|| LeastSquares::new(rows.collect(), rim.len())).flatten();
    let limit = if method == Method::Loop { LOOP_STEPS } else { SOLVE_STEPS };
    for step in 0..=limit {
        job.step("fit", 0.0)?;
        let gaps: Vec<DVec3> = masks
            .iter()
            .map(|mask| {
                let point = apply(mesh, mask);
                target.curves.closest(point).map_or(DVec3::ZERO, |foot| foot - point)
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
