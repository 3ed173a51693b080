//! Boundary and creases of the frozen surface as curves: their vertices stay on them.

use crate::mesh::{BoundaryRule, FaceId, HalfEdgeId, Mesh, VertexId};
use crate::subdivision::limit_mask;
use crate::subdivision::sharpness::is_infinite;
use glam::DVec3;

/// The limit curves of the sharp edges near a feature: boundary edges, unless the surface ends before them, and
/// infinitely sharp creases. They are uniform cubic B-splines that end in corners; an edge to a dart, whose curve is no
/// such spline, is left out.
#[derive(Clone, Default, Debug)]
pub struct SharpCurves {
    segments: Vec<Segment>,
}

/// True for an edge that bounds the surface on both sides.
fn is_sharp(mesh: &Mesh, h: HalfEdgeId) -> bool {
    let on_boundary = mesh.face(h).is_boundary() || mesh.face(h.mate()).is_boundary();
    let counts = on_boundary && mesh.subdivision().boundary != BoundaryRule::None;
    counts || is_infinite(mesh.edge_sharpness(h))
}

/// True for a vertex that stays on a sharp curve or in a corner: two or more sharp edges meet in it.
pub(super) fn is_on_curve(mesh: &Mesh, v: VertexId) -> bool {
    mesh.outgoing(v).filter(|&h| is_sharp(mesh, h)).nth(1).is_some()
}

/// The control point that continues a curve beyond the target of its last edge `h`.
fn beyond(mesh: &Mesh, h: HalfEdgeId) -> Option<DVec3> {
    let end = mesh.target(h);
    let mut others = mesh.outgoing(end).filter(|&other| other != h.mate() && is_sharp(mesh, other));
    let next = others.next()?;
    if limit_mask(mesh, end).len() == 1 {
        // A corner stays: the curve goes through it.
        return Some(2.0 * mesh.position(end) - mesh.position(mesh.source(h)));
    }
    Some(mesh.position(mesh.target(next)))
}

/// The curve of one sharp edge.
#[derive(Clone, Debug)]
struct Segment {
    control: [DVec3; 4],
    /// Box around the control points, which holds the curve.
    low: DVec3,
    high: DVec3,
}

impl Segment {
    fn new(control: [DVec3; 4]) -> Self {
        let (low, high) = control
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
        Self { control, low, high }
    }

    /// The squared distance that no point of the curve undercuts.
    fn bound(&self, point: DVec3) -> f64 {
        point.distance_squared(point.clamp(self.low, self.high))
    }

    /// The closest point and its squared distance.
    fn closest(&self, point: DVec3) -> (f64, DVec3) {
        let (mut u, mut least) = (0.0, f64::INFINITY);
        for i in 0..=STARTS {
            let start = i as f64 / STARTS as f64;
            let distance = evaluate(&self.control, start)[0].distance_squared(point);
            if distance < least {
                (u, least) = (start, distance);
            }
        }
        for _ in 0..NEWTON_STEPS {
            let [p, d, dd] = evaluate(&self.control, u);
            let slope = (p - point).dot(d);
            let curvature = d.length_squared() + (p - point).dot(dd);
            if curvature <= 0.0 {
                break;
            }
            let next = (u - slope / curvature).clamp(0.0, 1.0);
            if (next - u).abs() < 1e-15 {
                break;
            }
            u = next;
        }
        let foot = evaluate(&self.control, u)[0];
        (foot.distance_squared(point), foot)
    }
}

/// Parameters at which a segment is looked at before Newton takes over.
const STARTS: usize = 8;
const NEWTON_STEPS: usize = 20;

impl SharpCurves {
    /// The sharp curves along `faces`.
    pub fn around(mesh: &Mesh, faces: &[FaceId]) -> Self {
        let sharp = faces.iter().flat_map(|&f| mesh.face_half_edges(f)).filter(|&h| is_sharp(mesh, h));
        // Half-edges of one edge lie in two faces: the first will do.
        let mut edges: Vec<HalfEdgeId> = sharp.collect();
        edges.sort_unstable();
        edges.dedup_by_key(|h| h.edge());
        let segments = edges.into_iter().filter_map(|h| {
            let (first, last) = (beyond(mesh, h.mate())?, beyond(mesh, h)?);
            Some(Segment::new([first, mesh.position(mesh.source(h)), mesh.position(mesh.target(h)), last]))
        });
        Self { segments: segments.collect() }
    }

    /// The point of the curves closest to `point`; `None` where there is none.
    pub fn closest(&self, point: DVec3) -> Option<DVec3> {
        // The segment with the least bound first: it is nearly always the one, and rules out the others.
        let bounds: Vec<f64> = self.segments.iter().map(|segment| segment.bound(point)).collect();
        let first = (0..bounds.len()).min_by(|&a, &b| bounds[a].total_cmp(&bounds[b]))?;
        let mut best = self.segments[first].closest(point);
        for (segment, bound) in self.segments.iter().zip(bounds) {
            if bound < best.0 {
                let found = segment.closest(point);
                if found.0 < best.0 {
                    best = found;
                }
            }
        }
        Some(best.1)
    }
}

/// Position, first and second derivative of a uniform cubic B-spline segment at `u` in [0, 1].
pub(crate) fn evaluate(c: &[DVec3; 4], u: f64) -> [DVec3; 3] {
    let combine = |w: [f64; 4]| c[0] * w[0] + c[1] * w[1] + c[2] * w[2] + c[3] * w[3];
    let v = 1.0 - u;
    let (u2, u3) = (u * u, u * u * u);
    [
        combine([
            v * v * v / 6.0,
            (3.0 * u3 - 6.0 * u2 + 4.0) / 6.0,
            (-3.0 * u3 + 3.0 * u2 + 3.0 * u + 1.0) / 6.0,
            u3 / 6.0,
        ]),
        combine([-v * v / 2.0, (3.0 * u2 - 4.0 * u) / 2.0, (-3.0 * u2 + 2.0 * u + 1.0) / 2.0, u2 / 2.0]),
        combine([v, 3.0 * u - 2.0, -3.0 * u + 1.0, u]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evaluates_the_uniform_cubic_b_spline() {
        let c = [0.0, 1.0, 2.0, 3.0].map(|x| DVec3::new(x, x * x, 1.0));
        // Linear precision, and the known value (1 + 4 + 1)/6 of the squares at the knot: x^2 + 1/3.
        let [p, d, dd] = evaluate(&c, 0.0);
        assert!((p - DVec3::new(1.0, 1.0 + 1.0 / 3.0, 1.0)).length() < 1e-15);
        assert!((d - DVec3::new(1.0, 2.0, 0.0)).length() < 1e-15);
        assert!((dd - DVec3::new(0.0, 2.0, 0.0)).length() < 1e-15);
    }

    #[test]
    fn closest_on_a_straight_boundary() {
        let curves = SharpCurves {
            segments: vec![Segment::new([0.0, 1.0, 2.0, 3.0].map(|x| DVec3::new(x, 0.0, 0.0)))],
        };
        let foot = curves.closest(DVec3::new(1.3, 5.0, 2.0)).expect("a boundary");
        assert!((foot - DVec3::new(1.3, 0.0, 0.0)).length() < 1e-12);
        let end = curves.closest(DVec3::new(-4.0, 0.0, 0.0)).expect("a boundary");
        assert!((end - DVec3::new(1.0, 0.0, 0.0)).length() < 1e-12);
        assert!(SharpCurves::default().closest(DVec3::ZERO).is_none());
    }
}
