//! Exact evaluation of the limit surface at any parameter of any face.

use super::has_limit;
use super::patch::{Evaluated, Patch};
use crate::mesh::{FaceId, Mesh};
use glam::DVec3;

/// A point of the limit surface with its derivatives.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SurfacePoint {
    /// Position.
    pub position: DVec3,
    /// Derivative by u. At an extraordinary vertex: a tangent along the edge, of conventional length.
    pub du: DVec3,
    /// Derivative by v. At an extraordinary vertex: a tangent along the edge, of conventional length.
    pub dv: DVec3,
    /// Second derivatives; `None` at an extraordinary vertex, where they are not defined.
    pub second: Option<SecondDerivatives>,
    /// Unit normal, on the side from which faces are counter-clockwise; zero where the surface has none.
    pub normal: DVec3,
}

/// Second derivatives by u twice, by u and v, by v twice.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SecondDerivatives {
    /// By u twice.
    pub uu: DVec3,
    /// By u and v.
    pub uv: DVec3,
    /// By v twice.
    pub vv: DVec3,
}

impl From<Evaluated> for SurfacePoint {
    fn from(found: Evaluated) -> Self {
        let Evaluated { jet, normal, smooth } = found;
        let second = SecondDerivatives { uu: jet.duu, uv: jet.duv, vv: jet.dvv };
        Self { position: jet.position, du: jet.du, dv: jet.dv, second: smooth.then_some(second), normal }
    }
}

/// Evaluates the Catmull-Clark limit surface of `mesh`, with its sharpness and options.
///
/// A quad has `corner` 0 only, with (u, v) in [0, 1]^2 from its first corner, u along the first edge and v against
/// the last one. A face of k edges has one quadrant per corner: (0, 0) is the corner, (1, 0) the middle of the edge
/// to the next corner, (0, 1) the middle of the edge from the previous corner, (1, 1) the face point. Parameters
/// outside [0, 1] are moved to the nearest inside. `None` for a face or corner that does not exist, for a face without
/// a limit surface ([`has_limit`](super::has_limit)) and for NaN.
///
/// Each call builds the patch anew from the faces around; for many points in the same faces freeze a
/// [`LimitSurface`](crate::surface::LimitSurface).
pub fn evaluate(mesh: &Mesh, face: FaceId, corner: usize, u: f64, v: f64) -> Option<SurfacePoint> {
    if u.is_nan() || v.is_nan() || !mesh.has_face(face) || !has_limit(mesh, face) {
        return None;
    }
    Patch::evaluate_at(mesh, face, corner, u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)).map(Into::into)
}
