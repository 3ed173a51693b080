//! Curvature of the limit surface from its first and second derivatives.

use super::SurfacePoint;
use glam::{DMat2, DVec2, DVec3};

/// Curvature at a point of a surface (do Carmo 1976, section 3.3). Signed: positive where the surface bends towards its
/// normal, so a sphere of radius r with outward normals has both principal curvatures -1/r. Per model unit; Gaussian
/// curvature per square unit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Curvature {
    /// Principal curvatures, the greater first.
    pub principal: [f64; 2],
    /// Unit tangents along which the normal curvature takes these values; perpendicular to each other and, with the
    /// normal third, right-handed. Where both values are equal any pair would do; one is given.
    pub directions: [DVec3; 2],
    /// Mean of the principal curvatures.
    pub mean: f64,
    /// Product of the principal curvatures.
    pub gaussian: f64,
}

/// Tangents whose parallelogram is below this part of their lengths' product span no plane.
const PARALLEL: f64 = 1e-12;

impl SurfacePoint {
    /// The curvature here; `None` at an extraordinary vertex, where second derivatives are not defined, and where the
    /// tangents do not span a plane.
    pub fn curvature(&self) -> Option<Curvature> {
        let second = self.second?;
        let (length, n) = (self.du.length(), self.normal);
        // An orthonormal frame (x, y) of the tangent plane; du = a x, dv = b x + c y.
        let x = self.du / length;
        let y = n.cross(x);
        let (b, c) = (self.dv.dot(x), self.dv.dot(y));
        let flat = c.abs() > PARALLEL * self.dv.length() && x.is_finite() && n != DVec3::ZERO;
        if !flat {
            return None;
        }
        let to_parameters =
            DMat2::from_cols(DVec2::new(1.0 / length, 0.0), DVec2::new(-b / (length * c), 1.0 / c));
        let mixed = n.dot(second.uv);
        let form = DMat2::from_cols(DVec2::new(n.dot(second.uu), mixed), DVec2::new(mixed, n.dot(second.vv)));
        let shape = to_parameters.transpose() * form * to_parameters;
        let mean = 0.5 * (shape.x_axis.x + shape.y_axis.y);
        let half_difference = 0.5 * (shape.x_axis.x - shape.y_axis.y);
        let off_diagonal = 0.5 * (shape.x_axis.y + shape.y_axis.x);
        let radius = half_difference.hypot(off_diagonal);
        let angle = 0.5 * off_diagonal.atan2(half_difference);
        let first = x * angle.cos() + y * angle.sin();
        let found = Curvature {
            principal: [mean + radius, mean - radius],
            directions: [first, n.cross(first)],
            mean,
            gaussian: shape.determinant(),
        };
        found.mean.is_finite().then_some(found)
    }
}
