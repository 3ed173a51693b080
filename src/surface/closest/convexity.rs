//! When is the squared distance of a point to a bicubic patch convex in the parameters?
//!
//! Then it has one minimum over the patch, and Newton's method finds it; this is what ends the search of a closest
//! point with certainty.

use super::Bicubic;
use glam::DVec3;

/// A patch seen from a point: the cheap part of the bounds.
pub(super) struct View {
    net: [DVec3; 16],
    /// From the point to the mean of the control points.
    way: DVec3,
    /// Largest distance of a control point from their mean.
    radius: f64,
    /// No point of the patch is closer than this.
    pub(super) at_least: f64,
}

/// The dearer part of the bounds.
pub(super) struct Convexity {
    /// Half the squared distance has a positive definite Hessian all over the patch.
    pub(super) convex: bool,
    /// False when the distance surely rises or falls all over the patch in one of the parameters.
    pub(super) may_have_foot: bool,
    /// False when all normals point away from the direction asked for.
    pub(super) may_face: bool,
}

/// Mean of vectors, and the largest distance of any of them from it.
fn spread<const N: usize>(vectors: &[DVec3; N]) -> (DVec3, f64) {
    let mean = vectors.iter().sum::<DVec3>() / N as f64;
    let radius = vectors.iter().map(|v| v.distance_squared(mean)).fold(0.0, f64::max).sqrt();
    (mean, radius)
}

/// Smallest and largest product with `w`, and the largest length.
fn products<const N: usize>(vectors: &[DVec3; N], w: DVec3) -> (f64, f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64);
    let (low, high, length) = vectors.iter().fold(start, |(low, high, length), &v| {
        let product = v.dot(w);
        (low.min(product), high.max(product), length.max(v.length_squared()))
    });
    (low, high, length.sqrt())
}

impl View {
    pub(super) fn new(bicubic: &Bicubic, point: DVec3) -> Self {
        let net = bicubic.net();
        let (middle, radius) = spread(&net);
        let way = middle - point;
        let direction = way.normalize_or_zero();
        let nearest = net.iter().map(|&q| q.dot(direction)).fold(f64::INFINITY, f64::min);
        Self { net, way, radius, at_least: nearest - point.dot(direction) }
    }

    /// Bounds on the derivatives; `facing` is the direction that normals should point to, or zero.
    pub(super) fn convexity(&self, facing: DVec3) -> Convexity {
        let (p, w, radius) = (&self.net, self.way, self.radius);
        // Control vectors of the derivatives; their factors 3 and 6 are left out together with the square of 3, so
        // that 2/3 stay with uu and vv.
        let du: [DVec3; 12] = std::array::from_fn(|k| p[k / 3 * 4 + k % 3 + 1] - p[k / 3 * 4 + k % 3]);
        let dv: [DVec3; 12] = std::array::from_fn(|k| p[k + 4] - p[k]);
        let duu: [DVec3; 8] = std::array::from_fn(|k| du[k / 2 * 3 + k % 2 + 1] - du[k / 2 * 3 + k % 2]);
        let dvv: [DVec3; 8] = std::array::from_fn(|k| dv[k + 4] - dv[k]);
        let duv: [DVec3; 9] = std::array::from_fn(|k| du[k + 3] - du[k]);
        let level = |slopes: (f64, f64, f64)| slopes.0 <= radius * slopes.2 && slopes.1 >= -radius * slopes.2;
        let may_have_foot = level(products(&du, w)) && level(products(&dv, w));

        let (a, a_spread) = spread(&du);
        let (b, b_spread) = spread(&dv);
        let (a_length, b_length) = (a.length(), b.length());
        let change = a_length * b_spread + b_length * a_spread + a_spread * b_spread;
        let may_face = a.cross(b).dot(facing) + change >= 0.0;

        let diagonal = |length: f64, spread: f64, bend: (f64, f64, f64)| {
            let slope = (length - spread).max(0.0);
            slope * slope + 2.0 / 3.0 * (bend.0 - radius * bend.2)
        };
        let uu = diagonal(a_length, a_spread, products(&duu, w));
        let vv = diagonal(b_length, b_spread, products(&dvv, w));
        let twist = products(&duv, w);
        let ab = a.dot(b);
        let uv = (ab + twist.0).abs().max((ab + twist.1).abs()) + change + radius * twist.2;
        Convexity { convex: uu > 0.0 && vv > 0.0 && uu * vv > uv * uv, may_have_foot, may_face }
    }
}
