//! The local minimum of the distance of a point to a bicubic patch.

use super::{Bicubic, Jet};
use glam::DVec3;

/// The minimum of the distance over the patch, by Newton's method that keeps to [0, 1]^2 (projected, with halved
/// steps where the distance would grow; Gauss-Newton where the Hessian is not positive).
pub(super) fn minimise(bicubic: &Bicubic, point: DVec3) -> (f64, f64, Jet) {
    let mut at = [0.5, 0.5];
    let mut jet = bicubic.jet(at[0], at[1]);
    for _ in 0..32 {
        let way = jet.position - point;
        let gradient = [way.dot(jet.du), way.dot(jet.dv)];
        // A parameter at its end stays there while the distance falls outwards.
        let free =
            [0, 1].map(|i| !(at[i] <= 0.0 && gradient[i] >= 0.0 || at[i] >= 1.0 && gradient[i] <= 0.0));
        let Some((mut step, mut exact)) = newton_step(&jet, way, gradient, free) else {
            break;
        };
        // A parameter that would leave at once waits while the other one moves.
        let leaves = [0, 1].map(|i| at[i] <= 0.0 && step[i] < 0.0 || at[i] >= 1.0 && step[i] > 0.0);
        if leaves[0] || leaves[1] {
            let staying = [free[0] && !leaves[0], free[1] && !leaves[1]];
            match newton_step(&jet, way, gradient, staying) {
                Some(other) => (step, exact) = (other.0, false),
                None => break,
            }
        }
        // Shorten the step so that it ends on the border that it crosses first.
        let mut fraction = 1.0f64;
        let mut border = None;
        for i in 0..2 {
            let end = if step[i] < 0.0 { -at[i] } else { 1.0 - at[i] };
            if step[i].abs() * fraction > end.abs() {
                fraction = end / step[i];
                border = Some((i, at[i] + end));
            }
        }
        step = step.map(|x| x * fraction);
        let before = way.length_squared();
        // A short step of Newton's needs no check, which rounding would make fail.
        let trusted = exact && step[0].abs().max(step[1].abs()) < 1e-4;
        let mut moved = false;
        for halved in 0..10 {
            let mut next = [0, 1].map(|i: usize| (at[i] + step[i]).clamp(0.0, 1.0));
            if let (0, Some((i, end))) = (halved, border) {
                next[i] = end;
            }
            let next_jet = bicubic.jet(next[0], next[1]);
            if trusted || next_jet.position.distance_squared(point) <= before {
                (at, jet, moved) = (next, next_jet, true);
                break;
            }
            step = step.map(|x| 0.5 * x);
        }
        // Newton's method squares the error: after a step of 1e-8 nothing is left to gain.
        let length = step[0].abs().max(step[1].abs());
        if !moved || border.is_none() && length < if exact { 1e-8 } else { 1e-15 } {
            break;
        }
    }
    (at[0], at[1], jet)
}

/// The step of the free parameters, and whether it is Newton's; `None` when none is free or nothing can be solved.
fn newton_step(jet: &Jet, way: DVec3, gradient: [f64; 2], free: [bool; 2]) -> Option<([f64; 2], bool)> {
    let first = [jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared()];
    let full = [first[0] + way.dot(jet.duu), first[1] + way.dot(jet.duv), first[2] + way.dot(jet.dvv)];
    let determinant = |h: &[f64; 3]| h[0] * h[2] - h[1] * h[1];
    let exact = match free {
        [false, false] => return None,
        [true, false] => full[0] > 0.0,
        [false, true] => full[2] > 0.0,
        [true, true] => full[0] > 0.0 && determinant(&full) > 0.0,
    };
    // Gauss-Newton, with a little damping where the patch is collapsed in one direction.
    let damping = 1e-9 * (first[0] + first[2]);
    let h = if exact { full } else { [first[0] + damping, first[1], first[2] + damping] };
    let step = match free {
        [true, true] => {
            let d = determinant(&h);
            [(h[1] * gradient[1] - h[2] * gradient[0]) / d, (h[1] * gradient[0] - h[0] * gradient[1]) / d]
        }
        [true, false] => [-gradient[0] / h[0], 0.0],
        _ => [0.0, -gradient[1] / h[2]],
    };
    (step[0].is_finite() && step[1].is_finite()).then_some((step, exact))
}
