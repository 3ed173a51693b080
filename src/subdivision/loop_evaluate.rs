//! Exact evaluation of a Loop surface at any parameter of any triangle.

use super::evaluate::SurfacePoint;
use super::has_limit;
use super::loop_box_spline;
use super::loop_refine::LoopSurface;
use super::loop_ring::LoopRing;
use super::patch::Evaluated;
use super::patch_bicubic::Jet;
use crate::mesh::FaceId;
use glam::DVec3;

/// Beyond this depth a parameter counts as the vertex itself; the subdominant eigenvalue is below 0.63.
const MAX_DEPTH: usize = 128;

/// How the children's parameters run with the parent's: per child the derivatives of u and of v, and their values at the
/// parent's first corner.
const CHILDREN: [([[f64; 2]; 2], [f64; 2]); 4] = [
    ([[2.0, 0.0], [0.0, 2.0]], [0.0, 0.0]),
    ([[0.0, 2.0], [-2.0, -2.0]], [0.0, 2.0]),
    ([[-2.0, -2.0], [2.0, 0.0]], [2.0, 0.0]),
    ([[-2.0, 0.0], [0.0, -2.0]], [1.0, 1.0]),
];

fn child_of(u: f64, v: f64) -> usize {
    match (u + v <= 0.5, u >= 0.5, v >= 0.5) {
        (true, ..) => 0,
        (_, true, _) => 1,
        (_, _, true) => 2,
        _ => 3,
    }
}

/// A jet in the parameters (x, y) as one in (u, v), of which (x, y) has the constant derivatives `slope`.
fn chained(jet: &Jet, slope: &[[f64; 2]; 2]) -> Jet {
    let [[xu, xv], [yu, yv]] = *slope;
    let second =
        |a: f64, b: f64, c: f64, d: f64| a * c * jet.duu + (a * d + b * c) * jet.duv + b * d * jet.dvv;
    Jet {
        position: jet.position,
        du: xu * jet.du + yu * jet.dv,
        dv: xv * jet.du + yv * jet.dv,
        duu: second(xu, yu, xu, yu),
        duv: second(xu, yu, xv, yv),
        dvv: second(xv, yv, xv, yv),
    }
}

impl LoopSurface<'_> {
    /// The surface at (u, v) of a triangle, where u and v are the weights of its second and third corner: the triangle is
    /// u >= 0, v >= 0, u + v <= 1; parameters outside are moved into it. `None` for a face that does not exist or has no limit
    /// surface ([`has_limit`]) and for NaN.
    ///
    /// At an extraordinary vertex, and where creases meet, the derivatives are the edges of the plane that
    /// [`limit_point`](Self::limit_point) gives, of conventional length, and second derivatives are not defined.
    pub fn evaluate(&self, face: FaceId, u: f64, v: f64) -> Option<SurfacePoint> {
        let mesh = self.mesh;
        if u.is_nan() || v.is_nan() || !mesh.has_face(face) || !has_limit(mesh, face) {
            return None;
        }
        let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        let excess = (u + v).max(1.0);
        let (mut x, mut y) = (u / excess, v / excess);
        // Lengths keep their precision near the vertex to which the parameter may lead.
        let nearest = [1.0 - x - y, x, y]
            .iter()
            .enumerate()
            .fold(0, |best, (i, &w)| if w > [1.0 - x - y, x, y][best] { i } else { best });
        let vertex = mesh.face_vertices(face).nth(nearest)?;
        let limit = self.limit_point(vertex);
        let mut ring = LoopRing::new(mesh, face, limit.position)?;
        let mut slope = [[1.0, 0.0], [0.0, 1.0]];
        for _ in 0..MAX_DEPTH {
            if let Some(net) = ring.net() {
                let mut jet = chained(&loop_box_spline::jet(&net, x, y), &slope);
                jet.position += limit.position;
                return Some(Evaluated::regular(jet).into());
            }
            let child = child_of(x, y);
            let (step, [x0, y0]) = CHILDREN[child];
            (x, y) = (x0 + step[0][0] * x + step[0][1] * y, y0 + step[1][0] * x + step[1][1] * y);
            (x, y) = (x.clamp(0.0, 1.0), y.clamp(0.0, 1.0));
            slope = step.map(|row| std::array::from_fn(|j| row[0] * slope[0][j] + row[1] * slope[1][j]));
            ring = ring.child(child);
        }
        let normal = limit.normal().unwrap_or(DVec3::ZERO);
        let [du, dv] = limit.tangents;
        let jet = Jet { position: limit.position, du, dv, ..Jet::default() };
        Some(Evaluated { jet, normal, smooth: false }.into())
    }
}
