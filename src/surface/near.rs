//! Queries that start from a known place of the surface: Newton's method inside one patch.
//!
//! Much faster than a search, and enough where the answer is known to be near, as in the steps of a fit. They answer
//! only when the result lies in the patch of the start; callers search otherwise.

use super::{Foot, Hit, LimitSurface};
use crate::mesh::FaceId;
use glam::{DMat2, DMat3, DVec2, DVec3};

/// Newton converges quadratically from a near start; more steps mean that the start was not near.
const STEPS: usize = 12;
/// Steps below this, in parameters, change nothing.
const CONVERGED: f64 = 1e-14;

impl LimitSurface {
    /// The hit of a line, found from a hit of a nearby line. `None` when there is none in the same patch.
    pub fn line_hit_near(&self, start: &Hit, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let patch = self.patch_index(start.face, start.corner)?;
        let (mut u, mut v, mut s) = (start.u, start.v, start.s);
        for _ in 0..STEPS {
            let point = self.evaluate_patch(patch, u, v);
            let gap = origin + direction * s - point.position;
            let step = DMat3::from_cols(point.du, point.dv, -direction).inverse() * gap;
            (u, v, s) = (u + step.x, v + step.y, s + step.z);
            // Also false for a step that is not a number: the direction is tangent there.
            if !inside(u, v) {
                return None;
            }
            if step.x.abs().max(step.y.abs()) < CONVERGED {
                let point = self.evaluate_patch(patch, u, v);
                let s = (point.position - origin).dot(direction) / direction.length_squared();
                return Some(Hit { u, v, s, position: point.position, normal: point.normal, ..*start });
            }
        }
        None
    }

    /// The foot of the perpendicular from `point`, found from (u, v) of a patch near it. `None` when there is none in the
    /// same patch.
    pub fn foot_near(&self, face: FaceId, corner: usize, u: f64, v: f64, point: DVec3) -> Option<Foot> {
        let patch = self.patch_index(face, corner)?;
        let (mut u, mut v) = (u, v);
        for _ in 0..STEPS {
            let here = self.evaluate_patch(patch, u, v);
            let second = here.second?;
            let gap = here.position - point;
            let gradient = DVec2::new(gap.dot(here.du), gap.dot(here.dv));
            let mixed = here.du.dot(here.dv) + gap.dot(second.uv);
            let hessian = DMat2::from_cols(
                DVec2::new(here.du.length_squared() + gap.dot(second.uu), mixed),
                DVec2::new(mixed, here.dv.length_squared() + gap.dot(second.vv)),
            );
            // Only a minimum of the distance is a foot.
            if !(hessian.determinant() > 0.0 && hessian.x_axis.x > 0.0) {
                return None;
            }
            let step = hessian.inverse() * gradient;
            (u, v) = (u - step.x, v - step.y);
            if !inside(u, v) {
                return None;
            }
            if step.abs().max_element() < CONVERGED {
                let here = self.evaluate_patch(patch, u, v);
                return Some(Foot {
                    face,
                    corner,
                    u,
                    v,
                    position: here.position,
                    normal: here.normal,
                    distance: here.position.distance(point),
                });
            }
        }
        None
    }
}

fn inside(u: f64, v: f64) -> bool {
    (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)
}
